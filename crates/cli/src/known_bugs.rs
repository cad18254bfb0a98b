//! Failures that are known: those that a finding explains.
//!
//! A finding names cases, and a search ends with reduced scenes. To compare them, cases of the findings about the adapter
//! are drawn on it and reduced in the same way. So a match is seen and not guessed: it names a case which leaves the same
//! states and the same violation on this very driver, and a finding whose bug is gone matches nothing. Only cases from
//! which a scene could come are drawn, and a few of each finding for likeness; each is reduced once.

use crate::failure::Failure;
use crate::reduction::{DriverOracle, confirm};
use etalon_case::{Case, CaseRef, Library, Profile, build};
use etalon_diagnose::{Likeness, Signature, Symptom, Traits};
use etalon_explore::{Candidate, keys};
use etalon_frame::{Aspect, Limits};
use etalon_record::{AdapterRecord, Expectations, Known, Record, Verdict};
use etalon_runner::{Launch, Trials, Worker};
use serde_json::{Value, json};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The cases that are tried for one failure, and of each finding.
const TRIED: usize = 12;
const TRIED_OF_EACH: usize = 3;
/// The cases of each finding that stand for it where a failure has more than a case shows.
const STANDING: usize = 3;
/// The most keys of a scene that is reduced for a comparison.
const MOST_KEYS: usize = 600;

/// A finding that explains a failure, or seems to.
#[derive(Clone, Debug)]
pub(crate) struct Match {
    /// The finding's name.
    pub(crate) finding: String,
    /// The bug in one sentence.
    pub(crate) title: String,
    /// The case of the finding.
    case: String,
    /// The states that are left of the case.
    states: Signature,
    /// What is different; `None` where the failure is the same.
    beyond: Option<Beyond>,
}

/// What tells a failure from one that it is like.
#[derive(Clone, Debug)]
struct Beyond {
    /// The states that are not left of the case.
    states: Signature,
    /// The violation of the case, where it is another one.
    violation: Option<String>,
}

impl Match {
    /// True if case and failure leave the same states, words and violation.
    pub(crate) fn is_exact(&self) -> bool {
        self.beyond.is_none()
    }

    /// Returns why the finding was named.
    pub(crate) fn why(&self) -> String {
        let Self { case, states, .. } = self;
        let Some(beyond) = &self.beyond else {
            return format!("{case}, reduced, leaves the same states and violation");
        };
        let mut text = format!("has what is left of {case} ({states})");
        if let Some(violation) = &beyond.violation {
            text.push_str(&format!(", which violates {violation}"));
        }
        match beyond.states.is_empty() {
            true if beyond.violation.is_none() => text.push_str(", with other values"),
            true => {}
            false => text.push_str(&format!("; also {}", beyond.states)),
        }
        text
    }

    /// Returns what the description of a case file says of it.
    pub(crate) fn sentence(&self) -> String {
        let Self { finding, title, .. } = self;
        let word = if self.is_exact() {
            "Known"
        } else {
            "Looks like"
        };
        format!("{word}: {finding} ({title}): {}.", self.why())
    }

    pub(crate) fn json(&self) -> Value {
        json!({
            "finding": self.finding,
            "title": self.title,
            "match": if self.is_exact() { "exact" } else { "alike" },
            "case": self.case,
            "why": self.why(),
        })
    }
}

/// A case that findings about the adapter name.
struct Named<'a> {
    reference: CaseRef<'a>,
    id: String,
    /// The numbers of the findings.
    findings: Vec<usize>,
    states: Signature,
    words: Signature,
}

/// The attachments of a case that are looked at: one bug shows in one of them, another in others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Part {
    /// All.
    All,
    Color,
    DepthStencil,
}

impl Part {
    /// The part in which a failure with these traits shows.
    fn of(traits: &Traits) -> Self {
        match traits.aspect() {
            Some(Aspect::Color) => Self::Color,
            Some(_) => Self::DepthStencil,
            None => Self::All,
        }
    }

