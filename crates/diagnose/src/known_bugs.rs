//! Known bugs: matching failures with the findings that explain them.
//!
//! A finding names cases, and a search ends with reduced scenes. To compare them, cases of the adapter's
//! findings are drawn on it and reduced in the same way. A match is therefore observed, not guessed: it
//! names a case that is reduced to the same states and the same violation on this driver, and a finding
//! whose bug is gone matches nothing. Only cases from which a scene could derive are drawn, and a few of
//! each finding for their similarity; each is reduced once.

use crate::matching::{Difference, Match};
use crate::signature::Signature;
use crate::symptom::Symptom;
use crate::traits::{Similarity, Traits};
use etalon_frame::Aspect;
use etalon_record::{AdapterRecord, Expectations, Known, Record, Verdict};
use serde_json::{Value, json};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

/// The number of cases that are tried for one failure, in total and per finding.
const TRIED: usize = 12;
const TRIED_OF_EACH: usize = 3;
/// The number of cases that represent each finding, for failures that have more states than a single case.
const STANDING: usize = 3;

/// The driver that failed. It draws cases of findings, and reduces failures.
pub trait Driver {
    /// A case that findings can name.
    type Named;
    /// A case that was drawn.
    type Case;
    /// The reason why the driver can no longer be used.
    type Error;

    /// Returns true if the search must stop.
    fn is_stopped(&self) -> bool;

    /// Returns the document of a case; `None` if the case cannot be written as a document.
    fn document(&self, named: &Self::Named) -> Option<Value>;

    /// Draws a document. Returns `None` if the driver cannot draw it, or if it is too large to be reduced.
    ///
    /// # Errors
    /// If the driver cannot be started again.
    fn draw(&mut self, document: &Value) -> Result<Option<(Self::Case, Record)>, Self::Error>;

    /// Reduces a case that failed with this record. Returns the reduced case, with its symptom and traits.
    ///
    /// # Errors
    /// If the driver cannot be started again.
    fn reduce(
        &mut self,
        case: Self::Case,
        record: Record,
    ) -> Result<(Self::Case, Symptom, Traits), Self::Error>;

    /// Returns the facts of each draw of a case.
    fn facts(case: &Self::Case) -> Vec<Vec<String>>;

    /// Returns true if a case fails with a symptom in a new process.
    fn is_steady(&self, case: &Self::Case, symptom: &Symptom) -> bool;
}

/// A case that the adapter's findings name.
struct NamedCase<N> {
    case: N,
    id: String,
    /// The numbers of the findings.
    findings: Vec<usize>,
    states: Signature,
    words: Signature,
}

/// The attachments of a case that are compared: a bug can show in only one of them, and another bug in
/// others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum ComparedAttachments {
    /// All attachments.
    All,
    Color,
    DepthStencil,
}

impl ComparedAttachments {
    /// Returns the part in which a failure with these traits shows.
    fn of(traits: &Traits) -> Self {
        match traits.aspect() {
            Some(Aspect::Color) => Self::Color,
            Some(_) => Self::DepthStencil,
            None => Self::All,
        }
    }

    /// Returns the document with only this part read back; `None` if it has no such part.
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
        let reads = scene["read"].as_array().into_iter().flatten();
        let read: Vec<Value> = reads.filter(shown).cloned().collect();
        if read.is_empty() {
            return None;
        }
        document["scene"]["read"] = json!(read);
        Some(document)
    }
}

/// A case that was drawn, and its reduction.
struct Tried<C> {
    seen: Option<DrawnCase<C>>,
    /// The reduced case; the inner `None` if the case does not fail as a finding says.
    reduced: Option<Option<Reduced<C>>>,
}

/// A case as it was drawn.
struct DrawnCase<C> {
    case: C,
    record: Record,
    traits: Traits,
}

/// A reduced case.
struct Reduced<C> {
    case: C,
    symptom: Symptom,
    traits: Traits,
    /// True if the case fails in a new process; `None` until that was tried.
    steady: Option<bool>,
}

/// The known bugs of an adapter.
pub struct KnownBugs<D: Driver> {
    expectations: Expectations,
    named: Vec<NamedCase<D::Named>>,
    tried: BTreeMap<(usize, ComparedAttachments), Tried<D::Case>>,
    /// The numbers of the cases that represent findings.
    standing: Vec<usize>,
    driver: D,
}

