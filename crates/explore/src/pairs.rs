//! The pairs of states that scenes have covered.
//!
//! Most bugs need two states to meet, and chance repeats common pairs a hundred times before a rare one
//! occurs. Of several scenes, the one with the most new pairs is therefore drawn. States are identified by
//! hashes: only the generator knows their names and values.

use crate::choices::StateHash;
use std::collections::HashMap;

/// Pairs of states, within a draw or between a draw and its scene.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pairs {
    numbers: HashMap<StateHash, usize>,
    /// One row of bits per state, for the states with lower numbers.
    rows: Vec<Vec<u64>>,
    met: usize,
}

impl Pairs {
    /// Returns the number of pairs that a scene would add.
    pub(crate) fn new_in(&self, scopes: &[Vec<StateHash>]) -> usize {
        let mut count = 0;
        each_pair(scopes, |a, b| {
            let known = match (self.numbers.get(&a), self.numbers.get(&b)) {
                (Some(a), Some(b)) => self.has(*a, *b),
                _ => false,
            };
            count += usize::from(!known);
        });
        count
    }

    /// Adds the pairs of a scene.
    pub(crate) fn add(&mut self, scopes: &[Vec<StateHash>]) {
        each_pair(scopes, |a, b| {
            let [a, b] = [a, b].map(|state| self.number(state));
            let (row, bit) = (a.max(b), a.min(b));
            if a != b && !self.has(a, b) {
                let words = &mut self.rows[row];
                if words.len() <= bit / 64 {
                    words.resize(bit / 64 + 1, 0);
                }
                words[bit / 64] |= 1 << (bit % 64);
                self.met += 1;
            }
        });
    }

    /// Returns the number of pairs covered.
    pub(crate) fn met(&self) -> usize {
        self.met
    }

    /// Returns the number of states covered.
    pub(crate) fn states(&self) -> usize {
        self.rows.len()
    }

    fn number(&mut self, state: StateHash) -> usize {
        let next = self.rows.len();
        let number = *self.numbers.entry(state).or_insert(next);
        if number == next {
            self.rows.push(Vec::new());
        }
        number
    }

    fn has(&self, a: usize, b: usize) -> bool {
        let (row, bit) = (a.max(b), a.min(b));
        let word = self.rows[row].get(bit / 64);
        a == b || word.is_some_and(|word| word >> (bit % 64) & 1 == 1)
    }
}

/// Calls a function with each pair of states of a draw, including those of its scene.
fn each_pair(scopes: &[Vec<StateHash>], mut pair: impl FnMut(StateHash, StateHash)) {
    let Some((scene, draws)) = scopes.split_first() else {
        return;
    };
    let mut among = |states: &[StateHash]| {
        for (i, a) in states.iter().enumerate() {
            states[..i].iter().for_each(|b| pair(*a, *b));
        }
    };
    among(scene);
    draws.iter().for_each(|draw| among(draw));
    for draw in draws {
        for a in scene {
            draw.iter().for_each(|b| pair(*a, *b));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_counted_once_and_not_across_draws() {
        let mut pairs = Pairs::default();
        let scene = vec![vec![1, 2], vec![3, 4], vec![5]];
        // The pairs 1-2 and 3-4, and each state of a draw with both states of the scene.
        assert_eq!(pairs.new_in(&scene), 8);
        pairs.add(&scene);
        assert_eq!((pairs.met(), pairs.states()), (8, 5));
        assert_eq!(pairs.new_in(&scene), 0);
        pairs.add(&scene);
        assert_eq!(pairs.met(), 8);
        assert_eq!(pairs.new_in(&[vec![1], vec![3, 5]]), 1);
    }
}
