//! Extended dynamic state 2 and 3: pipeline state beyond Vulkan 1.3's that is set for each draw, if the path
//! asks for it.

use crate::device::Device;
use crate::single_state::SingleState;
use crate::state;
use ash::vk;
use etalon_scene::{ColorTarget, Draw, LogicOperation, Multisample, PolygonMode};

/// The states of extended dynamic state 3 that every pass has. They and [`COLOR_STATES`] are set together.
const RASTER_STATES: [vk::DynamicState; 4] = [
    vk::DynamicState::POLYGON_MODE_EXT,
    vk::DynamicState::DEPTH_CLAMP_ENABLE_EXT,
    vk::DynamicState::SAMPLE_MASK_EXT,
    vk::DynamicState::ALPHA_TO_COVERAGE_ENABLE_EXT,
];

/// The states of extended dynamic state 3 that only passes with colour attachments have.
const COLOR_STATES: [vk::DynamicState; 3] = [
    vk::DynamicState::COLOR_BLEND_ENABLE_EXT,
    vk::DynamicState::COLOR_BLEND_EQUATION_EXT,
    vk::DynamicState::COLOR_WRITE_MASK_EXT,
];

/// The part of the logic operation state that is dynamic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum DynamicLogic {
    /// No part.
    Nothing,
    /// The operation.
    Operation,
    /// The operation, and whether it is enabled; only beside extended dynamic state 3.
    All,
}

impl DynamicLogic {
    /// Returns the dynamic states.
    pub(crate) fn states(self) -> &'static [vk::DynamicState] {
        const ALL: [vk::DynamicState; 2] = [
            vk::DynamicState::LOGIC_OP_EXT,
            vk::DynamicState::LOGIC_OP_ENABLE_EXT,
        ];
        match self {
            Self::Nothing => &[],
            Self::Operation => &ALL[..1],
            Self::All => &ALL,
        }
    }
}

/// The dynamic states beyond Vulkan 1.3's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct DynamicStates {
    /// True if [`RASTER_STATES`] and [`COLOR_STATES`] are dynamic.
    pub(crate) extended: bool,
    pub(crate) logic: DynamicLogic,
    /// The state that is dynamic alone, if any.
    pub(crate) single: Option<SingleState>,
}

impl DynamicStates {
    /// Returns true if any of these states is dynamic.
    pub(crate) fn any(self) -> bool {
        self.extended || self.logic != DynamicLogic::Nothing || self.single.is_some()
    }

    /// Returns the dynamic states of a pipeline. `colored` is true if it has colour attachments.
    pub(crate) fn states(self, colored: bool) -> Vec<vk::DynamicState> {
        let raster: &[_] = if self.extended { &RASTER_STATES } else { &[] };
        let is_colored = self.extended && colored;
        let color: &[_] = if is_colored { &COLOR_STATES } else { &[] };
        let logic = if colored { self.logic.states() } else { &[] };
        let single: Vec<_> = self.single.iter().map(|state| state.dynamic()).collect();
        [raster, color, logic, &single].concat()
    }
}

/// The logic operation that a pipeline is created with if the operation is dynamic. It must have no effect.
const PLACEHOLDER_OPERATION: LogicOperation = LogicOperation::Equivalent;

/// Returns the draw that a pipeline is made from. Its values of the dynamic states must have no effect; see
/// [`pipeline_draw_of_extended`]. Draws of all logic operations share a pipeline.
pub(crate) fn pipeline_draw(states: DynamicStates, draw: &Draw) -> Draw {
    let logic = match states.logic {
        DynamicLogic::All if !draw.targets.is_empty() => Some(PLACEHOLDER_OPERATION),
        DynamicLogic::Operation => draw.logic.map(|_| PLACEHOLDER_OPERATION),
        DynamicLogic::All | DynamicLogic::Nothing => draw.logic,
    };
    let pipeline_draw = if states.extended {
        pipeline_draw_of_extended(draw)
    } else {
        draw.clone()
    };
    let pipeline_draw = Draw {
        logic,
        ..pipeline_draw
    };
    match states.single {
        Some(state) => state.held(&pipeline_draw),
        None => pipeline_draw,
    }
}

/// Returns a draw whose masks are the opposite of this draw's, and whose other values of [`RASTER_STATES`] and
/// [`COLOR_STATES`] are the defaults. Its pipeline is made from it, and these values must have no effect.
pub(crate) fn pipeline_draw_of_extended(draw: &Draw) -> Draw {
    let opposite = |target: &ColorTarget| ColorTarget {
        blend: None,
        advanced: None,
        write_mask: !target.write_mask & 0b1111,
    };
    Draw {
        targets: draw.targets.iter().map(opposite).collect(),
        polygon_mode: PolygonMode::Fill,
        depth_clamp: false,
        multisample: Multisample {
            mask: !draw.multisample.mask,
            alpha_to_coverage: false,
            ..draw.multisample
        },
        ..draw.clone()
    }
}

/// The values that a draw gives the dynamic states beyond Vulkan 1.3's.
pub(crate) struct DynamicValues {
    states: DynamicStates,
    logic: Option<LogicOperation>,
    polygon_mode: PolygonMode,
    depth_clamp: bool,
    samples: u32,
    mask: u32,
    alpha_to_coverage: bool,
    targets: Vec<vk::PipelineColorBlendAttachmentState>,
}

