//! Worlds: the consistent histories of one sample.

use crate::primitive::VertexId;
use etalon_frame::CodeInterval;
use smallvec::SmallVec;
use std::hash::{Hash, Hasher};
use std::num::NonZeroU64;

/// The maximum number of worlds of one sample; beyond it, the sample is open.
pub(crate) const WORLD_CAP: usize = 16;

/// The contents of one attachment at a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct SampleContents {
    /// The lowest and the highest code of each colour channel; for a depth attachment, the first is the depth.
    /// The orders of all encodings fit into 32 bits.
    pub(crate) codes: [[i32; 2]; 4],
    /// Stencil.
    pub(crate) stencil: u8,
    /// The geometry that the depth comes from, if that determines it: see [`crate::rules::SameDepth`]. For a colour
    /// attachment, the number of everything that its codes are computed from, if that is known exactly.
    pub(crate) origin: Option<NonZeroU64>,
}

impl SampleContents {
    /// Returns the codes of a channel.
    #[inline]
    pub(crate) fn channel(&self, c: usize) -> CodeInterval {
        let [low, high] = self.codes[c].map(i64::from);
        CodeInterval { low, high }
    }

    /// Returns the codes of all channels.
    #[inline]
    pub(crate) fn channels(&self) -> [CodeInterval; 4] {
        [0, 1, 2, 3].map(|c| self.channel(c))
    }

    /// Returns true if the colours are the same wherever they have this origin.
    pub(crate) fn is_determined(&self) -> bool {
        self.origin.is_some() || self.is_exact()
    }

    /// Returns true if every channel has one code.
    pub(crate) fn is_exact(&self) -> bool {
        self.codes.iter().all(|[low, high]| low == high)
    }

    /// Replaces the codes of a channel. The origin of the contents is no longer known.
    #[inline]
    pub(crate) fn set_channel(&mut self, c: usize, codes: CodeInterval) {
        self.origin = None;
        self.codes[c] = [codes.low, codes.high].map(|order| {
            debug_assert!(i32::try_from(order).is_ok(), "an order of {order}");
            order as i32
        });
    }

    #[inline]
    pub(crate) fn set_channels(&mut self, channels: [CodeInterval; 4]) {
        for (c, codes) in channels.into_iter().enumerate() {
            self.set_channel(c, codes);
        }
    }
}

impl Hash for SampleContents {
    /// Hashes what distinguishes most cells: every outcome needs a look-up of a state.
    fn hash<H: Hasher>(&self, state: &mut H) {
        let [red, green, blue, alpha] = self.codes;
        let both = |a: i32, b: i32| i64::from(a) << 32 | i64::from(b) & 0xffff_ffff;
        let lows = [both(red[0], green[0]), both(blue[0], alpha[0])];
        let origin = self.origin.map_or(0, NonZeroU64::get);
        (lows, both(red[1], self.stencil.into()), origin).hash(state);
    }
}

/// The worlds of one sample, mostly one.
pub(crate) type Worlds = SmallVec<[World; 1]>;

/// An event that a counter counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Increment {
    /// The counter, by its index in the scene.
    pub(crate) counter: u16,
    /// The draw and the primitive whose fragment counts.
    pub(crate) fragment: (u32, u32),
    /// True if it certainly counts; otherwise it may or may not count.
    pub(crate) certain: bool,
}

/// A clause about stores of colours with two readings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Contested {
    /// True: operands of blends into signed formats are clamped to -1 to 1; false: to 0 to 1.
    SignedOperands,
    /// True: results stored in signed formats are clamped to -1 to 1; false: to 0 to 1.
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
    /// The side on which the sample is, of the edge between two positions of a draw.
    Edge {
        /// The draw, counted over the scene. The invariance rules do not apply across draws whose state
        /// differs, so a choice does not either.
        draw: u32,
        /// The positions, the lower one first.
        ends: (VertexId, VertexId),
        /// The primitive, if the rules let each one decide separately.
        owner: Option<u32>,
    },
    /// Whether a value of sample coverage, given by its bits, covers the sample: the same for all draws of
    /// a pass.
    SampleCoverage { value: u32 },
    /// The reading of a contested clause: the same for all draws of a pass.
    Reading(Contested),
}

impl Decision {
    /// Returns true if later draws of the pass may refer to the choice.
    pub(crate) fn outlives_its_draw(self) -> bool {
        matches!(self, Self::SampleCoverage { .. } | Self::Reading(_))
    }
}

/// A consistent history: the contents of every attachment, and the choices that led there.
#[derive(Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct World {
    pub(crate) cells: SmallVec<[SampleContents; 2]>,
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

    /// Returns this world with a choice made; for an edge, `true` is the positive side from the lower to the
    /// higher position.
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
