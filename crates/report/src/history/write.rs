//! Writing the pages of a history.

use super::courses::Courses;
use super::data::{self, CaseFiles, Packed, file};
use super::families::Families;
use super::looks::Looks;
use super::matrix::{self, Counted};
use super::news::{News, Told};
use super::page::{Start, page};
use super::places::Places;
use super::scores::Scores;
use super::times::{self, Series};
use crate::error::ReportError;
use crate::staged::{Content, Staged};
use etalon_history::{History, Labels, TriageEntry};
use serde_json::json;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The file by which a folder is known to be the page of a history.
pub const HISTORY_PAGE_FILE: &str = "history.json";
/// All that such a folder has at its top.
const TOP: [&str; 3] = ["index.html", "data", HISTORY_PAGE_FILE];

/// The pages of a history, written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenHistory {
    /// The start page.
    pub html: PathBuf,
    /// The bytes of the start page.
    pub start: u64,
    /// The number of files.
    pub files: u64,
    /// The bytes of all files.
    pub bytes: u64,
}

/// Writes the pages of the runs of a history that have these labels, or of all where there are none, into a folder. An earlier page in it is replaced, and stays as it is if an error is
/// returned.
///
/// # Errors
/// Returns an error if the history cannot be read or has no such run, or the folder holds something else or cannot be written to.
pub fn write_history(
    history: &History,
    only: &Labels,
    to: &Path,
) -> Result<WrittenHistory, ReportError> {
    let places = Places::new(history, only);
    if places.runs.is_empty() {
        return Err(ReportError::NoRuns {
            path: history.path().to_owned(),
        });
    }
    match Content::of(to, HISTORY_PAGE_FILE, &TOP)? {
        Content::Empty | Content::Earlier => {}
        Content::Foreign(path) => return Err(ReportError::NotOfTheHistory { path }),
        Content::Other => {
            return Err(ReportError::NoHistoryPage {
                path: to.to_owned(),
            });
        }
    }
    let mut folder = Staged::begin(to)?;
    let cases = history.cases()?;
    let families = Families::new(cases);
    let mut looks = Looks::default();
    let (mut courses, mut scores) = (Vec::new(), Vec::new());
    for line in &places.timelines {
        let mut score = Scores::new(families.names.len(), line.runs.len());
        let all = Courses::read(
            history,
            line,
            cases.len(),
            &mut looks,
            |run, case, look, looks| {
                score.take(families.of[case], run, looks.class(look));
            },
        )?;
        score.compare(&all, line, &families, &looks);
        courses.push(all);
        scores.push(score);
    }
    let states = history.triage_states()?;
    let series = times::read(history, &places, &states)?;
    let lines = places
        .timelines
        .iter()
        .zip(&courses)
        .map(|(line, courses)| Told {
            line,
            courses,
            last: line.last(&places.runs),
        });
    let lines: Vec<Told<'_>> = lines.collect();
    let news = News::find(&places, &lines, cases, &families, &looks, &series, &states);

    // The script compares ids in UTF-16.
    let mut order: Vec<usize> = (0..cases.len()).collect();
    order.sort_by(|a, b| cases[*a].encode_utf16().cmp(cases[*b].encode_utf16()));
    let mut ranks = vec![0; cases.len()];
    for (rank, case) in order.iter().enumerate() {
        ranks[*case] = rank;
    }

    let mut write = |name: &str, value: &str| {
        folder.write(format!("data/{name}.js"), file(name, value).as_bytes())
    };
    write("runs", &data::runs(history, &places, &looks).to_string())?;
    write("cases", &data::cases(cases, &order).to_string())?;
    write("news", &data::news(&news).to_string())?;

    let mut of_case: BTreeMap<usize, Vec<&Series>> = BTreeMap::new();
    for one in &series {
        of_case.entry(one.case).or_default().push(one);
    }
    let log = history.triage_log()?;
    let mut said: BTreeMap<&str, Vec<&TriageEntry>> = BTreeMap::new();
    for entry in log.iter().filter(|entry| entry.subject.step.is_none()) {
        said.entry(&entry.subject.case).or_default().push(entry);
    }
    let (mut files, mut timed) = (CaseFiles::new(), Packed::new());
    for (rank, case) in order.iter().enumerate() {
        let id = &cases[*case];
        let times = of_case.get(case).map(|series| {
            timed.push(rank, &data::times(id, history, series));
            timed.last()
        });
        let said = said.get(&**id).map_or(&[][..], Vec::as_slice);
        files.push(rank, *case, &courses, times, said);
    }
    let (first, files) = files.finish();
    for (number, text) in files.iter().enumerate() {
        write(&format!("case-{number}"), text)?;
    }
    for (number, text) in timed.files.iter().enumerate() {
        write(&format!("times-{number}"), &format!("[{text}]"))?;
    }
    let mut events = Packed::new();
    for (place, text) in data::events(&places, &courses, &ranks) {
        events.push(place, &text);
    }
    for (number, text) in events.files.iter().enumerate() {
        write(&format!("run-{number}"), &format!("[{text}]"))?;
    }
    let counted: Vec<Counted<'_>> = places
        .timelines
        .iter()
        .zip(&scores)
        .map(|(line, scores)| Counted { line, scores })
        .collect();
    for (number, counted) in counted.iter().enumerate() {
        let value = matrix::data(&families, counted).to_string();
        write(&format!("adapter-{number}"), &value)?;
    }

    let names: Vec<&str> = places.timelines.iter().map(|line| &*line.name).collect();
    let index = json!({ "timelines": names, "cases": first, "runs": events.first });
    let html = page(&Start {
        history,
        places: &places,
        families: &families,
        counted: &counted,
        told: &lines,
        news: &news,
        cases: cases.len(),
        index: &index.to_string(),
    });
    folder.write("index.html", html.as_bytes())?;
    let about = json!({ "format": 1, "runs": places.runs.len(), "cases": cases.len() });
    folder.write(HISTORY_PAGE_FILE, format!("{about}\n").as_bytes())?;
    let (files, bytes) = (folder.files, folder.bytes);
    folder.finish()?;
    Ok(WrittenHistory {
        html: to.join("index.html"),
        start: html.len() as u64,
        files,
        bytes,
    })
}
