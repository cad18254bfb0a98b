//! Covering arrays: a few rows of a product in which every two values of every two axes occur together, or in
//! which every value occurs a number of times.

use std::collections::HashSet;

/// Two values that occur together: axis and position of the first, axis and position of the second.
type ValuePair = (usize, usize, usize, usize);

/// The coverage that the rows must reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cover {
    /// Each pair of values of any two axes occurs at least once.
    Pairs,
    /// Each value occurs this many times, or as often as the product allows.
    Each(usize),
}

/// Returns distinct rows that cover `cover` over axes of these lengths, chosen greedily and
/// deterministically. If no open pair determines a value, the least used value is taken, so that all values
/// occur about equally often and in different combinations.
pub(crate) fn rows(lengths: &[usize], cover: Cover) -> Vec<Vec<usize>> {
    let mut state = CoverState::new(lengths);
    match cover {
        Cover::Pairs if lengths.len() > 1 => {
            for pair in pairs(lengths) {
                if state.open.contains(&pair) {
                    let (a, i, b, j) = pair;
                    let row = state.row(&[(a, i), (b, j)]);
                    state.take(row);
                }
            }
        }
        Cover::Pairs => state.each(1),
        Cover::Each(times) => state.each(times),
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
    open: HashSet<ValuePair>,
    /// The number of rows with each value of each axis.
    used: Vec<Vec<usize>>,
    rows: Vec<Vec<usize>>,
}

impl<'a> CoverState<'a> {
    fn new(lengths: &'a [usize]) -> Self {
        Self {
            lengths,
            open: pairs(lengths).into_iter().collect(),
            used: lengths.iter().map(|n| vec![0; *n]).collect(),
            rows: Vec::new(),
        }
    }

    /// Adds rows until each value occurs in `times` of them, or until no new row is found.
    fn each(&mut self, times: usize) {
        if self.lengths.is_empty() {
            self.rows.push(Vec::new());
            return;
        }
        let mut seen = HashSet::new();
        for round in 1..=times {
            let (before, mut short) = (self.rows.len(), false);
            for axis in 0..self.lengths.len() {
                for value in 0..self.lengths[axis] {
                    if self.used[axis][value] < round {
                        short = true;
                        let row = self.row(&[(axis, value)]);
                        if seen.insert(row.clone()) {
                            self.take(row);
                        }
                    }
                }
            }
            // The next round would find the same rows again.
            if short && self.rows.len() == before {
                break;
            }
        }
    }

    fn take(&mut self, row: Vec<usize>) {
        for a in 0..row.len() {
            self.used[a][row[a]] += 1;
            for b in a + 1..row.len() {
                self.open.remove(&(a, row[a], b, row[b]));
            }
        }
        self.rows.push(row);
    }

    /// Returns a row with the fixed values. Axis by axis, it takes the value that covers most open pairs;
    /// among equals, the least used value; among these, the first value after a start that differs by axis,
    /// so that two axes with the same values do not always show the same one.
    fn row(&self, fixed: &[(usize, usize)]) -> Vec<usize> {
        let mut row: Vec<Option<usize>> = vec![None; self.lengths.len()];
        for (axis, value) in fixed {
            row[*axis] = Some(*value);
        }
        for axis in 0..self.lengths.len() {
            if row[axis].is_some() {
                continue;
            }
            let met = |value: usize| {
                let others = row.iter().enumerate();
                let open = others.filter(|(other, taken)| match taken {
                    Some(taken) if *other < axis => {
                        self.open.contains(&(*other, *taken, axis, value))
                    }
                    Some(taken) => self.open.contains(&(axis, value, *other, *taken)),
                    None => false,
                });
                open.count()
            };
            let length = self.lengths[axis];
            let values = (0..length).map(|i| (i + axis) % length);
            let best = values.min_by_key(|v| (usize::MAX - met(*v), self.used[axis][*v]));
            row[axis] = best;
        }
        row.into_iter().map(|value| value.unwrap_or(0)).collect()
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
                let found = rows.iter().any(|r| r[a] == i && r[b] == j);
                assert!(found, "{lengths:?}: {i} and {j} of axes {a} and {b}");
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
    fn every_value_occurs_as_often_as_asked() {
        for lengths in shapes() {
            let product: usize = lengths.iter().product();
            for times in [1, 2, 3, 100, usize::MAX] {
                let rows = rows(&lengths, Cover::Each(times));
                let distinct: HashSet<_> = rows.iter().collect();
                assert_eq!(distinct.len(), rows.len(), "{lengths:?}: a row comes twice");
                for (axis, length) in lengths.iter().enumerate() {
                    for value in 0..*length {
                        let found = rows.iter().filter(|r| r[axis] == value).count();
                        // The values of one axis can only occur as often as the others have combinations.
                        let expected = times.min(product / length).min(3);
                        assert!(
                            found >= expected,
                            "{lengths:?}: value {value} of axis {axis} occurs {found} times"
                        );
                    }
                }
            }
            let longest = lengths.iter().max().copied().unwrap_or(1);
            assert!(rows(&lengths, Cover::Each(1)).len() <= longest + 1);
        }
    }

    #[test]
    fn axes_of_equal_length_do_not_advance_together() {
        let rows = rows(&[8, 8], Cover::Each(1));
        assert_eq!(rows.len(), 8);
        assert!(rows.iter().all(|r| r[0] != r[1]), "{rows:?}");
    }
}