    /// Returns the document of which only this part is read back; `None` if there is none of it.
    fn of_document(self, mut document: Value) -> Option<Value> {
        if self == Self::All {
            return Some(document);
        }
        let scene = &document["scene"];
        let shown = |name: &&Value| {
            let format = &scene["attachments"][name.as_str().unwrap_or_default()]["format"];
            let format = format.as_str().unwrap_or_default();
            let color = !format.starts_with("depth") && !format.starts_with("stencil");
            color == (self == Self::Color)
        };
        let all = scene["read"].as_array().into_iter().flatten();
        let read: Vec<Value> = all.filter(shown).cloned().collect();
        if read.is_empty() {
            return None;
        }
        document["scene"]["read"] = json!(read);
        Some(document)
    }
}

/// A case that was drawn, and what is left of it.
#[derive(Default)]
struct Tried {
    seen: Option<Seen>,
    /// What is left; `None` inside where it does not fail as a finding says.
    reduced: Option<Option<Reduced>>,
}

/// A case as it was drawn.
struct Seen {
    candidate: Candidate,
    record: Record,
    traits: Traits,
}

/// What is left of a case.
struct Reduced {
    case: Case,
    symptom: Symptom,
    traits: Traits,
    /// True if it fails in a new process; `None` until that was tried.
    steady: Option<bool>,
}

/// The known bugs of an adapter.
pub(crate) struct KnownBugs<'a> {
    expectations: Expectations,
    named: Vec<Named<'a>>,
    tried: BTreeMap<(usize, Part), Tried>,
    /// The numbers of cases that stand for findings.
    standing: Vec<usize>,
    launch: Launch,
    limits: Limits,
    timeout: Duration,
    trials: Option<Trials>,
    stop: &'a AtomicBool,
}

impl<'a> KnownBugs<'a> {
    /// The expectations about an adapter, and the cases of the library that they name.
    pub(crate) fn new(
        expectations: &Expectations,
        adapter: &AdapterRecord,
        library: &'a Library,
        launch: Launch,
        timeout: Duration,
        stop: &'a AtomicBool,
    ) -> Self {
        let expectations = expectations.clone().about(adapter);
        let limits = adapter.limits.clone();
        let mut named: Vec<Named<'a>> = Vec::new();
        if !expectations.all().is_empty() {
            for reference in library.cases(Profile::Full) {
                let id = reference.id();
                let of_case = expectations.bad(adapter, &id);
                let place = |known: &Known| expectations.all().iter().position(|k| k == known);
                let findings: Vec<usize> = of_case.filter_map(place).collect();
                if !findings.is_empty() {
                    named.extend(Named::new(reference, id, findings));
                }
            }
        }
        let standing = standing(&named);
        Self {
            expectations,
            named,
            tried: BTreeMap::new(),
            standing,
            launch,
            limits,
            timeout,
            trials: None,
            stop,
        }
    }

    /// Returns the finding that explains a failure, or the one that it is like most; `None` if none is, or if the
    /// search is being stopped.
    pub(crate) fn matching(
        &mut self,
        verdict: Verdict,
        traits: &Traits,
        steady: bool,
    ) -> Result<Option<Match>, Failure> {
        let part = Part::of(traits);
        if steady && verdict.is_violation() {
            for number in self.may_leave(traits) {
                let at = (number, part);
                self.reduced(at, traits)?;
                if self.likeness(at, verdict, traits) == Some(Likeness::Same) && self.is_steady(at)
                {
                    return Ok(Some(self.told(at, verdict, traits, None)));
                }
            }
        }
        // The bug may show elsewhere too.
        let parts: &[Part] = match part {
            Part::All => &[Part::All],
            _ => &[Part::Color, Part::DepthStencil],
        };
        for number in self.standing.clone() {
            for part in parts {
                self.reduced((number, *part), traits)?;
            }
        }
        if self.stopped() {
            return Ok(None);
        }
        let all = self.tried.keys().copied();
        let alike = all.filter_map(|at| Some((at, self.likeness(at, verdict, traits)?)));
        let mut alike: Vec<((usize, Part), Likeness)> = alike.collect();
        // The one that says most of the failure.
        alike.sort_by_key(|(at, likeness)| {
            let known = self.left(*at).map(|r| &r.traits);
            let way = known.is_none_or(|k| k.way != traits.way);
            let shared = known.map_or(0, |k| k.words.shared(&traits.words));
            (*likeness, way, Reverse(shared))
        });
        // Of a failure behind others, all that its scene had is left.
        alike.retain(|(_, likeness)| steady || *likeness != Likeness::Elsewhere);
        // Some drivers leave behind what a failure is made of.
        let mut alike = alike.into_iter();
        let best = alike.find(|(at, _)| !steady || self.is_steady(*at));
        Ok(best.map(|(at, likeness)| {
            if steady && likeness == Likeness::Same && verdict.is_violation() {
                return self.told(at, verdict, traits, None);
            }
            let known = self.left(at).map(|r| &r.traits);
            let beyond = known.map(|k| Beyond {
                states: traits.states.without(&k.states),
                violation: (likeness == Likeness::Elsewhere).then(|| k.way.clone()),
            });
            self.told(at, verdict, traits, beyond)
        }))
    }

    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Returns what was left of a case.
    fn left(&self, at: (usize, Part)) -> Option<&Reduced> {
        self.tried.get(&at)?.reduced.as_ref()?.as_ref()
    }

