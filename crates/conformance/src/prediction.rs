//! Predicts which checks draw on a driver, from the features that it lacks.
//!
//! Tests of different drivers are in different binaries, so none of them sees the others' results. The
//! prediction needs no driver, so a single test asserts that each check draws on at least one driver. Each
//! run then asserts that the prediction was right.

use crate::checks::DriverCheck;
use crate::known::KnownFaults;
use crate::subject::CheckResult;
use etalon_backend::{Backend, BackendError, Prepared};
use etalon_frame::{AdapterInfo, Limits};
use etalon_scene::Scene;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

/// The predicted result of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Prediction {
    /// The check draws a scene.
    Draws,
    /// The check draws nothing on any driver.
    OnlyLooks,
    /// The check is skipped.
    Skips,
}

/// Returns the predicted result of a check on a driver; `None` if its missing features are not known.
pub(crate) fn predict(check: &DriverCheck, known: &KnownFaults) -> Option<Prediction> {
    let backend = Undrawn {
        info: AdapterInfo {
            name: known.name.to_owned(),
            backend: String::new(),
            device: String::new(),
            driver: String::new(),
            driver_version: String::new(),
            driver_id: String::new(),
            api_version: String::new(),
            software: true,
            offer: None,
        },
        limits: known.lacks?.limits(known.api),
    };
    let subject = known.subject(&backend, &[]);
    let outcome = catch_unwind(AssertUnwindSafe(|| check.run(&subject)));
    Some(match outcome {
        Ok(CheckResult::Passed(_)) => Prediction::OnlyLooks,
        Ok(CheckResult::Skipped(_)) => Prediction::Skips,
        Err(payload) if payload.is::<WouldDraw>() => Prediction::Draws,
        Err(payload) => resume_unwind(payload),
    })
}

/// A backend that panics instead of drawing.
struct Undrawn {
    info: AdapterInfo,
    limits: Limits,
}

struct WouldDraw;

impl Backend for Undrawn {
    fn adapter(&self) -> &AdapterInfo {
        &self.info
    }

    fn limits(&self) -> &Limits {
        &self.limits
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        match self.limits.missing(&scene.requirements()) {
            Some(requirement) => Err(BackendError::NotSupported(requirement)),
            None => resume_unwind(Box::new(WouldDraw)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::CHECKS;
    use crate::known::{KNOWN, WHOLE, known};

    /// The drivers on which each crate's tests run the suite.
    const TESTED: [(&str, &str); 4] = [
        ("vulkan", include_str!("../../vulkan/tests/driver/main.rs")),
        ("gl", include_str!("../../gl/tests/drivers/main.rs")),
        ("wgpu", include_str!("../../wgpu/tests/drivers/main.rs")),
        (
            "webgpu",
            include_str!("../../browser/tests/drivers/main.rs"),
        ),
    ];

    /// Checks that draw on no driver, each with its reason.
    const NOT_DRAWN_ANYWHERE: &[(&str, &str)] = &[(
        "resolves::depths_are_averaged",
        "of the drivers only lavapipe offers averages of depth, and takes the first sample",
    )];

    #[test]
    fn every_check_draws_on_a_driver() {
        let drawn = |check: &&DriverCheck| {
            KNOWN.iter().any(|known| {
                let fails = known.defects.concat().iter().any(|d| d.0 == check.name);
                !fails && predict(check, known).unwrap() != Prediction::Skips
            })
        };
        let undrawn = CHECKS.iter().filter(|check| !drawn(check));
        let undrawn: Vec<_> = undrawn.map(|check| check.name).collect();
        let expected: Vec<_> = NOT_DRAWN_ANYWHERE.iter().map(|(name, _)| *name).collect();
        assert_eq!(undrawn, expected);
    }

    #[test]
    fn checks_draw_unless_the_driver_lacks_what_they_need() {
        let which = |name: &str, expected: Prediction| -> Vec<_> {
            let known = known(name);
            let checks = CHECKS
                .iter()
                .filter(|check| predict(check, &known) == Some(expected));
            checks.map(|check| check.name).collect()
        };
        let skipped = [
            "depth::bounds_reject_by_the_stored_depth",
            "clears::masked_clears_keep_the_rest",
        ];
        assert_eq!(which("vulkan:lavapipe", Prediction::Skips), skipped);
        let skipped = [
            "depth::bounds_reject_by_the_stored_depth",
            "raster::a_viewport_of_negative_height_turns_the_picture_over",
            "resolves::depth_and_stencil_are_resolved_by_their_modes",
            "resolves::depths_are_averaged",
            "resolves::what_was_resolved_is_tested",
        ];
        assert_eq!(which("gl:llvmpipe", Prediction::Skips), skipped);
        let expected = [
            "limits::limits_are_at_least_the_required_ones",
            "limits::formats_are_described_without_contradiction",
            "prepared::denials_are_named",
        ];
        for known in KNOWN {
            assert_eq!(
                which(known.name, Prediction::OnlyLooks),
                expected,
                "{}",
                known.name
            );
        }
    }

    #[test]
    fn every_described_driver_is_tested() {
        for known in KNOWN {
            let (api, driver) = known.name.split_once(':').unwrap();
            let name = match driver.split_once(':') {
                Some(("es", driver)) => format!("{driver}_es"),
                Some((_, driver)) => driver.to_owned(),
                None => driver.to_owned(),
            };
            let (_, text) = TESTED.iter().find(|(tested, _)| *tested == api).unwrap();
            let mut words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
            assert!(words.any(|word| word == name), "{}", known.name);
        }
    }

    #[test]
    fn names_of_defects_are_those_of_checks() {
        for (name, _) in KNOWN.iter().flat_map(|known| known.defects.concat()) {
            let whole = WHOLE.contains(&name);
            assert!(
                whole || CHECKS.iter().any(|check| check.name == name),
                "{name}"
            );
        }
    }
}
