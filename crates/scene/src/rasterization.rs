//! Rasterization: topology, faces, viewport and samples.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The topology of vertices.
    PrimitiveTopology {
        /// Each vertex makes a point of one texel.
        PointList = "point-list",
        /// Each two vertices make a line one texel wide.
        LineList = "line-list",
        /// A line from each vertex to the next.
        LineStrip = "line-strip",
        /// Each three vertices make a triangle.
        TriangleList = "triangle-list",
        /// Each vertex after the second makes a triangle with the two preceding ones.
        TriangleStrip = "triangle-strip",
        /// Each vertex after the second makes a triangle with the first and the preceding one.
        TriangleFan = "triangle-fan",
    }
}

state_enum! {
    /// The vertex of each primitive whose attributes are flat over it.
    ProvokingVertex {
        /// The first: Vulkan's and WebGPU's.
        First = "first",
        /// The last: OpenGL's default.
        Last = "last",
    }
}

state_enum! {
    /// The part of a polygon that is drawn.
    PolygonMode {
        /// Fills the polygon.
        Fill = "fill",
        /// Draws the polygon's edges, one texel wide.
        Line = "line",
    }
}

state_enum! {
    /// The faces that are culled.
    CullMode {
        /// No faces.
        None = "none",
        /// Front faces.
        Front = "front",
        /// Back faces.
        Back = "back",
        /// Both faces are culled; points and lines remain.
        FrontAndBack = "front-and-back",
    }
}

state_enum! {
    /// The winding of front faces.
    FrontFace {
        /// Counter-clockwise.
        Ccw = "ccw",
        /// Clockwise.
        Cw = "cw",
    }
}

/// A viewport.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Viewport {
    /// Left, top, width and height in texels. With a negative height the picture is flipped, and the second
    /// number is its bottom (Vulkan, Controlling the Viewport).
    pub rect: [f32; 4],
    /// Window depths of clip depths 0 and 1; reversed if the first is larger.
    pub depth: [f32; 2],
}

impl Viewport {
    /// Returns the viewport over whole attachments of a size, with depths 0 to 1.
    pub fn whole(size: [u32; 2]) -> Self {
        Self {
            rect: [0.0, 0.0, size[0] as f32, size[1] as f32],
            depth: [0.0, 1.0],
        }
    }

    /// Returns left, top, width and height of the viewport's area, whether the picture is flipped or not.
    pub fn area(&self) -> [f32; 4] {
        let [x, y, w, h] = self.rect;
        [x, y.min(y + h), w, h.abs()]
    }

    /// Returns true if the picture is flipped.
    pub fn is_mirrored(&self) -> bool {
        self.rect[3] < 0.0
    }
}

/// Which samples of a fragment are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Multisample {
    /// Bit `i` lets sample `i` through.
    pub mask: u32,
    /// True if alpha reduces the coverage.
    pub alpha_to_coverage: bool,
    /// True if alpha counts as 1 after alpha to coverage.
    pub alpha_to_one: bool,
    /// The fraction of each texel's samples, 0 to 1, that get at least their own shader run; `None` turns
    /// sample shading off.
    pub min_sample_shading: Option<f32>,
    /// The fraction of each texel's samples that can be drawn; `None` turns sample coverage off.
    pub sample_coverage: Option<SampleCoverage>,
}

/// Sample coverage: only a fraction of each texel's samples can be drawn (OpenGL 4.6, 14.9.3).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SampleCoverage {
    /// The fraction, clamped to 0 to 1.
    pub value: f32,
    /// True if the other samples are drawn instead.
    #[serde(default)]
    pub invert: bool,
}

impl Multisample {
    /// Returns the least number of shader runs for a fully covered texel with this many samples (Vulkan,
    /// Sample Shading; OpenGL 4.6, 14.3.1.1).
    pub fn least_runs(&self, samples: u32) -> u32 {
        let share = self.min_sample_shading.unwrap_or(0.0);
        ((share * samples as f32).ceil() as u32).clamp(1, samples.max(1))
    }
}

impl Default for Multisample {
    fn default() -> Self {
        Self {
            mask: u32::MAX,
            alpha_to_coverage: false,
            alpha_to_one: false,
            min_sample_shading: None,
            sample_coverage: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_rounded_up_and_at_least_one() {
        let runs = |share, samples| {
            let state = Multisample {
                min_sample_shading: share,
                ..Multisample::default()
            };
            state.least_runs(samples)
        };
        assert_eq!(runs(None, 4), 1);
        assert_eq!(runs(Some(0.0), 4), 1);
        assert_eq!(runs(Some(0.25), 4), 1);
        assert_eq!(runs(Some(0.26), 4), 2);
        assert_eq!(runs(Some(0.8), 4), 4);
        assert_eq!(runs(Some(1.0), 16), 16);
        assert_eq!(runs(Some(1.0), 1), 1);
    }
}
