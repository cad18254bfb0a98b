//! Stores: depth and colours of a fragment that passed, with masks, blending and logic operations.

use crate::fragment::Incoming;
use crate::judging::{Judging, Range};
use crate::walk::{Notes, Place, Walk, codes_text};
use crate::world::World;
use etalon_frame::ChannelEncoding;
use etalon_pipeline::shader::FragmentOutput;
use etalon_pipeline::{Arithmetic, BlendInput, blend, takes_logic};

impl Walk<'_> {
    /// Stores the depth of a fragment that passed all tests.
    pub(crate) fn write_depth(
        &self,
        place: Place<'_>,
        world: &mut World,
        incoming: Incoming,
        notes: &mut Notes<'_>,
    ) {
        let mut judging = Judging::new(self.rules);
        let pass = &self.scene.passes[place.pass];
        if let (Some(state), Some(index)) = (place.draw.depth, pass.depth_stencil)
            && state.write
        {
            let encoding = self.depth_encoding(index);
            let codes = judging.encode(encoding, incoming.depth);
            world.cells[index].channels[0] = codes;
            world.cells[index].origin = incoming.origin;
            notes.add(
                || place.name(),
                "store depth",
                || {
                    let depth = incoming.depth.hull();
                    format!("{depth} as {}", codes_text(encoding, codes))
                },
                Some(self.rules.store.citation),
            );
        }
    }

    /// Stores the colours of a fragment that passed all tests.
    pub(crate) fn write_colors(
        &self,
        place: Place<'_>,
        world: &mut World,
        output: &FragmentOutput<Range>,
        notes: &mut Notes<'_>,
    ) {
        let mut judging = Judging::new(self.rules);
        let pass = &self.scene.passes[place.pass];
        let mut second = output.second.unwrap_or([Range::exact(0.0); 4]);
        if place.draw.multisample.alpha_to_one {
            second[3] = Range::exact(1.0);
        }
        for (location, index) in pass.color.iter().enumerate() {
            let Some(target) = place.draw.targets.get(location) else {
                continue;
            };
            let mut color = output.at_location(location);
            if place.draw.multisample.alpha_to_one {
                color[3] = Range::exact(1.0);
            }
            let attachment = &self.scene.attachments[*index];
            let encodings = attachment.format.color_channels();
            let all: [ChannelEncoding; 4] =
                std::array::from_fn(|c| encodings[c.min(encodings.len() - 1)]);
            let missing = missing_channels(encodings.len());
            let cell = &mut world.cells[*index];
            let value = match &target.blend {
                None => color,
                Some(state) => {
                    let dst = std::array::from_fn(|c| match missing[c] {
                        Some(value) => Range::exact(value),
                        None => judging.decode(all[c], cell.channels[c]),
                    });
                    let constant = place.draw.blend_constant.map(|v| judging.constant(v));
                    let input = BlendInput {
                        src: color,
                        src1: second,
                        dst,
                        constant,
                    };
                    let value = blend(&mut judging, state, all, &input);
                    notes.add(
                        || place.name(),
                        "blend",
                        || {
                            let side = |c: usize| {
                                let part = if c == 3 { state.alpha } else { state.color };
                                format!(
                                    "{}: {} × {} {} {} × {} = {}",
                                    ["red", "green", "blue", "alpha"][c],
                                    color[c].hull(),
                                    part.src_factor.name(),
                                    part.operation.name(),
                                    dst[c].hull(),
                                    part.dst_factor.name(),
                                    value[c].hull()
                                )
                            };
                            [0, 1, 2, 3].map(side).join("; ")
                        },
                        Some(self.rules.blend.citation),
                    );
                    value
                }
            };
            for (c, encoding) in encodings.iter().enumerate() {
                if target.write_mask & (1 << c) != 0 {
                    let codes = judging.encode(*encoding, value[c]);
                    cell.channels[c] = match place.draw.logic {
                        Some(operation) if takes_logic(attachment.format) => {
                            judging.logic(*encoding, operation, codes, cell.channels[c])
                        }
                        _ => codes,
                    };
                }
            }
            let cell = *cell;
            let masked = target.write_mask != 0xf;
            notes.add(
                || place.name(),
                "store color",
                || {
                    format!(
                        "{} holds {}",
                        attachment.name,
                        self.cell_text(*index, &cell)
                    )
                },
                Some(if masked {
                    self.rules.write_mask
                } else {
                    self.rules.store.citation
                }),
            );
        }
    }
}

/// The value of a destination's missing channel in blending: colours 0, alpha 1 (Vulkan, Blending;
/// OpenGL 4.6, 17.3.6).
fn missing_channels(channels: usize) -> [Option<f64>; 4] {
    std::array::from_fn(|c| {
        let value = if c == 3 { 1.0 } else { 0.0 };
        (c >= channels).then_some(value)
    })
}
