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
use std::rc::Rc;

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
    let (courses, scores) = scored(history, &places, &families, &mut looks)?;
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

    let mut write = |name: &str, value: &str| {
        folder.write(format!("data/{name}.js"), file(name, value).as_bytes())
    };
    let order = Order::of(cases);
    write("runs", &data::runs(history, &places, &looks).to_string())?;
    write("cases", &data::cases(cases, &order.cases).to_string())?;
    write("news", &data::news(&news).to_string())?;
    let packed = packed(history, &places, &courses, &series, &order)?;
    for (kind, files) in [
        ("case", &packed.cases),
        ("times", &packed.times),
        ("run", &packed.events),
    ] {
        for (number, text) in files.iter().enumerate() {
            write(&format!("{kind}-{number}"), text)?;
        }
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
    let index =
        json!({ "timelines": names, "cases": packed.first_cases, "runs": packed.first_runs });
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
    let (runs, cases) = (places.runs.len(), cases.len());
    let about = json!({ "etalon": "history", "format": 1, "runs": runs, "cases": cases });
    folder.finish(HISTORY_PAGE_FILE, about)?;
    Ok(WrittenHistory {
        html: to.join("index.html"),
        start: html.len() as u64,
        files: folder.files,
        bytes: folder.bytes,
    })
}

/// The courses and the scores of each timeline.
type Scored = (Vec<Courses>, Vec<Scores>);

fn scored(
    history: &History,
    places: &Places<'_>,
    families: &Families,
    looks: &mut Looks,
) -> Result<Scored, ReportError> {
    let (mut all_courses, mut scores) = (Vec::new(), Vec::new());
    let cases = families.of.len();
    for line in &places.timelines {
        let mut score = Scores::new(families.names.len(), line.runs.len());
        let courses = Courses::read(history, line, cases, looks, |run, case, look, looks| {
            score.take(families.of[case], run, looks.class(look));
        })?;
        score.compare(&courses, line, families, looks);
        all_courses.push(courses);
        scores.push(score);
    }
    Ok((all_courses, scores))
}

/// Cases as the script sorts them, which compares ids in UTF-16, and the rank of each.
struct Order {
    cases: Vec<usize>,
    ranks: Vec<usize>,
}

impl Order {
    fn of(ids: &[Rc<str>]) -> Self {
        let mut cases: Vec<usize> = (0..ids.len()).collect();
        cases.sort_by(|a, b| ids[*a].encode_utf16().cmp(ids[*b].encode_utf16()));
        let mut ranks = vec![0; ids.len()];
        for (rank, case) in cases.iter().enumerate() {
            ranks[*case] = rank;
        }
        Self { cases, ranks }
    }
}

/// The files of cases, of their frame times and of the events of runs, with the first case or run of each file.
struct PackedFiles {
    cases: Vec<String>,
    times: Vec<String>,
    events: Vec<String>,
    first_cases: Vec<usize>,
    first_runs: Vec<usize>,
}

fn packed(
    history: &History,
    places: &Places<'_>,
    courses: &[Courses],
    series: &[Series],
    order: &Order,
) -> Result<PackedFiles, ReportError> {
    let cases = history.cases()?;
    let mut series_of: BTreeMap<usize, Vec<&Series>> = BTreeMap::new();
    for times in series {
        series_of.entry(times.case).or_default().push(times);
    }
    let log = history.triage_log()?;
    let mut said: BTreeMap<&str, Vec<&TriageEntry>> = BTreeMap::new();
    for entry in log.iter().filter(|entry| entry.subject.step.is_none()) {
        said.entry(&entry.subject.case).or_default().push(entry);
    }
    let (mut files, mut timed) = (CaseFiles::new(), Packed::new());
    for (rank, case) in order.cases.iter().enumerate() {
        let id = &cases[*case];
        let times = series_of.get(case).map(|series| {
            timed.push(rank, &data::times(id, history, series));
            timed.last()
        });
        let said = said.get(&**id).map_or(&[][..], Vec::as_slice);
        files.push(rank, *case, courses, times, said);
    }
    let mut events = Packed::new();
    for (place, text) in data::events(places, courses, &order.ranks) {
        events.push(place, &text);
    }
    let (first_cases, files) = files.finish();
    let listed = |files: &[String]| files.iter().map(|text| format!("[{text}]")).collect();
    Ok(PackedFiles {
        cases: files,
        times: listed(&timed.files),
        events: listed(&events.files),
        first_cases,
        first_runs: events.first,
    })
}
