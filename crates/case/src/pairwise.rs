//! A pairwise covering array: few rows of a product in which every two values of every two axes
//! meet.

use std::collections::HashSet;

/// Two values that meet: axis and position of the one, axis and position of the other.
type Pair = (usize, usize, usize, usize);

/// Rows over axes of these lengths, in which each pair of values of each two axes stands at least
/// once: greedy and the same in every run. Two axes or fewer leave nothing out.
pub(crate) fn rows(lengths: &[usize]) -> Vec<Vec<usize>> {
    let mut open: HashSet<Pair> = HashSet::new();
    let mut order: Vec<Pair> = Vec::new();
    for a in 0..lengths.len() {
        for b in a + 1..lengths.len() {
            for i in 0..lengths[a] {
                order.extend((0..lengths[b]).map(|j| (a, i, b, j)));
            }
        }
    }
    if order.is_empty() {
        let alone = lengths.first().copied().unwrap_or(1);
        return (0..alone).map(|i| vec![i; lengths.len()]).collect();
    }
    open.extend(&order);
    let mut rows = Vec::new();
    for pair in &order {
        if !open.contains(pair) {
            continue;
        }
        let row = row(lengths, &open, *pair);
        for a in 0..lengths.len() {
            for b in a + 1..lengths.len() {
                open.remove(&(a, row[a], b, row[b]));
            }
        }
        rows.push(row);
    }
    rows
}

/// A row that holds one pair and, axis by axis, the value that meets most open pairs; of equals the
/// first.
fn row(lengths: &[usize], open: &HashSet<Pair>, (a, i, b, j): Pair) -> Vec<usize> {
    let mut row: Vec<Option<usize>> = vec![None; lengths.len()];
    row[a] = Some(i);
    row[b] = Some(j);
    for axis in 0..lengths.len() {
        if row[axis].is_some() {
            continue;
        }
        let met = |value: usize| {
            let others = row.iter().enumerate();
            others
                .filter(|(other, at)| match at {
                    Some(at) if *other < axis => open.contains(&(*other, *at, axis, value)),
                    Some(at) => open.contains(&(axis, value, *other, *at)),
                    None => false,
                })
                .count()
        };
        let (mut best, mut most) = (0, 0);
        for value in 0..lengths[axis] {
            let count = met(value);
            if count > most {
                (best, most) = (value, count);
            }
        }
        row[axis] = Some(best);
    }
    row.into_iter().map(|at| at.unwrap_or(0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_two_values_of_every_two_axes_meet() {
        for lengths in [
            vec![],
            vec![7],
            vec![3, 4],
            vec![2, 2, 2],
            vec![5, 1, 19, 19],
            vec![8, 3, 2, 6, 4],
        ] {
            let rows = rows(&lengths);
            assert_eq!(rows, super::rows(&lengths), "the same in every run");
            for a in 0..lengths.len() {
                assert!((0..lengths[a]).all(|i| rows.iter().any(|r| r[a] == i)));
                for b in a + 1..lengths.len() {
                    for (i, j) in (0..lengths[a]).flat_map(|i| (0..lengths[b]).map(move |j| (i, j)))
                    {
                        let found = rows.iter().any(|r| r[a] == i && r[b] == j);
                        assert!(found, "{lengths:?}: {i} and {j} of axes {a} and {b}");
                    }
                }
            }
            let all: usize = lengths.iter().product();
            assert!(rows.len() <= all, "{lengths:?}: {} of {all}", rows.len());
        }
        assert!(rows(&[8, 3, 2, 6, 4]).len() < 100, "of 1152");
    }
}
