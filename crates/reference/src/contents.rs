//! Contents of attachments that no draw wrote: initial contents and resolves.

use crate::interval::Interval;
use crate::judging::Judging;
use crate::notes::{Note, Notes};
use crate::range::Range;
use crate::rules::Resolve;
use crate::sample::Sample;
use crate::walk::Walk;
use crate::world::{SampleContents, World};
use etalon_frame::{Aspect, ChannelEncoding, CodeInterval, Codes, Origin, ResolveChoice, Step};
use etalon_pipeline::Arithmetic;
use etalon_scene::AttachmentContents;

/// The sum of a channel over the samples of a texel.
#[derive(Clone, Copy)]
struct ChannelSum {
    /// The least and the greatest code of a sample; `None` before the first.
    between: Option<CodeInterval>,
    /// The sum of the values.
    value: Interval,
    /// The sum of the codes.
    codes: Interval,
}

impl ChannelSum {
    const NOTHING: Self = Self {
        between: None,
        value: Interval::exact(0.0),
        codes: Interval::exact(0.0),
    };

    fn add(&mut self, codes: CodeInterval, value: Interval) {
        self.between = Some(self.between.map_or(codes, |between| between.hull(codes)));
        self.value = self.value.plus(value);
        self.codes.low += codes.low as f64;
        self.codes.high += codes.high as f64;
    }

    fn between(&self) -> CodeInterval {
        self.between.unwrap_or(CodeInterval::exact(0))
    }

    /// Returns the codes, within the range of the samples' codes, that a chain of rounded halvings can give.
    fn within_halvings(&self, codes: Interval, samples: u32) -> CodeInterval {
        let (between, halvings) = (self.between(), halvings(samples));
        CodeInterval {
            low: ((codes.low - halvings).floor() as i64).clamp(between.low, between.high),
            high: ((codes.high + halvings).ceil() as i64).clamp(between.low, between.high),
        }
    }

    fn average_of_codes(&self, samples: u32) -> CodeInterval {
        let count = f64::from(samples);
        self.within_halvings(self.codes.map_increasing(|v| v / count), samples)
    }
}

/// Returns the number of steps in which samples are averaged in pairs.
fn halvings(samples: u32) -> f64 {
    f64::from(samples.max(1).ilog2())
}

