//! What a shader sees of its textures: single texels, or a sampler's weighted average.

use crate::interval::Interval;
use crate::judge::{Place, Walk};
use crate::judging::{Judging, Range};
use etalon_case::scene::{Attachment, Contents};
use etalon_case::state::{AddressMode, FilterMode, Sampler};
use etalon_frame::CodeInterval;
use etalon_pipeline::{Arithmetic, texel_position};

impl Walk<'_> {
    /// What the shader sees of a texture at the sample.
    pub(crate) fn texel(&self, place: Place<'_>, t: usize) -> [Range; 4] {
        let Some(index) = place.draw.textures.get(t) else {
            return [Range::exact(0.0); 4];
        };
        let texture = &self.scene.attachments[*index];
        match (place.draw.sampler, place.primitive.uv(place.point)) {
            (Some(sampler), Some(uv)) => self.sampled(texture, sampler, uv),
            _ => self.fetched(texture, place.at.x as usize, place.at.y as usize),
        }
    }

    /// One texel. A format without alpha is read with alpha 1.
    fn fetched(&self, texture: &Attachment, x: usize, y: usize) -> [Range; 4] {
        let mut judging = Judging::new(self.rules);
        let mut texel = [0.0, 0.0, 0.0, 1.0].map(Range::exact);
        if let Contents::Texels(codes) = &texture.contents {
            let encodings = texture.format.color_channels();
            let start = (y * texture.size[0] as usize + x) * encodings.len();
            for (c, encoding) in encodings.iter().enumerate() {
                let order = encoding.order_of_code(codes[start + c]);
                texel[c] = judging.decode(*encoding, CodeInterval::exact(order));
            }
        }
        texel
    }

    /// Everything that legal filtering makes of the texels around a coordinate: the hull of what it
    /// is at all coordinates that rounding can lead to. In a linear filter that is a polynomial linear
    /// in each coordinate between two texel centres, so its extremes stand at ends and centres.
    fn sampled(&self, texture: &Attachment, sampler: Sampler, uv: [Interval; 2]) -> [Range; 4] {
        let step = self.rules.filter_step.value;
        let along = |axis: usize| -> Vec<f64> {
            let size = texture.size[axis];
            let scaled = uv[axis].map_increasing(|v| v * f64::from(size));
            let reach = scaled.widen(step);
            match sampler.filter {
                // Which texel is nearest changes at whole numbers.
                FilterMode::Nearest => whole(reach.low.floor(), reach.high.floor(), size),
                FilterMode::Linear => {
                    let (low, high) = (reach.low - 0.5, reach.high - 0.5);
                    let mut stops = whole(low.ceil(), high.floor(), size);
                    stops.extend([low, high]);
                    stops
                }
            }
        };
        let (across, down) = (along(0), along(1));
        let mut result: Option<[Interval; 4]> = None;
        for y in &down {
            for x in &across {
                let one = match sampler.filter {
                    FilterMode::Nearest => self.tap(texture, sampler, [*x as i64, *y as i64]),
                    FilterMode::Linear => self.weighted(texture, sampler, [*x, *y]),
                };
                result = Some(match result {
                    None => one,
                    Some(all) => std::array::from_fn(|c| all[c].hull(one[c])),
                });
            }
        }
        result.map_or([Range::exact(0.0); 4], |all| all.map(Range::same))
    }

    fn tap(&self, texture: &Attachment, sampler: Sampler, at: [i64; 2]) -> [Interval; 4] {
        let inside = |axis: usize| {
            let mode: AddressMode = sampler.address[axis];
            texel_position(mode, at[axis], texture.size[axis])
        };
        self.fetched(texture, inside(0), inside(1))
            .map(|channel| channel.float.hull(channel.coarse))
    }

    /// The average at a position counted from the centre of the first texel.
    fn weighted(&self, texture: &Attachment, sampler: Sampler, at: [f64; 2]) -> [Interval; 4] {
        let first = at.map(f64::floor);
        let weight = [at[0] - first[0], at[1] - first[1]];
        let mut sum = [Interval::exact(0.0); 4];
        let mut largest: f64 = 0.0;
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let part = |axis: usize, far: i64| match far {
                0 => 1.0 - weight[axis],
                _ => weight[axis],
            };
            let share = part(0, dx) * part(1, dy);
            let position = [first[0] as i64 + dx, first[1] as i64 + dy];
            for (sum, tap) in sum.iter_mut().zip(self.tap(texture, sampler, position)) {
                largest = largest.max(tap.low.abs()).max(tap.high.abs());
                let scaled = tap.map_increasing(|v| v * share);
                *sum = sum.corners(scaled, |a, b| a + b);
            }
        }
        sum.map(|sum| sum.widen(largest * self.rules.float_error.value * 4.0))
    }
}

/// The whole numbers from one to another, no more than go twice around the texture: after that all
/// texels have been met.
fn whole(low: f64, high: f64, size: u32) -> Vec<f64> {
    let most = 2 * size as usize + 1;
    std::iter::successors(Some(low), |v| Some(v + 1.0))
        .take_while(|v| *v <= high)
        .take(most)
        .collect()
}