    fn likeness(&self, at: (usize, Part), verdict: Verdict, traits: &Traits) -> Option<Likeness> {
        self.finding(at.0, verdict)?;
        traits.likeness(&self.left(at)?.traits)
    }

    /// Returns the first finding that names a case and excuses a verdict.
    fn finding(&self, number: usize, verdict: Verdict) -> Option<&Known> {
        let all = self.expectations.all();
        let mut findings = self.named[number].findings.iter().map(|f| &all[*f]);
        findings.find(|known| known.excuses(verdict))
    }

    fn told(
        &self,
        at: (usize, Part),
        verdict: Verdict,
        traits: &Traits,
        beyond: Option<Beyond>,
    ) -> Match {
        let known = self.finding(at.0, verdict);
        let states = self.left(at).map_or(&traits.states, |r| &r.traits.states);
        Match {
            finding: known.map(Known::name).unwrap_or_default(),
            title: known.map(|k| k.reason.clone()).unwrap_or_default(),
            case: self.named[at.0].id.clone(),
            states: states.clone(),
            beyond,
        }
    }

    /// Returns the cases from which a failure may be left, the likeliest first: those that have all its states.
    fn may_leave(&self, traits: &Traits) -> Vec<usize> {
        // A reduction replaces formats and meshes by simpler ones.
        let due = traits.states.without_formats().without_vertices();
        let has = |n: &usize| due.is_empty() || due.is_within(&self.named[*n].states);
        let mut all: Vec<usize> = (0..self.named.len()).filter(has).collect();
        all.sort_by_key(|n| {
            let words = &self.named[*n].words;
            (Reverse(words.shared(&traits.words)), words.len())
        });
        let mut of_each: BTreeMap<&[usize], usize> = BTreeMap::new();
        all.retain(|n| {
            let count = of_each.entry(&self.named[*n].findings).or_default();
            *count += 1;
            *count <= TRIED_OF_EACH
        });
        all.truncate(TRIED);
        all
    }

    /// Draws a case and reduces it, if it fails by the finding and is of use for a failure with these traits.
    fn reduced(&mut self, at: (usize, Part), traits: &Traits) -> Result<(), Failure> {
        if self.stopped() {
            return Ok(());
        }
        if !self.tried.contains_key(&at) {
            let seen = self.drawn(at)?;
            let reduced = seen.is_none().then_some(None);
            self.tried.insert(at, Tried { seen, reduced });
        }
        // What is left may be like a failure that has more, or in another violation.
        let of_use = |seen: &mut Seen| {
            traits.may_be_left_of(&seen.traits)
                || seen.traits.may_be_left_of(traits)
                || traits.aspect().is_some() && seen.traits.aspect().is_some()
        };
        let tried = self.tried.get_mut(&at);
        let seen = tried.and_then(|tried| tried.seen.take_if(of_use));
        if let Some(seen) = seen {
            let left = self.reduce(seen)?;
            self.tried.entry(at).or_default().reduced = Some(Some(left));
        }
        Ok(())
    }

