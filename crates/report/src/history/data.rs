//! The data of the scripts that accompany the page.
//!
//! Each file calls one function with its name and a value. Texts of the history are strings in lists and
//! never keys, because a key could name a prototype.

use super::courses::{Course, Courses};
use super::model::{Model, Timeline};
use super::news::{self, News};
use super::times::{CaseTimes, Timed};
use crate::lists::Interner;
use crate::numbers::trimmed;
use crate::words::machine;
use etalon_history::{History, Kind, TriageEntry, format_time};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::rc::Rc;

/// The number of bytes at which a file ends and the next begins.
const FILE_BYTES: usize = 100_000;

/// About the bytes of an index and its comma.
const INDEX_BYTES: usize = 4;

/// Returns the text of a file.
pub(super) fn file(name: &str, value: &str) -> String {
    // The suite chooses the names, which need no escapes.
    format!("etalonHistory(\"{name}\",{value});\n")
}

/// Packs texts into files of about [`FILE_BYTES`] bytes, without dividing a text.
#[derive(Default)]
pub(super) struct Files {
    /// The number of the first text of each file.
    pub(super) first: Vec<usize>,
    /// The texts of each file, joined by commas.
    pub(super) files: Vec<String>,
}

impl Files {
    pub(super) fn push(&mut self, number: usize, text: &str) {
        match self.files.last_mut() {
            Some(file) if file.len() + text.len() < FILE_BYTES => {
                file.push(',');
                file.push_str(text);
            }
            _ => {
                self.first.push(number);
                self.files.push(text.to_owned());
            }
        }
    }
}

/// Returns the runs, timelines, drivers, machines and looks as JSON. `script/runs.js` names the places of a row.
pub(super) fn runs(model: &Model<'_>) -> Value {
    let (mut drivers, mut machines) = (Interner::default(), Interner::default());
    let timelines = timeline_rows(model, &mut drivers);
    let runs = run_rows(model, &mut machines);
    json!({
        "runs": runs,
        "timelines": timelines,
        "drivers": drivers,
        "machines": machines,
        "looks": model.looks.data(),
    })
}

fn timeline_rows(model: &Model<'_>, drivers: &mut Interner<[String; 3]>) -> Vec<Value> {
    let timelines = model.places.timelines.iter().map(|line| {
        let runs = line.runs.iter().map(|run| {
            let a = &run.part.adapter;
            let driver = drivers.place([
                a.shown_version().to_owned(),
                a.info.driver.clone(),
                a.info.device.clone(),
            ]);
            json!([run.place, u8::from(run.whole), driver, run.part.records])
        });
        json!([*line.name, runs.collect::<Vec<Value>>()])
    });
    timelines.collect()
}

fn run_rows(model: &Model<'_>, machines: &mut Interner<String>) -> Vec<Value> {
    let runs = model.places.runs.iter().map(|run| {
        let machine = model.history.machine(run.machine).map(machine);
        let machine = machines.place(machine.unwrap_or_default());
        let labels: Vec<[String; 2]> = run
            .labels
            .iter()
            .map(|(key, value)| [key.to_string(), value.to_string()])
            .collect();
        json!([
            run.id.number(),
            run.kind.name(),
            format_time(run.started),
            match (run.kind, run.released) {
                (Kind::Release, Some(_)) => run.day(),
                _ => String::new(),
            },
            run.etalon,
            run.commit.clone().unwrap_or_default(),
            machine,
            run.profile.clone().unwrap_or_default(),
            run.missing,
            labels,
            run.digest_text().chars().take(12).collect::<String>()
        ])
    });
    runs.collect()
}

/// Returns the ids of all cases in the given order, each as the length of the prefix it shares with the id
/// before, and the rest.
pub(super) fn cases(cases: &[Rc<str>], order: &[usize]) -> Value {
    let mut before: Vec<char> = Vec::new();
    let entries = order.iter().map(|case| {
        let id: Vec<char> = cases[*case].chars().collect();
        let shared = id.iter().zip(&before).take_while(|(a, b)| a == b).count();
        let ending: String = id[shared..].iter().collect();
        // The script counts in UTF-16.
        let shared: usize = id[..shared].iter().map(|c| c.len_utf16()).sum();
        before = id;
        json!([shared, ending])
    });
    entries.collect()
}

/// Files of case histories. Most cases of a file have the same history, and share its text.
#[derive(Default)]
pub(super) struct CaseFiles {
    /// For each file except the first, the index of its first case among all cases.
    first: Vec<usize>,
    files: Vec<String>,
    current: HistoryFile,
}

