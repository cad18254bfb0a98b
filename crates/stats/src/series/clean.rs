//! Outliers, clamped towards their neighbours.
//!
//! A value is clamped to [`REACH`] deviations around the median of the [`WINDOW`] runs around it. Steps stay,
//! since a stretch of at least four runs is the majority of its own window, and one to three disturbed runs
//! in a row lose their weight. The deviation comes from differences of neighbours, which a step or a drift
//! hardly affects.

use crate::samples::quantile;

/// The number of runs in the window whose median a value is compared with.
const WINDOW: usize = 7;
/// The number of deviations that a value can be away from that median.
const REACH: f64 = 3.5;
/// The quantile of differences from which the deviation is computed. Up to an eighth of all runs can be
/// disturbed before it rises. If a machine switches between two speeds more often than that, the switches
/// raise it, and neither speed is clamped.
const QUANTILE: f64 = 0.75;
/// The same quantile of the magnitude of a standard normal variable.
const NORMAL: f64 = 1.150_349;
/// The minimum deviation, as a logarithm: medians of times are no finer.
pub(super) const FLOOR: f64 = 1e-4;

/// Returns the values with outliers clamped.
pub(super) fn clean(values: &[f64]) -> Vec<f64> {
    let reach = REACH * deviation(values);
    let half = WINDOW / 2;
    let mut room = Vec::with_capacity(WINDOW);
    let clamped = values.iter().enumerate().map(|(i, value)| {
        room.clear();
        room.extend_from_slice(&values[i.saturating_sub(half)..values.len().min(i + half + 1)]);
        room.sort_unstable_by(f64::total_cmp);
        let middle = quantile(&room, 0.5).unwrap_or(*value);
        value.clamp(middle - reach, middle + reach)
    });
    clamped.collect()
}

/// Returns the deviation of values, from the differences of neighbours.
fn deviation(values: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = values.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    let size = quantile(&sizes, QUANTILE).unwrap_or(0.0);
    (size / NORMAL / std::f64::consts::SQRT_2).max(FLOOR)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spikes_are_removed_and_steps_stay() {
        let mut values = vec![0.0; 20];
        values[5] = 1.0;
        values[6] = 2.0;
        values.extend([0.3; 12]);
        let cleaned = clean(&values);
        for (i, value) in cleaned.iter().enumerate() {
            let level = if i < 20 { 0.0 } else { 0.3 };
            assert!(
                (value - level).abs() <= REACH * FLOOR + 1e-12,
                "{i}: {value}"
            );
        }
        assert!(clean(&[]).is_empty());
        assert_eq!(clean(&[4.0]), [4.0]);
    }

    #[test]
    fn two_alternating_paces_are_both_kept() {
        let values: Vec<f64> = (0..60)
            .map(|i| if i * i % 7 < 3 { 0.0 } else { 0.2 })
            .collect();
        assert_eq!(clean(&values), values);
    }
}