impl Walk<'_> {
    /// Returns the values that a texel can be resolved to after the first passes; `None` if a sample is open.
    /// An average is the hull over samples and worlds, never their product. Integers resolve to one of the
    /// samples (OpenGL 4.6, 18.3.1); in Vulkan's render passes, to the first.
    pub(crate) fn resolve(
        &self,
        source: usize,
        target: usize,
        at: Sample,
        passes: usize,
        notes: &mut Notes<'_>,
    ) -> Option<Vec<[CodeInterval; 4]>> {
        let attachment = &self.scene.attachments[source];
        let mut single: Vec<[CodeInterval; 4]> = Vec::new();
        let encodings = attachment.format.color_channels();
        let mut sums = [ChannelSum::NOTHING; 4];
        for sample in 0..attachment.samples {
            let at = Sample {
                samples: attachment.samples,
                sample,
                ..at
            };
            let worlds = self.earlier(at, passes)?;
            if sample == 0 || !self.rules.resolve.value().takes_first() {
                single.extend(worlds.iter().map(|w| w.cells[source].channels()));
            }
            for (c, encoding) in encodings.iter().enumerate() {
                let intervals = worlds.iter().map(|w| w.cells[source].channel(c));
                if let Some(codes) = intervals.reduce(CodeInterval::hull) {
                    let value = Judging::new(self.rules).decode(*encoding, codes).float;
                    sums[c].add(codes, value);
                }
            }
        }
        if attachment.format.is_integer() {
            single.sort_unstable();
            single.dedup();
            let by = match self.rules.resolve.value() {
                rule if rule.takes_first() => ResolveChoice::First,
                _ => ResolveChoice::Any,
            };
            self.note_resolve(notes, [source, target], passes, by, [&single, &single]);
            return Some(single);
        }
        let mut result = [CodeInterval::exact(0); 4];
        // The averages of the codes themselves, as from implementations that do not convert sRGB to linear
        // values.
        let mut of_codes = result;
        for (c, encoding) in encodings.iter().enumerate() {
            let linear = self.average_color(*encoding, &sums[c], attachment.samples);
            result[c] = linear;
            of_codes[c] = if *encoding == ChannelEncoding::Srgb8 {
                sums[c].average_of_codes(attachment.samples)
            } else {
                linear
            };
        }
        let mut results = vec![result];
        if self.rules.resolve.value() == Resolve::CoarseAverage && of_codes != result {
            results.push(of_codes);
        }
        single.dedup();
        let by = ResolveChoice::Average;
        self.note_resolve(notes, [source, target], passes, by, [&single, &results]);
        Some(results)
    }

    /// Returns the codes that samples with this sum can resolve to.
    fn average_color(
        &self,
        encoding: ChannelEncoding,
        sum: &ChannelSum,
        samples: u32,
    ) -> CodeInterval {
        let mut judging = Judging::new(self.rules);
        let between = sum.between();
        let count = f64::from(samples);
        // The error is relative to the samples, not to their sum, which can be a small difference of large
        // values.
        let values = [between.low, between.high].map(|o| encoding.value_of_order(o).abs());
        let error = values[0].max(values[1]) * count * self.rules.float_error.value();
        // An interval that includes NaN has no usable ends.
        let exact = if sum.value.may_be_nan() {
            Interval::EVERYTHING
        } else {
            sum.value.map_increasing(|v| v / count).widen(error)
        };
        let average = judging.encode(encoding, Range::same(exact));
        match self.rules.resolve.value() {
            // The two least codes of a signed normalized integer have the same value, and the second is
            // stored.
            _ if between.is_exact() && !encoding.is_float() => {
                between.hull(canonical(encoding, between.low))
            }
            _ if exact.may_be_nan() && encoding.is_float() => average,
            Resolve::Between | Resolve::BetweenOrFirst if encoding.is_float() => {
                between.hull(average)
            }
            Resolve::Between | Resolve::BetweenOrFirst => between,
            Resolve::CoarseAverage if encoding.is_float() => {
                // The error of a halving is one code at the magnitude of the largest sample.
                let largest = between.low.abs().max(between.high.abs());
                let next = (largest + 1).min(encoding.max_order());
                let [value, past] = [largest, next].map(|o| encoding.value_of_order(o));
                let off = exact.widen((past - value) * halvings(samples));
                judging.encode(encoding, Range::same(off))
            }
            Resolve::CoarseAverage => sum.within_halvings(
                Interval {
                    low: average.low as f64,
                    high: average.high as f64,
                },
                samples,
            ),
            Resolve::Average => average,
        }
    }

    fn note_resolve(
        &self,
        notes: &mut Notes<'_>,
        [source, target]: [usize; 2],
        passes: usize,
        by: ResolveChoice,
        [samples, results]: [&[[CodeInterval; 4]]; 2],
    ) {
        notes.push(|| {
            let encodings = self.scene.attachments[source].format.color_channels();
            let codes = |sets: &[[CodeInterval; 4]]| {
                let each = sets.iter().map(|set| Codes::of_channels(encodings, *set));
                each.collect()
            };
            let into = self.target(target, Aspect::Color);
            let step = Step::Resolve {
                from: self.scene.attachments[source].name.clone(),
                to: into.attachment.clone(),
                by,
                samples: codes(samples),
                results: codes(results),
            };
            let mut stored = SampleContents::default();
            if let Some(channels) = results.first() {
                stored.set_channels(*channels);
            }
            let citation = self.rules.resolve.citation;
            Note::store(Origin::AfterPass(passes - 1), step, into, stored, citation)
        });
    }

    /// Returns the contents of a texel of an attachment before the first pass.
    pub(crate) fn first_contents(&self, index: usize, [x, y]: [usize; 2]) -> SampleContents {
        let mut judging = Judging::new(self.rules);
        let attachment = &self.scene.attachments[index];
        let encodings = attachment.format.color_channels();
        let mut cell = SampleContents::default();
        match &attachment.contents {
            AttachmentContents::Color(color) => {
                for (c, encoding) in encodings.iter().enumerate() {
                    let value = judging.constant(color[c]);
                    cell.set_channel(c, judging.encode(*encoding, value));
                }
            }
            AttachmentContents::DepthStencil { depth, stencil } => {
                let value = judging.constant(*depth);
                cell.set_channel(0, judging.encode(self.depth_encoding(index), value));
                cell.stencil = *stencil;
            }
            AttachmentContents::Texels(codes) => {
                let start = (y * attachment.size[0] as usize + x) * encodings.len();
                for (c, encoding) in encodings.iter().enumerate() {
                    let order = encoding.order_of_code(codes[start + c]);
                    cell.set_channel(c, CodeInterval::exact(order));
                }
            }
        }
        cell
    }

    pub(crate) fn initial(&self, at: Sample, notes: &mut Notes<'_>) -> World {
        let cells = self
            .scene
            .attachments
            .iter()
            .enumerate()
            .map(|(index, attachment)| {
                // The contents of an attachment of another size do not belong to this sample's story.
                let same = attachment.size == at.size;
                let place = if same { [at.x, at.y] } else { [0, 0] };
                let cell = self.first_contents(index, place.map(|v| v as usize));
                if self.has_shape(index, at) {
                    let contents = || self.all_contents(index, &cell);
                    let origin = || Origin::Attachment(attachment.name.clone());
                    match &attachment.contents {
                        AttachmentContents::Texels(_) => {
                            notes.add(origin, || Step::Upload(contents()), None)
                        }
                        _ => {
                            let citation = self.rules.store.citation;
                            notes.add(origin, || Step::Clear(contents()), Some(citation));
                        }
                    }
                }
                cell
            })
            .collect();
        World {
            cells,
            decisions: Vec::new(),
            events: Vec::new(),
        }
    }
}

/// Returns the code that the value of a code is stored as (two codes can have one value).
fn canonical(encoding: ChannelEncoding, order: i64) -> CodeInterval {
    let code = encoding.nearest_code(encoding.value_of_order(order));
    CodeInterval::exact(encoding.order_of_code(code))
}
