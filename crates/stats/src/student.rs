//! Student's distribution (Abramowitz and Stegun, 26.7).

use statrs::function::beta::checked_beta_reg;

/// Returns the probability that a variable of Student's distribution is farther from 0 than `t`; NaN without a
/// degree of freedom.
pub(crate) fn two_sided(t: f64, freedom: f64) -> f64 {
    if t.is_infinite() {
        return 0.0;
    }
    let square = t * t;
    // Without a degree of freedom, nothing is known.
    checked_beta_reg(freedom / 2.0, 0.5, freedom / (freedom + square)).unwrap_or(f64::NAN)
}

/// Returns the magnitude that a variable of Student's distribution exceeds with this probability.
pub(crate) fn quantile(probability: f64, freedom: f64) -> f64 {
    least(|t| two_sided(t, freedom) <= probability)
}

/// Returns the least value above 0 from which on a condition is true, to one part in 2^50.
pub(crate) fn least(holds: impl Fn(f64) -> bool) -> f64 {
    let mut high = 1.0;
    while !holds(high) && high < 1e12 {
        high *= 2.0;
    }
    let mut low = 0.0;
    for _ in 0..50 {
        let middle = f64::midpoint(low, high);
        if holds(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_quantiles_hold() {
        // Percentage points of Student's distribution, two-sided (Abramowitz and Stegun, table 26.10).
        for (freedom, probability, expected) in [
            (1.0, 0.05, 12.706),
            (4.0, 0.05, 2.776),
            (6.0, 0.01, 3.707),
            (10.0, 0.001, 4.587),
            (30.0, 0.05, 2.042),
            (120.0, 0.001, 3.373),
        ] {
            let found = quantile(probability, freedom);
            assert!(
                (found - expected).abs() < 6e-4,
                "{freedom} {probability}: {found}"
            );
            assert!((two_sided(found, freedom) - probability).abs() < 1e-9);
        }
    }

    #[test]
    fn student_s_distribution_agrees_with_closed_forms_far_out() {
        // One degree of freedom is Cauchy's distribution, two have an algebraic one.
        for t in [0.0, 0.1, 1.0, 7.0, 1e3, 1e6] {
            let cauchy = 1.0 - 2.0 / std::f64::consts::PI * f64::atan(t);
            assert!((two_sided(t, 1.0) - cauchy).abs() < 1e-12, "{t}");
            let root = (2.0 + t * t).sqrt();
            let two = 2.0 / (root * (root + t));
            assert!((two_sided(t, 2.0) / two - 1.0).abs() < 1e-9, "{t}");
        }
        assert_eq!(two_sided(f64::INFINITY, 5.0), 0.0);
        // Nearly normal: P(|Z| > 1.96) is 0.05.
        assert!((two_sided(1.959_964, 1e7) - 0.05).abs() < 1e-6);
    }
}