impl DynamicValues {
    pub(crate) fn new(draw: &Draw, samples: u32, states: DynamicStates) -> Self {
        debug_assert!(states.extended || states.logic != DynamicLogic::All);
        Self {
            states,
            logic: draw.logic,
            polygon_mode: draw.polygon_mode,
            depth_clamp: draw.depth_clamp,
            samples,
            mask: draw.multisample.mask,
            alpha_to_coverage: draw.multisample.alpha_to_coverage,
            targets: draw.targets.iter().map(state::color_target).collect(),
        }
    }

    /// Records the values.
    ///
    /// # Safety
    /// `commands` is being recorded.
    pub(crate) unsafe fn record(&self, device: &Device, commands: vk::CommandBuffer) {
        let colored = !self.targets.is_empty();
        if let (Some(api), true) = (&device.dynamic_logic, colored)
            && self.states.logic != DynamicLogic::Nothing
        {
            // A disabled operation must have no effect, so this is one whose effect would be visible.
            let operation = self.logic.unwrap_or(LogicOperation::Invert);
            // SAFETY: upheld by the caller; the feature is enabled if the function is loaded.
            unsafe { api.cmd_set_logic_op(commands, state::logic(operation)) };
        }
        let Some(api) = device.extended.as_ref().filter(|_| self.states.extended) else {
            return;
        };
        if colored && self.states.logic == DynamicLogic::All {
            // SAFETY: as above.
            unsafe { (api.cmd_set_logic_op_enable_ext)(commands, self.logic.is_some().into()) };
        }
        let targets = || self.targets.iter();
        let enables: Vec<_> = targets().map(|t| t.blend_enable).collect();
        let masks: Vec<_> = targets().map(|t| t.color_write_mask).collect();
        let equations: Vec<_> = targets()
            .map(|t| vk::ColorBlendEquationEXT {
                src_color_blend_factor: t.src_color_blend_factor,
                dst_color_blend_factor: t.dst_color_blend_factor,
                color_blend_op: t.color_blend_op,
                src_alpha_blend_factor: t.src_alpha_blend_factor,
                dst_alpha_blend_factor: t.dst_alpha_blend_factor,
                alpha_blend_op: t.alpha_blend_op,
            })
            .collect();
        let samples = state::samples(self.samples);
        let count = self.targets.len() as u32;
        // SAFETY: upheld by the caller; the features are enabled if the functions are loaded, and the arrays
        // have these lengths.
        unsafe {
            (api.cmd_set_polygon_mode_ext)(commands, state::polygon_mode(self.polygon_mode));
            (api.cmd_set_depth_clamp_enable_ext)(commands, self.depth_clamp.into());
            (api.cmd_set_sample_mask_ext)(commands, samples, &self.mask);
            (api.cmd_set_alpha_to_coverage_enable_ext)(commands, self.alpha_to_coverage.into());
            if colored {
                (api.cmd_set_color_blend_enable_ext)(commands, 0, count, enables.as_ptr());
                (api.cmd_set_color_blend_equation_ext)(commands, 0, count, equations.as_ptr());
                (api.cmd_set_color_write_mask_ext)(commands, 0, count, masks.as_ptr());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_scene::{Mesh, Shader, Viewport};

    fn draw(logic: Option<LogicOperation>) -> Draw {
        let mesh = Mesh {
            vertices: Vec::new(),
            indices: None,
        };
        Draw {
            logic,
            ..Draw::new(Shader::FlatColor, mesh, Viewport::whole([4, 4]))
        }
    }

    fn states(extended: bool, logic: DynamicLogic) -> DynamicStates {
        DynamicStates {
            extended,
            logic,
            single: None,
        }
    }

    #[test]
    fn draws_of_all_logic_operations_share_a_pipeline() {
        let logic_of_pipeline = |logic: DynamicLogic, extended, logic_of_draw| {
            pipeline_draw(states(extended, logic), &draw(logic_of_draw)).logic
        };
        let shared = Some(PLACEHOLDER_OPERATION);
        for operation in [
            LogicOperation::Xor,
            LogicOperation::Nor,
            PLACEHOLDER_OPERATION,
        ] {
            let operation = Some(operation);
            assert_eq!(
                logic_of_pipeline(DynamicLogic::Nothing, false, operation),
                operation
            );
            assert_eq!(
                logic_of_pipeline(DynamicLogic::Operation, false, operation),
                shared
            );
            assert_eq!(
                logic_of_pipeline(DynamicLogic::All, true, operation),
                shared
            );
        }
        // A draw without an operation: the enable is dynamic only if all of it is.
        assert_eq!(
            logic_of_pipeline(DynamicLogic::Operation, false, None),
            None
        );
        assert_eq!(logic_of_pipeline(DynamicLogic::All, true, None), shared);
    }

    #[test]
    fn a_pipeline_of_extended_states_has_opposite_masks() {
        let draw = draw(None);
        let pipeline = pipeline_draw(states(true, DynamicLogic::Nothing), &draw);
        assert_eq!(pipeline.multisample.mask, !draw.multisample.mask);
        assert_eq!(pipeline.targets.len(), draw.targets.len());
        for (target, original) in pipeline.targets.iter().zip(&draw.targets) {
            assert_eq!(target.write_mask ^ original.write_mask, 0b1111);
        }
        assert_eq!(
            pipeline_draw(states(false, DynamicLogic::Nothing), &draw),
            draw
        );
    }

    #[test]
    fn a_pass_without_colour_has_no_dynamic_colour_state() {
        let all = states(true, DynamicLogic::All);
        assert_eq!(all.states(false), RASTER_STATES);
        assert_eq!(all.states(true).len(), 4 + 3 + 2);
        assert_eq!(states(false, DynamicLogic::Nothing).states(true), []);
    }
}
