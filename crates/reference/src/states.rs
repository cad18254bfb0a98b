//! The states of samples: each distinct set of possible worlds, under a number.

use crate::sample::{Sample, Shape};
use crate::world::Worlds;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// The number of a state; [`OPEN`] if the sample is open.
pub(crate) type State = u32;

/// The state of samples about which nothing is asserted.
pub(crate) const OPEN: State = u32::MAX;

/// All states, each stored once.
#[derive(Debug, Default)]
pub(crate) struct States {
    all: Vec<Rc<Worlds>>,
    numbers: FxHashMap<Rc<Worlds>, State>,
}

impl States {
    pub(crate) fn number(&mut self, worlds: Option<Worlds>) -> State {
        let Some(worlds) = worlds else { return OPEN };
        if let Some(state) = self.numbers.get(&worlds) {
            return *state;
        }
        let state = self.all.len() as State;
        let worlds = Rc::new(worlds);
        self.all.push(Rc::clone(&worlds));
        self.numbers.insert(worlds, state);
        state
    }

    /// Returns the worlds of a state; `None` if the sample is open.
    pub(crate) fn worlds(&self, state: State) -> Option<&Rc<Worlds>> {
        self.all.get(state as usize)
    }
}

/// The states of all samples, one picture per shape, after the passes walked so far.
#[derive(Debug, Default)]
pub(crate) struct Pictures {
    pub(crate) shapes: Vec<Shape>,
    /// For each shape, the states of its samples.
    pub(crate) samples: Vec<Vec<State>>,
    pub(crate) states: States,
}

impl Pictures {
    pub(crate) fn shape(&self, shape: Shape) -> Option<usize> {
        self.shapes.iter().position(|s| *s == shape)
    }

    /// Returns true if a sample belongs to one of the pictures.
    pub(crate) fn has(&self, at: Sample) -> bool {
        self.shape((at.size, at.samples)).is_some()
    }

    /// Returns the state of a sample.
    pub(crate) fn state(&self, at: Sample) -> State {
        let shape = self.shape((at.size, at.samples));
        shape.map_or(OPEN, |s| self.samples[s][at.place()])
    }

    /// Returns the states of a shape's samples.
    pub(crate) fn of_shape(&self, shape: Shape) -> &[State] {
        self.shape(shape).map_or(&[], |s| &self.samples[s])
    }
}
