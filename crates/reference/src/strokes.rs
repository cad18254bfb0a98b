//! The strokes of a pass: runs of samples with equal signatures. A picture is painted with them.

use crate::bins::Segments;
use crate::sample::{Sample, SampleShape};
use crate::signature::{SampleKey, SignatureInputs};
use crate::texels::Lattice;
use crate::walk::Walk;
use etalon_scene::Pass;
use rustc_hash::FxHashMap;
use std::ops::Range;

/// A receiver of strokes.
pub(crate) trait Strokes {
    /// Returns true if signatures need inputs that vary over a primitive of a draw.
    fn names_inputs(&self, draw: u32) -> bool;

    /// Takes samples from `first` to the column `end` that have equal signatures.
    fn stroke(&mut self, first: Sample, end: u32, signature: &SampleKey);

    /// Returns true if further strokes are not needed.
    fn is_full(&self) -> bool {
        false
    }
}

/// The maximum number of kept strokes. A stroke takes 20 bytes.
const MAX_STROKES: usize = 1 << 17;
/// The maximum number of different signatures of kept strokes. With more, most samples differ, and finding the equal
/// ones costs more than it saves.
const MAX_SIGNATURES: usize = 1 << 12;

/// The strokes of each run of draws of a pass.
pub(crate) type PassStrokes = Vec<KeptStrokes>;

/// Kept strokes.
#[derive(Debug, Default)]
pub(crate) struct KeptStrokes {
    /// The first sample, the end column, and the number of the signature.
    strokes: Vec<(Sample, u32, u32)>,
    signatures: Vec<SampleKey>,
    numbers: FxHashMap<Vec<u64>, u32>,
}

impl KeptStrokes {
    /// Sends all strokes to another receiver.
    pub(crate) fn repeat(&self, to: &mut impl Strokes) {
        for (first, end, signature) in &self.strokes {
            to.stroke(*first, *end, &self.signatures[*signature as usize]);
        }
    }
}

impl Strokes for KeptStrokes {
    fn names_inputs(&self, _: u32) -> bool {
        true
    }

    fn stroke(&mut self, first: Sample, end: u32, signature: &SampleKey) {
        let next = self.signatures.len() as u32;
        let number = *self.numbers.entry(signature.identity()).or_insert(next);
        if number == next {
            self.signatures.push(signature.clone());
        }
        self.strokes.push((first, end, number));
    }

    fn is_full(&self) -> bool {
        self.strokes.len() > MAX_STROKES || self.signatures.len() > MAX_SIGNATURES
    }
}

/// Returns the runs of a pass's draws between clear commands, in order. The commands before draw `end` follow each run.
pub(crate) fn runs(pass: &Pass) -> impl Iterator<Item = Range<usize>> {
    let mut stops: Vec<usize> = pass.clears.iter().map(|clear| clear.before).collect();
    stops.push(pass.draws.len());
    stops.dedup();
    let mut next = 0;
    stops.into_iter().map(move |stop| {
        let first = std::mem::replace(&mut next, stop);
        first..stop
    })
}

impl Walk<'_> {
    /// Returns the strokes of each pass; `None` if signatures depend on earlier passes, or if there are more
    /// than [`MAX_STROKES`] strokes or [`MAX_SIGNATURES`] signatures.
    pub(crate) fn strokes(&self) -> Vec<Option<PassStrokes>> {
        let passes = self.scene.passes.iter().enumerate();
        let strokes = passes.map(|(p, pass)| {
            let tracer = Tracer::new(self, p);
            let keep = |draws| {
                let mut kept = KeptStrokes::default();
                tracer.trace(draws, &mut kept);
                kept.numbers = FxHashMap::default();
                (!kept.is_full()).then_some(kept)
            };
            let depends = tracer
                .inputs
                .iter()
                .any(SignatureInputs::reads_earlier_passes);
            if depends {
                return None;
            }
            runs(pass).map(keep).collect()
        });
        strokes.collect()
    }
}

/// Finds the strokes of a pass.
pub(crate) struct Tracer<'t, 'a> {
    walk: &'t Walk<'a>,
    pass: usize,
    inputs: Vec<SignatureInputs>,
    shape: SampleShape,
}

