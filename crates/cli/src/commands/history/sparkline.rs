//! Sparklines: lines of signs that show a development.

use etalon_record::Standing;

/// The largest number of signs of a line.
const WIDTH: usize = 80;

/// The bars for times, lowest first.
const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// Returns the values in groups of equal size, at most [`WIDTH`] groups.
fn groups<T>(values: &[T]) -> impl Iterator<Item = &[T]> {
    values.chunks(size(values.len()))
}

/// Returns the number of values that one sign stands for.
pub(super) fn size(values: usize) -> usize {
    values.div_ceil(WIDTH).max(1)
}

/// Returns a sign for each run, or for the worst of several.
pub(super) fn of_standings(standings: &[Standing]) -> String {
    let rank = |standing: &Standing| match standing {
        Standing::Unknown => 0,
        Standing::Good => 1,
        Standing::Flaky => 2,
        Standing::Bad => 3,
    };
    let sign = |standing: &Standing| match standing {
        Standing::Unknown => '·',
        Standing::Good => '✓',
        Standing::Flaky => '~',
        Standing::Bad => '✗',
    };
    groups(standings)
        .filter_map(|group| group.iter().max_by_key(|s| rank(s)))
        .map(sign)
        .collect()
}

/// Returns a bar for each time, or for the median of several, scaled between the lowest and the highest.
pub(super) fn of_times(times: &[f64]) -> String {
    let medians: Vec<f64> = groups(times)
        .filter_map(|group| {
            let mut sorted = group.to_vec();
            sorted.sort_unstable_by(f64::total_cmp);
            sorted.get(sorted.len() / 2).copied()
        })
        .collect();
    let low = medians.iter().copied().fold(f64::INFINITY, f64::min);
    let high = medians.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let top = BARS.len() - 1;
    let bar = |time: &f64| {
        // If all times are equal, the bars are low.
        let height = (time - low) / (high - low).max(f64::MIN_POSITIVE);
        BARS[((height * top as f64).round() as usize).min(top)]
    };
    medians.iter().map(bar).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_run_has_a_sign() {
        use Standing::{Bad, Flaky, Good, Unknown};
        assert_eq!(of_standings(&[Good, Bad, Flaky, Unknown]), "✓✗~·");
        assert_eq!(of_standings(&[]), "");
        assert_eq!(of_times(&[1.0, 1.5, 2.0]), "▁▅█");
        assert_eq!(of_times(&[2.0, 2.0]), "▁▁");
        assert_eq!(of_times(&[]), "");
    }

    #[test]
    fn many_runs_share_signs_and_none_is_hidden() {
        let mut standings = vec![Standing::Good; 1000];
        standings[500] = Standing::Bad;
        let line = of_standings(&standings);
        assert!(line.chars().count() <= WIDTH, "{line}");
        assert_eq!(line.matches('✗').count(), 1);
        let times: Vec<f64> = (0..1000).map(|i| 1.0 + f64::from(i)).collect();
        let line = of_times(&times);
        assert!(line.starts_with('▁') && line.ends_with('█'), "{line}");
    }
}
