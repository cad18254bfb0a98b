//! Choices: the integers from which a scene is made, and the states that follow from them.
//!
//! A generator asks for numbers below a bound and makes a scene from any answers. No external library draws
//! the numbers, because the same seed must give the same scenes in every release. Smaller scenes come from
//! edits of the document, not from fewer choices, since only the document is kept.

use etalon_frame::SplitMix64;
use std::hash::{DefaultHasher, Hash, Hasher};

/// A hash that identifies a state and its value.
pub(crate) type StateHash = u64;

/// A source of random answers.
#[derive(Clone, Debug)]
pub(crate) struct Choices {
    random: SplitMix64,
    /// The chosen states: those of the whole scene, then those of each draw.
    scopes: Vec<Vec<StateHash>>,
}

impl Choices {
    /// Creates the choices of a seed.
    pub(crate) fn by_seed(seed: u64) -> Self {
        Self {
            random: SplitMix64(seed),
            scopes: vec![Vec::new()],
        }
    }

    /// Returns a number below `bound`; draws a number even if 0 is the only answer.
    pub(crate) fn below(&mut self, bound: u32) -> u32 {
        (self.random.roll() % u64::from(bound.max(1))) as u32
    }

    /// Returns a number from `low` to `high`, inclusive; `low` is the simplest.
    pub(crate) fn range(&mut self, low: u32, high: u32) -> u32 {
        low + self.below(high.saturating_sub(low) + 1)
    }

    /// Returns true once in `n` times; false is simpler.
    pub(crate) fn once_in(&mut self, n: u32) -> bool {
        self.below(n) + 1 == n
    }

    /// Returns an item of a list, which must begin with the simplest.
    pub(crate) fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len() as u32) as usize]
    }

    /// Returns one of the values of a state, and records it.
    pub(crate) fn word(&mut self, state: &'static str, words: &[&'static str]) -> &'static str {
        let word = self.of(words);
        self.note(state, word);
        word
    }

    /// Returns true once in `n` times, and records the answer as a state.
    pub(crate) fn flag(&mut self, state: &'static str, n: u32) -> bool {
        let flag = self.once_in(n);
        self.note(state, flag);
        flag
    }

    /// Records the value of a state.
    pub(crate) fn note(&mut self, state: &'static str, value: impl Hash) {
        let mut hasher = DefaultHasher::new();
        state.hash(&mut hasher);
        value.hash(&mut hasher);
        if let Some(scope) = self.scopes.last_mut() {
            scope.push(hasher.finish());
        }
    }

    /// Begins the states of the next draw.
    pub(crate) fn begin_draw(&mut self) {
        self.scopes.push(Vec::new());
    }

    /// Returns the states, with those of the scene first.
    pub(crate) fn finish(self) -> Vec<Vec<StateHash>> {
        self.scopes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_the_same_answers_each_of_them_below_its_bound() {
        let answers = |seed| {
            let mut choices = Choices::by_seed(seed);
            (0..40).map(move |n| choices.below(n)).collect::<Vec<u32>>()
        };
        assert_eq!(answers(5), answers(5));
        assert_ne!(answers(5), answers(6));
        let below = |(n, answer): (usize, &u32)| *answer < (n as u32).max(1);
        assert!(answers(5).iter().enumerate().all(below));
    }

    #[test]
    fn states_belong_to_the_scene_or_to_a_draw() {
        let mut choices = Choices::by_seed(0);
        choices.note("cull", "none");
        choices.begin_draw();
        choices.note("cull", "front");
        choices.begin_draw();
        choices.note("cull", "back");
        let scopes = choices.finish();
        assert_eq!(scopes.iter().map(Vec::len).collect::<Vec<_>>(), [1, 1, 1]);
        assert_ne!(scopes[0], scopes[1]);
        assert_ne!(scopes[1], scopes[2]);
    }
}