/// Signatures whose memory is reused.
#[derive(Default)]
struct Spare {
    /// The signatures of the first and the last texel of a run.
    ends: [SampleKey; 2],
    middles: Vec<SampleKey>,
}

impl<'t, 'a> Tracer<'t, 'a> {
    pub(crate) fn new(walk: &'t Walk<'a>, pass: usize) -> Self {
        let (scene, draws) = (walk.scene, walk.scene.passes[pass].draws.len());
        Self {
            walk,
            pass,
            inputs: (0..draws).map(|draw| walk.inputs(pass, draw)).collect(),
            shape: (
                scene.pass_size(&scene.passes[pass]),
                scene.pass_samples(&scene.passes[pass]),
            ),
        }
    }

    /// Sends the strokes of some draws.
    pub(crate) fn trace(&self, draws: Range<usize>, to: &mut impl Strokes) {
        let (size, _) = self.shape;
        let lattice = self.walk.texels.lattice(size);
        let setup = &self.walk.setups[self.pass];
        let mut rows = setup.rows(draws);
        let mut segments = Segments::default();
        let mut spare = Spare::default();
        for y in 0..size[1] {
            if to.is_full() {
                break;
            }
            let active = rows.row(y);
            if active.is_empty() || lattice.first(0, y).is_none_or(|x| x >= size[0]) {
                continue;
            }
            segments.of_row(setup, y, active, |columns, members| {
                self.segment((y, columns), members, lattice, &mut spare, to);
            });
        }
    }

    fn at(&self, x: u32, y: u32, sample: u32) -> Sample {
        let (size, samples) = self.shape;
        Sample {
            size,
            samples,
            x,
            y,
            sample,
        }
    }

    fn sign(&self, at: Sample, members: &[u32], to: &impl Strokes, signature: &mut SampleKey) {
        let setup = &self.walk.setups[self.pass];
        let members = members.iter().map(|number| setup.member(*number));
        let names_inputs = |draw: u32| to.names_inputs(draw);
        self.walk.sign(
            self.pass,
            &self.inputs,
            at,
            members,
            names_inputs,
            signature,
        );
    }

    /// Sends the strokes of a part of a row.
    fn segment(
        &self,
        (y, columns): (u32, Range<u32>),
        members: &[u32],
        lattice: Lattice,
        spare: &mut Spare,
        to: &mut impl Strokes,
    ) {
        let [mut first, mut last] = std::mem::take(&mut spare.ends);
        for sample in 0..self.shape.1 {
            if lattice == Lattice::ALL {
                let left = self.at(columns.start, y, sample);
                let right = self.at(columns.end - 1, y, sample);
                self.sign(left, members, to, &mut first);
                if left == right {
                    to.stroke(left, columns.end, &first);
                    continue;
                }
                self.sign(right, members, to, &mut last);
                if first.spans(&last) {
                    to.stroke(left, columns.end, &first);
                    continue;
                }
                to.stroke(left, left.x + 1, &first);
                to.stroke(right, columns.end, &last);
                self.between([(left, &first), (right, &last)], members, spare, to);
            } else {
                let mut next = columns.start;
                while let Some(x) = lattice.first(next, y)
                    && x < columns.end
                {
                    let at = self.at(x, y, sample);
                    self.sign(at, members, to, &mut first);
                    to.stroke(at, x + 1, &first);
                    next = x + 1;
                }
            }
        }
        spare.ends = [first, last];
    }

    /// Sends the strokes between two samples of a row whose signatures are known.
    fn between(
        &self,
        [(left, first), (right, last)]: [(Sample, &SampleKey); 2],
        members: &[u32],
        spare: &mut Spare,
        to: &mut impl Strokes,
    ) {
        if right.x - left.x < 2 {
            return;
        }
        let next = Sample {
            x: left.x + 1,
            ..left
        };
        if first.spans(last) {
            to.stroke(next, right.x, first);
            return;
        }
        let middle = Sample {
            x: left.x + (right.x - left.x) / 2,
            ..left
        };
        let mut signature = spare.middles.pop().unwrap_or_default();
        self.sign(middle, members, to, &mut signature);
        to.stroke(middle, middle.x + 1, &signature);
        self.between([(left, first), (middle, &signature)], members, spare, to);
        self.between([(middle, &signature), (right, last)], members, spare, to);
        spare.middles.push(signature);
    }
}
