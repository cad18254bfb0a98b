//! Dead expectations: expectations that can excuse nothing, or that could have excused something and did
//! not.
//!
//! An expectation is called dead only if that is certain. If a run left out some of its cases or adapters,
//! it may be alive.

use crate::error::RecordError;
use crate::expectations::Expectations;
use crate::folder::DEAD_FILE;
use crate::json_file::read_json;
use crate::known::Known;
use crate::output_folder::OutputFolder;
use crate::parts::Parts;
use crate::run::Run;
use crate::verdict::Verdict;
use etalon_frame::state_enum;
use etalon_frame::threads::join;
use etalon_glob::Glob;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::cell::{Cell, LazyCell, OnceCell};
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;
use std::path::Path;
use std::rc::Rc;

state_enum! {
    /// The reason why an expectation is dead.
    DeadKind: array {
        /// A glob over ids, or an alternative in one, matches no case.
        NoCase = "no-case",
        /// A glob over names, or an alternative in one, matches no adapter that is described or was used.
        NoAdapter = "no-adapter",
        /// Another expectation excuses everything that it excuses.
        Covered = "covered",
        /// All cases of the expectation were drawn on all of its adapters, and none had the expected verdict.
        NeverMatched = "never-matched",
        /// The expectation's expiry date has passed.
        Expired = "expired",
    }
}

/// A dead expectation, or a dead part of one.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dead {
    /// The reason why the expectation, or its part, has no effect.
    pub kind: DeadKind,
    /// The file, and the entry's number if the file is a list.
    pub place: String,
    /// The dead glob, the position of the expectation that covers this one, or this one's reason.
    pub about: String,
}

impl Dead {
    /// Writes the dead expectations of a run into its folder; without any, removes the list of an
    /// earlier run.
    ///
    /// # Errors
    /// If the file cannot be written or removed.
    pub fn write(folder: &Path, dead: &[Self]) -> Result<(), RecordError> {
        OutputFolder::open(folder)?.write_json(DEAD_FILE, "dead expectations", dead)
    }

    /// Reads the dead expectations in a run folder; returns none if the folder has no list.
    ///
    /// # Errors
    /// If the list cannot be read or does not parse.
    pub fn read(folder: &Path) -> Result<Vec<Self>, RecordError> {
        read_json(folder, DEAD_FILE)
    }
}

/// The maximum number of comparisons of a glob with an id, or of two expectations: a search takes about a second.
const MAX_COMPARISONS: u64 = 1_000_000;

impl Expectations {
    /// Returns the dead expectations, sorted by kind and then in the order of their files. `ids` returns all
    /// existing cases, and is called if an expectation needs them; `described` are the names of the adapters
    /// that are described, whether or not the run used them. The globs of `sound` expectations are known to
    /// match something, and none of these covers another one.
    ///
    /// Stops after a million comparisons; [`DeadSearch::is_complete`] is false then.
    pub fn dead(
        &self,
        run: &Run,
        ids: impl FnOnce() -> Vec<String>,
        described: &[String],
        sound: impl Fn(&Known) -> bool,
    ) -> DeadSearch {
        let used = run.header.adapters.iter().map(|a| &a.info.name);
        let mut names = SortedNames::new(used.chain(described));
        let ids = LazyCell::new(|| Ids::new(&ids()));
        let left = Cell::new(MAX_COMPARISONS);
        let all_sound = self.all().iter().all(|known| sound(known));
        let prepare = || {
            if !all_sound && self.all().len() >= MANY {
                ids.parts();
            }
        };
        let (excuses, ()) = join(|| Excuses::of(self, run), prepare);
        let mut dead = self.unmatched_and_expired(&ids, &mut names, &left, sound);
        let reaches = self.reaches((&ids, &left), &mut names, run, &excuses, all_sound);
        // Without entries that can be dead, the ids are not needed.
        if reaches.iter().any(Option::is_some) {
            let names = &names.sorted;
            dead.extend(self.covered_or_never_matched(
                (&ids, &left),
                names,
                run,
                &excuses,
                &reaches,
            ));
        }
        DeadSearch::of(dead, &left)
    }

