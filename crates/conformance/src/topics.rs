//! The checks on an adapter whose author wants to know what to fix first.

use crate::checks::{CHECKS, DriverCheck};
use crate::subject::{CheckResult, CheckedBackend};
use etalon_backend::Backend;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A mistake that makes many checks fail.
#[derive(Debug)]
pub struct Topic {
    /// The name.
    pub name: &'static str,
    /// What is expected.
    pub rule: &'static str,
    /// The checks that fail with the mistake and pass with most others, or modules of checks.
    checks: &'static [&'static str],
}

/// All topics. Each is a reason for failures of the topics after it.
const TOPICS: &[Topic] = &[
    Topic {
        name: "limits",
        rule: "what the adapter says of itself is complete, and within its API",
        checks: &["limits"],
    },
    Topic {
        name: "orientation",
        rule: "row 0 is the top of the picture, and y points up in clip space: y = 1 is in row 0; viewports and scissor \
               rectangles count from the top left corner",
        checks: &[
            "drawing::a_rectangle_stays_in_its_corner",
            "drawing::columns_run_to_the_right_and_rows_down",
        ],
    },
    Topic {
        name: "transfer function",
        rule: "clear values and shader outputs are linear; a format with -srgb encodes red, green and blue once, and what \
               is read back are these codes: linear 0.5 is 188",
        checks: &["formats::srgb_codes_are_the_stored_bytes"],
    },
    Topic {
        name: "byte order",
        rule: "codes are the bits of the stored texel, little-endian: rgba8unorm has red in byte 0, bgra8unorm blue",
        checks: &[
            "formats::clears_store_0_and_1",
            "formats::uploads_come_back",
            "formats::draws_store_0_and_1",
            "uploads::texels_keep_their_places",
        ],
    },
    Topic {
        name: "sample order",
        rule: "each sample has its own value; sample i lies at the i-th sample position and obeys bit i of the mask, and \
               the samples of a texel are neighbours",
        checks: &[
            "samples::positions_are_those_of_the_limits",
            "samples::masks_let_their_samples_through",
            "samples::samples_are_drawn_one_by_one",
            "samples::every_format_keeps_its_samples",
            "samples::shaders_run_for_each_sample",
        ],
    },
    Topic {
        name: "faces",
        rule: "the winding of a face is that in the picture, and ccw is front unless the draw says cw",
        checks: &[
            "drawing::faces_are_told_apart_and_culled",
            "drawing::strips_keep_their_winding",
        ],
    },
    Topic {
        name: "depth",
        rule: "clip depths 0 to w become 0 to 1, then the range of the viewport",
        checks: &["depth"],
    },
    Topic {
        name: "blending",
        rule: "factors and operations are those of the draw, for colour and for alpha",
        checks: &[
            "drawing::blending_weighs_source_and_destination",
            "drawing::write_masks_keep_the_other_channels",
            "formats::blendable_formats_blend",
        ],
    },
];

/// Returns the first topic to which a failed check belongs, and its failed checks.
pub fn first_topic<'n>(failed: &[&'n str]) -> Option<(&'static Topic, Vec<&'n str>)> {
    TOPICS.iter().find_map(|topic| {
        let of_topic = |name: &&&str| {
            let module = name.split("::").next();
            topic
                .checks
                .iter()
                .any(|check| *check == **name || Some(*check) == module)
        };
        let failed: Vec<&str> = failed.iter().filter(of_topic).copied().collect();
        (!failed.is_empty()).then_some((topic, failed))
    })
}

/// Runs every check on an open backend, and passes on each result or message of failure.
pub fn check_each(
    backend: &dyn Backend,
    mut each: impl FnMut(&DriverCheck, Result<CheckResult, String>),
) {
    let subject = CheckedBackend::new(backend, &[]);
    for check in CHECKS {
        let result = catch_unwind(AssertUnwindSafe(|| check.run(&subject)));
        let result = result.map_err(|panic| {
            // What the failed check has drawn is not the next one's.
            let _ = subject.outcome();
            let text = panic.downcast_ref::<String>().cloned();
            let literal = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
            text.or(literal).unwrap_or_default()
        });
        each(check, result);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn topics_name_checks() {
        for name in TOPICS.iter().flat_map(|topic| topic.checks) {
            let is_named = |check: &DriverCheck| {
                check.name == *name || check.name.split("::").next() == Some(name)
            };
            assert!(CHECKS.iter().any(is_named), "{name}");
        }
    }

    #[test]
    fn the_first_topic_is_that_of_the_most_basic_mistake() {
        let orientation = "drawing::columns_run_to_the_right_and_rows_down";
        let failed = ["samples::masks_let_their_samples_through", orientation];
        let (topic, of_topic) = first_topic(&failed).unwrap();
        assert_eq!((topic.name, of_topic), ("orientation", vec![orientation]));
        assert_eq!(
            first_topic(&["depth::depths_outside_are_clipped"])
                .unwrap()
                .0
                .name,
            "depth"
        );
        assert!(first_topic(&["chains::two_attachments_take_turns"]).is_none());
    }
}
