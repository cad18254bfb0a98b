//! Pairs of adapters and records of two runs to compare.

use super::data::{RunSide, Unpaired};
use crate::error::ReportError;
use etalon_record::{Record, Run};
use std::collections::HashMap;
use std::path::Path;

/// A run with its folder, and its records by adapter and case.
pub(super) struct Folder<'a> {
    pub(super) path: &'a Path,
    pub(super) run: &'a Run,
    /// The header's adapters, then adapters that only records name.
    adapters: Vec<&'a str>,
    records: HashMap<&'a str, HashMap<&'a str, &'a Record>>,
}

impl<'a> Folder<'a> {
    pub(super) fn new(path: &'a Path, run: &'a Run) -> Self {
        let mut adapters = Vec::new();
        let mut records: HashMap<&str, HashMap<&str, &Record>> = HashMap::new();
        let named = run.header.adapters.iter().map(|a| a.info.name.as_str());
        for name in named.chain(run.records.iter().map(|r| r.adapter.as_str())) {
            records.entry(name).or_insert_with(|| {
                adapters.push(name);
                HashMap::new()
            });
        }
        for record in &run.records {
            let cases = records.entry(&record.adapter).or_default();
            // A run has one record per case and adapter. If a damaged run has two, the worse record counts.
            let rank = |r: &Record| (r.unexpected(), r.verdict.severity());
            let place = cases.entry(&record.case).or_insert(record);
            if rank(place) < rank(record) {
                *place = record;
            }
        }
        Self {
            path,
            run,
            adapters,
            records,
        }
    }

    fn has(&self, adapter: &str) -> bool {
        self.records.contains_key(adapter)
    }

    fn count(&self, adapter: &str) -> u64 {
        self.records.get(adapter).map_or(0, |r| r.len() as u64)
    }
}

/// The records of two adapters.
#[derive(Default)]
pub(super) struct Matched<'a> {
    /// Cases that both have a record of, by id.
    pub(super) both: Vec<[&'a Record; 2]>,
    /// Records of the first without a partner in the second, by id.
    pub(super) before: Vec<&'a Record>,
    /// Records of the second without a partner in the first, by id.
    pub(super) after: Vec<&'a Record>,
}

impl<'a> Matched<'a> {
    pub(super) fn new(folders: &[Folder<'a>; 2], adapter: [&str; 2]) -> Self {
        let none = HashMap::new();
        let [before, after] = [0, 1].map(|i| folders[i].records.get(adapter[i]).unwrap_or(&none));
        let mut matched = Self::default();
        for (case, old) in before {
            match after.get(case) {
                Some(new) => matched.both.push([old, new]),
                None => matched.before.push(old),
            }
        }
        let alone = after.iter().filter(|(case, _)| !before.contains_key(*case));
        matched.after.extend(alone.map(|(_, record)| *record));
        matched.both.sort_by(|a, b| a[0].case.cmp(&b[0].case));
        matched.before.sort_by(|a, b| a.case.cmp(&b.case));
        matched.after.sort_by(|a, b| a.case.cmp(&b.case));
        matched
    }
}

/// Returns the pairs of adapters: the named pair, or the only adapter of each run, or all adapters of the
/// same name.
pub(super) fn choose<'a>(
    before: &Folder<'a>,
    after: &Folder<'a>,
    named: Option<[&'a str; 2]>,
) -> Result<Vec<[&'a str; 2]>, ReportError> {
    if let Some(names) = named {
        for (folder, name) in [before, after].into_iter().zip(names) {
            if !folder.has(name) {
                return Err(ReportError::NoAdapter {
                    path: folder.path.to_owned(),
                    adapter: name.to_owned(),
                    known: folder.adapters.join(", "),
                });
            }
        }
        return Ok(vec![names]);
    }
    if let ([old], [new]) = (before.adapters.as_slice(), after.adapters.as_slice()) {
        return Ok(vec![[old, new]]);
    }
    let common = before.adapters.iter().filter(|name| after.has(name));
    let pairs: Vec<_> = common.map(|name| [*name, *name]).collect();
    if pairs.is_empty() && !before.adapters.is_empty() && !after.adapters.is_empty() {
        return Err(ReportError::NoCommonAdapter {
            before: before.adapters.join(", "),
            after: after.adapters.join(", "),
        });
    }
    Ok(pairs)
}

/// Returns the adapters that are in no pair. If the pair was `named`, all others were left out on purpose.
pub(super) fn unpaired(
    before: &Folder<'_>,
    after: &Folder<'_>,
    pairs: &[[&str; 2]],
    named: bool,
) -> Vec<Unpaired> {
    let mut found = Vec::new();
    for (side, folder) in [(RunSide::Before, before), (RunSide::After, after)] {
        let paired = |name: &str| pairs.iter().any(|pair| pair[side as usize] == name);
        let alone = folder.adapters.iter().filter(|name| !paired(name));
        found.extend(alone.map(|name| Unpaired {
            side,
            adapter: (*name).to_owned(),
            records: folder.count(name),
            worse: !named && side == RunSide::Before && folder.count(name) > 0,
        }));
    }
    found
}