impl<D: Driver> KnownBugs<D> {
    /// Creates the known bugs from the expectations about an adapter, with the cases that show them, by id.
    pub fn new(
        expectations: &Expectations,
        adapter: &AdapterRecord,
        cases: impl Iterator<Item = (String, D::Named)>,
        driver: D,
    ) -> Self {
        let expectations = expectations.about(adapter);
        let mut named: Vec<NamedCase<D::Named>> = Vec::new();
        if !expectations.all().is_empty() {
            for (id, case) in cases {
                let of_case = expectations.bad(adapter, &id);
                let place = |known: &Known| expectations.all().iter().position(|k| **k == *known);
                let findings: Vec<usize> = of_case.filter_map(place).collect();
                if !findings.is_empty()
                    && let Some(document) = driver.document(&case)
                {
                    named.push(NamedCase {
                        case,
                        id,
                        findings,
                        states: Signature::of(&document),
                        words: Signature::exact(&document),
                    });
                }
            }
        }
        let standing = standing(&named);
        Self {
            expectations,
            named,
            tried: BTreeMap::new(),
            standing,
            driver,
        }
    }

    /// Returns the finding that explains a failure, or the most similar one; `None` if no finding is
    /// similar, or if the search must stop.
    ///
    /// # Errors
    /// If the driver cannot be started again.
    pub fn matching(
        &mut self,
        symptom: &Symptom,
        traits: &Traits,
        steady: bool,
    ) -> Result<Option<Match>, D::Error> {
        let verdict = symptom.verdict;
        let part = ComparedAttachments::of(traits);
        let is_reduced = steady && symptom.keeps_worker();
        if is_reduced {
            for number in self.may_leave(traits, verdict) {
                let place = (number, part);
                self.reduced(place, traits)?;
                if self.similarity(place, verdict, traits) == Some(Similarity::Same)
                    && self.is_steady(place)
                {
                    return Ok(Some(self.matched(place, verdict, traits, None)));
                }
            }
        }
        // The bug can also show in other parts.
        let parts: &[ComparedAttachments] = match part {
            ComparedAttachments::All => &[ComparedAttachments::All],
            _ => &[
                ComparedAttachments::Color,
                ComparedAttachments::DepthStencil,
            ],
        };
        for number in self.standing.clone() {
            if self.finding(number, verdict, &[traits]).is_none() {
                continue;
            }
            for part in parts {
                self.reduced((number, *part), traits)?;
            }
        }
        if self.driver.is_stopped() {
            return Ok(None);
        }
        let places = self.tried.keys().copied();
        let alike =
            places.filter_map(|place| Some((place, self.similarity(place, verdict, traits)?)));
        let mut alike: Vec<((usize, ComparedAttachments), Similarity)> = alike.collect();
        // Prefers the case that shares the most with the failure.
        alike.sort_by_key(|(place, similarity)| {
            let known = self.left(*place).map(|r| &r.traits);
            let way = known.is_none_or(|k| k.way != traits.way);
            let shared = known.map_or(0, |k| k.words.shared(&traits.words));
            (*similarity, way, Reverse(shared))
        });
        // A failure that needs other scenes first was not reduced, so it has all states of its scene.
        alike.retain(|(_, similarity)| steady || *similarity != Similarity::Elsewhere);
        // Some failures depend on state that earlier draws left in the driver.
        let mut alike = alike.into_iter();
        let best = alike.find(|(place, _)| !steady || self.is_steady(*place));
        Ok(best.map(|(place, similarity)| {
            if is_reduced && similarity == Similarity::Same {
                return self.matched(place, verdict, traits, None);
            }
            let known = self.left(place).map(|r| &r.traits);
            let difference = known.map(|k| Difference {
                states: traits.states.without(&k.states),
                violation: (similarity == Similarity::Elsewhere).then(|| k.way.to_string()),
            });
            self.matched(place, verdict, traits, difference)
        }))
    }

    /// Returns the reduced case.
    fn left(&self, place: (usize, ComparedAttachments)) -> Option<&Reduced<D::Case>> {
        self.tried.get(&place)?.reduced.as_ref()?.as_ref()
    }

    fn similarity(
        &self,
        place: (usize, ComparedAttachments),
        verdict: Verdict,
        traits: &Traits,
    ) -> Option<Similarity> {
        let known = &self.left(place)?.traits;
        self.finding(place.0, verdict, &[known, traits])?;
        traits.similarity(known)
    }

    /// Returns the first finding that names a case, excuses a verdict, and needs only what all these scenes have.
    fn finding(&self, number: usize, verdict: Verdict, scenes: &[&Traits]) -> Option<&Known> {
        let entries = &self.expectations;
        let is_it = |finding: &&usize| {
            let is_met = |scene: &&Traits| entries.are_needs_met(**finding, &scene.draws);
            entries.all()[**finding].excuses(verdict) && scenes.iter().all(is_met)
        };
        let finding = self.named[number].findings.iter().find(is_it)?;
        Some(&entries.all()[*finding])
    }

    fn matched(
        &self,
        place: (usize, ComparedAttachments),
        verdict: Verdict,
        traits: &Traits,
        difference: Option<Difference>,
    ) -> Match {
        let reduced = self.left(place).map_or(traits, |r| &r.traits);
        let known = self.finding(place.0, verdict, &[reduced, traits]);
        let states = &reduced.states;
        Match {
            finding: known.map(Known::name).unwrap_or_default(),
            title: known.map(|k| k.reason.clone()).unwrap_or_default(),
            case: self.named[place.0].id.clone(),
            states: states.clone(),
            difference,
        }
    }

