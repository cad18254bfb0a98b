//! What a driver shows of the known bugs, and which formats and states it draws right: for programs that draw on it
//! and compare pictures.
//!
//! A picture has many states, and a bug needs a few of them. A state is therefore unsafe only where a bug needs it, or
//! where no picture with it is right.

use crate::symptom::Symptom;
use etalon_frame::ChannelEncoding;
use etalon_glob::Glob;
use etalon_record::{AdapterRecord, Expectation, Expectations, Known, Record, Verdict};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// The largest distance in codes at which a picture is still compared with a tolerance, rather than not at all.
const MOST_CODES: f64 = 4.0;

/// A case that was drawn, with what is known about its scene.
#[derive(Clone, Debug)]
pub struct DrawnCase<'a> {
    /// Its record.
    pub record: &'a Record,
    /// The facts of each of its draws; without draws, those of its scene.
    pub draws: Vec<Vec<String>>,
    /// The formats that its passes draw to: their names, and their facts.
    pub formats: Vec<[String; 2]>,
    /// The formats of the textures that its draws read: their names, and the facts of such draws.
    pub sampled: Vec<[String; 2]>,
}

/// What to do with pictures that meet a bug.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Advice {
    /// Compare them with a tolerance: no channel is further than these codes from the ideal one.
    Tolerance {
        /// The codes, rounded up.
        codes: u32,
        /// The encoding of the channels that they count in.
        encoding: ChannelEncoding,
    },
    /// Do not compare them.
    Skip,
    /// Compare them: only a counter, such as that of an occlusion query, is wrong.
    IgnoreCounters,
    /// Do not draw them: the process dies or hangs.
    Avoid,
}

/// A bug that the driver showed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShownBug {
    /// The name of its finding; `None` if no finding explains it.
    pub finding: Option<String>,
    /// The finding's title; otherwise how the case failed.
    pub title: String,
    /// The worst verdict.
    pub verdict: Verdict,
    /// The number of drawn cases that show it.
    pub cases: u64,
    /// One of them.
    pub example: String,
    /// The case that must be drawn before the example, if it is right alone.
    pub after: Option<String>,
    /// Globs over facts: a draw without all of them does not show the bug. Those of the finding, or what is left of an
    /// example when it is reduced, or what all examples have; empty if nothing is known.
    pub needs: Vec<String>,
    /// What to do about it.
    pub advice: Advice,
}

impl ShownBug {
    /// Returns the name by which facts refer to the bug.
    fn name(&self) -> String {
        self.finding.as_ref().unwrap_or(&self.example).clone()
    }
}

/// A finding about the driver that it did not show.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct UnseenBug {
    /// The finding's name.
    pub finding: String,
    /// Its title.
    pub title: String,
    /// The number of its cases that were drawn and right; none were drawn if 0.
    pub right: u64,
}

/// How safe a format or a state is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Safety {
    /// Right in some case, and no bug needs it.
    Safe,
    /// Right in some case, and a bug needs it, alone or together with others.
    Partly,
    /// Wrong in each case that has it, and a bug needs it.
    Wrong,
    /// Only in cases that are wrong, and no bug is known to need it.
    Unclear,
    /// The driver lacks it, or what its cases need besides it.
    NotSupported,
    /// No case with it was drawn.
    NotDrawn,
}

/// What is known about a format or a state.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Fact {
    /// How safe it is.
    pub safety: Safety,
    /// The number of drawn cases that have it and are right.
    pub right: u64,
    /// The number of drawn cases that have it and are wrong, for whatever reason.
    pub wrong: u64,
    /// The bugs that need it, or all bugs of its cases if none of these is right: their findings, or their examples.
    pub bugs: BTreeSet<String>,
    /// True if one of them needs it.
    #[serde(skip)]
    is_needed: bool,
    #[serde(skip)]
    is_lacking: bool,
}

