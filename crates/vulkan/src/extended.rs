//! Extended dynamic state 3: what else of a pipeline is set for each draw, where the path asks for it.

use crate::device::Device;
use crate::state;
use ash::vk;
use etalon_scene::{ColorTarget, Draw, Multisample, PolygonMode};

/// The further dynamic states.
pub(crate) const STATES: [vk::DynamicState; 7] = [
    vk::DynamicState::POLYGON_MODE_EXT,
    vk::DynamicState::DEPTH_CLAMP_ENABLE_EXT,
    vk::DynamicState::SAMPLE_MASK_EXT,
    vk::DynamicState::ALPHA_TO_COVERAGE_ENABLE_EXT,
    vk::DynamicState::COLOR_BLEND_ENABLE_EXT,
    vk::DynamicState::COLOR_BLEND_EQUATION_EXT,
    vk::DynamicState::COLOR_WRITE_MASK_EXT,
];

/// The number of [`STATES`] that a pass without colour attachments has.
pub(crate) const COLORLESS: usize = 4;

/// Returns a draw whose pipeline holds other values of [`STATES`], which must not act.
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

/// The values of [`STATES`] of one draw.
pub(crate) struct Extended {
    polygon_mode: PolygonMode,
    depth_clamp: bool,
    samples: u32,
    mask: u32,
    alpha_to_coverage: bool,
    targets: Vec<vk::PipelineColorBlendAttachmentState>,
}

impl Extended {
    pub(crate) fn new(draw: &Draw, samples: u32) -> Self {
        Self {
            polygon_mode: draw.polygon_mode,
            depth_clamp: draw.depth_clamp,
            samples,
            mask: draw.multisample.mask,
            alpha_to_coverage: draw.multisample.alpha_to_coverage,
            targets: draw.targets.iter().map(state::color_target).collect(),
        }
    }

    /// Records all of [`STATES`].
    ///
    /// # Safety
    /// `commands` is recording.
    pub(crate) unsafe fn set(&self, device: &Device, commands: vk::CommandBuffer) {
        let Some(api) = &device.extended else {
            return;
        };
        let all = || self.targets.iter();
        let enables: Vec<_> = all().map(|t| t.blend_enable).collect();
        let masks: Vec<_> = all().map(|t| t.color_write_mask).collect();
        let equations: Vec<_> = all()
            .map(|t| vk::ColorBlendEquationEXT {
                src_color_blend_factor: t.src_color_blend_factor,
                dst_color_blend_factor: t.dst_color_blend_factor,
                color_blend_op: t.color_blend_op,
                src_alpha_blend_factor: t.src_alpha_blend_factor,
                dst_alpha_blend_factor: t.dst_alpha_blend_factor,
                alpha_blend_op: t.alpha_blend_op,
            })
            .collect();
        // SAFETY: the caller's; the features are enabled wherever the functions are loaded.
        unsafe {
            api.cmd_set_polygon_mode(commands, state::polygon_mode(self.polygon_mode));
            api.cmd_set_depth_clamp_enable(commands, self.depth_clamp);
            api.cmd_set_sample_mask(commands, state::samples(self.samples), &[self.mask]);
            api.cmd_set_alpha_to_coverage_enable(commands, self.alpha_to_coverage);
            if !self.targets.is_empty() {
                api.cmd_set_color_blend_enable(commands, 0, &enables);
                api.cmd_set_color_blend_equation(commands, 0, &equations);
                api.cmd_set_color_write_mask(commands, 0, &masks);
            }
        }
    }
}
