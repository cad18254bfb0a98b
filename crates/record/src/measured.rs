//! The measurements of a method case: the distance of its picture from the truth, and its cost.

use crate::reason::Reason;
use etalon_frame::{Distance, SizedDistance};
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
    /// The same scene at the sizes of frames that people draw; empty if none was asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sizes: Vec<SizedFrame>,
    /// What a frame costs at any size; `None` if it was not timed at several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cost: Option<Cost>,
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

impl Times {
    /// The areas whose cases are timed.
    pub const AREAS: [&'static str; 2] = ["methods", "perf"];
}

/// A method's scene at one size of frames. It is not judged: the picture of the case is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SizedFrame {
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Frame times, of rounds in which all sizes took turns.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<Times>,
    /// The distance of the last frame from the truth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance: Option<SizedDistance>,
    /// The reason why it was not drawn or not read back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<Reason>,
}

/// What a frame costs: a fixed time, and a time for each megapixel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cost {
    /// The clock of the times.
    pub clock: Clock,
    /// Seconds of a frame without texels; noise can make them negative.
    pub fixed: Estimate,
    /// Seconds for each million texels.
    pub per_megapixel: Estimate,
    /// The largest distance of a size's median time from the line, as a share of that time; `None` with two sizes,
    /// through which every line passes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deviation: Option<f64>,
}

impl Cost {
    /// The largest deviation of times that a line describes.
    pub const STRAIGHT: f64 = 0.1;

    /// Returns the time in seconds of a frame with this number of texels, and its interval if there is one.
    pub fn at(&self, texels: f64) -> (f64, Option<[f64; 2]>) {
        let megapixels = texels / 1e6;
        let (fixed, unit) = (&self.fixed, &self.per_megapixel);
        let ends = fixed.interval.zip(unit.interval);
        let time = fixed.median + unit.median * megapixels;
        (
            time.max(0.0),
            ends.map(|(f, u)| [0, 1].map(|i| (f[i] + u[i] * megapixels).max(0.0))),
        )
    }

    /// Returns true if a line does not describe the times.
    pub fn is_crooked(&self) -> bool {
        self.deviation
            .is_some_and(|deviation| deviation > Self::STRAIGHT)
    }
}

/// A clock that times frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Clock {
    /// Timestamps of the device, around the passes of a frame.
    Device,
    /// The processor's clock, until the device was done.
    Wall,
}

/// A median over rounds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Estimate {
    /// The median.
    pub median: f64,
    /// Its interval with 95 % confidence; `None` with fewer than 6 rounds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval: Option<[f64; 2]>,
}

impl From<etalon_stats::Estimate> for Estimate {
    fn from(estimate: etalon_stats::Estimate) -> Self {
        Self {
            median: estimate.median,
            interval: estimate.interval,
        }
    }
}
