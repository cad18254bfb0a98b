//! The news of a run.

#[cfg(feature = "history")]
mod compare;

use crate::terminal::TableOptions;
use crate::words::plain;
use etalon_record::{Expected, Run, Verdict};
use serde::Serialize;
use std::borrow::Cow;
use std::collections::HashMap;

/// The maximum number of entries of a kind that a terminal lists.
const LISTED: usize = 20;

/// A run compared with the last run of each of its adapters.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RunNews {
    /// Each adapter with the run that it was compared with, in words.
    pub since: Vec<Since>,
    /// Unexpected records that became worse, the most serious first.
    pub broken: Vec<NewsEntry>,
    /// Unexpected records of adapters without an earlier run.
    pub uncompared: Vec<NewsEntry>,
    /// Records that are no longer unexpected, and better.
    pub fixed: Vec<NewsEntry>,
    /// Records that are no longer unexpected, and not better: now expected, unsupported or skipped.
    pub undecided: Vec<NewsEntry>,
    /// Records that are still unexpected, and not worse.
    pub old: Vec<NewsEntry>,
    /// Unexpected records that triage settled as real or ignored. They do not count.
    pub triaged: Vec<NewsEntry>,
}

/// An adapter and the run that it was compared with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Since {
    /// The adapter's name.
    pub adapter: String,
    /// The previous run, with its driver and commit; `None` if no earlier run can be compared.
    pub run: Option<String>,
}

/// A record with a note.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct NewsEntry {
    /// The case's id.
    pub case: String,
    /// The adapter's name.
    pub adapter: String,
    /// The verdict of this run, as recorded.
    pub verdict: Verdict,
    /// The previous verdict, or the reason why the record does not count.
    pub note: String,
}

impl RunNews {
    /// Returns the number of records that count against the run of these news, also beside its selected cases.
    pub fn counted(&self, run: &Run) -> u64 {
        (self.broken.len() + self.uncompared.len() + self.old.len()) as u64
            + run.unexpected_beside()
    }

    /// Returns the run as reports show it: records that triage settled count as expected, with the entry's
    /// reason.
    pub fn settle<'r>(&self, run: &'r Run) -> Cow<'r, Run> {
        if self.triaged.is_empty() {
            return Cow::Borrowed(run);
        }
        let notes = self.triaged.iter();
        let notes: HashMap<(&str, &str), &str> = notes
            .map(|entry| ((&*entry.case, &*entry.adapter), &*entry.note))
            .collect();
        let mut run = run.clone();
        for record in run.records.iter_mut().filter(|r| r.unexpected()) {
            if let Some(note) = notes.get(&(&*record.case, &*record.adapter)) {
                record.expected = Some(Expected {
                    reason: format!("triage {note}"),
                });
            }
        }
        Cow::Owned(run)
    }

    /// Returns the kinds of entries in the order of reports, each with its title.
    pub(crate) fn sections(&self) -> [(&'static str, &[NewsEntry]); 6] {
        [
            ("broken since the last run", &self.broken),
            ("fixed since the last run", &self.fixed),
            ("bad, nothing to compare", &self.uncompared),
            ("no longer counted, but not fixed", &self.undecided),
            ("unexpected as before", &self.old),
            ("settled by triage, not counted", &self.triaged),
        ]
    }
}

/// Returns the news for a terminal, new entries first. Always ends in a newline.
pub fn news_table(news: &RunNews, options: TableOptions) -> String {
    let mut text = String::new();
    for since in &news.since {
        let adapter = plain(&since.adapter, 60);
        text.push_str(&match &since.run {
            Some(run) => format!("{adapter}: compared with {}\n", plain(run, 400)),
            None => format!("{adapter}: no earlier run to compare with\n"),
        });
    }
    for (number, (title, entries)) in news.sections().into_iter().enumerate() {
        let color = ["31", "32", "31", "0", "0", "0"][number];
        let head = format!("{} {title}", entries.len());
        if entries.is_empty() && number > 1 {
            continue;
        }
        let color = if entries.is_empty() { "" } else { color };
        text += &format!("{}\n", options.paint(&head, color));
        for entry in entries.iter().take(LISTED) {
            text += &format!("  {}\n", line(entry));
        }
        if let Some(more @ 1..) = entries.len().checked_sub(LISTED) {
            text += &format!("  and {more} more\n");
        }
    }
    text
}

fn line(entry: &NewsEntry) -> String {
    format!(
        "{}  {}  {}: {}",
        entry.verdict,
        plain(&entry.adapter, 60),
        plain(&entry.case, 300),
        plain(&entry.note, 400)
    )
}
