//! Covering arrays: a few rows of a product in which every two values of every two axes occur together, or in
//! which every value occurs a number of times.

use std::cmp::Reverse;
use std::collections::HashSet;

/// Two values that occur together: axis and position of the first, axis and position of the second.
type ValuePair = (usize, usize, usize, usize);

/// The coverage that the rows must reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cover {
    /// Each pair of values of any two axes occurs at least once.
    Pairs,
    /// Each value occurs at least this many times, or as often as the product allows.
    AtLeast(usize),
}

/// Returns distinct rows that cover `cover` over axes of these lengths, chosen greedily and
/// deterministically. If no uncovered pair determines a value, the least used value is taken, so that all values
/// occur about equally often and in different combinations.
pub(crate) fn rows(lengths: &[usize], cover: Cover) -> Vec<Vec<usize>> {
    let mut state = CoverState::new(lengths);
    match cover {
        Cover::Pairs if lengths.len() > 1 => {
            for pair in pairs(lengths) {
                if state.uncovered.contains(&pair) {
                    let (a, i, b, j) = pair;
                    let row = state.greedy_row(&[(a, i), (b, j)]);
                    state.push(row);
                }
            }
        }
        Cover::Pairs => state.cover_values(1),
        Cover::AtLeast(times) => state.cover_values(times),
    }
    state.rows
}

fn pairs(lengths: &[usize]) -> Vec<ValuePair> {
    let mut pairs = Vec::new();
    for a in 0..lengths.len() {
        for b in a + 1..lengths.len() {
            for i in 0..lengths[a] {
                pairs.extend((0..lengths[b]).map(|j| (a, i, b, j)));
            }
        }
    }
    pairs
}

struct CoverState<'a> {
    lengths: &'a [usize],
    uncovered: HashSet<ValuePair>,
    /// The number of rows with each value of each axis.
    used: Vec<Vec<usize>>,
    /// The number of rows with each value, in their order, that are known to be taken.
    passed: Vec<Vec<usize>>,
    rows: Vec<Vec<usize>>,
}

impl<'a> CoverState<'a> {
    fn new(lengths: &'a [usize]) -> Self {
        Self {
            lengths,
            uncovered: pairs(lengths).into_iter().collect(),
            used: lengths.iter().map(|n| vec![0; *n]).collect(),
            passed: lengths.iter().map(|n| vec![0; *n]).collect(),
            rows: Vec::new(),
        }
    }

    /// Adds rows until each value occurs in `times` of them, or in all rows that have it.
    fn cover_values(&mut self, times: usize) {
        if self.lengths.is_empty() {
            self.rows.push(Vec::new());
            return;
        }
        let mut taken = HashSet::new();
        for round in 1..=times {
            let (before, mut lacks_rows) = (self.rows.len(), false);
            for axis in 0..self.lengths.len() {
                for value in 0..self.lengths[axis] {
                    if self.used[axis][value] < round {
                        lacks_rows = true;
                        if let Some(row) = self.untaken_row(axis, value, &taken) {
                            taken.insert(row.clone());
                            self.push(row);
                        }
                    }
                }
            }
            // The next round would find no row either.
            if lacks_rows && self.rows.len() == before {
                break;
            }
        }
    }

    fn push(&mut self, row: Vec<usize>) {
        for a in 0..row.len() {
            self.used[a][row[a]] += 1;
            for b in a + 1..row.len() {
                self.uncovered.remove(&(a, row[a], b, row[b]));
            }
        }
        self.rows.push(row);
    }

    /// Returns the greedy row with this value, or the first one that is not taken; `None` if all are.
    fn untaken_row(
        &mut self,
        axis: usize,
        value: usize,
        taken: &HashSet<Vec<usize>>,
    ) -> Option<Vec<usize>> {
        let greedy = self.greedy_row(&[(axis, value)]);
        if !taken.contains(&greedy) {
            return Some(greedy);
        }
        // Rows stay taken, so that each is passed once.
        let passed = self.passed[axis][value];
        let rows = (passed..).map_while(|number| self.row_with(axis, value, number));
        let rows_passed = rows.take_while(|row| taken.contains(row)).count();
        self.passed[axis][value] = passed + rows_passed;
        self.row_with(axis, value, passed + rows_passed)
    }

