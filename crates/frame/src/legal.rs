//! Legal sets: what the rules allow at each sample of each image.

use crate::counter::CounterSet;
use crate::encoding::ChannelEncoding;
use crate::format::Aspect;
use crate::image::{Image, ReadPath};
use rustc_hash::FxHashMap;
use smallvec::SmallVec;
use std::num::NonZeroU64;

/// A closed interval of code orders (see [`ChannelEncoding`]); never empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CodeInterval {
    /// The smallest order.
    pub low: i64,
    /// The largest order.
    pub high: i64,
}

impl CodeInterval {
    /// Returns the interval between two orders.
    ///
    /// # Panics
    /// If `low` is above `high`: an empty set of legal values is a bug of the reference.
    pub fn new(low: i64, high: i64) -> Self {
        assert!(low <= high, "empty code interval {low}..={high}");
        Self { low, high }
    }

    /// Returns the interval of one order.
    pub fn exact(order: i64) -> Self {
        Self {
            low: order,
            high: order,
        }
    }

    /// Returns true if the order is inside.
    pub fn contains(self, order: i64) -> bool {
        self.low <= order && order <= self.high
    }

    /// Returns true if the interval is a single order.
    pub fn is_exact(self) -> bool {
        self.low == self.high
    }

    /// Returns the number of orders inside.
    pub fn count(self) -> u64 {
        (self.high - self.low) as u64 + 1
    }

    /// Returns the smallest interval that contains both.
    pub fn hull(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }
}

/// The outcome of one consistent history: an interval per channel of a [`SampleGroup`].
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct WorldBox {
    /// Channel intervals in the order of the group's channels.
    pub channels: SmallVec<[CodeInterval; 6]>,
}

impl WorldBox {
    /// Returns the number of channels in which a sample is outside.
    pub fn violations(&self, orders: &[i64]) -> usize {
        self.channels
            .iter()
            .zip(orders)
            .filter(|(interval, order)| !interval.contains(**order))
            .count()
    }
}

/// The legal values of one sample: the values in any of these boxes. An empty list means *open*: nothing is
/// asserted.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct TexelSet {
    /// The boxes, sorted and without repetition.
    pub worlds: Vec<WorldBox>,
    /// The number of everything that the colours are computed from, if it is known exactly: samples with the same
    /// number must have the same colours.
    pub operands: Option<NonZeroU64>,
}

impl TexelSet {
    /// Returns true if nothing is asserted.
    pub fn is_open(&self) -> bool {
        self.worlds.is_empty()
    }

    /// Returns true if a sample is legal.
    pub fn allows(&self, orders: &[i64]) -> bool {
        self.is_open() || self.worlds.iter().any(|w| w.violations(orders) == 0)
    }

    /// Returns the box that a sample violates in the fewest channels.
    pub fn nearest(&self, orders: &[i64]) -> Option<&WorldBox> {
        self.worlds.iter().min_by_key(|w| w.violations(orders))
    }

    /// Returns the hull of one channel over all boxes; `None` if the set is open.
    pub fn hull(&self, channel: usize) -> Option<CodeInterval> {
        self.worlds
            .iter()
            .map(|w| w.channels[channel])
            .reduce(CodeInterval::hull)
    }

    /// Returns the number of codes of one channel that are in some box.
    pub fn count(&self, channel: usize) -> u64 {
        if let [world] = &self.worlds[..] {
            return world.channels[channel].count();
        }
        let mut intervals: Vec<CodeInterval> =
            self.worlds.iter().map(|w| w.channels[channel]).collect();
        intervals.sort_unstable();
        let mut total = 0;
        let mut reached = i64::MIN;
        for interval in intervals {
            let low = interval.low.max(reached.saturating_add(1));
            if low <= interval.high {
                total += CodeInterval::new(low, interval.high).count();
                reached = interval.high;
            }
        }
        total
    }
}