    /// Returns the globs that match nothing, and the expectations that have expired.
    fn unmatched_and_expired(
        &self,
        ids: &LazyCell<Ids, impl FnOnce() -> Ids>,
        names: &mut SortedNames,
        left: &Cell<u64>,
        sound: impl Fn(&Known) -> bool,
    ) -> Vec<Dead> {
        let mut dead = Vec::new();
        for (number, known) in self.all().iter().enumerate() {
            let mut parts = Vec::new();
            if !sound(known) {
                parts = self.unmatched(number, ids, names, left);
            }
            if self.expired(known) {
                let last = known.expires.as_deref().unwrap_or_default();
                parts.push((DeadKind::Expired, format!("{last}: {}", known.reason)));
            }
            dead.extend(parts.into_iter().map(|(kind, about)| Dead {
                kind,
                place: known.place(),
                about,
            }));
        }
        dead
    }

    /// Returns what each expectation names; `None` if it cannot be covered and cannot have failed to match.
    fn reaches(
        &self,
        (ids, left): (&LazyCell<Ids, impl FnOnce() -> Ids>, &Cell<u64>),
        names: &mut SortedNames,
        run: &Run,
        excuses: &Excuses<'_>,
        all_sound: bool,
    ) -> Vec<Option<NamedPairs>> {
        let mut reaches = Vec::new();
        for (number, known) in self.all().iter().enumerate() {
            // An expectation for another machine or run can name cases and adapters that are missing here. An
            // expectation for other adapters can only be covered, and no sound one is.
            if !self.applies(number) || all_sound && excuses.adapters(number).is_empty() {
                reaches.push(None);
                continue;
            }
            let adapters = names.reach(&known.adapters);
            // Reading the ids of all cases takes longer than a short run.
            let is_alive =
                all_sound && !excuses.excused_nothing(number, &adapters, run, &names.sorted);
            let reach = if is_alive {
                None
            } else {
                let first = (self.case_globs(number).iter()).find_map(|glob| ids.first(glob, left));
                let first = first.filter(|_| !adapters.is_empty());
                first.map(|first| NamedPairs { first, adapters })
            };
            reaches.push(reach);
        }
        reaches
    }

    /// Returns the expectations that another one covers, and the expectations that never matched.
    fn covered_or_never_matched(
        &self,
        (ids, left): (&Ids, &Cell<u64>),
        names: &[String],
        run: &Run,
        excuses: &Excuses<'_>,
        reaches: &[Option<NamedPairs>],
    ) -> Vec<Dead> {
        let mut dead = Vec::new();
        let naming = self.naming_first(ids, reaches, left);
        for (number, known) in self.all().iter().enumerate() {
            let Some(reach) = &reaches[number] else {
                continue;
            };
            let is_within = |one: usize, other: usize| {
                let (Some(within), Some(around)) = (&reaches[one], &reaches[other]) else {
                    return false;
                };
                within.adapters.is_subset(&around.adapters)
                    && (self.all()[one].cases == self.all()[other].cases
                        || self.case_globs(one).iter().all(|glob| {
                            ids.matching(glob, left)
                                .all(|id| self.names(other, &ids.sorted[id]))
                        }))
            };
            let others = naming.get(&reach.first).into_iter().flatten();
            let cover = others.copied().find(|other| {
                let by = &self.all()[*other];
                *other != number
                    && spend(left)
                    && covers(by, known)
                    && is_within(number, *other)
                    // Of two equal expectations, the second is dead.
                    && (*other < number || !(covers(known, by) && is_within(*other, number)))
            });
            let drawn = |adapter: &BTreeSet<&str>| {
                self.case_globs(number).iter().all(|glob| {
                    ids.matching(glob, left)
                        .all(|id| adapter.contains(ids.sorted[id].as_str()))
                })
            };
            let kind = if let Some(other) = cover {
                Some((DeadKind::Covered, self.all()[other].place()))
            } else {
                let excused_nothing = excuses.excused_nothing(number, &reach.adapters, run, names);
                let mut cases = excuses
                    .adapters(number)
                    .iter()
                    .map(|n| &excuses.recorded[*n]);
                let never = excused_nothing && cases.all(drawn);
                never.then(|| (DeadKind::NeverMatched, known.reason.clone()))
            };
            // Without a comparison left, nothing is certain.
            if left.get() == 0 {
                break;
            }
            dead.extend(kind.map(|(kind, about)| Dead {
                kind,
                place: known.place(),
                about,
            }));
        }
        dead
    }

