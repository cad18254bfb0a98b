//! Student's distribution: Abramowitz and Stegun, 26.5 and 26.7.

/// Returns the probability that a variable of Student's distribution is farther from 0 than `t`.
pub(crate) fn two_sided(t: f64, freedom: f64) -> f64 {
    if t.is_infinite() {
        return 0.0;
    }
    let square = t * t;
    incomplete_beta(freedom / (freedom + square), freedom / 2.0, 0.5).clamp(0.0, 1.0)
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

/// Returns the regularized incomplete beta function.
fn incomplete_beta(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return x.clamp(0.0, 1.0);
    }
    let front = a * x.ln() + b * (1.0 - x).ln() + ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b);
    // The fraction converges fast only on this side of the mean.
    if x < (a + 1.0) / (a + b + 2.0) {
        front.exp() * beta_fraction(x, a, b) / a
    } else {
        1.0 - front.exp() * beta_fraction(1.0 - x, b, a) / b
    }
}

/// Returns the continued fraction 26.5.8, evaluated from the front (Lentz 1976).
fn beta_fraction(x: f64, a: f64, b: f64) -> f64 {
    let guarded = |v: f64| if v.abs() < 1e-300 { 1e-300 } else { v };
    let mut c = 1.0;
    let mut d = 1.0 / guarded(1.0 - (a + b) * x / (a + 1.0));
    let mut fraction = d;
    for m in 1..500 {
        let m = f64::from(m);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut factor = 1.0;
        for term in [even, odd] {
            d = 1.0 / guarded(1.0 + term * d);
            c = guarded(1.0 + term / c);
            factor = c * d;
            fraction *= factor;
        }
        if (factor - 1.0).abs() < 1e-14 {
            break;
        }
    }
    fraction
}

/// Returns the logarithm of the gamma function above 0: Stirling's series (6.1.41), shifted until five terms
/// suffice.
fn ln_gamma(x: f64) -> f64 {
    let mut x = x;
    let mut product = 1.0;
    while x < 10.0 {
        product *= x;
        x += 1.0;
    }
    let y = 1.0 / (x * x);
    let series =
        1.0 / 12.0 - y * (1.0 / 360.0 - y * (1.0 / 1260.0 - y * (1.0 / 1680.0 - y / 1188.0)));
    (x - 0.5) * x.ln() - x + 0.5 * std::f64::consts::TAU.ln() + series / x - f64::ln(product)
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
    fn closed_forms_hold_far_out() {
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
