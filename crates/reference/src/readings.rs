//! Clauses with two readings. A driver follows one reading throughout; a mix of both is not legal.

use crate::rules::{ConstantClamp, Rules, SignedClamp, SrgbLogic};
use crate::world::{Contested, Decision, World, Worlds};
use etalon_frame::{ChannelEncoding, TextureFormat};
use etalon_scene::{Draw, Pass, PrimitiveTopology, PrimitiveVertices, RESTART, Scene};
use smallvec::{SmallVec, smallvec};

/// The parts of a draw that the specifications leave open, independent of its fragments.
pub(crate) struct OpenTexts {
    /// The contested clauses that matter to the draw.
    contested: SmallVec<[Contested; 2]>,
    /// True if an index that might not be a restart points past the vertices, or if a line can continue
    /// beyond the near or far plane. The result is then not modelled.
    pub(crate) vertices: bool,
}

impl OpenTexts {
    pub(crate) fn new(rules: &Rules, scene: &Scene, pass: &Pass, draw: &Draw) -> Self {
        let restarts = || draw.mesh.indices.iter().flatten().any(|i| *i == RESTART);
        let indices =
            draw.fetch.base_vertex != 0 && !rules.restarts_before_base_vertex.value() && restarts();
        Self {
            contested: contested(rules, scene, pass, draw),
            vertices: indices || has_line_beyond(draw) && !rules.clips_lines_by_depth.value(),
        }
    }

    /// Returns true if a contested clause matters to the draw.
    pub(crate) fn is_contested(&self) -> bool {
        !self.contested.is_empty()
    }

    /// Splits a world by the readings that matter to the draw and that the world has not chosen yet.
    pub(crate) fn by_reading(&self, world: World) -> Worlds {
        let mut worlds: Worlds = smallvec![world];
        for contested in &self.contested {
            let decision = Decision::Reading(*contested);
            let split = |world: World| -> Worlds {
                if world.decided(decision).is_some() {
                    return smallvec![world];
                }
                let readings = [true, false].map(|reading| world.with(decision, reading));
                readings.into_iter().collect()
            };
            worlds = worlds.into_iter().flat_map(split).collect();
        }
        worlds
    }
}

/// Returns true if an end of a line is beyond the near or far plane, or behind the eye.
fn has_line_beyond(draw: &Draw) -> bool {
    let is_beyond = |vertex: usize| {
        let [.., z, w] = draw.mesh.vertices[vertex].position;
        w <= 0.0 || !draw.depth_clamp && (z < 0.0 || z > w)
    };
    let is_line = matches!(
        draw.topology,
        PrimitiveTopology::LineList | PrimitiveTopology::LineStrip
    );
    is_line
        && draw
            .primitives()
            .into_iter()
            .any(|primitive| match primitive {
                PrimitiveVertices::Line(ends) => ends.into_iter().any(is_beyond),
                PrimitiveVertices::Point(_) | PrimitiveVertices::Triangle(_) => false,
            })
}

/// Returns the contested clauses that matter to a draw.
fn contested(rules: &Rules, scene: &Scene, pass: &Pass, draw: &Draw) -> SmallVec<[Contested; 2]> {
    let colors = &pass.color;
    let formats = colors.iter().map(|i| scene.attachments[*i].format);
    let is_signed = |format: TextureFormat| {
        let encodings = format.color_channels();
        encodings
            .iter()
            .any(|e| matches!(e, ChannelEncoding::Snorm(_)))
    };
    let blends = draw
        .targets
        .iter()
        .any(|t| draw.blend_of(t).is_some() || t.advanced.is_some());
    let signed = formats.clone().any(is_signed);
    let srgb = formats.clone().any(|f| f == TextureFormat::Rgba8UnormSrgb);
    let constant = draw.blend_constant.iter().any(|v| !(0.0..=1.0).contains(v));
    let outputs = colors.len().min(draw.targets.len());
    let others = outputs > 1 || draw.shader.has_second_source();
    let mut contested = SmallVec::new();
    if signed && blends && rules.signed_clamp.value() == SignedClamp::Either {
        contested.push(Contested::SignedOperands);
    }
    if signed && rules.signed_result.value() == SignedClamp::Either {
        contested.push(Contested::SignedResults);
    }
    if srgb && draw.logic.is_some() && rules.srgb_logic.value() == SrgbLogic::Either {
        contested.push(Contested::SrgbLogic);
    }
    if constant && blends && rules.constant_clamp.value() == ConstantClamp::Either {
        contested.push(Contested::ClampedConstant);
    }
    if others && draw.alpha_to_one() && rules.one_is_first_output.value() {
        contested.push(Contested::OneForAll);
    }
    contested
}
