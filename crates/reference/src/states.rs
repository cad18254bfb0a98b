//! The states of samples: each distinct set of possible worlds, under a number.

use crate::sample::{Sample, SampleShape};
use crate::world::Worlds;
use rustc_hash::{FxHashMap, FxHasher};
use std::hash::{Hash, Hasher};
use std::rc::Rc;

/// The number of a state; [`OPEN`] if the sample is open.
pub(crate) type StateNumber = u32;

/// The state of samples about which nothing is asserted.
pub(crate) const OPEN: StateNumber = u32::MAX;

/// All states, each stored once.
#[derive(Debug, Default)]
pub(crate) struct States {
    /// Each state's worlds, and the latest earlier state with the same hash; [`OPEN`] if no earlier state has it.
    all: Vec<(Rc<Worlds>, StateNumber)>,
    /// For each hash, the last state that has it.
    last: FxHashMap<u64, StateNumber>,
}

impl States {
    pub(crate) fn number(&mut self, worlds: Option<Worlds>) -> StateNumber {
        let Some(worlds) = worlds else { return OPEN };
        let mut hasher = FxHasher::default();
        worlds.hash(&mut hasher);
        let last = self.last.entry(hasher.finish()).or_insert(OPEN);
        let mut state = *last;
        while let Some((known, earlier)) = self.all.get(state as usize) {
            if **known == worlds {
                return state;
            }
            state = *earlier;
        }
        self.all.push((Rc::new(worlds), *last));
        *last = self.all.len() as StateNumber - 1;
        *last
    }

    /// Returns the worlds of a state; `None` if the sample is open.
    pub(crate) fn worlds(&self, state: StateNumber) -> Option<&Rc<Worlds>> {
        self.all.get(state as usize).map(|(worlds, _)| worlds)
    }
}

/// The states of all samples, one picture per shape, after the passes walked so far.
#[derive(Debug, Default)]
pub(crate) struct StatePictures {
    pub(crate) shapes: Vec<SampleShape>,
    /// For each shape, the states of its samples.
    pub(crate) samples: Vec<Vec<StateNumber>>,
    pub(crate) states: States,
}

impl StatePictures {
    pub(crate) fn shape(&self, shape: SampleShape) -> Option<usize> {
        self.shapes.iter().position(|s| *s == shape)
    }

    /// Returns true if a sample belongs to one of the pictures.
    pub(crate) fn has(&self, at: Sample) -> bool {
        self.shape((at.size, at.samples)).is_some()
    }

    /// Returns the state of a sample.
    pub(crate) fn state(&self, at: Sample) -> StateNumber {
        let shape = self.shape((at.size, at.samples));
        shape.map_or(OPEN, |s| self.samples[s][at.place()])
    }

    /// Returns the states of a shape's samples.
    pub(crate) fn of_shape(&self, shape: SampleShape) -> &[StateNumber] {
        self.shape(shape).map_or(&[], |s| &self.samples[s])
    }
}