/// One image of a legal set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageInfo {
    /// The attachment's name.
    pub attachment: String,
    /// The aspect.
    pub aspect: Aspect,
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Samples per texel.
    pub samples: u32,
    /// Channel encodings as read back.
    pub channels: Vec<ChannelEncoding>,
    /// The way the image must have been read.
    pub read: ReadPath,
    /// The index of the [`SampleGroup`] with the image's samples.
    pub group: usize,
    /// The image's first channel within the group.
    pub first_channel: usize,
}

impl ImageInfo {
    /// Returns true if a frame's image has this name, aspect and shape.
    pub fn matches(&self, image: &Image) -> bool {
        self.attachment == image.attachment
            && self.aspect == image.aspect
            && self.size == image.size
            && self.samples == image.samples
            && self.channels == image.channels
            && self.read == image.read
            && image.codes.len() == image.expected_len()
    }
}

/// Images of one size and sample count, whose samples are judged jointly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SampleGroup {
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Samples per texel.
    pub samples: u32,
    /// Encodings of all channels, image by image.
    pub channels: Vec<ChannelEncoding>,
    palette: Vec<TexelSet>,
    /// Runs of consecutive samples with the same set, row by row and texel by texel.
    runs: Vec<SampleRun>,
}

/// Consecutive samples with the same set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct SampleRun {
    /// The index of the first sample after the run.
    end: usize,
    /// The set's index in the palette.
    set: u32,
}

impl SampleGroup {
    /// Returns the legal values of one sample. The position must be inside the group's size.
    pub fn sample(&self, x: u32, y: u32, sample: u32) -> &TexelSet {
        let index = (y as usize * self.size[0] as usize + x as usize) * self.samples as usize
            + sample as usize;
        let run = self.runs.partition_point(|run| run.end <= index);
        &self.palette[self.runs[run].set as usize]
    }

    /// Returns the number of samples.
    pub(crate) fn len(&self) -> usize {
        self.runs.last().map_or(0, |run| run.end)
    }

    /// Returns the runs of consecutive samples with the same set, in order: the index of the first sample
    /// after the run, and the set.
    pub fn runs(&self) -> impl Iterator<Item = (usize, &TexelSet)> {
        let set = |run: &SampleRun| &self.palette[run.set as usize];
        self.runs.iter().map(move |run| (run.end, set(run)))
    }

    /// Returns the column, the row and the sample within the texel of a sample, by its index.
    pub fn position(&self, index: usize) -> [u32; 3] {
        let texel = index / self.samples as usize;
        let width = self.size[0] as usize;
        // Each part fits, since the index was made from unsigned 32-bit numbers.
        [texel % width, texel / width, index % self.samples as usize].map(|n| n as u32)
    }

    /// Returns the distinct sets, each with the number of samples that have it.
    pub fn distinct(&self) -> Vec<(&TexelSet, u64)> {
        let mut counts = vec![0_u64; self.palette.len()];
        let mut start = 0;
        for run in &self.runs {
            counts[run.set as usize] += (run.end - start) as u64;
            start = run.end;
        }
        self.palette.iter().zip(counts).collect()
    }
}

/// The legal values of a whole frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LegalSet {
    /// The images, in the order of the scene's `read` list.
    pub images: Vec<ImageInfo>,
    /// The groups they belong to.
    pub groups: Vec<SampleGroup>,
    /// The counters, in the order of the scene's.
    pub counters: Vec<CounterSet>,
    statistics: Vec<(Aspect, AspectStatistics)>,
}

/// The part of one aspect that a legal set asserts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AspectStatistics {
    /// The number of channel values in all samples of the aspect.
    pub channels: u64,
    /// The number of channel values about which something is asserted.
    pub asserted: u64,
    /// The number of channel values with exactly one legal code.
    pub exact: u64,
    /// The number of legal codes, summed over the asserted channel values.
    pub codes: u64,
}

impl AspectStatistics {
    /// Adds another image's or case's figures.
    pub fn add(&mut self, other: Self) {
        self.channels += other.channels;
        self.asserted += other.asserted;
        self.exact += other.exact;
        self.codes = self.codes.saturating_add(other.codes);
    }
}

