//! Scales: from a value to its position on an axis, and the ticks of the axis.

/// A map from values to positions between 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scale {
    /// Linear, between two values.
    Linear(f64, f64),
    /// Logarithmic, between the decimal logarithms of two values.
    Log(f64, f64),
}

impl Scale {
    /// Returns a linear scale that includes all values.
    pub(crate) fn linear(values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = ends(values).unwrap_or((0.0, 1.0));
        let pad = match high - low {
            0.0 => low.abs().max(1.0) * 0.5,
            span => span * 0.04,
        };
        Self::Linear(low - pad, high + pad)
    }

    /// Returns a logarithmic scale that includes all values, over at least a factor of two. The values must
    /// be positive.
    pub(crate) fn log(values: impl IntoIterator<Item = f64>) -> Self {
        let logs = values.into_iter().map(f64::log10);
        let (low, high) = ends(logs).unwrap_or((0.0, 1.0));
        let pad = ((high - low) * 0.06)
            .max((0.31 - (high - low)) / 2.0)
            .max(0.02);
        Self::Log(low - pad, high + pad)
    }

    /// Returns a logarithmic scale between two positive values.
    pub(crate) fn log_between(low: f64, high: f64) -> Self {
        Self::Log(low.log10(), high.log10())
    }

    /// Returns a logarithmic scale if all values are positive and span a factor of 20, else a linear one.
    pub(crate) fn fitting(values: &[f64]) -> Self {
        match ends(values.iter().copied()) {
            Some((low, high)) if low > 0.0 && high / low >= 20.0 => {
                Self::log(values.iter().copied())
            }
            _ => Self::linear(values.iter().copied()),
        }
    }

    /// Returns the least and the greatest value.
    pub(crate) fn ends(self) -> (f64, f64) {
        match self {
            Self::Linear(low, high) => (low, high),
            Self::Log(low, high) => (10_f64.powf(low), 10_f64.powf(high)),
        }
    }

    /// Returns the position of a value, from 0 to 1.
    pub(crate) fn at(self, value: f64) -> f64 {
        let (low, high, value) = match self {
            Self::Linear(low, high) => (low, high, value),
            Self::Log(low, high) => (low, high, value.log10()),
        };
        ((value - low) / (high - low)).clamp(0.0, 1.0)
    }

    /// Returns round values within the scale: about `count`, and never more than twice as many.
    pub(crate) fn ticks(self, count: usize) -> Vec<f64> {
        match self {
            Self::Linear(low, high) => linear_ticks(low, high, count),
            Self::Log(low, high) => {
                let decades = high - low;
                if decades < 0.7 {
                    let ticks = linear_ticks(10_f64.powf(low), 10_f64.powf(high), count);
                    return ticks.into_iter().filter(|t| *t > 0.0).collect();
                }
                let step = (decades / count as f64).ceil().max(1.0);
                let parts: &[f64] = if decades * 3.0 <= count as f64 * 1.6 {
                    &[1.0, 2.0, 5.0]
                } else if decades * 2.0 <= count as f64 * 1.6 {
                    &[1.0, 3.0]
                } else {
                    &[1.0]
                };
                let first = (low / step).floor() * step;
                let powers = ((high - first) / step).ceil() as usize + 1;
                (0..powers)
                    .map(|i| first + i as f64 * step)
                    .flat_map(|e| parts.iter().map(move |p| (e + p.log10(), *p, e)))
                    .filter(|(value, _, _)| (low..=high).contains(value))
                    .map(|(_, p, e)| power(p, e))
                    .collect()
            }
        }
    }
}

/// Returns a digit times a power of ten, rounded to the nearest `f64`.
fn power(digit: f64, exponent: f64) -> f64 {
    format!("{digit}e{exponent}")
        .parse()
        .unwrap_or_else(|_| digit * 10_f64.powf(exponent))
}

fn ends(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.into_iter().filter(|v| v.is_finite());
    finite.fold(None, |ends, v| match ends {
        None => Some((v, v)),
        Some((low, high)) => Some((low.min(v), high.max(v))),
    })
}

fn linear_ticks(low: f64, high: f64, count: usize) -> Vec<f64> {
    let raw = (high - low) / count.max(1) as f64;
    let magnitude = 10_f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|m| m * magnitude)
        .find(|s| *s >= raw * 0.999)
        .unwrap_or(raw);
    let first = (low / step).ceil();
    (0..=2 * count)
        .map(|i| (first + i as f64) * step)
        .take_while(|t| *t <= high)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_hold_their_values_and_their_ticks() {
        for values in [
            vec![1.0],
            vec![0.0, 0.0],
            vec![-3.0, 12.0],
            vec![1e-12, 1e12],
            vec![0.1, 0.100001],
        ] {
            let mut scales = vec![
                Scale::linear(values.iter().copied()),
                Scale::fitting(&values),
            ];
            if values.iter().all(|v| *v > 0.0) {
                scales.push(Scale::log(values.iter().copied()));
            }
            for scale in scales {
                for v in &values {
                    let place = scale.at(*v);
                    assert!(place > 0.0 && place < 1.0, "{scale:?} {v} {place}");
                }
                let ticks = scale.ticks(5);
                assert!((2..=12).contains(&ticks.len()), "{scale:?} {ticks:?}");
                assert!(ticks.is_sorted());
                assert!(ticks.iter().all(|t| t.is_finite()), "{ticks:?}");
            }
        }
        let ticks = Scale::log([0.001, 0.1]).ticks(5);
        assert_eq!(ticks, [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1]);
        let ticks = Scale::log([1e-6, 1.0]).ticks(5);
        assert_eq!(ticks, [1e-6, 1e-4, 0.01, 1.0]);
        assert!(matches!(Scale::fitting(&[1.0, 4.0]), Scale::Linear(..)));
        assert!(matches!(Scale::fitting(&[1.0, 64.0]), Scale::Log(..)));
    }
}
