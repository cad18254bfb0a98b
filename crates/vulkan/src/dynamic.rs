//! Dynamic state, set for each draw: all state that Vulkan 1.3 can make dynamic, so that draws share
//! pipelines.
//!
//! Vulkan also requires the parameters of disabled tests, which must have no effect. They get values whose
//! effect would be visible, so that a driver that ignores the enable does not pass by chance.

use crate::clear::intersection;
use crate::device::Device;
use crate::error::internal;
use crate::extended::DynamicStates;
use crate::state;
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::PathViewport;
use etalon_scene::{
    CullMode, DepthBias, DepthState, Draw, FrontFace, PrimitiveTopology, StencilFace, StencilState,
    Tessellation, Viewport,
};

/// The dynamic states of a pipeline, without viewports. The topology stays in the class of the pipeline's
/// topology.
const STATES: [vk::DynamicState; 18] = [
    vk::DynamicState::PRIMITIVE_TOPOLOGY,
    vk::DynamicState::PRIMITIVE_RESTART_ENABLE,
    vk::DynamicState::CULL_MODE,
    vk::DynamicState::FRONT_FACE,
    vk::DynamicState::RASTERIZER_DISCARD_ENABLE,
    vk::DynamicState::DEPTH_BIAS_ENABLE,
    vk::DynamicState::DEPTH_BIAS,
    vk::DynamicState::DEPTH_BOUNDS_TEST_ENABLE,
    vk::DynamicState::DEPTH_BOUNDS,
    vk::DynamicState::DEPTH_TEST_ENABLE,
    vk::DynamicState::DEPTH_WRITE_ENABLE,
    vk::DynamicState::DEPTH_COMPARE_OP,
    vk::DynamicState::STENCIL_TEST_ENABLE,
    vk::DynamicState::STENCIL_OP,
    vk::DynamicState::STENCIL_COMPARE_MASK,
    vk::DynamicState::STENCIL_WRITE_MASK,
    vk::DynamicState::STENCIL_REFERENCE,
    vk::DynamicState::BLEND_CONSTANTS,
];

/// The way to set the state of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Setting {
    /// True if all state is part of the pipeline.
    pub(crate) fixed: bool,
    /// The states beyond Vulkan 1.3's that are dynamic.
    pub(crate) beyond: DynamicStates,
    pub(crate) viewport: PathViewport,
}

impl Setting {
    /// Returns the dynamic states of a pipeline. `colored` is true if it has colour attachments.
    pub(crate) fn states(self, colored: bool) -> Vec<vk::DynamicState> {
        let viewports: &[_] = match (self.viewport, self.fixed) {
            (PathViewport::WithCount, _) => &[
                vk::DynamicState::VIEWPORT_WITH_COUNT,
                vk::DynamicState::SCISSOR_WITH_COUNT,
            ],
            (_, true) => &[],
            (_, false) => &[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR],
        };
        let states: &[_] = if self.fixed { &[] } else { &STATES };
        [viewports, states, &self.beyond.states(colored)].concat()
    }
}

/// The dynamic state of one draw.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dynamic {
    setting: Setting,
    viewport: vk::Viewport,
    scissor: vk::Rect2D,
    topology: PrimitiveTopology,
    tessellation: Option<Tessellation>,
    restart: bool,
    cull: CullMode,
    front_face: FrontFace,
    rasterizer_discard: bool,
    depth_bias: DepthBias,
    depth_bounds: Option<[f32; 2]>,
    depth: Option<DepthState>,
    stencil: Option<StencilState>,
    blend_constant: [f32; 4],
}

impl Dynamic {
    /// Returns the state of a draw. `area` is the render area, and `whole` is true if it covers the
    /// attachments. `restart` enables primitive restart.
    ///
    /// # Errors
    /// If depth bounds are outside 0..=1, which Vulkan cannot express (vkCmdSetDepthBounds).
    pub(crate) fn new(
        draw: &Draw,
        area: vk::Rect2D,
        whole: bool,
        restart: bool,
        setting: Setting,
    ) -> Result<Self, BackendError> {
        let bounds = draw.depth_bounds.iter().flatten();
        if bounds.into_iter().any(|b| !(0.0..=1.0).contains(b)) {
            return Err(internal("depth bounds lie outside 0 to 1"));
        }
        let given = draw.scissor.map(scissor);
        Ok(Self {
            setting,
            viewport: viewport(&draw.viewport),
            scissor: match given {
                None => area,
                Some(given) if whole => given,
                Some(given) => intersection(given, area).unwrap_or_default(),
            },
            topology: draw.topology,
            tessellation: draw.tessellation,
            restart,
            cull: draw.cull,
            front_face: draw.front_face,
            rasterizer_discard: draw.rasterizer_discard,
            depth_bias: draw.depth_bias,
            depth_bounds: draw.depth_bounds,
            depth: draw.depth,
            stencil: draw.stencil,
            blend_constant: draw.blend_constant,
        })
    }

