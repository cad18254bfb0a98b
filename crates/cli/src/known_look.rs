//! Finds failures of a run that findings explain although the findings name other cases.
//!
//! Findings name the suite's cases, so none of them names a user's own case that meets a known bug. Failing
//! cases and the cases of findings are therefore reduced on the driver. If both reduce to the same states and
//! the same violation, and have the facts that the finding needs, the failure is known by its look.

use crate::failure::Failure;
use crate::match_text::match_sentence;
use crate::output::say;
use etalon_case::{Case, CaseRef, Library, Profile, build, select};
use etalon_diagnose::{Group, Groups, KnownBugs, Match, Symptom, Traits};
use etalon_explore::{Candidate, draw_facts};
use etalon_record::{AdapterRecord, Expectation, Expectations, Expected, Record, Run};
use etalon_runner::{Launch, Reducer, confirm};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// The id of a case that is built for a reduction.
const NAME: &str = "found/look";

/// The inputs of a comparison with findings.
pub(crate) struct LookInputs<'a> {
    /// The cases of the run.
    pub(crate) library: &'a Library,
    pub(crate) expectations: &'a Expectations,
    pub(crate) launches: &'a [Launch],
    /// The time limit of a case.
    pub(crate) timeout: Duration,
    /// True once the run is being stopped.
    pub(crate) stop: &'a AtomicBool,
}

impl LookInputs<'_> {
    /// Marks the unexpected records of a folder's run that findings explain. Returns the number of records
    /// that stay unexpected.
    pub(crate) fn mark(&self, folder: &Path) -> Result<u64, Failure> {
        let mut run = Run::read(folder).map_err(Failure::incomplete)?;
        if run.unexpected() == 0 {
            return Ok(0);
        }
        let records = run.records.iter().filter(|r| r.unexpected());
        let ids: BTreeSet<&str> = records.map(|r| r.case.as_str()).collect();
        let cases: HashMap<String, CaseRef<'_>> = self.library.named(&ids).collect();
        let built_in = Library::built_in();
        for adapter in &run.header.adapters {
            let seen = self.seen(&run.records, adapter);
            let of_adapter = |r: &&mut Record| {
                r.adapter == adapter.info.name && r.unexpected() && Symptom::of(r).keeps_worker()
            };
            let failing: Vec<&mut Record> = run.records.iter_mut().filter(of_adapter).collect();
            let mut launches = self.launches.iter();
            if let Some(launch) = launches.find(|launch| launch.adapter == adapter.info.name)
                && !failing.is_empty()
            {
                let count = failing.len();
                say!(
                    "{}: failures to compare with findings: {count}",
                    adapter.info.name
                );
                self.mark_all(failing, &cases, adapter, &seen, launch, built_in)?;
            }
        }
        run.replace_in(folder).map_err(Failure::incomplete)?;
        Ok(run.unexpected())
    }

    /// Returns the names of the findings that records of an adapter show.
    fn seen(&self, records: &[Record], adapter: &AdapterRecord) -> BTreeSet<String> {
        let records = records.iter().filter(|r| {
            r.adapter == adapter.info.name && r.verdict.is_bad() && r.expected.is_some()
        });
        let names = records.filter_map(|record| {
            let shown = record.shown();
            match self
                .expectations
                .look_up_record(adapter, &record.case, shown)
            {
                Expectation::Agrees(known) => Some(known.name()),
                _ => None,
            }
        });
        names.collect()
    }

    /// Marks an adapter's failures that findings explain, if its records show these findings too. The needs of a
    /// finding do not say all that it is about, so a finding that the run does not show proves nothing.
    fn mark_all(
        &self,
        failing: Vec<&mut Record>,
        cases: &HashMap<String, CaseRef<'_>>,
        adapter: &AdapterRecord,
        seen: &BTreeSet<String>,
        launch: &Launch,
        built_in: &Library,
    ) -> Result<(), Failure> {
        let reducer = || {
            let limits = adapter.limits.clone();
            Reducer::new(launch.clone(), limits, self.timeout, self.stop)
        };
        let mut groups = Groups::default();
        let mut looking = reducer();
        let numbers = failing.iter().map(|record| {
            let case = cases.get(&record.case).ok_or_else(|| {
                Failure::incomplete(format!("there is no case `{}`", record.case))
            })?;
            let document = case.document().map_err(Failure::usage)?;
            group(&mut groups, &mut looking, document, record)
        });
        let numbers = numbers.collect::<Result<Vec<usize>, Failure>>()?;
        let mut bugs = known_bugs(self.expectations, adapter, built_in, reducer())?;
        let mut matches: Vec<Option<Match>> = Vec::new();
        let name = &adapter.info.name;
        for group in groups.iter_mut() {
            if let Some(case) = group.scene.take() {
                let steady = confirm(launch, &case, &group.symptom, self.timeout);
                group.steady = steady.is_ok();
            }
            let found = if group.can_be_compared() {
                bugs.matching(&group.symptom, &group.traits, group.steady)?
            } else {
                None
            };
            match &found {
                Some(like) if !like.is_exact() => {
                    say!("{name}: {} of them: {}", group.count, match_sentence(like));
                }
                Some(like) if !seen.contains(&like.finding) => say!(
                    "{name}: {} of them look like {}, but no record of this run shows its finding: {}",
                    group.count,
                    like.case,
                    like.title
                ),
                _ => {}
            }
            matches.push(found);
        }
        for (record, number) in failing.into_iter().zip(numbers) {
            let is_known = |known: &&Match| known.is_exact() && seen.contains(&known.finding);
            if let Some(known) = matches[number].as_ref().filter(is_known) {
                let reason = known.title.clone();
                record.expected = Some(Expected { reason });
                record.look = Some(known.case.clone());
            }
        }
        Ok(())
    }
}

