//! The sample masks that a fragment shader can read.

use crate::interval::Interval;
use crate::possible::Possible;
use crate::primitive::{Shape, inside_of};
use crate::range::Range;
use crate::rules::InputMaskRule;
use crate::sample::Sample;
use crate::walk::{FragmentPlace, Walk};
use etalon_scene::{Draw, EarlyTests};
use smallvec::{SmallVec, smallvec};

/// A sample mask with bits that can be open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct InputBits {
    /// The bits that are set.
    pub(crate) set: u32,
    /// The bits that can be set, including those in `set`.
    pub(crate) possible: u32,
}

impl InputBits {
    /// Returns a mask without open bits.
    fn exact(set: u32) -> Self {
        Self { set, possible: set }
    }

    /// Adds a bit.
    fn add(&mut self, bit: u32, set: Possible) {
        self.set |= if set.must() { bit } else { 0 };
        self.possible |= if set.can() { bit } else { 0 };
    }

    /// Returns the value of a bit.
    pub(crate) fn bit(self, number: u32) -> Range {
        let has = |bits: u32| f64::from((bits >> number) & 1);
        Range::same(Interval {
            low: has(self.set),
            high: has(self.possible),
        })
    }
}

impl Walk<'_> {
    /// Returns the masks that the run that shades a covered sample can read; a single mask if its shader
    /// reads none.
    pub(crate) fn input_masks(&self, place: &FragmentPlace<'_>) -> SmallVec<[InputBits; 2]> {
        let (draw, samples) = (place.draw, place.at.samples);
        if !draw.shader.reads_mask() {
            return smallvec![InputBits::default()];
        }
        let sample_bit = InputBits::exact(1 << place.at.sample);
        if samples == 1 {
            return smallvec![sample_bit];
        }
        let covered = self.covered_samples(place);
        let some = InputBits {
            set: sample_bit.set,
            ..covered
        };
        match (
            self.rules.input_mask.value(),
            draw.multisample.min_sample_shading,
        ) {
            (InputMaskRule::AllOrOwn, _) if covered == sample_bit => smallvec![sample_bit],
            (InputMaskRule::AllOrOwn, _) => smallvec![covered, sample_bit],
            _ if draw.shader.runs_per_sample() => smallvec![sample_bit],
            (InputMaskRule::OfRun, None) => smallvec![covered],
            (InputMaskRule::OfRun | InputMaskRule::OfAnyRun, Some(1.0)) => smallvec![sample_bit],
            _ => smallvec![some],
        }
    }

    /// Returns the samples of a fragment's texel that its primitive covers, including its own.
    fn covered_samples(&self, place: &FragmentPlace<'_>) -> InputBits {
        let pass = &self.scene.passes[place.pass];
        // Without post-depth coverage, it is open whether early tests clear bits.
        let forced = place.draw.early_tests == EarlyTests::Forced && pass.depth_stencil.is_some();
        let mut bits = InputBits::default();
        for sample in 0..place.at.samples {
            let set = if sample == place.at.sample {
                Possible::Always
            } else {
                let drawn = self.mask_keeps(place.draw, sample);
                let tested = Possible::of(true, !forced);
                self.covers(place, sample).and(drawn).and(tested)
            };
            bits.add(1 << sample, set);
        }
        bits
    }

    /// Returns whether the draw's sample mask and sample coverage keep a sample in the mask that shaders
    /// read.
    fn mask_keeps(&self, draw: &Draw, sample: u32) -> Possible {
        let state = &draw.multisample;
        if state.mask & (1 << sample) == 0 {
            Possible::of(!self.rules.input_mask_lacks_masked.value(), false)
        } else {
            Possible::of(true, state.sample_coverage.is_none())
        }
    }

    /// Returns whether a fragment's primitive covers a sample of its texel. Clipping can split a primitive,
    /// and points and lines can be split too; each part then has a fragment of its own.
    fn covers(&self, place: &FragmentPlace<'_>, sample: u32) -> Possible {
        let at = Sample { sample, ..place.at };
        let point = self.sample_point(at);
        let sides = self.sides_of(place.primitive, at, point);
        let hit = (place.pass, place.draw_index);
        let Ok(hit) = self.hit(hit, place.primitive, sides, point) else {
            return Possible::Never;
        };
        let must = match &place.primitive.shape {
            Shape::Triangle(triangle) => {
                let (least, most) = triangle.area;
                let inside = |positive: bool| hit.sides == [inside_of(positive); 3];
                self.is_whole(place) && (least > 0 && inside(true) || most < 0 && inside(false))
            }
            _ => false,
        };
        Possible::of(true, must)
    }

    /// Returns true if nothing clips a fragment's primitive.
    pub(crate) fn is_whole(&self, place: &FragmentPlace<'_>) -> bool {
        let primitive = place.primitive;
        let clip = self.setups[place.pass].clip(place.draw_index);
        clip.holds_all_of(primitive)
            && (place.draw.depth_clamp || primitive.clip_depth.is_none())
            && primitive.distances.is_empty()
    }
}
