//! Passes: their attachments, and what happens to these before, between and after the draws.
//!
//! Load and store operations are separate from the lists of attachments, and clear commands are separate from
//! the draws, each with the index of the draw that it precedes. A pass without them is described as if they
//! did not exist.

use crate::draw::Draw;
use crate::path::Path;
use etalon_frame::{Aspect, PathResolves, state_enum};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A render pass. Attachments keep their contents from the previous pass, unless a load operation clears them
/// or a store operation discarded them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// Indices of the colour attachments, in location order.
    pub color: Vec<usize>,
    /// The attachment to which each colour attachment is resolved at the end of the pass: a single-sample
    /// attachment of the same format and size. Has the same length as `color`.
    pub resolve: Vec<Option<usize>>,
    /// Index of the depth-stencil attachment; `None` if the pass has neither depth nor stencil.
    pub depth_stencil: Option<usize>,
    /// True if the pass declares that it writes neither depth nor stencil.
    pub depth_stencil_read_only: bool,
    /// The resolve of depth and stencil at the end of the pass; `None` keeps the target.
    #[serde(default)]
    pub depth_stencil_resolve: Option<DepthStencilResolve>,
    /// Load and store operations; by default, all contents are loaded and stored.
    #[serde(default)]
    pub operations: PassOperations,
    /// Clear commands, in the order of the draws that they precede.
    #[serde(default)]
    pub clears: Vec<Clear>,
    /// Draws in the order of submission, which the API keeps.
    pub draws: Vec<Draw>,
}

/// A resolve of the samples of depth and stencil.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DepthStencilResolve {
    /// Index of the attachment that the resolve writes: single-sample, of the same format and size.
    pub to: usize,
    /// The mode of depth; [`ResolveMode::None`] for formats without depth.
    pub depth: ResolveMode,
    /// The mode of stencil, never an average; [`ResolveMode::None`] for formats without stencil.
    pub stencil: ResolveMode,
}

state_enum! {
    /// The conversion of a texel's samples to one value.
    ResolveMode {
        /// The aspect is not resolved and keeps its value.
        None = "none",
        /// The first sample.
        SampleZero = "sample-zero",
        /// The average of the samples.
        Average = "average",
        /// The least sample.
        Min = "min",
        /// The greatest sample.
        Max = "max",
    }
}

/// The load and store operations of a pass, per aspect.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PassOperations {
    /// The operations of the colour attachments, in location order; attachments past the end are loaded and
    /// stored.
    #[serde(default)]
    pub color: Vec<Operations<[f32; 4]>>,
    /// The operations of depth; the default if the pass has no depth.
    #[serde(default)]
    pub depth: Operations<f32>,
    /// The operations of stencil; the default if the pass has no stencil.
    #[serde(default)]
    pub stencil: Operations<u8>,
}

/// The load and store operation of one aspect with clear values of type `V`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Operations<V> {
    /// The operation at the start of the pass.
    #[serde(default)]
    pub load: LoadOperation<V>,
    /// The operation at the end of the pass, after resolves.
    #[serde(default)]
    pub store: StoreOperation,
}

/// The contents of an aspect at the start of a pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LoadOperation<V> {
    /// The previous contents.
    #[default]
    Load,
    /// This value in all texels and samples.
    Clear(V),
}

impl<V: Copy> LoadOperation<V> {
    /// Returns the clear value; `None` if nothing is cleared.
    pub fn clear_value(self) -> Option<V> {
        match self {
            Self::Load => None,
            Self::Clear(value) => Some(value),
        }
    }
}

state_enum! {
    /// The fate of an aspect's contents at the end of a pass.
    #[derive(Default)]
    StoreOperation {
        /// The aspect keeps its contents.
        #[default]
        Store = "store",
        /// The aspect is undefined until it is cleared as a whole.
        Discard = "discard",
    }
}

/// A clear command within a pass. Neither the scissor rectangle nor the masks of draws affect it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Clear {
    /// Index of the draw before which it is executed; the number of draws for the end of the pass.
    pub before: usize,
    /// The cleared aspects with their values.
    pub target: ClearTarget,
    /// Left, top, width and height of the cleared texels, inside the attachments; `None` for all.
    pub rect: Option<[u32; 4]>,
}

/// The aspects that a clear command writes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum ClearTarget {
    /// A colour attachment.
    Color {
        /// The attachment's location in the pass.
        location: usize,
        /// Red, green, blue, alpha.
        value: [f32; 4],
        /// The mask of written channels: bit 0 is red, bit 3 alpha.
        write_mask: u8,
    },
    /// Depth, stencil or both.
    DepthStencil {
        /// Depth in 0..=1; `None` leaves it unchanged.
        depth: Option<f32>,
        /// Stencil; `None` leaves it unchanged.
        stencil: Option<u8>,
        /// False if depth writes are masked off.
        depth_write: bool,
        /// The mask of written stencil bits.
        stencil_write_mask: u8,
    },
}

impl ClearTarget {
    /// Returns true if a mask protects channels or bits.
    pub fn is_masked(&self) -> bool {
        match *self {
            Self::Color { write_mask, .. } => write_mask != 0b1111,
            Self::DepthStencil {
                depth,
                stencil,
                depth_write,
                stencil_write_mask,
            } => depth.is_some() && !depth_write || stencil.is_some() && stencil_write_mask != 0xff,
        }
    }
}

impl Pass {
    /// Returns the operations of the colour attachment at a location.
    pub fn color_operations(&self, location: usize) -> Operations<[f32; 4]> {
        let given = self.operations.color.get(location);
        given.copied().unwrap_or_default()
    }