    /// Returns two viewports and scissor rectangles, and their count: 1, or 2 if the draw selects the second.
    pub(crate) fn viewports(&self) -> ([vk::Viewport; 2], [vk::Rect2D; 2], usize) {
        let turned = vk::Viewport {
            y: self.viewport.y + self.viewport.height,
            height: -self.viewport.height,
            ..self.viewport
        };
        match self.setting.viewport {
            PathViewport::Array => (
                [turned, self.viewport],
                [vk::Rect2D::default(), self.scissor],
                2,
            ),
            PathViewport::One | PathViewport::WithCount => {
                ([self.viewport; 2], [self.scissor; 2], 1)
            }
        }
    }

    /// Returns the depth bias, and whether it is enabled.
    fn bias(&self) -> (DepthBias, bool) {
        let biased = self.depth_bias.constant != 0 || self.depth_bias.slope != 0.0;
        (if biased { self.depth_bias } else { IDLE_BIAS }, biased)
    }

    fn stencil(&self) -> StencilState {
        self.stencil.unwrap_or(StencilState {
            front: StencilFace::REJECTING,
            back: StencilFace::REJECTING,
        })
    }

    /// Returns a state that differs from this one in every respect, so that a draw with it is wrong or draws
    /// nothing.
    pub(crate) fn opposite(&self) -> Self {
        let mut other = *self;
        other.viewport.width += 1.0;
        other.scissor = vk::Rect2D::default();
        other.restart = false;
        other.cull = CullMode::FrontAndBack;
        other.front_face = match self.front_face {
            FrontFace::Ccw => FrontFace::Cw,
            FrontFace::Cw => FrontFace::Ccw,
        };
        other.rasterizer_discard = !self.rasterizer_discard;
        other.depth_bias = if self.bias().1 {
            DepthBias::default()
        } else {
            IDLE_BIAS
        };
        other.depth = match self.depth {
            None => Some(DepthState::REJECTING),
            Some(_) => None,
        };
        other.stencil = match self.stencil {
            None => Some(self.stencil()),
            Some(_) => None,
        };
        other.blend_constant = self.blend_constant.map(|c| 1.0 - c);
        other
    }

    /// Returns a text that is unique to the state.
    pub(crate) fn text(&self) -> String {
        format!("{self:?}")
    }

