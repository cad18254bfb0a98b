//! The result of drawing with an innocent: the rasterizer with what some specification permits.

use crate::sighting::Sighting;
use crate::verdict::Verdict;
use etalon_frame::Grade;
use serde::{Deserialize, Serialize};

/// The description of an innocent.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InnocentInfo {
    /// The stable name, which the globs of `etalon mutants` match.
    pub name: String,
    /// The behaviour, in one sentence.
    pub about: String,
    /// The hardware or driver that behaves so.
    pub source: String,
    /// The names of the permissions that it uses.
    pub permissions: Vec<String>,
    /// True if it is the rasterizer itself.
    pub is_itself: bool,
    /// True if it combines several behaviours.
    pub is_profile: bool,
}

/// The verdicts on an innocent under one specification.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InnocentTally {
    /// The specification: `OpenGL 3.3`.
    pub specification: String,
    /// The strongest evidence that forbids the behaviour; absent if the specification permits it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub forbidden: Option<Grade>,
    /// The number of imprecise cases.
    pub imprecise: u64,
    /// The number of cases with a violation.
    pub violations: u64,
    /// The worst verdict that the rasterizer itself gets as well; such cases count for nothing else.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shared: Option<Verdict>,
    /// The most severe violation, and of equal ones the first; absent if no case has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst: Option<Sighting>,
}

impl InnocentTally {
    /// Adds a verdict.
    pub fn add(&mut self, sighting: Sighting) {
        match sighting.verdict {
            Verdict::Pass => {}
            Verdict::Imprecise => self.imprecise += 1,
            _ => {
                self.violations += 1;
                if Some(sighting.verdict.severity()) > self.severity() {
                    self.worst = Some(sighting);
                }
            }
        }
    }

    /// Returns the severity of the worst violation.
    fn severity(&self) -> Option<u8> {
        self.worst.as_ref().map(|worst| worst.verdict.severity())
    }

    /// Notes a verdict that the rasterizer itself gets as well.
    pub fn share(&mut self, verdict: Option<Verdict>) {
        self.shared = self
            .shared
            .into_iter()
            .chain(verdict)
            .max_by_key(|v| v.severity());
    }

    /// Returns the verdict that the specification's evidence supports; `None` if it permits the behaviour.
    pub fn due(&self) -> Option<Verdict> {
        self.forbidden.map(|grade| Verdict::of_band(grade.band()))
    }

    /// Returns true if a verdict is more severe than the specification's evidence supports.
    pub fn is_accused(&self) -> bool {
        self.severity() > self.due().map(Verdict::severity)
    }

    /// Returns true if the specification forbids the behaviour and no case shows it with the evidence's grade.
    pub fn is_missed(&self) -> bool {
        let shown = self.severity().max(self.shared.map(Verdict::severity));
        shown < self.due().map(Verdict::severity)
    }
}

/// The result of one innocent.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InnocentRecord {
    /// The innocent, described as in the registry.
    pub innocent: InnocentInfo,
    /// The number of cases whose frames differ from those of the rasterizer itself.
    pub changed: u64,
    /// One tally per specification, in the same order for every innocent.
    pub specifications: Vec<InnocentTally>,
}

impl InnocentRecord {
    /// Adds the result of the same innocent with further cases.
    pub fn add(&mut self, other: Self) {
        self.changed += other.changed;
        for (tally, other) in self.specifications.iter_mut().zip(other.specifications) {
            if other.severity() > tally.severity() {
                tally.worst.clone_from(&other.worst);
            }
            tally.imprecise += other.imprecise;
            tally.violations += other.violations;
            tally.share(other.shared);
        }
    }

    /// Returns what is wrong with the verdicts, and under which specification. Only if every case was drawn must some
    /// case show the behaviour.
    pub fn complaints(&self, every_case: bool) -> impl Iterator<Item = (&str, &'static str)> {
        let each = self.specifications.iter().filter_map(move |tally| {
            let why = if tally.is_accused() {
                Some("it is accused of more than the evidence supports")
            } else if every_case && tally.is_missed() {
                Some("it is forbidden, and no case shows it")
            } else {
                None
            };
            why.map(|why| (tally.specification.as_str(), why))
        });
        let is_unused = every_case && self.changed == 0 && !self.innocent.is_itself;
        each.chain(is_unused.then_some(("every specification", "it changes no frame")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tally(forbidden: Option<Grade>, verdicts: &[Verdict]) -> InnocentTally {
        let mut tally = InnocentTally {
            specification: "OpenGL 3.3".to_owned(),
            forbidden,
            imprecise: 0,
            violations: 0,
            shared: None,
            worst: None,
        };
        for verdict in verdicts {
            tally.add(Sighting {
                case: "blend/x".to_owned(),
                verdict: *verdict,
                texel: None,
                message: String::new(),
            });
        }
        tally
    }

    #[test]
    fn a_permitted_behaviour_may_be_imprecise_and_nothing_worse() {
        let fine = tally(None, &[Verdict::Pass, Verdict::Imprecise]);
        assert!(!fine.is_accused() && !fine.is_missed());
        assert_eq!((fine.imprecise, fine.violations), (1, 0));
        for verdict in [
            Verdict::Disputed,
            Verdict::RequiredByCts,
            Verdict::Fail,
            Verdict::InternalError,
        ] {
            assert!(
                tally(None, &[verdict, Verdict::Pass]).is_accused(),
                "{verdict:?}"
            );
        }
    }

    #[test]
    fn a_forbidden_behaviour_gets_the_verdict_of_its_evidence() {
        let disputed = |verdicts| tally(Some(Grade::Disputed), verdicts);
        let right = disputed(&[Verdict::Imprecise, Verdict::Disputed]);
        assert!(!right.is_accused() && !right.is_missed());
        assert!(disputed(&[Verdict::Fail]).is_accused());
        assert!(disputed(&[Verdict::Imprecise]).is_missed());
    }
}
