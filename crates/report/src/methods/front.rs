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

#[cfg(test)]
mod tests {
    use super::front;

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