/// Returns the bugs that expectations about an adapter know, with the cases of a library that they name.
pub(crate) fn known_bugs<'a>(
    expectations: &Expectations,
    adapter: &AdapterRecord,
    library: &'a Library,
    reducer: Reducer<'a>,
) -> Result<KnownBugs<Reducer<'a>>, Failure> {
    let about = expectations.about(adapter);
    let globs: Vec<String> = about.all().iter().flat_map(|k| k.cases.clone()).collect();
    // Without a glob, all cases would be selected.
    let cases = if globs.is_empty() {
        Vec::new()
    } else {
        let selected = select(library, Profile::Full, &globs);
        selected.map_err(Failure::usage)?.cases
    };
    let cases = cases.into_iter().map(|case| (case.id(), case));
    Ok(KnownBugs::new(&about, adapter, cases, reducer))
}

/// Returns the number of the group that a failure of a document belongs to; adds a new group if no group
/// matches.
fn group(
    groups: &mut Groups<Option<Case>>,
    reducer: &mut Reducer<'_>,
    document: Value,
    record: &Record,
) -> Result<usize, Failure> {
    let symptom = Symptom::of(record);
    if let Some(number) = groups.count(&document, &symptom, reducer.is_stopped()) {
        return Ok(number);
    }
    let case = build(NAME, &document).map_err(Failure::usage)?;
    let scene = Candidate { document, case };
    let looked = reducer.look(scene, record.clone(), symptom)?;
    if let Some(number) = groups.count_reduced(&looked.key) {
        return Ok(number);
    }
    let Candidate { document, case } = looked.scene;
    let traits = Traits::of(&document, &looked.symptom, draw_facts(&case));
    let mut group = Group::new(None, traits, looked.symptom, looked.key);
    group.scene = group.steady.then_some(case);
    Ok(groups.push(group))
}

/// Returns lines about the records that are known by their look, grouped by finding; empty without such
/// records.
pub(crate) fn lines(run: &Run) -> String {
    let mut findings: BTreeMap<&str, (u64, &str)> = BTreeMap::new();
    for record in &run.records {
        if let (Some(expected), Some(case)) = (&record.expected, &record.look) {
            findings.entry(&expected.reason).or_insert((0, case)).0 += 1;
        }
    }
    let count: u64 = findings.values().map(|(count, _)| count).sum();
    let mut text = match count {
        0 => String::new(),
        1 => "1 failure looks like a known bug\n".to_owned(),
        count => format!("{count} failures look like known bugs\n"),
    };
    for (reason, (count, case)) in findings {
        text.push_str(&format!("{count:6}  {reason}: like {case}\n"));
    }
    text
}