    /// Returns the globs of an expectation, or their alternatives, that match nothing.
    fn unmatched(
        &self,
        number: usize,
        ids: &Ids,
        names: &mut SortedNames,
        left: &Cell<u64>,
    ) -> Vec<(DeadKind, String)> {
        let known = &self.all()[number];
        let mut parts = Vec::new();
        for (text, glob) in known.cases.iter().zip(self.case_globs(number)) {
            let without = ids.parts_without(text, glob, left).into_iter();
            parts.extend(without.map(|part| (DeadKind::NoCase, part)));
        }
        for glob in &known.adapters {
            let without = names.parts_without(glob).into_iter();
            parts.extend(without.map(|part| (DeadKind::NoAdapter, part)));
        }
        parts
    }

    /// Returns, for the first case of each expectation, the expectations that name this case. Incomplete if no
    /// comparisons are left.
    fn naming_first(
        &self,
        ids: &Ids,
        reaches: &[Option<NamedPairs>],
        left: &Cell<u64>,
    ) -> HashMap<usize, Vec<usize>> {
        let firsts: BTreeSet<usize> = reaches.iter().flatten().map(|reach| reach.first).collect();
        let firsts: Vec<usize> = firsts.into_iter().collect();
        // Both are in the order of the ids.
        let named = Ids::new(firsts.iter().map(|first| &ids.sorted[*first]));
        let mut naming: HashMap<usize, Vec<usize>> = HashMap::new();
        for number in (0..reaches.len()).filter(|number| reaches[*number].is_some()) {
            for glob in self.case_globs(number) {
                for index in named.matching(glob, left) {
                    let others = naming.entry(firsts[index]).or_default();
                    if others.last() != Some(&number) {
                        others.push(number);
                    }
                }
            }
        }
        naming
    }
}

/// The result of a search for dead expectations.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeadSearch {
    /// The dead expectations and parts, by kind.
    pub dead: Vec<Dead>,
    /// False if there were too many globs to compare all: others can be dead too.
    pub is_complete: bool,
}

impl DeadSearch {
    fn of(mut dead: Vec<Dead>, left: &Cell<u64>) -> Self {
        dead.sort_by_key(|d| d.kind);
        Self {
            dead,
            is_complete: left.get() > 0,
        }
    }
}

/// Counts a comparison; returns false if none is left.
fn spend(left: &Cell<u64>) -> bool {
    left.set(left.get().saturating_sub(1));
    left.get() > 0
}

/// The use of each expectation in a run.
struct Excuses<'r> {
    /// By adapter of the run: the cases that were recorded on it.
    recorded: Vec<BTreeSet<&'r str>>,
    /// By expectation: the run's adapters that it is about.
    adapters: Vec<Vec<usize>>,
    /// By expectation: the fate of its cases.
    outcomes: Vec<DrawnOutcome>,
}

/// The fate of an expectation's cases in a run.
#[derive(Clone, Copy, Default)]
struct DrawnOutcome {
    /// True if a run can show whether the expectation is needed.
    can_be_judged: bool,
    /// True if it excused a verdict.
    excused: bool,
    /// True if a case was drawn.
    drawn: bool,
}