    /// Returns the rasterization state for a pipeline.
    pub(crate) fn rasterization(&self) -> vk::PipelineRasterizationStateCreateInfo<'static> {
        let (bias, biased) = self.bias();
        vk::PipelineRasterizationStateCreateInfo::default()
            .cull_mode(state::cull(self.cull))
            .front_face(state::front_face(self.front_face))
            .rasterizer_discard_enable(self.rasterizer_discard)
            .depth_bias_enable(biased)
            .depth_bias_constant_factor(bias.constant as f32)
            .depth_bias_clamp(bias.clamp)
            .depth_bias_slope_factor(bias.slope)
    }

    /// Returns the input assembly state for a pipeline.
    pub(crate) fn assembly(&self) -> vk::PipelineInputAssemblyStateCreateInfo<'static> {
        vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(state::topology(self.topology, self.tessellation))
            .primitive_restart_enable(self.restart)
    }

    /// Returns the depth-stencil state for a pipeline.
    pub(crate) fn depth_stencil(&self) -> vk::PipelineDepthStencilStateCreateInfo<'static> {
        let [low, high] = self.depth_bounds.unwrap_or(IDLE_BOUNDS);
        let depth = self.depth.unwrap_or(DepthState::REJECTING);
        let face = |side: &StencilFace| vk::StencilOpState {
            fail_op: state::stencil(side.fail_op),
            pass_op: state::stencil(side.pass_op),
            depth_fail_op: state::stencil(side.depth_fail_op),
            compare_op: state::compare(side.compare),
            compare_mask: side.read_mask.into(),
            write_mask: side.write_mask.into(),
            reference: side.reference.into(),
        };
        let stencil = self.stencil();
        vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(self.depth.is_some())
            .depth_write_enable(depth.write)
            .depth_compare_op(state::compare(depth.compare))
            .depth_bounds_test_enable(self.depth_bounds.is_some())
            .min_depth_bounds(low)
            .max_depth_bounds(high)
            .stencil_test_enable(self.stencil.is_some())
            .front(face(&stencil.front))
            .back(face(&stencil.back))
    }

    /// Returns the blend constant for a pipeline.
    pub(crate) fn blend_constants(&self) -> [f32; 4] {
        self.blend_constant
    }

    /// Records those of [`Setting::states`] that differ from the state `before`, or all without it.
    ///
    /// # Safety
    /// `commands` is being recorded, and the device has the features that the draw needs. Everything of
    /// `before` is still set.
    pub(crate) unsafe fn set(
        &self,
        device: &Device,
        commands: vk::CommandBuffer,
        before: Option<&Self>,
    ) {
        let api = &device.raw;
        let (viewports, scissors, count) = self.viewports();
        let bounds = |v: &vk::Viewport| [v.x, v.y, v.width, v.height, v.min_depth, v.max_depth];
        let same_viewports = before.is_some_and(|b| bounds(&b.viewport) == bounds(&self.viewport));
        let same_scissors = before.is_some_and(|b| b.scissor == self.scissor);
        // SAFETY: upheld by the caller; no call here takes a pointer that outlives it.
        unsafe {
            match (self.setting.viewport, self.setting.fixed) {
                (PathViewport::WithCount, _) => {
                    if !same_viewports {
                        api.cmd_set_viewport_with_count(commands, &viewports[..count]);
                    }
                    if !same_scissors {
                        api.cmd_set_scissor_with_count(commands, &scissors[..count]);
                    }
                }
                (_, true) => {}
                (_, false) => {
                    if !same_viewports {
                        api.cmd_set_viewport(commands, 0, &viewports[..count]);
                    }
                    if !same_scissors {
                        api.cmd_set_scissor(commands, 0, &scissors[..count]);
                    }
                }
            }
        }
        if self.setting.fixed {
            return;
        }
        // SAFETY: as above.
        unsafe {
            self.set_rasterization(device, commands, before);
            self.set_tests(device, commands, before);
        }
    }

    /// Returns a state's value if it differs from that of `before`.
    fn changed<T: PartialEq>(&self, before: Option<&Self>, of: impl Fn(&Self) -> T) -> Option<T> {
        let value = of(self);
        before.is_none_or(|b| of(b) != value).then_some(value)
    }

    /// # Safety
    /// As for [`Self::set`].
    unsafe fn set_rasterization(
        &self,
        device: &Device,
        commands: vk::CommandBuffer,
        before: Option<&Self>,
    ) {
        let api = &device.raw;
        // SAFETY: upheld by the caller.
        unsafe {
            if let Some(t) = self.changed(before, |d| state::topology(d.topology, d.tessellation)) {
                api.cmd_set_primitive_topology(commands, t);
            }
            if let Some(restart) = self.changed(before, |d| d.restart) {
                api.cmd_set_primitive_restart_enable(commands, restart);
            }
            if let Some(cull) = self.changed(before, |d| d.cull) {
                api.cmd_set_cull_mode(commands, state::cull(cull));
            }
            if let Some(front) = self.changed(before, |d| d.front_face) {
                api.cmd_set_front_face(commands, state::front_face(front));
            }
            if let Some(discard) = self.changed(before, |d| d.rasterizer_discard) {
                api.cmd_set_rasterizer_discard_enable(commands, discard);
            }
            if let Some(biased) = self.changed(before, |d| d.bias().1) {
                api.cmd_set_depth_bias_enable(commands, biased);
            }
            if let Some(bias) = self.changed(before, |d| d.bias().0) {
                api.cmd_set_depth_bias(commands, bias.constant as f32, bias.clamp, bias.slope);
            }
            if let Some(constant) = self.changed(before, |d| d.blend_constant) {
                api.cmd_set_blend_constants(commands, &constant);
            }
        }
    }

    /// # Safety
    /// As for [`Self::set`].
    unsafe fn set_tests(
        &self,
        device: &Device,
        commands: vk::CommandBuffer,
        before: Option<&Self>,
    ) {
        let api = &device.raw;
        let depth = |d: &Self| d.depth.unwrap_or(DepthState::REJECTING);
        // SAFETY: upheld by the caller.
        unsafe {
            if let Some(enabled) = self.changed(before, |d| d.depth_bounds.is_some()) {
                api.cmd_set_depth_bounds_test_enable(commands, enabled);
            }
            let bounds = self.changed(before, |d| d.depth_bounds.unwrap_or(IDLE_BOUNDS));
            if let Some([low, high]) = bounds {
                api.cmd_set_depth_bounds(commands, low, high);
            }
            if let Some(enabled) = self.changed(before, |d| d.depth.is_some()) {
                api.cmd_set_depth_test_enable(commands, enabled);
            }
            if let Some(write) = self.changed(before, |d| depth(d).write) {
                api.cmd_set_depth_write_enable(commands, write);
            }
            if let Some(compare) = self.changed(before, |d| depth(d).compare) {
                api.cmd_set_depth_compare_op(commands, state::compare(compare));
            }
            if let Some(enabled) = self.changed(before, |d| d.stencil.is_some()) {
                api.cmd_set_stencil_test_enable(commands, enabled);
            }
            for face in [vk::StencilFaceFlags::FRONT, vk::StencilFaceFlags::BACK] {
                let side = |d: &Self| match face {
                    vk::StencilFaceFlags::FRONT => d.stencil().front,
                    _ => d.stencil().back,
                };
                let operations = |d: &Self| {
                    let side = side(d);
                    (side.fail_op, side.pass_op, side.depth_fail_op, side.compare)
                };
                if let Some((fail, pass, depth_fail, compare)) = self.changed(before, operations) {
                    api.cmd_set_stencil_op(
                        commands,
                        face,
                        state::stencil(fail),
                        state::stencil(pass),
                        state::stencil(depth_fail),
                        state::compare(compare),
                    );
                }
                if let Some(mask) = self.changed(before, |d| side(d).read_mask) {
                    api.cmd_set_stencil_compare_mask(commands, face, mask.into());
                }
                if let Some(mask) = self.changed(before, |d| side(d).write_mask) {
                    api.cmd_set_stencil_write_mask(commands, face, mask.into());
                }
                if let Some(reference) = self.changed(before, |d| side(d).reference) {
                    api.cmd_set_stencil_reference(commands, face, reference.into());
                }
            }
        }
    }
}