impl LegalSet {
    /// Returns the figures per aspect, in the order colour, depth, stencil; aspects that are not read are
    /// absent.
    pub fn statistics(&self) -> &[(Aspect, AspectStatistics)] {
        &self.statistics
    }

    /// Returns the figures per aspect of complete images and groups.
    fn count(images: &[ImageInfo], groups: &[SampleGroup]) -> Vec<(Aspect, AspectStatistics)> {
        let mut result: Vec<(Aspect, AspectStatistics)> = Vec::new();
        for image in images {
            let group = &groups[image.group];
            let mut sum = AspectStatistics::default();
            for (set, times) in group.distinct() {
                for (i, encoding) in image.channels.iter().enumerate() {
                    let range = CodeInterval::new(encoding.min_order(), encoding.max_order());
                    let codes = set.count(image.first_channel + i);
                    sum.channels += times;
                    if !set.is_open() && codes < range.count() {
                        sum.asserted += times;
                        sum.codes = sum.codes.saturating_add(codes.saturating_mul(times));
                        sum.exact += if codes == 1 { times } else { 0 };
                    }
                }
            }
            match result
                .iter_mut()
                .find(|(aspect, _)| *aspect == image.aspect)
            {
                Some((_, total)) => total.add(sum),
                None => result.push((image.aspect, sum)),
            }
        }
        result.sort_by_key(|(aspect, _)| *aspect);
        result
    }

    /// Returns the approximate size of the set in bytes, for cache limits.
    pub fn weight(&self) -> usize {
        self.groups
            .iter()
            .map(|g| {
                g.runs.len() * size_of::<SampleRun>()
                    + g.palette
                        .iter()
                        .map(|t| 32 + t.worlds.len() * 128)
                        .sum::<usize>()
            })
            .sum()
    }
}

/// Builds a [`LegalSet`]: images first, then every group's samples in storage order.
#[derive(Debug, Default)]
pub struct LegalSetBuilder {
    images: Vec<ImageInfo>,
    groups: Vec<SampleGroup>,
    interned: Vec<FxHashMap<TexelSet, u32>>,
    counters: Vec<CounterSet>,
}

impl LegalSetBuilder {
    /// Adds an image to the group of its size and sample count. Returns the group.
    pub fn image(
        &mut self,
        attachment: &str,
        aspect: Aspect,
        size: [u32; 2],
        samples: u32,
        channels: &[ChannelEncoding],
        read: ReadPath,
    ) -> usize {
        let group = self
            .groups
            .iter()
            .position(|g| g.size == size && g.samples == samples)
            .unwrap_or_else(|| {
                self.interned.push(FxHashMap::default());
                self.groups.push(SampleGroup {
                    size,
                    samples,
                    channels: Vec::new(),
                    palette: Vec::new(),
                    runs: Vec::new(),
                });
                self.groups.len() - 1
            });
        self.images.push(ImageInfo {
            attachment: attachment.to_owned(),
            aspect,
            size,
            samples,
            channels: channels.to_vec(),
            read,
            group,
            first_channel: self.groups[group].channels.len(),
        });
        self.groups[group].channels.extend_from_slice(channels);
        group
    }

    /// Returns the number of groups.
    pub fn groups(&self) -> usize {
        self.groups.len()
    }

    /// Returns the size and the sample count of a group.
    pub fn shape(&self, group: usize) -> ([u32; 2], u32) {
        let group = &self.groups[group];
        (group.size, group.samples)
    }

    /// Returns the index of a set in a group's palette, and adds the set if it is new.
    pub fn set(&mut self, group: usize, mut set: TexelSet) -> u32 {
        set.worlds.sort_unstable();
        set.worlds.dedup();
        let interned = &mut self.interned[group];
        let next = interned.len() as u32;
        *interned.entry(set).or_insert(next)
    }

