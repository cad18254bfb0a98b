//! The shift between two sets of values, by ranks.
//!
//! The Wilcoxon–Mann–Whitney statistic U counts the pairs in which the second set's value is the smaller one.
//! If both sets come from one distribution, every order of all values is equally likely, whatever that
//! distribution is, so the distribution of U is known exactly. By inversion, the shifts that the test would
//! not reject are between two of the ordered differences of pairs (Hodges and Lehmann 1963; Hollander and
//! Wolfe, Nonparametric Statistical Methods, 4.3).

/// The minimum number of rounds on each side for a conclusion at [`crate::LEVEL`]: with 6 on each side, even
/// the most extreme of the 924 orders has a probability above half the level.
pub const MIN_ROUNDS: usize = 7;

/// The largest number of values for which orders are counted; C(120, 60) and every intermediate count fit
/// into 128 bits. Beyond it, the normal approximation is used: U has lighter tails than the normal
/// distribution, so the approximation can only make the interval wider.
const COUNTED: usize = 120;

/// Returns the number of ordered differences of pairs outside the interval of a level at each end, plus one:
/// the largest k with P(U < k) <= level / 2. Returns 0 if no interval has that level.
pub(crate) fn rank_of_bound(m: usize, n: usize, level: f64) -> usize {
    if m == 0 || n == 0 {
        return 0;
    }
    if m + n > COUNTED {
        return normal_rank(m, n, level);
    }
    // The number of orders with U = u is the coefficient of q^u of the Gaussian binomial, the
    // product over i = 1..=m of (1 - q^(n+i)) / (1 - q^i).
    let most = m * n / 2;
    let mut orders = vec![0_i128; most + 1];
    if let Some(first) = orders.first_mut() {
        *first = 1;
    }
    let mut total = 1.0_f64;
    for i in 1..=m {
        total *= (n + i) as f64 / i as f64;
        for u in (n + i..=most).rev() {
            orders[u] -= orders[u - (n + i)];
        }
        for u in i..=most {
            orders[u] += orders[u - i];
        }
    }
    let mut below = 0.0;
    for (u, count) in orders.iter().enumerate() {
        below += *count as f64 / total;
        if below > level / 2.0 {
            return u;
        }
    }
    most
}

/// Returns the rank of the bound by the normal distribution of the same mean and variance, with continuity
/// correction.
fn normal_rank(m: usize, n: usize, level: f64) -> usize {
    let (m, n) = (m as f64, n as f64);
    let deviation = (m * n * (m + n + 1.0) / 12.0).sqrt();
    let rank = m * n / 2.0 - upper_normal(level / 2.0) * deviation - 0.5;
    rank.floor().max(0.0) as usize
}

/// Returns the value that a standard normal variable exceeds with a small probability: Abramowitz and Stegun
/// 26.2.23, error below 4.5e-4, for probabilities up to a half.
pub(crate) fn upper_normal(probability: f64) -> f64 {
    let t = (-2.0 * probability.ln()).sqrt();
    let above = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    let below = 1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308));
    // The error bound is added, so that the interval is never too narrow.
    t - above / below + 4.5e-4
}

/// A shift with its interval, which is infinite if there are too few values for the level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shift {
    pub(crate) estimate: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
}

/// Returns how far `after` is above `before`: the median of all differences of pairs, and the interval of the
/// shift with a confidence of at least 1 - `level`.
pub(crate) fn shift(before: &[f64], after: &[f64], level: f64) -> Shift {
    let mut pairs = Vec::new();
    differences(before, after, &mut pairs);
    let rank = rank_of_bound(before.len(), after.len(), level);
    let (low, high) = bounds(&mut pairs, rank);
    let middle = pairs.len() / 2;
    let odd = pairs.len() % 2 == 1;
    let mut nth = |i: usize| *pairs.select_nth_unstable_by(i, f64::total_cmp).1;
    let estimate = match middle {
        0 => nth(0),
        _ if odd => nth(middle),
        _ => f64::midpoint(nth(middle - 1), nth(middle)),
    };
    Shift {
        estimate,
        low,
        high,
    }
}

/// Returns only the lower bound of [`shift`]'s interval, given the bound's rank; `room` is overwritten.
pub(crate) fn lower_bound(before: &[f64], after: &[f64], rank: usize, room: &mut Vec<f64>) -> f64 {
    differences(before, after, room);
    match rank.checked_sub(1).filter(|index| *index < room.len()) {
        Some(index) => *room.select_nth_unstable_by(index, f64::total_cmp).1,
        None => f64::NEG_INFINITY,
    }
}

