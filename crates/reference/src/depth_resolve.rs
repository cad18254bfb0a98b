//! Resolves of depth and stencil.
//!
//! A resolve to the first sample keeps that sample's worlds, with depth and stencil together. A least or
//! greatest depth is the hull over the worlds of all samples; a stencil value is each value that some choice
//! of worlds gives. The results contain every outcome, and so does the interval of an average.

use crate::interval::Interval;
use crate::judging::Judging;
use crate::notes::{Note, Notes};
use crate::range::Range;
use crate::rules::Resolve;
use crate::sample::Sample;
use crate::walk::Walk;
use crate::world::{SampleContents, Worlds, merge};
use etalon_frame::{Aspect, ChannelEncoding, CodeInterval, Origin, Step};
use etalon_pipeline::Arithmetic;
use etalon_scene::{DepthStencilResolve, ResolveMode};
use std::collections::BTreeSet;
use std::rc::Rc;

/// The resolved texel; `None` leaves the aspect unchanged.
type Resolved = (Option<CodeInterval>, Option<u8>);

impl Walk<'_> {
    /// Resolves depth and stencil at the end of a pass, at a sample of any attachment; `None` if the sample
    /// is open.
    pub(crate) fn resolve_depth_stencil(
        &self,
        p: usize,
        at: Sample,
        worlds: &mut Worlds,
        notes: &mut Notes<'_>,
    ) -> Option<()> {
        let pass = &self.scene.passes[p];
        let (Some(source), Some(resolve)) = (pass.depth_stencil, &pass.depth_stencil_resolve)
        else {
            return Some(());
        };
        let target = &self.scene.attachments[resolve.to];
        if (target.size, target.samples) != (at.size, at.samples) {
            return Some(());
        }
        let samples = self.scene.attachments[source].samples;
        let each = (0..samples).map(|sample| {
            let at = Sample {
                samples,
                sample,
                ..at
            };
            self.earlier(at, p + 1)
        });
        let each: Vec<Rc<Worlds>> = each.collect::<Option<_>>()?;
        let outcomes = self.outcomes(source, resolve, &each);
        *worlds = worlds
            .iter()
            .flat_map(|world| {
                outcomes.iter().map(|(depth, stencil)| {
                    let mut world = world.clone();
                    let cell = &mut world.cells[resolve.to];
                    if let Some(codes) = depth {
                        cell.set_channel(0, *codes);
                    }
                    cell.stencil = stencil.unwrap_or(cell.stencil);
                    world
                })
            })
            .collect();
        let cell = worlds.first()?.cells[resolve.to];
        self.note_depth_resolve(notes, p, (source, resolve), cell);
        merge(worlds).then_some(())
    }

    /// Returns each pair of depth and stencil that the worlds of the samples can resolve to.
    fn outcomes(
        &self,
        source: usize,
        resolve: &DepthStencilResolve,
        samples: &[Rc<Worlds>],
    ) -> BTreeSet<Resolved> {
        if [resolve.depth, resolve.stencil] == [ResolveMode::SampleZero; 2] {
            return first_cells(source, samples)
                .map(|cell| (Some(cell.channel(0)), Some(cell.stencil)))
                .collect();
        }
        let depths = self.depths(source, resolve.depth, samples);
        let stencils = stencils(source, resolve.stencil, samples);
        let pairs = depths.iter();
        pairs
            .flat_map(|depth| stencils.iter().map(|stencil| (*depth, *stencil)))
            .collect()
    }

    /// Returns the depths that the worlds of the samples can resolve to.
    fn depths(
        &self,
        source: usize,
        mode: ResolveMode,
        samples: &[Rc<Worlds>],
    ) -> BTreeSet<Option<CodeInterval>> {
        let hulls = samples.iter().filter_map(|worlds| {
            let codes = worlds.iter().map(|w| w.cells[source].channel(0));
            codes.reduce(CodeInterval::hull)
        });
        let ends = |pick: fn(i64, i64) -> i64| {
            let ends = |a: CodeInterval, b: CodeInterval| {
                CodeInterval::new(pick(a.low, b.low), pick(a.high, b.high))
            };
            [hulls.clone().reduce(ends)].into()
        };
        match mode {
            ResolveMode::None => [None].into(),
            ResolveMode::SampleZero => first_cells(source, samples)
                .map(|cell| Some(cell.channel(0)))
                .collect(),
            ResolveMode::Min => ends(i64::min),
            ResolveMode::Max => ends(i64::max),
            ResolveMode::Average => {
                let hulls: Vec<CodeInterval> = hulls.collect();
                let between = hulls.iter().copied().reduce(CodeInterval::hull);
                let average = between.map(|b| self.average(self.depth_encoding(source), &hulls, b));
                [average].into()
            }
        }
    }

    /// Returns the average of depths, with the accuracy of an average of colours.
    fn average(
        &self,
        encoding: ChannelEncoding,
        samples: &[CodeInterval],
        between: CodeInterval,
    ) -> CodeInterval {
        if between.is_exact() && !encoding.is_float() {
            return between;
        }
        let mut judging = Judging::new(self.rules);
        let values = samples.iter().map(|s| judging.decode(encoding, *s).float);
        let zero = Interval::exact(0.0);
        let sum = values.fold(zero, |sum, value| sum.plus(value));
        let count = samples.len() as f64;
        let largest = encoding.value_of_order(between.high).abs();
        let error = largest * count * self.rules.float_error.value();
        let exact = sum.map_increasing(|v| v / count).widen(error);
        let halvings = count.log2();
        let average = judging.encode(encoding, Range::same(exact));
        match self.rules.resolve.value() {
            Resolve::Average => average,
            Resolve::Between | Resolve::BetweenOrFirst => between.hull(average),
            Resolve::CoarseAverage if encoding.is_float() => {
                let next = (between.high + 1).min(encoding.max_order());
                let [value, past] = [between.high, next].map(|o| encoding.value_of_order(o));
                let off = exact.widen((past - value) * halvings);
                judging.encode(encoding, Range::same(off))
            }
            Resolve::CoarseAverage => {
                let off = |code: i64, by: f64| {
                    (code as f64 + by).clamp(between.low as f64, between.high as f64)
                };
                CodeInterval::new(
                    off(average.low, -halvings).floor() as i64,
                    off(average.high, halvings).ceil() as i64,
                )
            }
        }
    }

    fn note_depth_resolve(
        &self,
        notes: &mut Notes<'_>,
        p: usize,
        (source, resolve): (usize, &DepthStencilResolve),
        contents: SampleContents,
    ) {
        for (aspect, mode) in [
            (Aspect::Depth, resolve.depth),
            (Aspect::Stencil, resolve.stencil),
        ] {
            if mode == ResolveMode::None {
                continue;
            }
            notes.push(|| {
                let target = self.target(resolve.to, aspect);
                let step = Step::ResolveDepthStencil {
                    from: self.scene.attachments[source].name.clone(),
                    to: target.attachment.clone(),
                    mode: mode.to_string(),
                    result: self.contents(resolve.to, aspect, &contents).codes[0],
                    aspect,
                };
                let citation = self.rules.resolve.citation;
                Note::store(Origin::AfterPass(p), step, target, contents, citation)
            });
        }
    }
}