/// The file being filled.
#[derive(Default)]
struct HistoryFile {
    courses: Interner<String>,
    /// The index of each case's history in `courses`.
    course_of_case: Vec<usize>,
    /// Entries of cases with times or triage: the case's index within the file, the file of its times or -1,
    /// and the triage entries.
    extras: Vec<Value>,
    bytes: usize,
}

impl CaseFiles {
    /// Adds a case: its history on all timelines, the file of its times, and its triage entries. `rank` is its
    /// position in the order of the files, `case` its index in the courses. Unlike [`Files`], a file can exceed
    /// its size by one case, whose history is often in it already.
    pub(super) fn push(
        &mut self,
        rank: usize,
        case: usize,
        timelines: &[Timeline<'_>],
        times: Option<usize>,
        triage: &[&TriageEntry],
    ) {
        if self.current.bytes > FILE_BYTES {
            self.files.push(std::mem::take(&mut self.current).text());
            self.first.push(rank);
        }
        let current = &mut self.current;
        let on_line = |(line, timeline): (usize, &Timeline<'_>)| {
            let courses = &timeline.courses;
            Some(course_data(line, courses.of[case].as_ref()?, courses))
        };
        let lines = timelines.iter().enumerate().filter_map(on_line);
        let text = lines.collect::<Value>().to_string();
        current.bytes += INDEX_BYTES;
        if !current.courses.has(&text) {
            current.bytes += text.len();
        }
        if times.is_some() || !triage.is_empty() {
            let triage: Vec<Value> = triage.iter().map(|entry| entry_data(entry)).collect();
            let index = current.course_of_case.len();
            let extra = json!([index, times.map_or(-1, |t| t as i64), triage]);
            current.bytes += extra.to_string().len();
            current.extras.push(extra);
        }
        current.course_of_case.push(current.courses.place(text));
    }

    /// Returns the first case of each file, and the texts of all files.
    pub(super) fn finish(mut self) -> (Vec<usize>, Vec<String>) {
        self.files.push(self.current.text());
        self.first.insert(0, 0);
        (self.first, self.files)
    }
}

impl HistoryFile {
    fn text(self) -> String {
        let courses = self.courses.values.join(",");
        format!(
            "[[{courses}],{},{}]",
            json!(self.course_of_case),
            json!(self.extras)
        )
    }
}

/// Returns the timeline, the first and last run, and spans; then gaps and events if there are any.
fn course_data(line: usize, course: &Course, courses: &Courses) -> Value {
    let flat = |pairs: &[(u32, u32)]| -> Vec<u32> {
        pairs
            .iter()
            .flat_map(|(first, other)| [*first, *other])
            .collect()
    };
    let (spans, gaps) = (flat(&course.spans), flat(&courses.gaps.list(course.gaps)));
    let events = course.events.iter();
    let events = events.flat_map(|e| [news::number(e.event) as u32, e.after, e.at]);
    let events: Vec<u32> = events.collect();
    let mut value = vec![
        json!(line),
        json!(course.first),
        json!(course.last),
        json!(spans),
    ];
    if !gaps.is_empty() || !events.is_empty() {
        value.push(json!(gaps));
    }
    if !events.is_empty() {
        value.push(json!(events));
    }
    Value::from(value)
}

fn entry_data(entry: &TriageEntry) -> Value {
    json!([
        entry.subject.timeline,
        entry.state.name(),
        format_time(entry.at),
        entry.author,
        entry.reason
    ])
}

/// Returns the series of a case.
pub(super) fn times(id: &str, history: &History, series: &[&CaseTimes]) -> String {
    let series_data: Vec<Value> = series
        .iter()
        .map(|series| {
            let machine = history.machine(series.machine).map(machine);
            let times: Vec<Value> = series.times.iter().map(timed).collect();
            json!([
                series.line,
                machine.unwrap_or_default(),
                series.ruler.clone().unwrap_or_default(),
                times
            ])
        })
        .collect();
    json!([id, series_data]).to_string()
}

/// Returns times and their changes. `script/chart.js` names the places of a row.
fn timed(timed: &Timed) -> Value {
    let micros = |seconds: f64| number(seconds * 1e6);
    let medians: Vec<Value> = timed.points.iter().map(|p| micros(p.median)).collect();
    let rulers = timed
        .points
        .iter()
        .map(|p| p.ruler.map_or(json!(0), micros));
    let mut rulers: Vec<Value> = rulers.collect();
    if timed.points.iter().all(|p| p.ruler.is_none()) {
        rulers.clear();
    }
    let ratio = |r: &etalon_stats::Ratio| [number(r.estimate), number(r.low), number(r.high)];
    let changes: Vec<Value> = timed
        .told()
        .map(|(c, state, fresh)| {
            json!([
                c.index,
                c.between[0],
                c.between[1].min(timed.points.len() - 1),
                micros(c.before),
                micros(c.after),
                ratio(&c.ratio),
                news::probability(c.p),
                number(c.visible),
                c.cause.text(),
                u8::from(c.returns),
                c.ruled.as_ref().map(ratio),
                c.ruler.as_ref().map(ratio),
                u8::from(fresh),
                state.map(entry_data),
            ])
        })
        .collect();
    let drifts: Vec<Value> = timed
        .changes
        .drifts
        .iter()
        .map(|d| json!([d.from, d.to, ratio(&d.ratio), u8::from(d.machine)]))
        .collect();
    let visible = timed.changes.visible(etalon_stats::MIN_RUNS.max(10));
    json!([
        timed.time.name(),
        ranges(&timed.runs),
        medians,
        rulers,
        changes,
        drifts,
        number(timed.changes.noise),
        visible.map(number),
    ])
}

/// Returns ascending numbers as the first number and length of each stretch.
fn ranges(numbers: &[usize]) -> Vec<usize> {
    let stretches = numbers.chunk_by(|a, b| a + 1 == *b);
    stretches
        .flat_map(|stretch| [stretch[0], stretch.len()])
        .collect()
}

/// Returns a number rounded to four significant digits.
fn number(value: f64) -> Value {
    if !value.is_finite() || value == 0.0 {
        return json!(0);
    }
    let digits = 3 - value.abs().log10().floor() as i32;
    let digits = usize::try_from(digits.min(12)).unwrap_or(0);
    let short = trimmed(format!("{value:.digits$}"));
    match short.parse::<i64>() {
        Ok(integer) => json!(integer),
        Err(_) => short.parse::<f64>().map_or(json!(0), |n| json!(n)),
    }
}

/// Returns the events of each run, by the run's index: timeline, kind, and cases as indices into the list of
/// all cases.
pub(super) fn events(model: &Model<'_>, ranks: &[usize]) -> BTreeMap<usize, String> {
    let mut events_by_run: BTreeMap<usize, BTreeMap<(usize, usize), Vec<usize>>> = BTreeMap::new();
    for (line, timeline) in model.timelines.iter().enumerate() {
        for (case, course) in timeline.courses.of.iter().enumerate() {
            for event in course.iter().flat_map(|course| &course.events) {
                let place = timeline.line.runs[event.at as usize].place;
                let kinds = events_by_run.entry(place).or_default();
                let key = (line, news::number(event.event));
                kinds.entry(key).or_default().push(ranks[case]);
            }
        }
    }
    let text = |kinds: BTreeMap<(usize, usize), Vec<usize>>| -> Vec<Value> {
        let kinds = kinds.into_iter();
        kinds
            .map(|((line, kind), mut cases)| {
                cases.sort_unstable();
                json!([line, kind, cases])
            })
            .collect()
    };
    events_by_run
        .into_iter()
        .map(|(place, kinds)| (place, json!([place, text(kinds)]).to_string()))
        .collect()
}

/// The maximum number of lines of news that are kept.
const MAX_NEWS: usize = 5_000;

/// Returns the first [`MAX_NEWS`] lines of news.
pub(super) fn news(news: &News) -> Value {
    let lines = news.items.iter().take(MAX_NEWS).map(|item| {
        json!([
            item.kind.colour(),
            item.word,
            item.subject,
            u8::from(item.is_family),
            item.text,
            item.chip
        ])
    });
    lines.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_significant_digits() {
        for (value, expected) in [
            (1234.56, "1235"),
            (12.3456, "12.35"),
            (0.012_345_6, "0.01235"),
            (123_456.0, "123456"),
            (1.0, "1"),
            (0.0, "0"),
            (f64::NAN, "0"),
            (100.0, "100"),
            (1e-20, "0"),
        ] {
            assert_eq!(number(value).to_string(), expected);
        }
    }

    #[test]
    fn ranges_are_first_numbers_and_lengths() {
        assert_eq!(ranges(&[0, 1, 2, 5, 7, 8]), [0, 3, 5, 1, 7, 2]);
    }

    #[test]
    fn ids_share_prefixes_counted_in_utf_16() {
        let ids: Vec<Rc<str>> = ["a/𝄞x", "a/𝄞y", "b"].map(Rc::from).to_vec();
        let text = cases(&ids, &[0, 1, 2]).to_string();
        assert_eq!(text, r#"[[0,"a/𝄞x"],[4,"y"],[0,"b"]]"#);
    }

    #[test]
    fn texts_are_never_split_between_files() {
        let mut packed = Files::default();
        let long = "x".repeat(60_000);
        for number in 0..3 {
            packed.push(number, &long);
        }
        packed.push(3, "y");
        assert_eq!(packed.first, [0, 1, 2]);
        assert!(packed.files[2].ends_with(",y"));
    }
}
