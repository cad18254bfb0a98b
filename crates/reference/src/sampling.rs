//! Textures as a shader reads them: single texels, or a sampler's weighted average.

use crate::interval::Interval;
use crate::judging::Judging;
use crate::range::Range;
use crate::rounding::to_codes;
use crate::sample::Sample;
use crate::walk::{FragmentPlace, Walk};
use crate::world::World;
use etalon_frame::{Aspect, ChannelEncoding, CodeInterval};
use etalon_pipeline::{Arithmetic, texel_position};
use etalon_scene::{AddressMode, FilterMode, InterpolationSampling, Sampler};
use smallvec::SmallVec;

/// A texture as a sampler sees it.
#[derive(Clone, Copy)]
struct SampledTexture {
    /// The attachment.
    index: usize,
    /// The reading pass, if an earlier pass drew to the texture.
    pass: Option<usize>,
}

/// The texels that one coordinate has reached, before addressing.
type ReachedTexels = SmallVec<[([i64; 2], [Range; 4]); 4]>;

/// The maximum number of texels of a drawn texture that one coordinate can reach; beyond it, any result is
/// legal.
const MOST_DRAWN_TEXELS: usize = 9;

impl Walk<'_> {
    /// Returns the value that the shader reads from a texture at the sample, in a world.
    pub(crate) fn texel(&self, place: &FragmentPlace<'_>, world: &World, t: usize) -> [Range; 4] {
        let Some(index) = place.draw.textures.get(t).copied() else {
            return [Range::exact(0.0); 4];
        };
        let drawn = self.is_drawn_before(index, place.pass);
        if self.scene.passes[place.pass].attaches(index) {
            return self.left_at_sample(place, world, index);
        }
        match (place.draw.sampler, self.coordinates(place)) {
            (Some(sampler), Some(uv)) => {
                let texture = SampledTexture {
                    index,
                    pass: drawn.then_some(place.pass),
                };
                // Linear filtering of a drawn texture, which combines four texels, is not modelled.
                match sampler.filter {
                    FilterMode::Linear if drawn => self.anything(index),
                    _ => self
                        .sampled(texture, sampler, uv)
                        .unwrap_or_else(|| self.anything(index)),
                }
            }
            _ if drawn => self.left_before(place, world, index),
            _ => self.fetched(index, [place.at.x as usize, place.at.y as usize]),
        }
    }

    /// Returns the texture coordinates that the shader reads.
    pub(crate) fn uv(&self, place: &FragmentPlace<'_>) -> [Range; 2] {
        self.coordinates(place)
            .map_or([Range::exact(0.0); 2], |uv| uv.map(Range::same))
    }

    fn coordinates(&self, place: &FragmentPlace<'_>) -> Option<[Interval; 2]> {
        let samples = self.samples_shaded(place);
        let mut sampling = place.draw.shader.interpolation_sampling();
        if sampling == InterpolationSampling::Sample
            && self.anywhere(samples).is_some()
            && !self.rules.inputs_at_samples.value()
        {
            // At a position of the sample that is not known, inside the primitive.
            sampling = InterpolationSampling::Centroid;
        }
        place
            .primitive
            .uv_seen(place.point, self.units, samples, sampling)
    }

    /// Returns true if an earlier pass draws or resolves to an attachment.
    pub(crate) fn is_drawn_before(&self, index: usize, pass: usize) -> bool {
        self.scene.passes[..pass]
            .iter()
            .any(|pass| pass.color.contains(&index) || pass.resolve.contains(&Some(index)))
    }

    /// Returns the result of sampling a texture whose texels are not modelled.
    pub(crate) fn anything(&self, index: usize) -> [Range; 4] {
        let encodings = self.scene.attachments[index].format.color_channels();
        let slack = self.rules.float_error.value() * 4.0;
        let mut texel = [0.0, 0.0, 0.0, 1.0].map(|v| Range::same(Interval::exact(v).widen(slack)));
        for (channel, encoding) in texel.iter_mut().zip(encodings) {
            *channel = Range::same(match encoding.normalized_range() {
                Some((low, high)) => Interval {
                    low: f64::from(low),
                    high: f64::from(high),
                }
                .widen(slack),
                None => Interval::EVERYTHING,
            });
        }
        texel
    }

    /// Returns the texel under the sample after earlier passes: this world's contents if the shapes agree,
    /// otherwise everything that it can contain.
    fn left_before(&self, place: &FragmentPlace<'_>, world: &World, index: usize) -> [Range; 4] {
        let attachment = &self.scene.attachments[index];
        let at = place.at;
        if attachment.size != at.size {
            return self.anything(index);
        }
        if attachment.samples == at.samples {
            return self.left_at_sample(place, world, index);
        }
        let at = Sample {
            samples: attachment.samples,
            sample: 0,
            ..at
        };
        let contents = self.contents_before(index, at, place.pass);
        contents.unwrap_or_else(|| self.anything(index))
    }

    /// Returns the contents of an attachment at the sample, as this world has them when the fragment is shaded.
    fn left_at_sample(&self, place: &FragmentPlace<'_>, world: &World, index: usize) -> [Range; 4] {
        let cell = &world.cells[index];
        let red = match place.draw.aspect_read(self.scene.attachments[index].format) {
            Aspect::Color => return self.decoded(index, cell.channels()),
            Aspect::Depth => {
                Judging::new(self.rules).decode(self.depth_encoding(index), cell.channel(0))
            }
            Aspect::Stencil => Range::exact(f64::from(cell.stencil)),
        };
        let [none, one] = [0.0, 1.0].map(Range::exact);
        [red, none, none, one]
    }

    /// Returns everything that a sample of a texture can contain after earlier passes; `None` if that is
    /// unknown.
    fn contents_before(&self, index: usize, at: Sample, pass: usize) -> Option<[Range; 4]> {
        let worlds = self.earlier(at, pass)?;
        let contents = worlds.iter().map(|w| w.cells[index].channels());
        let hull = contents.reduce(|a, b| std::array::from_fn(|c| a[c].hull(b[c])))?;
        Some(self.decoded(index, hull))
    }

    /// Returns one texel of a texture that no pass drew to.
    fn fetched(&self, index: usize, at: [usize; 2]) -> [Range; 4] {
        self.decoded(index, self.first_contents(index, at).channels())
    }

    /// Returns the value of stored codes. A format without alpha is read with alpha 1.
    fn decoded(&self, index: usize, codes: [CodeInterval; 4]) -> [Range; 4] {
        let mut judging = Judging::new(self.rules);
        let mut texel = [0.0, 0.0, 0.0, 1.0].map(Range::exact);
        let encodings = self.scene.attachments[index].format.color_channels();
        for (c, encoding) in encodings.iter().enumerate() {
            texel[c] = judging.decode(*encoding, codes[c]);
        }
        texel
    }

    /// Returns all results of legal filtering at a coordinate: the hull over all coordinates that rounding
    /// can lead to; `None` if a texel among them can contain anything. A linear filter is linear in each
    /// coordinate between two texel centres, so its extremes are at ends and centres.
    fn sampled(
        &self,
        texture: SampledTexture,
        sampler: Sampler,
        uv: [Interval; 2],
    ) -> Option<[Range; 4]> {
        if uv
            .iter()
            .any(|v| !(v.low.is_finite() && v.high.is_finite()))
        {
            return None;
        }
        let texels = self.scene.attachments[texture.index].size;
        let step = self.rules.filter_step.value();
        let along = |axis: usize| -> Vec<f64> {
            let size = texels[axis];
            let scaled = uv[axis].map_increasing(|v| v * f64::from(size));
            let reach = scaled.widen(step);
            match sampler.filter {
                // The nearest texel changes at integers.
                FilterMode::Nearest => integers(reach.low.floor(), reach.high.floor(), size),
                FilterMode::Linear => {
                    let (low, high) = (reach.low - 0.5, reach.high - 0.5);
                    let mut stops = integers(low.ceil(), high.floor(), size);
                    stops.extend([low, high]);
                    stops
                }
            }
        };
        let (across, down) = (along(0), along(1));
        if texture.pass.is_some() && across.len() * down.len() > MOST_DRAWN_TEXELS {
            return None;
        }
        let mut result: Option<[Range; 4]> = None;
        let mut taps = ReachedTexels::new();
        for y in &down {
            for x in &across {
                let value = match sampler.filter {
                    FilterMode::Nearest => {
                        let at = [*x as i64, *y as i64];
                        let texel = self.tap(texture, sampler, at, &mut taps)?;
                        texel.map(|c| Range::same(c.hull()))
                    }
                    FilterMode::Linear => self.weighted(texture, sampler, [*x, *y], &mut taps)?,
                };
                result = Some(match result {
                    None => value,
                    Some(hull) => std::array::from_fn(|c| hull[c].zip(value[c], Interval::hull)),
                });
            }
        }
        Some(result.unwrap_or([Range::exact(0.0); 4]))
    }

    fn tap(
        &self,
        texture: SampledTexture,
        sampler: Sampler,
        at: [i64; 2],
        taps: &mut ReachedTexels,
    ) -> Option<[Range; 4]> {
        if let Some((_, texel)) = taps.iter().find(|(known, _)| *known == at) {
            return Some(*texel);
        }
        let index = texture.index;
        let inside = |axis: usize| {
            let mode: AddressMode = sampler.address[axis];
            texel_position(mode, at[axis], self.scene.attachments[index].size[axis])
        };
        let texel = [inside(0), inside(1)];
        let texel = match texture.pass {
            None => self.fetched(index, texel),
            Some(pass) => self.drawn(index, texel, pass)?,
        };
        taps.push((at, texel));
        Some(texel)
    }

    /// Returns everything that a texel of a texture can contain after earlier passes; `None` if that is
    /// unknown.
    fn drawn(&self, index: usize, [x, y]: [usize; 2], pass: usize) -> Option<[Range; 4]> {
        let attachment = &self.scene.attachments[index];
        let (x, y) = (x as u32, y as u32);
        // Away from the judged texels, not all primitives are set up.
        if attachment.samples != 1 || !self.texels.contains(attachment.size, x, y) {
            return None;
        }
        let at = Sample {
            size: attachment.size,
            samples: 1,
            x,
            y,
            sample: 0,
        };
        self.contents_before(index, at, pass)
    }

    /// Returns the linearly filtered value at a position relative to the centre of the first texel: computed in
    /// floats, and, if the rules allow it, in steps that are rounded to codes.
    fn weighted(
        &self,
        texture: SampledTexture,
        sampler: Sampler,
        at: [f64; 2],
        taps: &mut ReachedTexels,
    ) -> Option<[Range; 4]> {
        let first = at.map(f64::floor);
        let weight = [at[0] - first[0], at[1] - first[1]];
        let mut sum = [Interval::exact(0.0); 4];
        let mut largest: f64 = 0.0;
        // The averages along one axis, for the rows and then for the columns.
        let mut lines = [[[Interval::exact(0.0); 4]; 2]; 2];
        let part = |axis: usize, far: i64| match far {
            0 => 1.0 - weight[axis],
            _ => weight[axis],
        };
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let share = part(0, dx) * part(1, dy);
            let position = [
                (first[0] as i64).saturating_add(dx),
                (first[1] as i64).saturating_add(dy),
            ];
            let texel = self.tap(texture, sampler, position, taps)?;
            for (c, texel) in texel.into_iter().enumerate() {
                let tap = texel.hull();
                largest = largest.max(tap.low.abs()).max(tap.high.abs());
                sum[c] = sum[c].plus(tap.map_increasing(|v| v * share));
                for (axis, [near, far]) in [[dx, dy], [dy, dx]].into_iter().enumerate() {
                    let line = &mut lines[axis][far as usize][c];
                    let weight = part(axis, near);
                    *line = line.plus(texel.codes.map_increasing(|v| v * weight));
                }
            }
        }
        let floats = sum.map(|sum| sum.widen(largest * self.rules.float_error.value() * 4.0));
        let mut ranges = floats.map(Range::same);
        let encodings = self.scene.attachments[texture.index]
            .format
            .color_channels();
        for (c, (range, encoding)) in ranges.iter_mut().zip(encodings).enumerate() {
            let normalized = matches!(
                encoding,
                ChannelEncoding::Unorm(_) | ChannelEncoding::Snorm(_)
            );
            if normalized && self.rules.filters_to_codes.value() {
                let stepped = |axis: usize| {
                    let [near, far] = [0, 1].map(|line| {
                        let line_of = to_codes(*encoding, lines[axis][line][c]);
                        line_of.map_increasing(|v| v * part(1 - axis, line as i64))
                    });
                    to_codes(*encoding, near.plus(far))
                };
                let codes = stepped(0).hull(stepped(1));
                *range = Range {
                    float: range.float,
                    ..Range::same(codes)
                };
            }
        }
        Some(ranges)
    }
}

/// Returns the integers between two numbers, but at most twice the texture's size, which is enough to reach
/// every texel.
fn integers(low: f64, high: f64, size: u32) -> Vec<f64> {
    let most = 2 * size as usize + 1;
    std::iter::successors(Some(low), |v| Some(v + 1.0))
        .take_while(|v| *v <= high)
        .take(most)
        .collect()
}