    /// Returns the row of this number of those with a value, in their order; `None` if there are fewer.
    fn row_with(&self, axis: usize, value: usize, number: usize) -> Option<Vec<usize>> {
        let mut row = vec![value; self.lengths.len()];
        let mut rest = number;
        for other in (0..row.len()).rev().filter(|other| *other != axis) {
            row[other] = rest % self.lengths[other];
            rest /= self.lengths[other];
        }
        (rest == 0).then_some(row)
    }

    /// Returns a row with the fixed values. Axis by axis, it takes the value that covers most uncovered pairs;
    /// among equals, the least used value; among these, the first value after a start that differs by axis,
    /// so that two axes with the same values do not always show the same one.
    fn greedy_row(&self, fixed: &[(usize, usize)]) -> Vec<usize> {
        let mut row: Vec<Option<usize>> = vec![None; self.lengths.len()];
        for (axis, value) in fixed {
            row[*axis] = Some(*value);
        }
        for axis in 0..self.lengths.len() {
            if row[axis].is_some() {
                continue;
            }
            let newly_covered = |value: usize| {
                let others = row.iter().enumerate();
                let pairs = others.filter(|(other, chosen)| match chosen {
                    Some(chosen) if *other < axis => {
                        self.uncovered.contains(&(*other, *chosen, axis, value))
                    }
                    Some(chosen) => self.uncovered.contains(&(axis, value, *other, *chosen)),
                    None => false,
                });
                pairs.count()
            };
            let length = self.lengths[axis];
            let values = (0..length).map(|i| (i + axis) % length);
            row[axis] = values.min_by_key(|v| (Reverse(newly_covered(*v)), self.used[axis][*v]));
        }
        let values = row.into_iter();
        values
            .map(|value| value.expect("no axis is empty"))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shapes() -> Vec<Vec<usize>> {
        vec![
            vec![],
            vec![7],
            vec![3, 4],
            vec![2, 2, 2],
            vec![5, 1, 19, 19],
            vec![8, 3, 2, 6, 4],
        ]
    }

    #[test]
    fn every_two_values_of_every_two_axes_meet() {
        for lengths in shapes() {
            let rows = rows(&lengths, Cover::Pairs);
            assert_eq!(rows, super::rows(&lengths, Cover::Pairs), "always the same");
            for a in 0..lengths.len() {
                assert!((0..lengths[a]).all(|i| rows.iter().any(|r| r[a] == i)));
            }
            for (a, i, b, j) in pairs(&lengths) {
                let meet = rows.iter().any(|r| r[a] == i && r[b] == j);
                assert!(meet, "{lengths:?}: {i} and {j} of axes {a} and {b}");
            }
            let product: usize = lengths.iter().product();
            assert!(
                rows.len() <= product,
                "{lengths:?}: {} of {product}",
                rows.len()
            );
        }
        assert!(rows(&[8, 3, 2, 6, 4], Cover::Pairs).len() < 100, "of 1152");
    }

    #[test]
    fn every_value_occurs_as_often_as_asked_or_possible() {
        for lengths in shapes() {
            let product: usize = lengths.iter().product();
            for times in [1, 2, 3, 10, 100, usize::MAX] {
                let rows = rows(&lengths, Cover::AtLeast(times));
                let distinct: HashSet<_> = rows.iter().collect();
                assert_eq!(distinct.len(), rows.len(), "{lengths:?}: a row comes twice");
                for (axis, length) in lengths.iter().enumerate() {
                    for value in 0..*length {
                        let count = rows.iter().filter(|r| r[axis] == value).count();
                        // The values of one axis can only occur as often as the others have combinations.
                        let expected = times.min(product / length);
                        assert!(
                            count >= expected,
                            "{lengths:?}: value {value} of axis {axis} occurs {count} times, not {expected}"
                        );
                    }
                }
            }
            let longest = lengths.iter().max().copied().unwrap_or(1);
            assert_eq!(rows(&lengths, Cover::AtLeast(1)).len(), longest);
        }
    }

    #[test]
    fn axes_of_one_length_do_not_go_in_step() {
        let rows = rows(&[8, 8], Cover::AtLeast(1));
        assert_eq!(rows.len(), 8);
        assert!(rows.iter().all(|r| r[0] != r[1]), "{rows:?}");
    }
}
