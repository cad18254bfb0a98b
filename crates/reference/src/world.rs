//! Worlds: the consistent stories of one sample.

use crate::primitive::VertexId;
use etalon_frame::CodeInterval;
use smallvec::SmallVec;
use std::hash::{Hash, Hasher};

/// The most worlds of one sample; past it the sample is open.
pub(crate) const WORLD_CAP: usize = 16;

/// The contents of one attachment at a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Cell {
    /// Colour channels; of a depth attachment the first is the depth.
    pub(crate) channels: [CodeInterval; 4],
    /// Stencil.
    pub(crate) stencil: u8,
    /// The geometry that the depth comes from, where that pins it: see [`crate::rules::SameDepth`].
    pub(crate) origin: Option<u64>,
}

impl Hash for Cell {
    /// What tells most cells apart; states are looked up by it for every outcome.
    fn hash<H: Hasher>(&self, state: &mut H) {
        let [red, green, blue, alpha] = self.channels;
        let lows = [red.low, green.low, blue.low, alpha.low];
        (lows, red.high, self.stencil).hash(state);
    }
}

impl Default for Cell {
    fn default() -> Self {
        Self {
            channels: [CodeInterval::exact(0); 4],
            stencil: 0,
            origin: None,
        }
    }
}

/// The worlds of one sample: mostly one.
pub(crate) type Worlds = SmallVec<[World; 1]>;

/// An event that a counter counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Increment {
    /// The counter, by its place in the scene.
    pub(crate) counter: u16,
    /// The draw and the primitive whose fragment counts.
    pub(crate) fragment: (u32, u32),
    /// True if it counts for certain; else it may.
    pub(crate) certain: bool,
}

/// A text about stores of colours with two readings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Contested {
    /// True: what is blended into signed formats is clamped to -1 to 1; false: to 0 to 1.
    SignedOperands,
    /// True: what is stored in signed formats is clamped to -1 to 1; false: to 0 to 1.
    SignedResults,
    /// True: logic operations apply to sRGB attachments.
    SrgbLogic,
    /// True: the blend constant is clamped to 0 to 1.
    ClampedConstant,
    /// True: alpha to one replaces the alpha of every output; false: of the first one.
    OneForAll,
}

/// A choice that the rules leave open, taken once per world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Decision {
    /// The side of the edge between two positions of a draw on which the sample lies.
    Edge {
        /// The draw, counted over the scene. The invariance rules do not reach across draws whose
        /// state differs, so neither does a choice.
        draw: u32,
        /// The positions, the lower one first.
        ends: (VertexId, VertexId),
        /// The primitive, where the rules let each decide for itself.
        owner: Option<u32>,
    },
    /// True if a value of sample coverage, given by its bits, covers the sample: the same for all draws
    /// of a pass.
    SampleCoverage { value: u32 },
    /// The reading of a contested text: the same for all draws of a pass.
    Reading(Contested),
}

impl Decision {
    /// True if later draws of the pass may refer to the choice.
    pub(crate) fn outlives_its_draw(self) -> bool {
        matches!(self, Self::SampleCoverage { .. } | Self::Reading(_))
    }
}

/// One consistent story: the contents of every attachment, and the choices that led there.
#[derive(Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct World {
    pub(crate) cells: SmallVec<[Cell; 2]>,
    pub(crate) decisions: Vec<(Decision, bool)>,
    /// The events so far, in order.
    pub(crate) events: Vec<Increment>,
}

impl Clone for World {
    fn clone(&self) -> Self {
        Self {
            // A copy of all cells at once.
            cells: SmallVec::from_slice(&self.cells),
            decisions: self.decisions.clone(),
            events: self.events.clone(),
        }
    }
}

impl World {
    pub(crate) fn decided(&self, decision: Decision) -> Option<bool> {
        self.decisions
            .iter()
            .find(|(d, _)| *d == decision)
            .map(|(_, outcome)| *outcome)
    }

    /// Returns this world with a choice taken; of an edge, `true` is the positive side from the lower to
    /// the higher number.
    pub(crate) fn with(&self, decision: Decision, outcome: bool) -> Self {
        let mut world = self.clone();
        world.decisions.push((decision, outcome));
        world
    }
}

/// Merges equal worlds; returns `false` if more than [`WORLD_CAP`] remain.
pub(crate) fn merge(worlds: &mut Worlds) -> bool {
    if worlds.len() > 1 {
        worlds.sort_unstable();
        worlds.dedup();
    }
    worlds.len() <= WORLD_CAP
}