/// Writes the differences of all pairs.
fn differences(before: &[f64], after: &[f64], into: &mut Vec<f64>) {
    into.clear();
    for b in before {
        into.extend(after.iter().map(|a| a - b));
    }
}

/// Returns the `rank`th smallest and the `rank`th largest value, counted from 1.
fn bounds(values: &mut [f64], rank: usize) -> (f64, f64) {
    let Some(index) = rank.checked_sub(1).filter(|index| *index < values.len()) else {
        return (f64::NEG_INFINITY, f64::INFINITY);
    };
    let last = values.len() - 1;
    let low = *values.select_nth_unstable_by(index, f64::total_cmp).1;
    let high = *values
        .select_nth_unstable_by(last - index, f64::total_cmp)
        .1;
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LEVEL;

    /// Returns the distribution of U by enumerating every order.
    fn counted(m: usize, n: usize) -> Vec<f64> {
        let mut orders = vec![0.0; m * n + 1];
        for set in 0_u32..1 << (m + n) {
            if set.count_ones() as usize != m {
                continue;
            }
            let mut u = 0;
            let mut others = 0;
            for i in 0..m + n {
                match set >> i & 1 {
                    1 => u += others,
                    _ => others += 1,
                }
            }
            orders[u] += 1.0;
        }
        orders
    }

    #[test]
    fn ranks_of_bounds_are_those_of_all_orders_counted() {
        for (m, n) in [
            (1, 1),
            (3, 4),
            (5, 5),
            (6, 6),
            (7, 7),
            (8, 7),
            (4, 11),
            (9, 9),
        ] {
            let orders = counted(m, n);
            let total: f64 = orders.iter().sum();
            for level in [0.2, 0.05, 0.01, LEVEL] {
                let mut below = 0.0;
                let expected = orders.iter().position(|count| {
                    below += count / total;
                    below > level / 2.0
                });
                let expected = expected.unwrap().min(m * n / 2);
                assert_eq!(rank_of_bound(m, n, level), expected, "{m} {n} {level}");
            }
        }
    }

    #[test]
    fn published_critical_values_hold() {
        // Two-sided tables of the largest significant U: Mann and Whitney's test at 0.05 and 0.01 for 10 and
        // 10 (23 and 16), for 20 and 20 (127 and 105).
        for (n, level, critical) in [
            (10, 0.05, 23),
            (10, 0.01, 16),
            (20, 0.05, 127),
            (20, 0.01, 105),
        ] {
            assert_eq!(rank_of_bound(n, n, level), critical + 1);
        }
    }

    #[test]
    fn seven_rounds_are_the_fewest_that_can_say_anything() {
        assert_eq!(rank_of_bound(MIN_ROUNDS - 1, MIN_ROUNDS - 1, LEVEL), 0);
        assert_eq!(rank_of_bound(MIN_ROUNDS, MIN_ROUNDS, LEVEL), 1);
        assert_eq!(rank_of_bound(0, 100, LEVEL), 0);
    }

    #[test]
    fn the_normal_approximation_takes_over_on_the_safe_side() {
        for n in [40, 50, 60] {
            let counted = rank_of_bound(n, n, LEVEL);
            let normal = normal_rank(n, n, LEVEL);
            assert!(
                normal <= counted && normal * 100 >= counted * 97,
                "{n}: {counted} {normal}"
            );
        }
        // And it increases throughout, including where the approximation takes over.
        let ranks: Vec<usize> = (55..66).map(|n| rank_of_bound(n, n, LEVEL)).collect();
        assert!(ranks.is_sorted(), "{ranks:?}");
    }

    #[test]
    fn a_shift_is_the_median_difference() {
        let before: Vec<f64> = (0..9).map(f64::from).collect();
        let after: Vec<f64> = before.iter().map(|v| v + 3.0).collect();
        let s = shift(&before, &after, 0.05);
        assert_eq!(s.estimate, 3.0);
        assert!(s.low < 3.0 && 3.0 < s.high && s.low > -3.0, "{s:?}");
        let single = shift(&[1.0], &[4.0], 0.05);
        assert_eq!((single.estimate, single.high), (3.0, f64::INFINITY));
        let two = shift(&[1.0], &[4.0, 6.0], 0.05);
        assert_eq!((two.estimate, two.low), (4.0, f64::NEG_INFINITY));
    }
}