/// The parameters of a disabled depth bias.
const IDLE_BIAS: DepthBias = DepthBias {
    constant: 1_000_000,
    slope: 0.0,
    clamp: 0.0,
};

/// The parameters of a disabled depth bounds test; no case stores a depth inside these bounds.
const IDLE_BOUNDS: [f32; 2] = [0.999_999, 0.999_999_5];

/// Returns the Vulkan viewport. The negative height turns clip space's y axis up: y = 1 is at the top of the
/// rectangle, nearer to the origin (Vulkan, Controlling the Viewport). A mirrored viewport gets a positive
/// height.
fn viewport(viewport: &Viewport) -> vk::Viewport {
    let [x, y, width, height] = viewport.rect;
    vk::Viewport {
        x,
        y: y + height,
        width,
        height: -height,
        min_depth: viewport.depth[0],
        max_depth: viewport.depth[1],
    }
}

/// Returns the scissor rectangle, clamped so that offset plus extent is at most the largest `i32`, which no
/// attachment reaches.
fn scissor([x, y, width, height]: [u32; 4]) -> vk::Rect2D {
    let most = i32::MAX.unsigned_abs();
    let (x, y) = (x.min(most), y.min(most));
    vk::Rect2D {
        offset: vk::Offset2D {
            x: x.cast_signed(),
            y: y.cast_signed(),
        },
        extent: vk::Extent2D {
            width: width.min(most - x),
            height: height.min(most - y),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_viewport_is_flipped_about_its_centre() {
        let turned = viewport(&Viewport {
            rect: [2.0, 3.0, 4.0, 6.0],
            depth: [0.75, 0.25],
        });
        assert_eq!((turned.x, turned.width), (2.0, 4.0));
        assert_eq!((turned.y, turned.height), (9.0, -6.0));
        assert_eq!((turned.min_depth, turned.max_depth), (0.75, 0.25));
        let mirrored = viewport(&Viewport {
            rect: [2.0, 9.0, 4.0, -6.0],
            depth: [0.0, 1.0],
        });
        assert_eq!((mirrored.y, mirrored.height), (3.0, 6.0));
    }

    #[test]
    fn a_scissor_is_clamped_to_what_vulkan_can_represent() {
        let rect = scissor([3_000_000_000, 1, 5, u32::MAX]);
        assert_eq!(rect.offset.x, i32::MAX);
        assert_eq!(rect.extent.width, 0);
        assert_eq!(rect.extent.height, i32::MAX.unsigned_abs() - 1);
    }
}
