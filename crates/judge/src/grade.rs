//! Grades of violations: the strongest evidence that a frame violates.
//!
//! Legal sets are computed from all evidence together. Only a frame outside them is judged again by the
//! stronger evidence alone, so legal frames cost nothing extra.

use etalon_frame::{Band, CounterOutcome, Frame, Grade, Limits, compare};
use etalon_record::MAX_WRONG_TEXELS;
use etalon_reference::rules::BlendPrecision;
use etalon_reference::{Rules, Sets, fit, set_by};
use etalon_scene::Scene;
use std::collections::HashSet;

/// The samples and counters of a frame that some evidence forbids.
struct Forbidden {
    samples: HashSet<(u32, u32, u32)>,
    /// The total number of forbidden samples; [`Forbidden::samples`] has the first of them.
    count: u64,
    counters: Vec<bool>,
}

impl Forbidden {
    fn any(&self) -> bool {
        self.count > 0 || self.counters.contains(&true)
    }
}

/// A frame's violations, by the evidence that forbids them.
pub(crate) struct Grades {
    /// Forbidden by the "must" clauses of the specification.
    proven: Forbidden,
    /// Forbidden by "must" clauses or by the CTS.
    required: Forbidden,
    /// Forbidden by all evidence, if every representation that a reading permits is tried; `None` if stronger evidence
    /// forbids as many samples.
    disputed: Option<Forbidden>,
}

impl Grades {
    /// Grades a frame with this number of samples that are illegal by all evidence; `None` if every violation in it is
    /// proven.
    pub(crate) fn of(
        scene: &Scene,
        limits: &Limits,
        (frame, wrong): (&Frame, u64),
        sets: &Sets<'_>,
    ) -> Option<Self> {
        let rules = Rules::of(limits);
        let forbidden_by = |grade| forbidden(scene, limits, frame, &rules.bound_by(grade), sets);
        if rules.bound_by(Grade::Proven) == rules {
            return None;
        }
        let required = forbidden_by(Grade::RequiredByCts);
        let disputed = (required.count < wrong).then(|| {
            let mut rules = rules.clone();
            if rules.blend.value() == BlendPrecision::DestinationCodes {
                rules.blend.set(BlendPrecision::UniformSteps);
            }
            forbidden(scene, limits, frame, &rules, sets)
        });
        Some(Self {
            proven: forbidden_by(Grade::Proven),
            required,
            disputed,
        })
    }

    /// Returns the number of samples that violate, if it is lower than by all evidence.
    pub(crate) fn violations(&self) -> Option<u64> {
        self.disputed.as_ref().map(|disputed| disputed.count)
    }

    /// Returns the band of the whole frame.
    pub(crate) fn frame(&self) -> Band {
        self.band(Forbidden::any)
    }

    /// Returns the band of a sample that all evidence places outside the set.
    pub(crate) fn sample(&self, position: (u32, u32, u32)) -> Band {
        self.band(|forbidden| forbidden.samples.contains(&position))
    }

    /// Returns the band of a counter, by its index, that is outside the range by all evidence.
    pub(crate) fn counter(&self, index: usize) -> Band {
        self.band(|forbidden| forbidden.counters.get(index) == Some(&true))
    }

    fn band(&self, forbids: impl Fn(&Forbidden) -> bool) -> Band {
        let grade = if forbids(&self.proven) {
            Grade::Proven
        } else if forbids(&self.required) {
            Grade::RequiredByCts
        } else if self.disputed.as_ref().is_none_or(forbids) {
            Grade::Disputed
        } else {
            return Band::Imprecise;
        };
        grade.band()
    }
}

/// Returns what rules forbid in a frame, under the depth encodings that forbid the least.
fn forbidden(
    scene: &Scene,
    limits: &Limits,
    frame: &Frame,
    rules: &Rules,
    sets: &Sets<'_>,
) -> Forbidden {
    let alternatives = limits.alternatives(&scene.formats());
    let each = alternatives.iter().filter_map(|limits| {
        let open = set_by(scene, limits, rules, sets);
        // The whole frame has one step of depth bias, as in the set by all evidence.
        let set = match fit(scene, limits, rules, &open, frame, sets) {
            Ok(Some(fitted)) => fitted.legal,
            _ => open,
        };
        // The first wrong samples have the same order under any rules, and wider rules leave fewer of them,
        // so the kept samples suffice for a record.
        let found = compare(frame, &set, &set, MAX_WRONG_TEXELS).ok()?;
        let illegal = |counter: &CounterOutcome| counter.band == Some(Band::Fail);
        Some(Forbidden {
            samples: found.wrong.iter().map(|w| (w.x, w.y, w.sample)).collect(),
            count: found.texels.wrong,
            counters: found.counters.iter().map(illegal).collect(),
        })
    });
    each.min_by_key(|f| (f.count, f.counters.iter().filter(|c| **c).count()))
        .unwrap_or(Forbidden {
            samples: HashSet::new(),
            count: 0,
            counters: Vec::new(),
        })
}
