//! The judge: takes a case, the frames that a driver drew of its scenes, and its limits, and returns the
//! verdict with its grade, the assertions, and the story of the first wrong sample.
//!
//! Legal sets come from `reference`, and `truth` has the pictures that methods are compared with. Records and frame
//! files go to `record`. Nothing here draws, waits or writes, so the crate also compiles for WebAssembly.

mod denial;
mod expected_values;
mod frame_file;
mod grade;
mod judge;
mod judgement_cache;
mod kept;
#[cfg(test)]
mod limits_test;
mod line_gap;
mod measure;
mod pictures;
mod relation;
mod requirement;
mod round_trips;
mod story;
mod texel;
mod timing;
mod undrawn;

pub use denial::denials;
pub use judge::{Judge, Judged, is_due_to_fail};
pub use kept::{IMPRECISE_FRAMES, ShownDetail, mark_flaky, note_validation, shorten};
pub use measure::{SizedScene, Truths, measured};
pub use pictures::{keep_pictures, pictured};
pub use relation::changed_picture;
pub use requirement::note_requirement;
pub use round_trips::{Blocked, RoundTrips, round_trips};
pub use story::{story_of_relation, story_of_sample};
pub use texel::judge_texel;
pub use timing::{FrameSeconds, Timing, medians};
pub use undrawn::{is_unexpectedly_bad, settled, undrawn};
