//! Extended dynamic state 2 and 3: pipeline state beyond Vulkan 1.3's that is set for each draw, if the path
//! asks for it.

use crate::device::Device;
use crate::single_state::SingleState;
use crate::state;
use ash::vk;
use etalon_scene::{ColorTarget, Draw, LogicOperation, Multisample, PolygonMode};

/// The states of extended dynamic state 3 that are set together.
const STATES: [vk::DynamicState; 7] = [
    vk::DynamicState::POLYGON_MODE_EXT,
    vk::DynamicState::DEPTH_CLAMP_ENABLE_EXT,
    vk::DynamicState::SAMPLE_MASK_EXT,
    vk::DynamicState::ALPHA_TO_COVERAGE_ENABLE_EXT,
    vk::DynamicState::COLOR_BLEND_ENABLE_EXT,
    vk::DynamicState::COLOR_BLEND_EQUATION_EXT,
    vk::DynamicState::COLOR_WRITE_MASK_EXT,
];

/// The number of [`STATES`] that a pass without colour attachments has.
const COLORLESS: usize = 4;

/// The part of the logic operation state that is dynamic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum DynamicLogic {
    /// No part.
    Nothing,
    /// The operation.
    Operation,
    /// The operation, and whether it is enabled.
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
pub(crate) struct Further {
    /// True if all of [`STATES`] are dynamic.
    pub(crate) extended: bool,
    pub(crate) logic: DynamicLogic,
    /// The state that is dynamic alone, if any.
    pub(crate) single: Option<SingleState>,
}

impl Further {
    /// Returns true if any of these states is dynamic.
    pub(crate) fn any(self) -> bool {
        self.extended || self.logic != DynamicLogic::Nothing || self.single.is_some()
    }

    /// Returns the dynamic states of a pipeline. `colored` is true if it has colour attachments.
    pub(crate) fn states(self, colored: bool) -> Vec<vk::DynamicState> {
        let extended: &[_] = match (self.extended, colored) {
            (false, _) => &[],
            (true, false) => &STATES[..COLORLESS],
            (true, true) => &STATES,
        };
        let logic = if colored { self.logic.states() } else { &[] };
        let single: Vec<_> = self.single.iter().map(|state| state.dynamic()).collect();
        [extended, logic, &single].concat()
    }
}

/// The logic operation that a pipeline is created with if the operation is dynamic. It must have no effect.
const HELD: LogicOperation = LogicOperation::Equivalent;

/// Returns the draw that a pipeline is made from: its values of the dynamic states differ from the draw's, and
/// must have no effect. Draws of all logic operations then share a pipeline.
pub(crate) fn held_by(further: Further, draw: &Draw) -> Draw {
    let logic = match further.logic {
        DynamicLogic::All if !draw.targets.is_empty() => Some(HELD),
        DynamicLogic::Operation => draw.logic.map(|_| HELD),
        DynamicLogic::All | DynamicLogic::Nothing => draw.logic,
    };
    let drawn = if further.extended {
        held(draw)
    } else {
        draw.clone()
    };
    let drawn = Draw { logic, ..drawn };
    match further.single {
        Some(state) => state.held(&drawn),
        None => drawn,
    }
}

/// Returns a draw whose values of [`STATES`] differ from this draw's. Its pipeline is made from it, and these
/// values must have no effect.
pub(crate) fn held(draw: &Draw) -> Draw {
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

/// The values that a draw gives the further dynamic states.
pub(crate) struct Extended {
    further: Further,
    logic: Option<LogicOperation>,
    polygon_mode: PolygonMode,
    depth_clamp: bool,
    samples: u32,
    mask: u32,
    alpha_to_coverage: bool,
    targets: Vec<vk::PipelineColorBlendAttachmentState>,
}

impl Extended {
    pub(crate) fn new(draw: &Draw, samples: u32, further: Further) -> Self {
        Self {
            further,
            logic: draw.logic,
            polygon_mode: draw.polygon_mode,
            depth_clamp: draw.depth_clamp,
            samples,
            mask: draw.multisample.mask,
            alpha_to_coverage: draw.multisample.alpha_to_coverage,
            targets: draw.targets.iter().map(state::color_target).collect(),
        }
    }

    /// Records all further dynamic states.
    ///
    /// # Safety
    /// `commands` is being recorded.
    pub(crate) unsafe fn set(&self, device: &Device, commands: vk::CommandBuffer) {
        let colored = !self.targets.is_empty();
        if let (Some(api), true) = (&device.dynamic_logic, colored)
            && self.further.logic != DynamicLogic::Nothing
        {
            // If the operation is disabled, drawing with this one would be visible.
            let operation = self.logic.unwrap_or(LogicOperation::Invert);
            // SAFETY: upheld by the caller; the feature is enabled if the function is loaded.
            unsafe { api.cmd_set_logic_op(commands, state::logic(operation)) };
        }
        let Some(api) = device.extended.as_ref().filter(|_| self.further.extended) else {
            return;
        };
        if colored && self.further.logic == DynamicLogic::All {
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

    #[test]
    fn draws_of_all_logic_operations_share_a_pipeline_that_holds_another() {
        let draw = |logic| {
            let mesh = Mesh {
                vertices: Vec::new(),
                indices: None,
            };
            Draw {
                logic,
                ..Draw::new(Shader::FlatColor, mesh, Viewport::whole([4, 4]))
            }
        };
        let held = |logic: DynamicLogic, extended, logic_of_draw| {
            let further = Further {
                extended,
                logic,
                single: None,
            };
            held_by(further, &draw(logic_of_draw)).logic
        };
        let (xor, nor) = (Some(LogicOperation::Xor), Some(LogicOperation::Nor));
        for operation in [xor, nor] {
            assert_eq!(held(DynamicLogic::Nothing, false, operation), operation);
            assert_eq!(held(DynamicLogic::Operation, false, operation), Some(HELD));
            assert_eq!(held(DynamicLogic::All, true, operation), Some(HELD));
        }
        // A draw without an operation: the enable is dynamic only if all of it is.
        assert_eq!(held(DynamicLogic::Operation, false, None), None);
        assert_eq!(held(DynamicLogic::All, true, None), Some(HELD));
    }
}
