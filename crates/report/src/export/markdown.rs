//! `summary.md`, for the job page of a continuous integration.
//!
//! GitHub takes at most one MiB for a step's summary and throws away what is longer, so the file stays
//! below [`LIMIT`] bytes for every run, and states what it leaves out. Texts of a run may be
//! hostile: text goes through [`escaped`], names and commands through [`code`].

use crate::command;
use crate::export::status::{incomplete, particulars};
use crate::news::{NewsEntry, RunNews};
use crate::numbers::{count, percent_of};
use crate::run::grid::VerdictTally;
use crate::run::unexpected::unexpected_records;
use crate::table::{Table, some};
use crate::words::{Tone, headline, name, plain, symbol};
use etalon_frame::Aspect;
use etalon_record::{Assertion, Record, Run, Verdict};
use std::collections::BTreeMap;

/// The upper limit of the file's size in bytes.
pub(crate) const LIMIT: usize = 1_000_000;
/// The maximum number of records that a list names; longer lists belong on a page that can be searched.
const LISTED: usize = 500;

/// A text that grows up to a limit.
struct MarkdownText {
    text: String,
    /// The length of the text at which the current section must end.
    until: usize,
}

impl MarkdownText {
    /// Begins a section that can fill the text up to `until` bytes.
    fn section(&mut self, until: usize) {
        self.until = until.min(LIMIT - 4096);
    }

    /// Adds a line if there is room for it.
    fn line(&mut self, line: &str) -> bool {
        let fits = self.text.len() + line.len() < self.until;
        if fits {
            self.text.push_str(line);
            self.text.push('\n');
        }
        fits
    }

    /// Adds a section with a table.
    fn table<R>(&mut self, title: &str, table: &Table<'_, R>, rows: impl IntoIterator<Item = R>) {
        let (head, rows) = table.markdown(rows);
        self.line(&format!("## {title}\n"));
        self.line(&head);
        self.lines(&rows, LISTED, String::clone);
        self.line("");
    }

    /// Adds a section with a line per item, unless there are no items.
    fn list<T>(&mut self, title: &str, items: &[T], line: impl Fn(&T) -> String) {
        if !items.is_empty() {
            self.line(&format!("## {title}\n"));
            self.lines(items, LISTED, line);
            self.line("");
        }
    }

    /// Adds at most `most` lines while there is room, and the number of the lines left out.
    fn lines<T>(&mut self, items: &[T], most: usize, line: impl Fn(&T) -> String) {
        let shown = items
            .iter()
            .take(most)
            .take_while(|item| self.line(&line(item)));
        let left = items.len() - shown.count();
        if left > 0 {
            // Room for this line was reserved.
            self.text += &format!("\n{left} more left out of this summary.\n");
        }
    }
}

/// Returns the content of `summary.md`.
pub(crate) fn summary(run: &Run, news: Option<&RunNews>) -> String {
    let mut text = MarkdownText {
        text: String::new(),
        until: 0,
    };
    text.section(100_000);
    head(&mut text, run, news);
    if let Some(news) = news {
        text.section(200_000);
        told(&mut text, news);
    }
    if !run.records.is_empty() {
        text.section(250_000);
        adapters(&mut text, run);
        text.section(700_000);
        unexpected(&mut text, run);
        text.section(800_000);
        improvements(&mut text, run);
        text.section(900_000);
        asserted(&mut text, run);
    }
    text.section(950_000);
    absent(&mut text, run);
    text.text
}