impl<'r> Excuses<'r> {
    fn of(expectations: &Expectations, run: &'r Run) -> Self {
        let numbers: HashMap<&str, usize> = (0..)
            .zip(&run.header.adapters)
            .map(|(number, adapter)| (adapter.info.name.as_str(), number))
            .collect();
        let mut excuses = Self {
            recorded: vec![BTreeSet::new(); run.header.adapters.len()],
            adapters: Vec::new(),
            outcomes: Vec::new(),
        };
        for (number, known) in expectations.all().iter().enumerate() {
            let adapters = run.header.adapters.iter().enumerate();
            let about = adapters.filter(|(_, a)| expectations.is_about(number, a));
            excuses.adapters.push(about.map(|(n, _)| n).collect());
            // A flaky case can pass every time, and a skipped case has no verdict.
            let can_be_judged = !expectations.expired(known)
                && !matches!(known.verdict, Verdict::Flaky | Verdict::Skipped);
            excuses.outcomes.push(DrawnOutcome {
                can_be_judged,
                ..DrawnOutcome::default()
            });
        }
        for record in &run.records {
            let Some(adapter) = numbers.get(record.adapter.as_str()) else {
                continue;
            };
            excuses.recorded[*adapter].insert(&record.case);
            let is_drawn = !matches!(
                record.verdict,
                Verdict::NotSupported | Verdict::Skipped | Verdict::Blocked
            );
            for number in expectations.naming(&record.case) {
                let outcome = &mut excuses.outcomes[number];
                if outcome.can_be_judged
                    && !outcome.excused
                    && excuses.adapters[number].contains(adapter)
                {
                    outcome.excused = expectations.excuses(number, record.shown());
                    outcome.drawn |= is_drawn;
                }
            }
        }
        excuses
    }

    /// Returns the numbers of the run's adapters that an expectation is about.
    fn adapters(&self, number: usize) -> &[usize] {
        &self.adapters[number]
    }

    /// Returns true if a run drew cases of an expectation on all its adapters, and it excused no verdict.
    fn excused_nothing(
        &self,
        number: usize,
        adapters: &BTreeSet<usize>,
        run: &Run,
        names: &[String],
    ) -> bool {
        let about = &self.adapters[number];
        let is_used = |name: &String| {
            let mut used = about.iter().map(|n| &run.header.adapters[*n].info.name);
            used.any(|used| used == name)
        };
        let outcome = self.outcomes[number];
        outcome.can_be_judged
            && !outcome.excused
            && outcome.drawn
            && adapters.iter().all(|index| is_used(&names[*index]))
    }
}

/// The cases and adapters that an expectation names.
struct NamedPairs {
    /// The index of one of its cases.
    first: usize,
    /// The indices of its adapters.
    adapters: Rc<BTreeSet<usize>>,
}

/// Returns true if an expectation excuses whatever another one excuses, for each driver and on each day.
fn covers(by: &Known, known: &Known) -> bool {
    let verdict = by.excuses(known.verdict)
        && (known.verdict == Verdict::Skipped) == (by.verdict == Verdict::Skipped);
    let driver = by.driver == "*"
        || by.driver == known.driver
        || !is_pattern(&known.driver)
            && Glob::new(&by.driver).is_ok_and(|glob| glob.is_match(&known.driver));
    let version = by.version.is_none() || by.version == known.version;
    let day = match (&by.expires, &known.expires) {
        (None, _) => true,
        (Some(_), None) => false,
        (Some(by), Some(known)) => by >= known,
    };
    let symptom = by.symptom.is_none() || by.symptom == known.symptom;
    let device = by.device.is_none() || by.device == known.device;
    let machine = by.processor.is_none() || by.processor == known.processor;
    let labels = by.labels.iter().all(|label| known.labels.contains(label));
    verdict && driver && device && version && day && symptom && machine && labels
}

fn is_pattern(glob: &str) -> bool {
    glob.contains(['*', '?', '[', '{', '\\'])
}

/// Names, and the names that each glob matched so far. Entries share most of their globs.
struct SortedNames {
    sorted: Vec<String>,
    matches: HashMap<String, Vec<usize>>,
    /// The names that each list of globs matched so far, by index.
    reaches: HashMap<Vec<String>, Rc<BTreeSet<usize>>>,
}

/// Returns texts in their order, each once.
fn sorted<'a>(texts: impl IntoIterator<Item = &'a String>) -> Vec<String> {
    let mut sorted: Vec<&String> = texts.into_iter().collect();
    sorted.sort_unstable();
    sorted.dedup();
    sorted.into_iter().cloned().collect()
}

