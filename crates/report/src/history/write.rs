//! Writing the pages of a history.

use super::data::{self, CaseFiles, Files, file};
use super::matrix;
use super::model::Model;
use super::news::News;
use super::page::page;
use super::places::Places;
use super::times::CaseTimes;
use crate::error::ReportError;
use crate::staged::{PagesKind, Staged, WrittenFolder};
use etalon_history::{History, TriageEntry};
use etalon_record::Labels;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

/// The file that marks a folder as the page of a history.
pub const HISTORY_PAGE_FILE: &str = "history.json";
/// The kind of this folder.
const FOLDER: PagesKind = PagesKind {
    mark: HISTORY_PAGE_FILE,
    names: ["page", "page of a history"],
};

/// Writes the pages of the runs of a history into a folder. With labels, only runs that have them all are
/// shown. If `replace` is true, an earlier page in the folder is replaced, unless an error is returned.
///
/// # Errors
/// Returns an error if the history cannot be read or has no such run, or the folder has other files or cannot
/// be written to.
pub fn write_history(
    history: &History,
    only: &Labels,
    to: &Path,
    replace: bool,
) -> Result<WrittenFolder, ReportError> {
    let places = Places::new(history, only);
    if places.runs.is_empty() {
        return Err(ReportError::NoRuns {
            path: history.path().to_owned(),
        });
    }
    let folder = Staged::begin(to, &FOLDER, replace)?;
    let model = Model::read(history, &places)?;
    let news = News::find(&model);
    let write = |name: &str, value: &str| {
        folder.write(format!("data/{name}.js"), file(name, value).as_bytes())
    };
    let order = PageOrder::of(model.cases);
    write("runs", &data::runs(&model).to_string())?;
    write("cases", &data::cases(model.cases, &order.cases).to_string())?;
    write("news", &data::news(&news).to_string())?;
    let (packed, index) = packed(&model, &order)?;
    for (kind, files) in &packed {
        for (number, text) in files.iter().enumerate() {
            write(&format!("{kind}-{number}"), text)?;
        }
    }
    for (number, timeline) in model.timelines.iter().enumerate() {
        let value = matrix::data(&model.families, timeline).to_string();
        write(&format!("adapter-{number}"), &value)?;
    }
    let html = page(&model, &news, &index.to_string());
    let (runs, cases) = (places.runs.len(), model.cases.len());
    let about = json!({ "etalon": "history", "format": 1, "runs": runs, "cases": cases });
    folder.finish(html.as_bytes(), about)
}

/// Cases in the order of the script, which compares ids in UTF-16, and the rank of each.
struct PageOrder {
    cases: Vec<usize>,
    ranks: Vec<usize>,
}

impl PageOrder {
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

/// The files of cases, of frame times and of events of runs, and the first case or run of each file.
type Packed = ([(&'static str, Vec<String>); 3], Value);

fn packed(model: &Model<'_>, order: &PageOrder) -> Result<Packed, ReportError> {
    let mut series_of: BTreeMap<usize, Vec<&CaseTimes>> = BTreeMap::new();
    for times in &model.series {
        series_of.entry(times.case).or_default().push(times);
    }
    let log = model.history.triage_log()?;
    let mut said: BTreeMap<&str, Vec<&TriageEntry>> = BTreeMap::new();
    for entry in log.iter().filter(|entry| entry.subject.step.is_none()) {
        said.entry(&entry.subject.case).or_default().push(entry);
    }
    let (mut files, mut timed) = (CaseFiles::default(), Files::default());
    for (rank, case) in order.cases.iter().enumerate() {
        let id = &model.cases[*case];
        let times = series_of.get(case).map(|series| {
            timed.push(rank, &data::times(id, model.history, series));
            timed.files.len() - 1
        });
        let said = said.get(&**id).map_or(&[][..], Vec::as_slice);
        files.push(rank, *case, &model.timelines, times, said);
    }
    let mut events = Files::default();
    for (place, text) in data::events(model, &order.ranks) {
        events.push(place, &text);
    }
    let (first, files) = files.finish();
    let index = json!({ "cases": first, "runs": events.first });
    let listed = |files: Files| files.files.iter().map(|text| format!("[{text}]")).collect();
    let packed = [
        ("case", files),
        ("times", listed(timed)),
        ("run", listed(events)),
    ];
    Ok((packed, index))
}