    /// Adds the next `count` samples of a group, which have the set with this index.
    pub fn samples(&mut self, group: usize, set: u32, count: usize) {
        let group = &mut self.groups[group];
        let end = group.len() + count;
        match group.runs.last_mut() {
            _ if count == 0 => {}
            Some(last) if last.set == set => last.end = end,
            _ => group.runs.push(SampleRun { end, set }),
        }
    }

    /// Adds a counter.
    pub fn counter(&mut self, counter: CounterSet) {
        self.counters.push(counter);
    }

    /// Returns the finished set.
    ///
    /// # Panics
    /// If a group has too few or too many samples: a bug of the judge.
    pub fn build(mut self) -> LegalSet {
        for (group, interned) in self.groups.iter_mut().zip(self.interned) {
            let mut sets: Vec<(TexelSet, u32)> = interned.into_iter().collect();
            sets.sort_unstable_by_key(|(_, number)| *number);
            group.palette = sets.into_iter().map(|(set, _)| set).collect();
        }
        for group in &self.groups {
            let expected = group.size[0] as usize * group.size[1] as usize * group.samples as usize;
            assert_eq!(group.len(), expected, "a group's samples are not complete");
        }
        LegalSet {
            statistics: LegalSet::count(&self.images, &self.groups),
            images: self.images,
            groups: self.groups,
            counters: self.counters,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(boxes: &[&[(i64, i64)]]) -> TexelSet {
        TexelSet {
            worlds: boxes
                .iter()
                .map(|b| WorldBox {
                    channels: b.iter().map(|(l, h)| CodeInterval::new(*l, *h)).collect(),
                })
                .collect(),
            operands: None,
        }
    }

    #[test]
    fn codes_in_overlapping_boxes_count_once() {
        let s = set(&[&[(0, 3)], &[(2, 5)], &[(9, 9)]]);
        assert_eq!(s.count(0), 7);
    }

    #[test]
    fn a_texel_must_lie_in_one_box_as_a_whole() {
        let s = set(&[&[(0, 0), (0, 0)], &[(255, 255), (9, 9)]]);
        assert!(s.allows(&[0, 0]));
        assert!(s.allows(&[255, 9]));
        assert!(!s.allows(&[255, 0]));
        assert_eq!(s.nearest(&[255, 8]).map(|w| w.channels[1].low), Some(9));
    }

    #[test]
    fn samples_are_found_in_runs() {
        let mut builder = LegalSetBuilder::default();
        let unorm = ChannelEncoding::Unorm(8);
        builder.image("c", Aspect::Color, [3, 2], 2, &[unorm], ReadPath::Copy);
        let numbers = [0, 7].map(|code| builder.set(0, set(&[&[(code, code)]])));
        for (number, count) in [(0, 1), (0, 2), (1, 0), (1, 4), (0, 1), (1, 4)] {
            builder.samples(0, numbers[number], count);
        }
        let group = &builder.build().groups[0];
        let low = |x, y, sample| group.sample(x, y, sample).worlds[0].channels[0].low;
        let positions = (0..12).map(|index| group.position(index));
        let values: Vec<i64> = positions.map(|[x, y, sample]| low(x, y, sample)).collect();
        assert_eq!(values, [0, 0, 0, 7, 7, 7, 7, 0, 7, 7, 7, 7]);
        assert_eq!(group.runs().count(), 4);
        let times: Vec<u64> = group.distinct().iter().map(|(_, times)| *times).collect();
        assert_eq!(times, [4, 8]);
    }

    #[test]
    fn a_set_of_everything_is_not_asserted() {
        let mut builder = LegalSetBuilder::default();
        let unorm = ChannelEncoding::Unorm(8);
        builder.image("c", Aspect::Color, [2, 1], 1, &[unorm], ReadPath::Copy);
        for allowed in [set(&[&[(0, 255)]]), set(&[&[(7, 8)]])] {
            let number = builder.set(0, allowed);
            builder.samples(0, number, 1);
        }
        let (_, figures) = builder.build().statistics()[0];
        assert_eq!((figures.channels, figures.asserted), (2, 1));
        assert_eq!((figures.exact, figures.codes), (0, 2));
    }
}