impl SortedNames {
    fn new<'a>(names: impl IntoIterator<Item = &'a String>) -> Self {
        Self {
            sorted: sorted(names),
            matches: HashMap::new(),
            reaches: HashMap::new(),
        }
    }

    /// Returns the indices of the names that one of the globs matches.
    fn reach(&mut self, globs: &[String]) -> Rc<BTreeSet<usize>> {
        if let Some(reach) = self.reaches.get(globs) {
            return Rc::clone(reach);
        }
        let mut reach = BTreeSet::new();
        for glob in globs {
            reach.extend(self.matches(glob));
        }
        let reach = Rc::new(reach);
        self.reaches.insert(globs.to_vec(), Rc::clone(&reach));
        reach
    }

    fn matches(&mut self, glob: &str) -> &[usize] {
        if !self.matches.contains_key(glob) {
            let found = matches(glob, &self.sorted);
            self.matches.insert(glob.to_owned(), found);
        }
        &self.matches[glob]
    }

    /// Returns the glob itself if it matches no name; otherwise its [`alternatives`] that match no name.
    fn parts_without(&mut self, glob: &str) -> Vec<String> {
        if self.matches(glob).is_empty() {
            return vec![glob.to_owned()];
        }
        let mut parts = alternatives(glob);
        parts.retain(|part| self.matches(part).is_empty());
        parts
    }
}

/// Returns the indices of the names that a glob matches. `names` must be sorted.
fn matches(glob: &str, names: &[String]) -> Vec<usize> {
    let Ok(glob) = Glob::new(glob) else {
        return Vec::new();
    };
    let near = beginning(glob.prefix(), names);
    near.filter(|index| glob.is_match(&names[*index])).collect()
}

/// Returns the range of the sorted names that begin with a prefix.
fn beginning(prefix: &str, names: &[String]) -> Range<usize> {
    let start = names.partition_point(|name| name.as_str() < prefix);
    let length = names[start..].partition_point(|name| name.starts_with(prefix));
    start..start + length
}

/// The ids of all cases.
struct Ids {
    sorted: Vec<String>,
    /// Made when it is first used.
    parts: OnceCell<Parts>,
}

/// With this many expectations, the index of ids is built in advance, beside the records.
const MANY: usize = 1000;

/// Up to this many ids are compared one by one, without the index.
const FEW: usize = 64;

impl Ids {
    fn new<'a>(ids: impl IntoIterator<Item = &'a String>) -> Self {
        Self {
            sorted: sorted(ids),
            parts: OnceCell::new(),
        }
    }

    /// Returns the indices of the ids that a glob matches, as long as comparisons are left.
    fn matching<'i>(
        &'i self,
        glob: &'i Glob,
        left: &'i Cell<u64>,
    ) -> Box<dyn Iterator<Item = usize> + 'i> {
        if let Some(id) = glob.only_match() {
            let found = self.sorted.binary_search_by(|other| other.as_str().cmp(id));
            return Box::new(found.ok().into_iter());
        }
        let range = beginning(glob.prefix(), &self.sorted);
        let near = if range.len() <= FEW {
            None
        } else {
            self.parts()
                .rarest(glob.literals().iter().map(String::as_bytes))
        };
        let candidates: Box<dyn Iterator<Item = usize>> = match near {
            Some(indices) => {
                let near = indices.iter().copied();
                Box::new(near.filter(move |index| range.contains(index)))
            }
            None => Box::new(range),
        };
        Box::new(
            candidates
                .take_while(|_| spend(left))
                .filter(move |index| glob.is_match(&self.sorted[*index])),
        )
    }

    fn parts(&self) -> &Parts {
        self.parts.get_or_init(|| Parts::new(&self.sorted))
    }

    /// Returns the index of the first id that a glob matches.
    fn first(&self, glob: &Glob, left: &Cell<u64>) -> Option<usize> {
        self.matching(glob, left).next()
    }

    /// Returns the glob itself if it certainly matches no id; otherwise its [`alternatives`] that match none.
    fn parts_without(&self, text: &str, glob: &Glob, left: &Cell<u64>) -> Vec<String> {
        let is_without = |glob: &Glob| self.first(glob, left).is_none() && left.get() > 0;
        if is_without(glob) {
            return vec![text.to_owned()];
        }
        let mut parts = alternatives(text);
        parts.retain(|part| Glob::new(part).ok().is_none_or(|glob| is_without(&glob)));
        parts
    }
}