    /// Draws a part of a case. Returns it if it fails as a finding says.
    fn drawn(&mut self, at: (usize, Part)) -> Result<Option<Seen>, Failure> {
        let number = at.0;
        let Ok(document) = self.named[number].reference.document() else {
            return Ok(None);
        };
        let Some(document) = at.1.of_document(document) else {
            return Ok(None);
        };
        // A case may need all that it reads.
        let Ok(case) = build("found/known", &document) else {
            return Ok(None);
        };
        if keys(&document["scene"]) > MOST_KEYS
            || self.limits.missing(&case.requirements()).is_some()
        {
            return Ok(None);
        }
        let mut trials = self.trials()?;
        let mut record = None;
        let mut due = Some(&case);
        let drawn = trials.first(&mut || due.take(), |case| *case, &mut |_, judged| {
            record = Some(judged);
            true
        });
        drawn.map_err(Failure::incomplete)?;
        self.trials = Some(trials);
        let known = |record: &Record| self.finding(number, record.verdict).is_some();
        let Some(record) = record.filter(known) else {
            return Ok(None);
        };
        let traits = Traits::of(&document, &Symptom::of(&record));
        let candidate = Candidate { document, case };
        Ok(Some(Seen {
            candidate,
            record,
            traits,
        }))
    }

    fn trials(&mut self) -> Result<Trials, Failure> {
        match self.trials.take() {
            Some(trials) => Ok(trials),
            None => {
                let worker = Worker::start(&self.launch).map_err(Failure::incomplete)?;
                Ok(Trials::new(self.launch.clone(), worker, self.timeout))
            }
        }
    }

    /// Reduces a case. One that ends its worker stays as it is: each step would cost a process.
    fn reduce(&mut self, seen: Seen) -> Result<Reduced, Failure> {
        if !seen.record.verdict.is_violation() {
            return Ok(Reduced {
                case: seen.candidate.case,
                symptom: Symptom::of(&seen.record),
                traits: seen.traits,
                steady: None,
            });
        }
        let trials = self.trials()?;
        let mut oracle = DriverOracle::new(trials, seen.record, self.timeout, Some(self.stop));
        let reduction = oracle.reduce(seen.candidate, &self.limits);
        if let Some(error) = oracle.error {
            return Err(Failure::incomplete(error));
        }
        let smallest = reduction.smallest;
        let traits = Traits::of(&smallest.document, &oracle.symptom);
        let symptom = oracle.symptom.clone();
        self.trials = Some(oracle.trials);
        Ok(Reduced {
            case: smallest.case,
            symptom,
            traits,
            steady: None,
        })
    }

    /// True if what is left of a case fails in a new process.
    fn is_steady(&mut self, at: (usize, Part)) -> bool {
        let (launch, timeout) = (&self.launch, self.timeout);
        let tried = self.tried.get_mut(&at);
        let reduced = tried.and_then(|t| t.reduced.as_mut()?.as_mut());
        let Some(Reduced {
            case,
            symptom,
            steady,
            ..
        }) = reduced
        else {
            return false;
        };
        *steady.get_or_insert_with(|| confirm(launch, case, symptom, timeout).is_ok())
    }
}

impl<'a> Named<'a> {
    /// A case of the library; `None` if it cannot be written as a document.
    fn new(reference: CaseRef<'a>, id: String, findings: Vec<usize>) -> Option<Self> {
        let document = reference.document().ok()?;
        Some(Self {
            reference,
            id,
            findings,
            states: Signature::of(&document),
            words: Signature::exact(&document),
        })
    }
}

/// Returns the cases that stand for each finding: some of its cases, evenly spaced.
fn standing(named: &[Named<'_>]) -> Vec<usize> {
    let mut of_each: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (number, case) in named.iter().enumerate() {
        for finding in &case.findings {
            of_each.entry(*finding).or_default().push(number);
        }
    }
    let each = of_each.values().flat_map(|all| {
        let count = all.len().min(STANDING);
        (0..count).map(move |i| all[i * (all.len() - 1) / count.max(2).saturating_sub(1)])
    });
    let all: BTreeSet<usize> = each.collect();
    all.into_iter().collect()
}