    /// Returns true if an attachment is drawn to or tested in the pass.
    pub fn attaches(&self, index: usize) -> bool {
        self.color.contains(&index) || self.depth_stencil == Some(index)
    }

    /// Returns true if a draw of the pass reads an attachment of the pass.
    pub fn reads_itself(&self) -> bool {
        self.draws.iter().any(|draw| draw.reads_own(self))
    }

    /// Returns the locations whose resolves the path makes commands after the pass, with their targets.
    /// Contents that the pass discards are still resolved within it.
    pub fn moved_resolves(&self, path: &Path) -> impl Iterator<Item = (usize, usize)> {
        let moved = path.resolves == PathResolves::Moved;
        let targets = self.resolve.iter().enumerate().filter(move |_| moved);
        targets.filter_map(|(location, to)| {
            let stored = self.color_operations(location).store == StoreOperation::Store;
            to.filter(|_| stored).map(|to| (location, to))
        })
    }

    /// Returns the indices of the attachments that resolves write.
    pub fn resolve_targets(&self) -> impl Iterator<Item = usize> + '_ {
        let depth_stencil = self.depth_stencil_resolve.iter().map(|r| r.to);
        self.resolve.iter().flatten().copied().chain(depth_stencil)
    }

    /// Returns the clears of the load operations as clear commands.
    pub fn loading_clears(&self) -> Vec<Clear> {
        let full_clear = |target| Clear {
            before: 0,
            target,
            rect: None,
        };
        let mut clears = Vec::new();
        for location in 0..self.color.len() {
            if let LoadOperation::Clear(value) = self.color_operations(location).load {
                clears.push(full_clear(ClearTarget::Color {
                    location,
                    value,
                    write_mask: 0b1111,
                }));
            }
        }
        let depth = self.operations.depth.load.clear_value();
        let stencil = self.operations.stencil.load.clear_value();
        if depth.is_some() || stencil.is_some() {
            clears.push(full_clear(ClearTarget::DepthStencil {
                depth,
                stencil,
                depth_write: true,
                stencil_write_mask: 0xff,
            }));
        }
        clears
    }

    /// Returns the clear commands that are executed before the draw with this index, or at the end.
    pub fn clears_before(&self, draw: usize) -> &[Clear] {
        let start = self.clears.partition_point(|c| c.before < draw);
        let end = self.clears.partition_point(|c| c.before <= draw);
        &self.clears[start..end]
    }

    /// Returns the aspects that load operations clear, by attachment.
    pub fn cleared(&self) -> Vec<(usize, Aspect)> {
        let Self { operations, .. } = self;
        self.aspects(
            |location| self.color_operations(location).load != LoadOperation::Load,
            operations.depth.load != LoadOperation::Load,
            operations.stencil.load != LoadOperation::Load,
        )
    }

    /// Returns the aspects that store operations discard, by attachment.
    pub fn discarded(&self) -> Vec<(usize, Aspect)> {
        let Self { operations, .. } = self;
        self.aspects(
            |location| self.color_operations(location).store == StoreOperation::Discard,
            operations.depth.store == StoreOperation::Discard,
            operations.stencil.store == StoreOperation::Discard,
        )
    }

    fn aspects(
        &self,
        color: impl Fn(usize) -> bool,
        depth: bool,
        stencil: bool,
    ) -> Vec<(usize, Aspect)> {
        let colors = self.color.iter().enumerate();
        let mut aspects: Vec<_> = colors
            .filter(|(location, _)| color(*location))
            .map(|(_, index)| (*index, Aspect::Color))
            .collect();
        for (has, aspect) in [(depth, Aspect::Depth), (stencil, Aspect::Stencil)] {
            aspects.extend(self.depth_stencil.filter(|_| has).map(|i| (i, aspect)));
        }
        aspects
    }
}

impl Draw {
    /// Returns true if the draw reads an attachment of its own pass.
    pub fn reads_own(&self, pass: &Pass) -> bool {
        self.textures.iter().any(|index| pass.attaches(*index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clear(before: usize) -> Clear {
        Clear {
            before,
            target: ClearTarget::Color {
                location: 0,
                value: [0.0; 4],
                write_mask: 0b1111,
            },
            rect: None,
        }
    }

    #[test]
    fn clears_are_found_by_the_draw_that_follows() {
        let pass = Pass {
            clears: [0, 2, 2, 3].map(clear).to_vec(),
            ..Pass::default()
        };
        let counts = [0, 1, 2, 3, 4].map(|draw| pass.clears_before(draw).len());
        assert_eq!(counts, [1, 0, 2, 1, 0]);
    }

    #[test]
    fn operations_name_the_aspects_of_the_pass() {
        let mut pass = Pass {
            color: vec![4, 5],
            depth_stencil: Some(2),
            ..Pass::default()
        };
        assert_eq!((pass.cleared(), pass.discarded()), (vec![], vec![]));
        let red = Operations {
            load: LoadOperation::Clear([1.0, 0.0, 0.0, 1.0]),
            ..Operations::default()
        };
        pass.operations.color = vec![Operations::default(), red];
        pass.operations.depth.store = StoreOperation::Discard;
        pass.operations.stencil.load = LoadOperation::Clear(3);
        assert_eq!(pass.cleared(), [(5, Aspect::Color), (2, Aspect::Stencil)]);
        assert_eq!(pass.discarded(), [(2, Aspect::Depth)]);
        let value = pass.color_operations(1).load.clear_value();
        assert_eq!(value, Some([1.0, 0.0, 0.0, 1.0]));
    }
}
