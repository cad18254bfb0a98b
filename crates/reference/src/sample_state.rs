//! Sample shading and sample coverage: where a fragment's inputs are evaluated, and the samples that coverage
//! keeps.

use crate::interval::Interval;
use crate::notes::Notes;
use crate::primitive::Shape;
use crate::range::Range;
use crate::rules::{AlphaToCoverage, FragCoord, Rules};
use crate::sample::Sample;
use crate::walk::{FragmentPlace, Walk};
use crate::world::{Decision, World};
use etalon_frame::{Rejection, Step};
use etalon_pipeline::Point;
use etalon_scene::{Multisample, SampleCoverage};
use smallvec::{SmallVec, smallvec};

/// The point of a texel at which an input of a fragment shader is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ShadedAt {
    /// The centre.
    Center,
    /// The position of the sample itself.
    Sample,
    /// The position of any sample.
    AnySample,
    /// Any point of the texel.
    Texel,
}

/// Returns the point whose coordinates a shader reads as the fragment's, with several samples.
fn frag_coord_at(rules: &Rules, state: &Multisample, samples: u32) -> ShadedAt {
    match (rules.frag_coord.value(), state.min_sample_shading) {
        (FragCoord::Inputs, _) => inputs_at(rules, state),
        (FragCoord::Sample, None) => ShadedAt::Center,
        // If there are as many runs as samples, and each run has at least one sample, each run has exactly
        // one.
        (FragCoord::Sample, Some(_)) if state.least_runs(samples) == samples => ShadedAt::Sample,
        (FragCoord::Sample, Some(_)) => ShadedAt::AnySample,
    }
}

/// Returns the point at which undecorated inputs are interpolated, with several samples.
fn inputs_at(rules: &Rules, state: &Multisample) -> ShadedAt {
    match state.min_sample_shading {
        Some(1.0) if rules.inputs_at_samples.value() => ShadedAt::Sample,
        _ => ShadedAt::Texel,
    }
}

impl Walk<'_> {
    /// Returns the fragment coordinates that a shader reads, in texels.
    pub(crate) fn frag_coord(&self, place: &FragmentPlace<'_>) -> [Range; 2] {
        let Sample { x, y, samples, .. } = place.at;
        let units = self.units as f64;
        let point = |p: Point| [p.x, p.y].map(|v| Interval::exact(v as f64 / units));
        let [across, down] = match frag_coord_at(self.rules, &place.draw.multisample, samples) {
            _ if samples == 1 => point(place.point),
            ShadedAt::Sample => point(place.point),
            ShadedAt::AnySample => (0..samples)
                .map(|sample| point(self.sample_point(Sample { sample, ..place.at })))
                .reduce(|a, b| [a[0].hull(b[0]), a[1].hull(b[1])])
                .unwrap_or_else(|| point(place.point)),
            ShadedAt::Center => [x, y].map(|v| Interval::exact(f64::from(v) + 0.5)),
            ShadedAt::Texel => [x, y].map(|v| Interval {
                low: f64::from(v),
                high: f64::from(v) + 1.0,
            }),
        };
        [across, down].map(|v| Range::same(v.widen(self.rules.float_error.value() * v.high)))
    }

    /// Returns 1 over the clip-space w that a shader reads; 0 if it reads none.
    pub(crate) fn reciprocal_w(&self, place: &FragmentPlace<'_>) -> Range {
        let samples = self.samples_shaded(place);
        let w = place.primitive.w_seen(place.point, self.units, samples);
        w.map_or(Range::exact(0.0), Range::same)
    }

    /// Returns the number of samples at whose points inputs may be interpolated; 1 if only the sample's own
    /// point is possible.
    pub(crate) fn samples_shaded(&self, place: &FragmentPlace<'_>) -> u32 {
        let at_sample = inputs_at(self.rules, &place.draw.multisample) == ShadedAt::Sample;
        match place.primitive.shape {
            Shape::Triangle(_) if at_sample => 1,
            _ => place.at.samples,
        }
    }

    /// Splits a world by sample coverage. Each result has `true` if the sample is drawn.
    pub(crate) fn by_sample_coverage(
        &self,
        place: &FragmentPlace<'_>,
        world: World,
        notes: &mut Notes<'_>,
    ) -> SmallVec<[(World, bool); 2]> {
        let state = place.draw.multisample.sample_coverage;
        // Without multisampling, the step is skipped.
        let Some(SampleCoverage { value, invert }) = state.filter(|_| place.at.samples > 1) else {
            return smallvec![(world, true)];
        };
        // Adding 0 turns a negative zero into a positive one.
        let value = value.clamp(0.0, 1.0) + 0.0;
        let decision = Decision::SampleCoverage {
            value: value.to_bits(),
        };
        let ends = self.rules.sample_coverage.value() == AlphaToCoverage::Ends;
        let known = match value {
            0.0 | 1.0 if ends => Some(value > 0.0),
            _ => world.decided(decision),
        };
        let drawn = known.map(|covered| covered != invert);
        if drawn != Some(true) {
            self.note_rejection(
                notes,
                place,
                Rejection::SampleCoverage,
                drawn.is_some(),
                || Step::SampleCoverage {
                    share: value,
                    inverted: invert,
                    sample: place.at.sample,
                },
            );
        }
        match known {
            Some(covered) => smallvec![(world, covered != invert)],
            None => [true, false]
                .map(|covered| (world.with(decision, covered), covered != invert))
                .into_iter()
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_limits;
    use etalon_frame::Api;

    #[test]
    fn only_a_whole_share_pins_attributes_and_only_in_opengl() {
        let with = |share| Multisample {
            min_sample_shading: share,
            ..Multisample::default()
        };
        for api in [Api::OpenGl, Api::OpenGlEs] {
            let rules = Rules::of(&test_limits::limits(api));
            assert_eq!(inputs_at(&rules, &with(Some(1.0))), ShadedAt::Sample);
            assert_eq!(inputs_at(&rules, &with(Some(0.9))), ShadedAt::Texel);
            assert_eq!(frag_coord_at(&rules, &with(None), 4), ShadedAt::Texel);
            assert_eq!(frag_coord_at(&rules, &with(Some(1.0)), 4), ShadedAt::Sample);
        }
        let rules = Rules::of(&test_limits::limits(Api::Vulkan));
        let shaded_at = |share| frag_coord_at(&rules, &with(share), 4);
        assert_eq!(shaded_at(None), ShadedAt::Center);
        assert_eq!(shaded_at(Some(0.0)), ShadedAt::AnySample);
        assert_eq!(shaded_at(Some(0.75)), ShadedAt::AnySample);
        assert_eq!(shaded_at(Some(0.76)), ShadedAt::Sample);
        assert_eq!(inputs_at(&rules, &with(Some(1.0))), ShadedAt::Texel);
    }
}
