//! The Pareto front of two costs.

/// Returns the points that no other point beats, in the order of the first cost. A point beats another if it
/// is as good in both costs and better in one. Of equal points, only the first is returned.
pub(super) fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|a, b| {
        let (a, b) = (points[*a], points[*b]);
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let mut least = f64::INFINITY;
    order.retain(|i| {
        let better = points[*i].1 < least;
        least = least.min(points[*i].1);
        better
    });
    order
}

/// Returns the points that can be on the front or not, since the first cost is only known to be within an interval.
pub(super) fn undecided(points: &[([f64; 2], f64)]) -> Vec<usize> {
    let beats = |a: f64, a_other: f64, b: f64, b_other: f64| {
        a_other <= b_other && (a < b || (a == b && a_other < b_other))
    };
    let undecided = |point: &usize| {
        let ([low, high], cost) = points[*point];
        let others = points.iter().enumerate().filter(|(i, _)| i != point);
        let (mut possibly, mut certainly) = (false, false);
        for (_, &([other_low, other_high], other)) in others {
            possibly |= beats(other_low, other, high, cost);
            certainly |= beats(other_high, other, low, cost);
        }
        possibly && !certainly
    };
    (0..points.len()).filter(undecided).collect()
}

#[cfg(test)]
mod tests {
    use super::{front, undecided};

    #[test]
    fn overlapping_intervals_leave_the_front_open() {
        let known = |first: f64, second: f64| ([first; 2], second);
        assert_eq!(
            undecided(&[known(1.0, 1.0), known(1.0, 2.0), known(1.0, 1.0)]),
            [0; 0]
        );
        // The first may be slower than the second, which is more accurate. The third is slower than both.
        let points = [([1.0, 3.0], 2.0), ([2.0, 4.0], 1.0), ([5.0, 6.0], 2.0)];
        assert_eq!(undecided(&points), [0]);
        // The second is worse, but can be faster.
        assert_eq!(undecided(&[([2.0, 4.0], 1.0), ([3.0, 5.0], 2.0)]), [1]);
        assert_eq!(undecided(&[([2.0, 3.0], 1.0), ([4.0, 5.0], 2.0)]), [0; 0]);
    }

    #[test]
    fn no_point_beats_a_point_on_the_front() {
        assert_eq!(front(&[]), [0; 0]);
        assert_eq!(front(&[(1.0, 1.0)]), [0]);
        // The third point beats the second, and the last equals the first.
        let points = [(3.0, 0.0), (2.0, 2.0), (2.0, 1.0), (1.0, 5.0), (3.0, 0.0)];
        assert_eq!(front(&points), [3, 2, 0]);
        // As slow, but worse.
        assert_eq!(front(&[(1.0, 2.0), (1.0, 1.0)]), [1]);
        // Slower and no better.
        assert_eq!(front(&[(1.0, 1.0), (2.0, 1.0)]), [0]);
    }

    #[test]
    fn the_front_agrees_with_its_definition() {
        let mut state = 7_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 29)
        };
        for _ in 0..200 {
            let points: Vec<(f64, f64)> = (0..9).map(|_| (next(), next())).collect();
            let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
            let mut expected: Vec<(f64, f64)> = points
                .iter()
                .copied()
                .filter(|p| !points.iter().any(|o| beats(*o, *p)))
                .collect();
            expected.sort_by(|a, b| a.0.total_cmp(&b.0));
            expected.dedup();
            let found: Vec<(f64, f64)> = front(&points).into_iter().map(|i| points[i]).collect();
            assert_eq!(found, expected);
        }
    }
}
