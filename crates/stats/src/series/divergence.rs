//! The place that divides a stretch into the two parts that differ the most.
//!
//! The measure is the energy distance of Matteson and James (2014) between the parts before and after a
//! place, with exponent 1. Sums of distances between numbers need no pairs: a Fenwick tree over ranks keeps
//! count and sum of the values so far, so all places of n values take n log n steps.

/// Returns the index from `least` to `len - least` that divides the values best, if there is one.
pub(super) fn best_place(values: &[f64], least: usize) -> Option<usize> {
    let n = values.len();
    let last = n.checked_sub(least).filter(|last| *last >= least)?;
    let before = inner_distances(values.iter());
    let mut after = inner_distances(values.iter().rev());
    after.reverse();
    let pairs = |k: usize| (k * (k - 1)) as f64 / 2.0;
    let mut best = (0.0, None);
    for place in least..=last {
        let between = before[n] - before[place] - after[place];
        let (m, k) = (place as f64, (n - place) as f64);
        let inner = before[place] / pairs(place) + after[place] / pairs(n - place);
        let divergence = m * k / (m + k) * (2.0 / (m * k) * between - inner);
        if divergence > best.0 {
            best = (divergence, Some(place));
        }
    }
    best.1
}

/// Returns, for each k, the sum of the distances of all pairs among the first k values.
fn inner_distances<'a>(values: impl Iterator<Item = &'a f64> + Clone) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.clone().copied().collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let mut seen = RankSums(vec![(0.0, 0.0); sorted.len() + 1]);
    let mut total = 0.0;
    let (mut count, mut sum) = (0.0, 0.0);
    let mut sums = vec![0.0];
    for value in values {
        let rank = sorted.partition_point(|v| v < value) + 1;
        let (below, sum_below) = seen.up_to(rank);
        total += value * below - sum_below + (sum - sum_below) - value * (count - below);
        seen.add(rank, *value);
        count += 1.0;
        sum += value;
        sums.push(total);
    }
    sums
}

/// Counts and sums of the values so far, by rank from 1.
struct RankSums(Vec<(f64, f64)>);

impl RankSums {
    fn add(&mut self, rank: usize, value: f64) {
        let mut node = rank;
        while let Some((count, sum)) = self.0.get_mut(node) {
            *count += 1.0;
            *sum += value;
            node += node & node.wrapping_neg();
        }
    }

    fn up_to(&self, rank: usize) -> (f64, f64) {
        let mut sums = (0.0, 0.0);
        let mut node = rank;
        while node > 0 {
            let (count, sum) = self.0[node];
            sums = (sums.0 + count, sums.1 + sum);
            node &= node - 1;
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use oorandom::Rand64;

    /// Returns the divergence at a place, directly by its definition.
    fn divergence(values: &[f64], place: usize) -> f64 {
        let (before, after) = values.split_at(place);
        let mean = |a: &[f64], b: &[f64]| {
            let distances = a.iter().flat_map(|x| b.iter().map(move |y| (x - y).abs()));
            distances.sum::<f64>()
        };
        let (m, n) = (before.len() as f64, after.len() as f64);
        let within = |a: &[f64]| mean(a, a) / (a.len() * (a.len() - 1)) as f64;
        m * n / (m + n) * (2.0 * mean(before, after) / (m * n) - within(before) - within(after))
    }

    #[test]
    fn the_best_place_has_the_largest_divergence() {
        for seed in 0..50 {
            let mut random = Rand64::new(seed);
            let values: Vec<f64> = (0..30)
                .map(|i| (random.rand_float() * 8.0).round() + if i > 18 { 3.0 } else { 0.0 })
                .collect();
            let found = best_place(&values, 3).unwrap();
            let most = (3..=27).map(|p| divergence(&values, p)).fold(0.0, f64::max);
            assert!((divergence(&values, found) - most).abs() < 1e-9, "{seed}");
        }
    }

    #[test]
    fn equal_or_few_values_have_no_best_place() {
        assert_eq!(best_place(&[5.0; 12], 4), None);
        assert_eq!(best_place(&[1.0, 2.0, 3.0], 2), None);
        assert_eq!(best_place(&[], 2), None);
        assert_eq!(best_place(&[1.0, 1.0, 2.0, 2.0], 2), Some(2));
    }
}
