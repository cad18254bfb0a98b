//! Choices: the whole numbers that a scene is made from, and the states that follow from them.
//!
//! A generator asks for numbers below a bound and makes a scene of every answer. No library draws the numbers: the same
//! seed must give the same scenes in every release of one. Smaller scenes come from edits of the document and not
//! from fewer choices, since a document is what is kept.

use etalon_frame::SplitMix64;
use std::hash::{DefaultHasher, Hash, Hasher};

/// A state and its value, as a number that tells it from others.
pub(crate) type State = u64;

/// Answers by chance.
#[derive(Clone, Debug)]
pub(crate) struct Choices {
    random: SplitMix64,
    /// The states that were chosen: those of the whole scene, then those of each draw.
    scopes: Vec<Vec<State>>,
}

impl Choices {
    /// The choices of a seed.
    pub(crate) fn by_seed(seed: u64) -> Self {
        Self {
            random: SplitMix64(seed),
            scopes: vec![Vec::new()],
        }
    }

    /// Returns a number below `bound`; the answer 0 even where there is no choice.
    pub(crate) fn below(&mut self, bound: u32) -> u32 {
        (self.random.roll() % u64::from(bound.max(1))) as u32
    }

    /// Returns a number from `low` to `high`, both included; `low` is the simplest.
    pub(crate) fn range(&mut self, low: u32, high: u32) -> u32 {
        low + self.below(high.saturating_sub(low) + 1)
    }

    /// True once in `n` times; false is simpler.
    pub(crate) fn once_in(&mut self, n: u32) -> bool {
        self.below(n) + 1 == n
    }

    /// Returns one of a list, of which the first is the simplest.
    pub(crate) fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len() as u32) as usize]
    }

    /// Returns one of the values of a state, and notes it.
    pub(crate) fn word(&mut self, state: &'static str, words: &[&'static str]) -> &'static str {
        let word = self.of(words);
        self.note(state, word);
        word
    }

    /// True once in `n` times, as a state that is noted.
    pub(crate) fn flag(&mut self, state: &'static str, n: u32) -> bool {
        let flag = self.once_in(n);
        self.note(state, flag);
        flag
    }

    /// Notes the value of a state.
    pub(crate) fn note(&mut self, state: &'static str, value: impl Hash) {
        let mut hasher = DefaultHasher::new();
        state.hash(&mut hasher);
        value.hash(&mut hasher);
        if let Some(scope) = self.scopes.last_mut() {
            scope.push(hasher.finish());
        }
    }

    /// Begins the states of another draw.
    pub(crate) fn begin_draw(&mut self) {
        self.scopes.push(Vec::new());
    }

    /// Returns the states, those of the scene first.
    pub(crate) fn finish(self) -> Vec<Vec<State>> {
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
