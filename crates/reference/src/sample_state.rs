//! Sample shading and sample coverage: where a fragment's inputs lie, and the samples that a share draws.

use crate::interval::Interval;
use crate::judging::Range;
use crate::primitive::Shape;
use crate::rules::{Rules, ShadedAt};
use crate::walk::{Notes, Place, Sample, Walk};
use crate::world::{Decision, World};
use etalon_pipeline::Point;
use etalon_scene::SampleCoverage;
use smallvec::{SmallVec, smallvec};

impl Walk<'_> {
    /// Returns the coordinates of the fragment that a shader reads, in texels.
    pub(crate) fn frag_coord(&self, place: Place<'_>) -> [Range; 2] {
        let Sample { x, y, samples, .. } = place.at;
        let units = self.units as f64;
        let point = |p: Point| [p.x, p.y].map(|v| Interval::exact(v as f64 / units));
        let rule = Rules::frag_coord(self.limits.api, &place.draw.multisample, samples);
        let [across, down] = match rule.value {
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
        [across, down].map(|v| Range::same(v.widen(self.rules.float_error.value * v.high)))
    }

    /// Returns the number of samples among which the point may be chosen at which inputs are
    /// interpolated: 1 if it is the sample's own.
    pub(crate) fn samples_shaded(&self, place: Place<'_>) -> u32 {
        let rule = Rules::inputs(self.limits.api, &place.draw.multisample);
        let own = rule.value == ShadedAt::Sample;
        match place.primitive.shape {
            Shape::Triangle(_) if own => 1,
            _ => place.at.samples,
        }
    }

    /// Splits a world by sample coverage. Returns each with true if the sample is drawn.
    pub(crate) fn by_sample_coverage(
        &self,
        place: Place<'_>,
        world: World,
        notes: &mut Notes<'_>,
    ) -> SmallVec<[(World, bool); 2]> {
        let state = place.draw.multisample.sample_coverage;
        // The step is skipped without several samples.
        let Some(SampleCoverage { value, invert }) = state.filter(|_| place.at.samples > 1) else {
            return smallvec![(world, true)];
        };
        let decision = Decision::SampleCoverage {
            value: value.to_bits(),
        };
        let known = match value {
            _ if value <= 0.0 => Some(false),
            _ if value >= 1.0 => Some(true),
            _ => world.decided(decision),
        };
        notes.add(
            || place.name(),
            "sample coverage",
            || {
                let sample = place.at.sample;
                let word = match known.map(|covered| covered != invert) {
                    Some(true) => "is drawn",
                    Some(false) => "is not drawn",
                    None => "may or may not be drawn",
                };
                let of = if invert { "inverted " } else { "" };
                format!("by the {of}share {value}, sample {sample} {word}")
            },
            Some(Rules::sample_coverage(self.limits)),
        );
        match known {
            Some(covered) => smallvec![(world, covered != invert)],
            None => [true, false]
                .map(|covered| (world.with(decision, covered), covered != invert))
                .into_iter()
                .collect(),
        }
    }
}