/// Expands each group `{…}` of a glob in turn: one glob per alternative, which replaces its group. Returns
/// none if the glob has no group, or has nested groups.
fn alternatives(glob: &str) -> Vec<String> {
    let mut globs = Vec::new();
    let mut start = 0;
    while let Some(open) = glob[start..].find('{').map(|offset| offset + start) {
        let Some(close) = glob[open..].find('}').map(|offset| offset + open) else {
            return Vec::new();
        };
        let inside = &glob[open + 1..close];
        if inside.contains(['{', '[', '\\']) || glob[..open].ends_with(['\\', '[']) {
            return Vec::new();
        }
        let each = inside.split(',');
        globs.extend(each.map(|choice| format!("{}{choice}{}", &glob[..open], &glob[close + 1..])));
        start = close + 1;
    }
    globs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adapter::AdapterRecord;
    use crate::header::Header;
    use crate::record::Record;

    const IDS: [&str; 4] = ["a/x=1/y=1", "a/x=1/y=2", "a/x=2/y=1", "b"];

    fn adapter(name: &str) -> AdapterRecord {
        serde_json::from_value(serde_json::json!({
            "name": name, "backend": "gl", "device": "d", "driver": "Mesa",
            "driver_version": "Mesa 25.0.7", "api_version": "1", "software": true,
            "limits": { "api": "open-gl", "sub_pixel_bits": 8, "max_size": 1,
                "max_color_attachments": 8, "formats": {}, "features": [], "sample_positions": {} },
        }))
        .unwrap()
    }

    /// Returns a run of these cases on `gl:a`, in which the cases that begin with `a` fail.
    fn run(ids: &[&str]) -> Run {
        let verdict = |id: &str| {
            if id.starts_with('a') {
                Verdict::Fail
            } else {
                Verdict::Pass
            }
        };
        let records = ids.iter().map(|id| Record::new(*id, "gl:a", verdict(id)));
        Run {
            records: records.collect(),
            beside: Vec::new(),
            truncated: false,
            header: Header::new(vec![adapter("gl:a")], ids.len() as u64),
        }
    }

    fn entry(adapter: &str, case: &str, verdict: &str) -> String {
        format!(
            r#"{{ "adapter": "{adapter}", "driver": "*", "case": "{case}", "verdict": "{verdict}",
                "reason": "r", "evidence": "e" }}"#
        )
    }

    fn dead(entries: &[String], drawn: &[&str]) -> Vec<(DeadKind, String, String)> {
        let text = format!("[{}]", entries.join(","));
        let read = Expectations::parse(&text, Path::new("e")).unwrap();
        let ids = IDS.map(str::to_owned);
        let search = read.dead(&run(drawn), || ids.into(), &["gl:b".to_owned()], |_| false);
        let found = search.dead;
        found
            .into_iter()
            .map(|d| (d.kind, d.place, d.about))
            .collect()
    }

    fn one(kind: DeadKind, number: u32, about: &str) -> Vec<(DeadKind, String, String)> {
        vec![(kind, format!("e: entry {number}"), about.to_owned())]
    }

    #[test]
    fn the_ids_are_read_for_a_sound_expectation_only_if_it_can_be_dead() {
        let found = |case: &str, ids: fn() -> Vec<String>| {
            let text = format!("[{}]", entry("gl:a", case, "fail"));
            let read = Expectations::parse(&text, Path::new("e")).unwrap();
            let dead = read.dead(&run(&IDS), ids, &[], |_| true).dead;
            dead.into_iter().map(|d| d.kind).collect::<Vec<_>>()
        };
        // One fails as expected, and the other was not drawn.
        for case in ["a/*", "c"] {
            assert_eq!(found(case, || panic!("the ids were read")), []);
        }
        let all = || IDS.map(str::to_owned).into();
        assert_eq!(found("b", all), [DeadKind::NeverMatched]);
    }

    #[test]
    fn a_glob_that_matches_a_case_is_alive() {
        for case in ["a/*", "a/x=1/y=1", "a/x={1,2}/y={1,2}", "*y=2", "a/x=1/y=?"] {
            assert_eq!(dead(&[entry("gl:a", case, "fail")], &IDS), [], "{case}");
            assert_eq!(dead(&[entry("*", case, "fail")], &IDS), [], "{case}");
        }
    }

    #[test]
    fn a_glob_that_matches_nothing_is_dead() {
        let found = |adapter: &str, case: &str| dead(&[entry(adapter, case, "fail")], &IDS);
        use DeadKind::{NoAdapter, NoCase};
        assert_eq!(found("gl:a", "a/z=*"), one(NoCase, 1, "a/z=*"));
        assert_eq!(found("gl:a", "a/x=1/y=3"), one(NoCase, 1, "a/x=1/y=3"));
        let alternative = found("gl:a", "a/x={1,3}/y=1");
        assert_eq!(alternative, one(NoCase, 1, "a/x=3/y=1"));
        assert_eq!(found("gl:c", "a/*"), one(NoAdapter, 1, "gl:c"));
        assert_eq!(found("gl:{a,c}", "a/*"), one(NoAdapter, 1, "gl:c"));
        assert_eq!(found("gl:b", "a/*"), [], "described, and not used here");
    }

    #[test]
    fn a_covered_entry_is_dead_and_so_is_the_second_of_two_equal_ones() {
        let (wide, narrow) = (entry("*", "a/*", "fail"), entry("gl:a", "a/x=1/*", "fail"));
        let covered = |entries: &[&String]| {
            let entries: Vec<String> = entries.iter().map(|e| (*e).clone()).collect();
            dead(&entries, &IDS)
        };
        let kind = DeadKind::Covered;
        assert_eq!(covered(&[&wide, &narrow]), one(kind, 2, "e: entry 1"));
        assert_eq!(covered(&[&narrow, &wide]), one(kind, 1, "e: entry 2"));
        assert_eq!(covered(&[&wide, &wide]), one(kind, 2, "e: entry 1"));
        let crash = entry("gl:b", "a/x=1/*", "crash");
        assert_eq!(covered(&[&wide, &crash]), []);
        let flaky = entry("*", "a/*", "flaky");
        assert_eq!(covered(&[&flaky, &crash]), one(kind, 2, "e: entry 1"));
        let late = wide.replace("\"evidence\"", "\"expires\": \"2030-01-01\", \"evidence\"");
        assert_eq!(covered(&[&late, &narrow]), []);
        let ranged = wide.replace("\"evidence\"", "\"version\": \">=9\", \"evidence\"");
        assert_eq!(covered(&[&ranged, &narrow]), []);
    }

    #[test]
    fn an_entry_dies_only_when_all_its_cases_were_drawn_on_all_its_adapters() {
        let never = |adapter: &str, case: &str, verdict: &str, drawn: &[&str]| {
            dead(&[entry(adapter, case, verdict)], drawn)
        };
        let kind = DeadKind::NeverMatched;
        assert_eq!(never("gl:a", "b", "fail", &IDS), one(kind, 1, "r"));
        assert_eq!(never("gl:a", "a/*", "crash", &IDS), one(kind, 1, "r"));
        assert_eq!(never("gl:a", "b", "fail", &IDS[..3]), [], "b was not drawn");
        assert_eq!(
            never("gl:a", "a/*", "crash", &IDS[1..]),
            [],
            "one was not drawn"
        );
        assert_eq!(never("gl:*", "b", "fail", &IDS), [], "gl:b was not used");
        assert_eq!(never("gl:a", "b", "flaky", &IDS), [], "flakes may pass");
        assert_eq!(never("gl:a", "b", "skipped", &IDS), []);
    }

    #[test]
    fn the_list_of_dead_entries_is_written_and_read_back() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(Dead::read(folder.path()).unwrap(), []);
        let entry = Dead {
            kind: DeadKind::NoCase,
            place: "e".to_owned(),
            about: "a/*".to_owned(),
        };
        Dead::write(folder.path(), std::slice::from_ref(&entry)).unwrap();
        assert_eq!(Dead::read(folder.path()).unwrap(), [entry]);
        Dead::write(folder.path(), &[]).unwrap();
        assert!(!folder.path().join(DEAD_FILE).exists());
    }
}
