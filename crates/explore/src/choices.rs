//! Choices: the whole numbers that a scene is made from.
//!
//! A generator asks for numbers below a bound and makes a scene of every answer, so a changed or shortened
//! sequence is a scene too: 0 is the simplest answer, and stands for all that are missing. That is the way of
//! Hypothesis. Its engine is not used, neither `hegeltest`, since what is needed of it are these few lines:
//! the loop around them runs on other machines' drivers, weighs scenes by what was met, and must give the same
//! scenes for a seed in every release of a library.

use std::hash::{DefaultHasher, Hash, Hasher};

/// A state and its value, as a number that tells it from others.
pub(crate) type State = u64;

/// A sequence of answers, which comes from a seed or is given.
#[derive(Clone, Debug)]
pub(crate) struct Choices {
    source: Source,
    made: Vec<u32>,
    /// The states that were chosen: those of the whole scene, then those of each draw.
    scopes: Vec<Vec<State>>,
}

#[derive(Clone, Debug)]
enum Source {
    /// The state of a SplitMix64 generator (Steele, Lea, Flood 2014).
    Seed(u64),
    /// Answers, and the number of those given.
    Given(Vec<u32>, usize),
}

impl Choices {
    /// Choices by chance.
    pub(crate) fn by_seed(seed: u64) -> Self {
        Self::new(Source::Seed(seed))
    }

    /// Choices that were made before, as far as they go.
    pub(crate) fn given(choices: &[u32]) -> Self {
        Self::new(Source::Given(choices.to_vec(), 0))
    }

    fn new(source: Source) -> Self {
        Self {
            source,
            made: Vec::new(),
            scopes: vec![Vec::new()],
        }
    }

    /// Returns a number below `bound`; the answer 0 is noted even where there is no choice.
    pub(crate) fn below(&mut self, bound: u32) -> u32 {
        let bound = bound.max(1);
        let answer = match &mut self.source {
            Source::Seed(state) => {
                *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
                let mut z = *state;
                z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
                z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
                ((z ^ (z >> 31)) % u64::from(bound)) as u32
            }
            Source::Given(all, at) => {
                let answer = all.get(*at).copied().unwrap_or(0) % bound;
                *at += 1;
                answer
            }
        };
        self.made.push(answer);
        answer
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

    /// Returns the answers and the states, those of the scene first.
    pub(crate) fn finish(self) -> (Vec<u32>, Vec<Vec<State>>) {
        (self.made, self.scopes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn given_answers_are_repeated_and_zero_stands_for_what_is_missing() {
        let mut by_seed = Choices::by_seed(5);
        let first: Vec<u32> = (1..9).map(|n| by_seed.below(n * 7)).collect();
        let (made, _) = by_seed.finish();
        assert_eq!(made, first);
        let mut given = Choices::given(&made[..4]);
        let again: Vec<u32> = (1..9).map(|n| given.below(n * 7)).collect();
        assert_eq!(again[..4], first[..4]);
        assert_eq!(again[4..], [0; 4]);
        let mut large = Choices::given(&[9]);
        assert_eq!(large.below(4), 1);
    }

    #[test]
    fn states_belong_to_the_scene_or_to_a_draw() {
        let mut choices = Choices::given(&[0, 1, 1]);
        choices.word("cull", &["none", "front"]);
        choices.begin_draw();
        choices.word("cull", &["none", "front"]);
        choices.begin_draw();
        choices.flag("cull", 2);
        let (_, scopes) = choices.finish();
        assert_eq!(scopes.iter().map(Vec::len).collect::<Vec<_>>(), [1, 1, 1]);
        assert_ne!(scopes[0], scopes[1]);
        assert_ne!(scopes[1], scopes[2]);
    }
}