/// Returns the source's contents in the worlds of the first sample.
fn first_cells(source: usize, samples: &[Rc<Worlds>]) -> impl Iterator<Item = SampleContents> {
    let worlds = samples.first().into_iter().flat_map(|worlds| worlds.iter());
    worlds.map(move |world| world.cells[source])
}

/// Returns the stencil values that the worlds of the samples can resolve to.
fn stencils(source: usize, mode: ResolveMode, samples: &[Rc<Worlds>]) -> BTreeSet<Option<u8>> {
    match mode {
        ResolveMode::None | ResolveMode::Average => [None].into(),
        ResolveMode::SampleZero => first_cells(source, samples)
            .map(|cell| Some(cell.stencil))
            .collect(),
        ResolveMode::Min | ResolveMode::Max => {
            let values = samples.iter().map(|worlds| {
                let stencils = worlds.iter().map(|w| w.cells[source].stencil);
                stencils.collect::<BTreeSet<u8>>()
            });
            let values: Vec<BTreeSet<u8>> = values.collect();
            extremes(mode, &values).into_iter().map(Some).collect()
        }
    }
}

/// Returns the least or greatest stencil values that choosing one value of each sample can give.
fn extremes(mode: ResolveMode, samples: &[BTreeSet<u8>]) -> BTreeSet<u8> {
    let beyond = |value: u8, other: u8| match mode {
        ResolveMode::Min => other >= value,
        _ => other <= value,
    };
    let values = samples.iter().flatten().copied();
    values
        .filter(|value| {
            let mut each = samples.iter();
            each.all(|sample| sample.iter().any(|other| beyond(*value, *other)))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_extreme_stencil_value_is_one_that_all_samples_leave_possible() {
        let samples = [[1, 7].into(), [3, 4].into(), [4].into()];
        assert_eq!(extremes(ResolveMode::Min, &samples), [1, 3, 4].into());
        assert_eq!(extremes(ResolveMode::Max, &samples), [4, 7].into());
    }
}
