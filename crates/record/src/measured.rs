//! The measurements of a method case: the distance of its picture from the truth, and its cost.

use etalon_frame::Distance;
use serde::{Deserialize, Serialize};

/// Accuracy and cost of one method on one adapter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measured {
    /// The question that the method answers, such as `transparency`.
    pub question: String,
    /// The scene that the method draws, such as `windows`.
    pub scene: String,
    /// The method, such as `depth-peeling`.
    pub method: String,
    /// The parameter of the family's stability curve, with this case's value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parameter: Option<Parameter>,
    /// Distance from the truth.
    pub distance: Distance,
    /// Frame times; `None` if the picture is wrong by the rules, and therefore not timed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<Times>,
    /// The number of render passes.
    pub passes: u32,
    /// The number of draw calls.
    pub draws: u32,
    /// The number of fragment shader invocations, if the adapter has statistics.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fragments: Option<u64>,
    /// Bytes of all attachments, by their formats' texel sizes.
    pub bytes: u64,
    /// A PNG of the picture below the run folder, with `/` between its parts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub picture: Option<String>,
    /// A PNG of the truth below the run folder.
    #[serde(default, rename = "truth", skip_serializing_if = "Option::is_none")]
    pub truth_picture: Option<String>,
}

/// A parameter and its value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// The name of the axis, as in the case's id.
    pub name: String,
    /// The axis's value in the case, in the unit of the case file.
    pub value: f64,
}

/// Medians of a case's frame times in seconds, measured while nothing else was drawn or judged.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Times {
    /// The number of timed frames, after the warm-up.
    pub samples: u32,
    /// Time until the device was done.
    pub wall: f64,
    /// Time until the last call that submits work returned.
    pub cpu: f64,
    /// Time between GPU timestamps, if the device has them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gpu: Option<f64>,
    /// The 95 % confidence interval of the median wall time, between two of the samples; with fewer than
    /// six frames, the shortest and the longest time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval: Option<[f64; 2]>,
}