/// The answer for one adapter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Preflight {
    /// The bugs, those of the most cases first.
    pub bugs: Vec<ShownBug>,
    /// The findings about the driver that it did not show.
    pub unseen: Vec<UnseenBug>,
    /// Formats that are drawn to, by their names.
    pub formats: BTreeMap<String, Fact>,
    /// Formats of textures that are read, by their names.
    pub sampled: BTreeMap<String, Fact>,
    /// Other facts of draws by their names.
    pub states: BTreeMap<String, Fact>,
}

/// The cases of one bug.
struct Shown<'a> {
    known: Option<&'a Known>,
    cases: Vec<&'a DrawnCase<'a>>,
    needs: Vec<String>,
}

impl Preflight {
    /// Makes the answer from all cases of a run on one adapter. `formats` are the names and the facts of all formats, and
    /// `states` the names of all facts. `needs` returns the facts that the failures of a bug need, unless its finding
    /// says so.
    pub fn new(
        cases: &[DrawnCase<'_>],
        adapter: &AdapterRecord,
        expectations: &Expectations,
        formats: &[[String; 2]],
        states: &[String],
        mut needs: impl FnMut(Option<&Known>, &[&DrawnCase<'_>]) -> Vec<String>,
    ) -> Self {
        let about = expectations.about(adapter);
        let mut shown: BTreeMap<String, Shown<'_>> = BTreeMap::new();
        for case in cases.iter().filter(|case| is_wrong(case.record)) {
            let known = match about.look_up_record(adapter, &case.record.case, case.record.shown())
            {
                Expectation::Agrees(known) => Some(known),
                _ => None,
            };
            let name = known.map_or_else(|| Symptom::of(case.record).to_string(), Known::name);
            let bug = shown.entry(name).or_insert_with(|| Shown {
                known,
                cases: Vec::new(),
                needs: known.map_or_else(Vec::new, |known| known.needs.clone()),
            });
            bug.cases.push(case);
        }
        for bug in shown.values_mut() {
            // A case that fails only after others says little about itself.
            bug.cases.sort_by_key(|case| !case.record.after.is_empty());
            if bug.needs.is_empty() {
                bug.needs = needs(bug.known, &bug.cases);
            }
        }
        let fact = || Fact {
            safety: Safety::NotDrawn,
            right: 0,
            wrong: 0,
            bugs: BTreeSet::new(),
            is_needed: false,
            is_lacking: false,
        };
        let no_case = |name: &String| (name.clone(), fact());
        let of_formats = || formats.iter().map(|[name, _]| no_case(name)).collect();
        let mut answer = Self {
            bugs: Vec::new(),
            unseen: unseen(cases, &about, &shown),
            formats: of_formats(),
            sampled: of_formats(),
            states: states.iter().map(no_case).collect(),
        };
        for case in cases {
            let names = |formats: &'_ [[String; 2]]| -> BTreeSet<String> {
                formats.iter().map(|[name, _]| name.clone()).collect()
            };
            let states = case.draws.iter().flatten().cloned().collect();
            for (facts, own) in [
                (&mut answer.formats, names(&case.formats)),
                (&mut answer.sampled, names(&case.sampled)),
                (&mut answer.states, states),
            ] {
                for name in own {
                    let fact = facts.entry(name).or_insert_with(fact);
                    fact.count(case.record);
                }
            }
        }
        for bug in shown.values() {
            answer.add(bug, formats);
        }
        for facts in answer.tables() {
            for fact in facts.values_mut() {
                fact.safety = fact.safety();
            }
        }
        answer
            .bugs
            .sort_by(|a, b| b.cases.cmp(&a.cases).then_with(|| a.title.cmp(&b.title)));
        answer
    }

    fn tables(&mut self) -> [&mut BTreeMap<String, Fact>; 3] {
        [&mut self.formats, &mut self.sampled, &mut self.states]
    }

    /// Keeps what a draw with these facts alone can meet: the bugs that need no others, and the facts themselves.
    /// `names` are the names of the facts and of formats.
    pub fn keep(&mut self, facts: &BTreeSet<String>, names: &BTreeSet<String>) {
        let is_met = |bug: &ShownBug| {
            let needs = bug.needs.iter().filter_map(|need| Glob::new(need).ok());
            needs
                .into_iter()
                .all(|need| facts.iter().any(|fact| need.is_match(fact)))
        };
        self.bugs.retain(is_met);
        let met: BTreeSet<String> = self.bugs.iter().map(ShownBug::name).collect();
        for table in self.tables() {
            table.retain(|name, _| names.contains(name));
            for fact in table.values_mut() {
                fact.bugs.retain(|bug| met.contains(bug));
                fact.safety = fact.safety();
            }
        }
    }

    /// Adds a bug, and marks the facts that it needs.
    fn add(&mut self, bug: &Shown<'_>, formats: &[[String; 2]]) {
        let first = bug.cases[0].record;
        let shown = ShownBug {
            finding: bug.known.map(Known::name),
            title: bug.known.map_or_else(
                || Symptom::of(first).to_string(),
                |known| known.reason.clone(),
            ),
            verdict: bug
                .cases
                .iter()
                .map(|case| case.record.verdict)
                .max_by_key(|verdict| verdict.severity())
                .unwrap_or(first.verdict),
            cases: bug.cases.len() as u64,
            example: first.case.clone(),
            after: first.after.first().cloned(),
            needs: bug.needs.clone(),
            advice: advice(&bug.cases),
        };
        let name = shown.name();
        let needs: Vec<Glob> = bug.needs.iter().filter_map(|n| Glob::new(n).ok()).collect();
        let is_needed = |fact: &str| needs.iter().any(|need| need.is_match(fact));
        let mark = |fact: Option<&mut Fact>, is_needed: bool| {
            if let Some(fact) = fact.filter(|fact| is_needed || fact.right == 0 && fact.wrong > 0) {
                fact.bugs.insert(name.clone());
                fact.is_needed |= is_needed;
            }
        };
        // Facts that no failing case has can show the bug too.
        for (name, fact) in &mut self.states {
            mark(Some(fact), is_needed(name));
        }
        for [name, fact] in formats {
            mark(self.formats.get_mut(name), is_needed(fact));
        }
        for case in &bug.cases {
            for fact in case.draws.iter().flatten() {
                mark(self.states.get_mut(fact), false);
            }
            for [format, _] in &case.formats {
                mark(self.formats.get_mut(format), false);
            }
            for [format, fact] in &case.sampled {
                mark(self.sampled.get_mut(format), is_needed(fact));
            }
        }
        self.bugs.push(shown);
    }
}

impl Fact {
    fn count(&mut self, record: &Record) {
        if is_right(record) {
            self.right += 1;
        } else if is_wrong(record) {
            self.wrong += 1;
        }
        self.is_lacking |= record.verdict == Verdict::NotSupported;
    }

    fn safety(&self) -> Safety {
        match (self.right, self.wrong) {
            (0, 0) if self.is_lacking => Safety::NotSupported,
            (0, 0) => Safety::NotDrawn,
            (0, _) if self.is_needed => Safety::Wrong,
            (0, _) => Safety::Unclear,
            _ if self.bugs.is_empty() => Safety::Safe,
            _ => Safety::Partly,
        }
    }
}

/// Returns true if the driver drew the case as the specification allows.
fn is_right(record: &Record) -> bool {
    matches!(record.verdict, Verdict::Pass | Verdict::Imprecise)
}

/// Returns true if the driver is at fault.
fn is_wrong(record: &Record) -> bool {
    let other = matches!(
        record.verdict,
        Verdict::Open | Verdict::Blocked | Verdict::InternalError
    );
    record.verdict.is_bad() && !other && !record.due_fail
}

/// Returns the findings that no case shows.
fn unseen(
    cases: &[DrawnCase<'_>],
    about: &Expectations,
    shown: &BTreeMap<String, Shown<'_>>,
) -> Vec<UnseenBug> {
    let mut unseen: BTreeMap<String, UnseenBug> = BTreeMap::new();
    for (number, known) in about.all().iter().enumerate() {
        let finding = known.name();
        if shown.contains_key(&finding) {
            continue;
        }
        let right = cases
            .iter()
            .filter(|case| is_right(case.record) && about.names(number, &case.record.case));
        let right = right.count() as u64;
        let bug = unseen.entry(finding.clone()).or_insert(UnseenBug {
            finding,
            title: known.reason.clone(),
            right: 0,
        });
        bug.right += right;
    }
    unseen.into_values().collect()
}

/// Returns what to do about a bug that these cases show.
fn advice(cases: &[&DrawnCase<'_>]) -> Advice {
    let records = || cases.iter().map(|case| case.record);
    let is_lost = |record: &Record| {
        matches!(
            record.verdict,
            Verdict::Crash | Verdict::Timeout | Verdict::DeviceLost
        )
    };
    if records().any(is_lost) {
        return Advice::Avoid;
    }
    let is_judged = |record: &Record| record.verdict.is_violation();
    if !records().all(is_judged) {
        return Advice::Skip;
    }
    if records().all(|record| record.texels.wrong == 0 && record.is_decided_by_counter()) {
        return Advice::IgnoreCounters;
    }
    let distances = || records().flat_map(|record| &record.accuracy);
    // Integers are no measure.
    let is_integer = |encoding| matches!(encoding, Some(ChannelEncoding::Uint(_)));
    if distances().any(|distance| is_integer(distance.encoding)) {
        return Advice::Skip;
    }
    let furthest = distances().max_by(|a, b| a.max.total_cmp(&b.max));
    match furthest {
        Some(furthest)
            if furthest.max <= MOST_CODES && distances().all(|distance| distance.overflow == 0) =>
        {
            match furthest.encoding {
                Some(encoding) => Advice::Tolerance {
                    codes: furthest.max.ceil() as u32,
                    encoding,
                },
                None => Advice::Skip,
            }
        }
        _ => Advice::Skip,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::{AdapterInfo, Api, Limits};

    fn adapter() -> AdapterRecord {
        AdapterRecord {
            info: AdapterInfo {
                name: "gl:mine".to_owned(),
                driver: "mine".to_owned(),
                ..AdapterInfo::default()
            },
            release: None,
            limits: Limits::nothing(Api::OpenGl),
        }
    }

    fn findings() -> Expectations {
        let finding = |cases: &str, needs: &str| {
            format!(
                r#"{{ "title": "{cases} is wrong", "adapters": ["gl:*"], "driver": "*", "cases": ["{cases}/*"],
                    "grade": "proven", "clause": "c", "evidence": "e", "needs": [{needs}] }}"#
            )
        };
        let [clip, line] = [finding("clip", "\"clip-distances\""), finding("line", "")];
        let files = [("clip.json", &*clip), ("line.json", &*line)];
        Expectations::of_findings(&files).expect("they parse")
    }

    fn answer(records: &[(Record, &[&str])]) -> Preflight {
        let cases = records.iter().map(|(record, facts)| DrawnCase {
            record,
            draws: vec![facts.iter().map(|fact| (*fact).to_owned()).collect()],
            formats: vec![["rgba8unorm".to_owned(), "color=unorm8".to_owned()]],
            sampled: Vec::new(),
        });
        let cases: Vec<DrawnCase<'_>> = cases.collect();
        let states = ["clip-distances", "cull", "never"].map(str::to_owned);
        let reduced =
            |_: Option<&Known>, _: &[&DrawnCase<'_>]| vec!["topology=line-list".to_owned()];
        Preflight::new(&cases, &adapter(), &findings(), &[], &states, reduced)
    }

    fn record(case: &str, verdict: Verdict) -> Record {
        Record::new(case, "gl:mine", verdict)
    }

    #[test]
    fn only_what_a_bug_needs_is_unsafe() {
        let answer = answer(&[
            (
                record("clip/a", Verdict::Fail),
                &["clip-distances", "cull", "only"],
            ),
            (
                record("depth/a", Verdict::Pass),
                &["clip-distances", "cull"],
            ),
            (
                record("line/a", Verdict::Fail),
                &["topology=line-list", "cull"],
            ),
            (record("depth/b", Verdict::NotSupported), &["lacking"]),
        ]);
        let safety = |name: &str| answer.states[name].safety;
        assert_eq!(safety("clip-distances"), Safety::Partly);
        assert_eq!(safety("cull"), Safety::Safe);
        assert_eq!(safety("only"), Safety::Unclear);
        assert_eq!(safety("topology=line-list"), Safety::Wrong);
        assert_eq!(safety("lacking"), Safety::NotSupported);
        assert_eq!(safety("never"), Safety::NotDrawn);
        assert_eq!(answer.formats["rgba8unorm"].safety, Safety::Safe);
        let bugs = answer.bugs.iter().map(|bug| bug.finding.as_deref());
        assert_eq!(bugs.collect::<Vec<_>>(), [Some("clip"), Some("line")]);
        assert!(answer.unseen.is_empty());
    }

    #[test]
    fn only_bugs_that_a_draw_can_meet_are_kept() {
        let answer = || {
            answer(&[
                (record("clip/a", Verdict::Fail), &["clip-distances"]),
                (record("line/a", Verdict::Fail), &["topology=line-list"]),
            ])
        };
        for (used, met) in [
            (vec!["clip-distances", "cull"], vec!["clip"]),
            (vec!["cull"], vec![]),
            (
                vec!["clip-distances", "topology=line-list"],
                vec!["clip", "line"],
            ),
        ] {
            let mut answer = answer();
            let used = used.into_iter().map(str::to_owned).collect();
            answer.keep(&used, &used);
            let bugs = answer.bugs.iter().filter_map(|bug| bug.finding.as_deref());
            assert_eq!(bugs.collect::<Vec<_>>(), met);
            assert!(answer.states.keys().all(|name| used.contains(name)));
        }
    }

    #[test]
    fn a_known_bug_that_is_gone_is_said_to_be() {
        let answer = answer(&[(record("clip/a", Verdict::Pass), &["clip-distances"])]);
        let unseen: Vec<(&str, u64)> = answer
            .unseen
            .iter()
            .map(|b| (&*b.finding, b.right))
            .collect();
        assert_eq!(unseen, [("clip", 1), ("line", 0)]);
        assert_eq!(answer.states["clip-distances"].safety, Safety::Safe);
    }

    #[test]
    fn a_failure_without_a_finding_is_a_bug_too() {
        let answer = answer(&[(record("blend/a", Verdict::Fail), &["topology=line-list"])]);
        let [bug] = &answer.bugs[..] else {
            panic!("{:?}", answer.bugs)
        };
        assert_eq!(
            (bug.finding.as_deref(), bug.example.as_str()),
            (None, "blend/a")
        );
        assert_eq!(
            answer.states["topology=line-list"].bugs,
            BTreeSet::from(["blend/a".to_owned()])
        );
    }

    #[test]
    fn the_advice_depends_on_how_far_pictures_are_off() {
        let advised = |change: fn(&mut Record)| {
            let mut record = record("clip/a", Verdict::Fail);
            record.texels.wrong = 1;
            change(&mut record);
            answer(&[(record, &[])]).bugs[0].advice
        };
        fn off(record: &mut Record, max: f64, overflow: u64) {
            let mut accuracy = etalon_frame::Accuracy::none(
                etalon_frame::Aspect::Color,
                Some(ChannelEncoding::Unorm(8)),
            );
            (accuracy.max, accuracy.overflow) = (max, overflow);
            record.accuracy.push(accuracy);
        }
        let encoding = ChannelEncoding::Unorm(8);
        let tolerance = Advice::Tolerance { codes: 2, encoding };
        assert_eq!(advised(|record| off(record, 1.5, 0)), tolerance);
        assert_eq!(advised(|record| off(record, 9.0, 0)), Advice::Skip);
        assert_eq!(advised(|record| off(record, 1.0, 1)), Advice::Skip);
        assert_eq!(advised(|_| ()), Advice::Skip);
        assert_eq!(
            advised(|record| record.verdict = Verdict::Crash),
            Advice::Avoid
        );
    }
}