fn head(text: &mut MarkdownText, run: &Run, news: Option<&RunNews>) {
    let h = &run.header;
    text.line("# etalon\n");
    if let Some(why) = incomplete(run) {
        text.line(&format!("**✗ Incomplete: {why}.**\n"));
    }
    let bad = news.map_or_else(|| run.unexpected(), |news| news.counted(run));
    if bad > 0 {
        text.line(&format!("**✗ {}.**\n", count(bad, "unexpected record")));
    } else if !run.records.is_empty() {
        text.line("**✓ Nothing unexpected.**\n");
    }
    let better = run.records.iter().filter(|r| r.improvement()).count() as u64;
    if better > 0 {
        text.line(&format!(
            "**{}**: their expectations can be removed.\n",
            count(better, "improvement")
        ));
    }
    let commit = h
        .provenance
        .commit
        .as_deref()
        .map_or(String::new(), |commit| {
            format!(", commit {}", code(commit, 100))
        });
    let shard = h
        .settings
        .shard
        .map_or(String::new(), |s| format!(", shard {s}"));
    text.line(&format!(
        "{} on {}, {}{shard}. Started {}, etalon {}{commit}, {}, {}, {}.\n",
        count(h.cases, "case"),
        count(h.adapters.len() as u64, "adapter"),
        count(run.records.len() as u64, "record"),
        code(&h.provenance.started, 60),
        escaped(&h.provenance.etalon, 60),
        escaped(&h.provenance.machine.cpu, 200),
        count(u64::from(h.provenance.machine.cores), "core"),
        escaped(&h.provenance.machine.os, 200),
    ));
    text.line(&format!(
        "{}\n",
        code(&h.provenance.command.join(" "), 2000)
    ));
}

/// Writes the news, then the runs with which this run was compared.
fn told(text: &mut MarkdownText, news: &RunNews) {
    for (title, entries) in news.sections() {
        if entries.is_empty() {
            continue;
        }
        let n = entries.len();
        text.line(&format!("## {n} {title}\n"));
        text.lines(entries, LISTED / 4, |entry: &NewsEntry| {
            format!(
                "- **{}** {} on {}: {}",
                name(entry.verdict),
                code(&entry.case, 400),
                code(&entry.adapter, 100),
                escaped(&entry.note, 300)
            )
        });
        text.line("");
    }
    text.line("## Compared with\n");
    text.lines(&news.since, LISTED / 4, |since| {
        let run = since.run.as_deref();
        let run = run.unwrap_or("no earlier run of this adapter");
        format!("- {}: {}", code(&since.adapter, 100), escaped(run, 300))
    });
    text.line("");
}

/// Returns a table with a row per adapter and a column per verdict that occurs.
fn adapters(text: &mut MarkdownText, run: &Run) {
    let mut records_of: BTreeMap<&str, Vec<&Record>> = BTreeMap::new();
    for record in &run.records {
        records_of.entry(&record.adapter).or_default().push(record);
    }
    for adapter in &run.header.adapters {
        records_of.entry(&adapter.info.name).or_default();
    }
    let rows: Vec<(&str, VerdictTally)> = records_of
        .into_iter()
        .map(|(adapter, records)| (adapter, VerdictTally::of(records)))
        .collect();
    let missing = |tally: &VerdictTally| run.header.cases.saturating_sub(tally.total);
    let any = |count: &dyn Fn(&VerdictTally) -> u64| rows.iter().any(|(_, tally)| count(tally) > 0);
    let mut table = Table::<&(&str, VerdictTally)>::new("")
        .text("adapter", |(adapter, _)| code(adapter, 100))
        .text("driver", |(adapter, _)| {
            let driver = run.header.adapter(adapter).map(|a| a.driver_text());
            escaped(&driver.unwrap_or_default(), 200)
        });
    for verdict in Verdict::ALL {
        if any(&|tally| tally.plain(verdict)) {
            let title = format!("{} {}", symbol(verdict), name(verdict));
            table = table.number(title, move |(_, tally)| some(tally.plain(verdict)));
        }
    }
    if any(&|tally| tally.known) {
        table = table.number("expected", |(_, tally)| some(tally.known));
    }
    if any(&|tally| tally.due) {
        table = table.number("selftests", |(_, tally)| some(tally.due));
    }
    table = table.number("unexpected", |(_, tally)| {
        some(tally.unexpected).map(|n| format!("**{n}**"))
    });
    if any(&missing) {
        table = table.number("missing", |(_, tally)| some(missing(tally)));
    }
    text.table("Adapters", &table, &rows);
}