    /// Returns the cases from which a failure could have been reduced, the likeliest first: cases with all
    /// its states, of findings that need nothing else.
    fn may_leave(&self, traits: &Traits, verdict: Verdict) -> Vec<usize> {
        // A reduction replaces formats and meshes by simpler ones.
        let wanted = traits.states.without_formats().without_vertices();
        let has = |n: &usize| {
            (wanted.is_empty() || wanted.is_within(&self.named[*n].states))
                && self.finding(*n, verdict, &[traits]).is_some()
        };
        let mut likely: Vec<usize> = (0..self.named.len()).filter(has).collect();
        likely.sort_by_key(|n| {
            let words = &self.named[*n].words;
            (Reverse(words.shared(&traits.words)), words.len())
        });
        let mut of_each: BTreeMap<&[usize], usize> = BTreeMap::new();
        likely.retain(|n| {
            let count = of_each.entry(&self.named[*n].findings).or_default();
            *count += 1;
            *count <= TRIED_OF_EACH
        });
        likely.truncate(TRIED);
        likely
    }

    /// Draws a case, and reduces it if it fails as the finding says and is useful for a failure with these
    /// traits.
    fn reduced(
        &mut self,
        place: (usize, ComparedAttachments),
        traits: &Traits,
    ) -> Result<(), D::Error> {
        if self.driver.is_stopped() {
            return Ok(());
        }
        if !self.tried.contains_key(&place) {
            let seen = self.drawn(place)?;
            let reduced = seen.is_none().then_some(None);
            self.tried.insert(place, Tried { seen, reduced });
        }
        // The reduced case can resemble a failure that has more states, or another violation.
        let of_use = |seen: &mut DrawnCase<D::Case>| {
            traits.may_be_left_of(&seen.traits)
                || seen.traits.may_be_left_of(traits)
                || traits.aspect().is_some() && seen.traits.aspect().is_some()
        };
        let tried = self.tried.get_mut(&place);
        let seen = tried.and_then(|tried| tried.seen.take_if(of_use));
        if let Some(seen) = seen {
            let left = self.reduce(seen)?;
            let reduced = Some(Some(left));
            self.tried.insert(
                place,
                Tried {
                    seen: None,
                    reduced,
                },
            );
        }
        Ok(())
    }

    /// Draws a part of a case. Returns it if it fails as a finding says.
    fn drawn(
        &mut self,
        place: (usize, ComparedAttachments),
    ) -> Result<Option<DrawnCase<D::Case>>, D::Error> {
        let (number, part) = place;
        let document = self.driver.document(&self.named[number].case);
        let Some(document) = document.and_then(|document| part.of_document(document)) else {
            return Ok(None);
        };
        let Some((case, record)) = self.driver.draw(&document)? else {
            return Ok(None);
        };
        if self.finding(number, record.verdict, &[]).is_none() {
            return Ok(None);
        }
        let traits = Traits::of(&document, &Symptom::of(&record), D::facts(&case));
        Ok(Some(DrawnCase {
            case,
            record,
            traits,
        }))
    }

    /// Reduces a case. A case that ends its worker is kept as it is, because each step would cost a
    /// process.
    fn reduce(&mut self, seen: DrawnCase<D::Case>) -> Result<Reduced<D::Case>, D::Error> {
        let symptom = Symptom::of(&seen.record);
        let (case, symptom, traits) = if symptom.keeps_worker() {
            self.driver.reduce(seen.case, seen.record)?
        } else {
            (seen.case, symptom, seen.traits)
        };
        Ok(Reduced {
            case,
            symptom,
            traits,
            steady: None,
        })
    }

    /// Returns true if the reduced case fails in a new process.
    fn is_steady(&mut self, place: (usize, ComparedAttachments)) -> bool {
        let tried = self.tried.get_mut(&place);
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
        *steady.get_or_insert_with(|| self.driver.is_steady(case, symptom))
    }
}

/// Returns the cases that represent each finding: some of its cases, evenly spaced.
fn standing<N>(named: &[NamedCase<N>]) -> Vec<usize> {
    let mut of_each: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (number, case) in named.iter().enumerate() {
        for finding in &case.findings {
            of_each.entry(*finding).or_default().push(number);
        }
    }
    let each = of_each.values().flat_map(|numbers| {
        let count = numbers.len().min(STANDING);
        (0..count).map(move |i| numbers[i * (numbers.len() - 1) / count.max(2).saturating_sub(1)])
    });
    let alike: BTreeSet<usize> = each.collect();
    alike.into_iter().collect()
}