fn unexpected(text: &mut MarkdownText, run: &Run) {
    text.list("Unexpected", &unexpected_records(run), |record| {
        let sign = match Tone::of(record) {
            Tone::Missed => symbol(Verdict::Fail),
            _ => symbol(record.verdict),
        };
        let mut entry = format!(
            "- {sign} **{}** {} on {}: {}",
            name(record.verdict),
            code(&record.case, 400),
            code(&record.adapter, 100),
            escaped(&headline(record), 300),
        );
        for line in particulars(record).iter().take(6) {
            entry += &format!("\\\n  {}", escaped(line, 300));
        }
        entry += &format!("\\\n  {}", code(&command::explain(record), 800));
        entry
    });
}

fn improvements(text: &mut MarkdownText, run: &Run) {
    let better: Vec<&Record> = run.records.iter().filter(|r| r.improvement()).collect();
    text.list("Better than expected", &better, |record| {
        format!(
            "- {} on {}: {} expected, {} recorded",
            code(&record.case, 400),
            code(&record.adapter, 100),
            record.improves.map_or("", name),
            name(record.verdict)
        )
    });
}

/// The asserted channels over all adapters, by area and aspect.
fn asserted(text: &mut MarkdownText, run: &Run) {
    let mut sums: BTreeMap<(&str, Aspect), Assertion> = BTreeMap::new();
    for record in &run.records {
        for assertion in &record.assertions {
            sums.entry((record.parts().area(), assertion.aspect))
                .and_modify(|sum| sum.add(assertion))
                .or_insert(*assertion);
        }
    }
    if sums.is_empty() {
        return;
    }
    let table = Table::<((&str, Aspect), Assertion)>::new("")
        .text("area", |((area, _), _)| code(area, 100))
        .text("aspect", |((_, aspect), _)| aspect.to_string())
        .number("channels", |(_, sum)| sum.channels)
        .number("asserted", |(_, sum)| {
            percent_of(sum.asserted, sum.channels)
        })
        .number("exactly one code legal", |(_, sum)| {
            percent_of(sum.exact, sum.channels)
        });
    text.table("What was asserted", &table, sums);
}

fn absent(text: &mut MarkdownText, run: &Run) {
    let absent = &run.header.absent;
    if absent.is_empty() {
        return;
    }
    text.line("## Absent adapters\n");
    text.lines(absent, LISTED, |a| {
        format!(
            "- {}: {}; {}",
            code(&a.name, 100),
            escaped(&a.reason, 300),
            escaped(&a.remedy, 300)
        )
    });
}

/// Returns text without a meaning in Markdown, in HTML or for GitHub's filters. Character references are not
/// markup, and a word joiner keeps mentions, issues and emoji from being recognized.
fn escaped(text: &str, longest: usize) -> String {
    let mut result = String::new();
    for c in plain(text, longest).chars() {
        match c {
            '@' | '#' | ':' => result.push_str(&format!("&#{};\u{2060}", c as u32)),
            '.' | ',' | '-' | '/' | '=' | '%' | '+' | '(' | ')' | ';' | '?' => result.push(c),
            c if c.is_ascii_punctuation() => result.push_str(&format!("&#{};", c as u32)),
            c => result.push(c),
        }
    }
    result
}

/// Returns a name or a command as code, which no filter touches; as escaped text if code cannot hold it.
fn code(text: &str, longest: usize) -> String {
    let shown = plain(text, longest);
    let held =
        !shown.contains(['`', '|', '\\']) && !shown.trim().is_empty() && shown.trim() == shown;
    if held {
        format!("`{shown}`")
    } else {
        escaped(text, longest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_loses_its_meaning_as_markdown() {
        assert_eq!(escaped("a|b<i>", 99), "a&#124;b&#60;i&#62;");
        assert_eq!(escaped("@me", 99), "&#64;\u{2060}me");
        assert_eq!(escaped("a\nb", 99), "a&#92;nb");
        assert_eq!(code("gl:es:x", 99), "`gl:es:x`");
        assert_eq!(code("a`b", 99), "a&#96;b");
        assert_eq!(code("", 99), "");
    }
}
