//! The parameter values at which a method's error crosses one percent.

use crate::numbers::digits;

/// The largest tolerated error: one percent of full brightness.
pub(super) const LIMIT: f64 = 0.01;
/// Replaces an error of zero, which has no logarithm.
const LEAST: f64 = 1e-6;

/// The behaviour of an error along a parameter, relative to [`LIMIT`].
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Break {
    /// The error is at or below the limit everywhere.
    Never,
    /// The error is above the limit everywhere.
    Always,
    /// The error crosses the limit; the crossings are in order of the parameter.
    Crossings(Vec<Crossing>),
}

/// A point at which the error crosses [`LIMIT`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossing {
    /// The parameter's value, interpolated between the logarithms of the errors on both sides.
    pub(super) value: f64,
    /// True if the error is above the limit after the crossing.
    pub(super) leaves: bool,
    /// The measured values of the parameter on both sides.
    pub(super) between: [f64; 2],
}

impl Crossing {
    /// Returns the value with as many digits as the interpolation justifies.
    pub(super) fn text(self) -> String {
        digits(self.value, 2)
    }
}

/// Finds the break of a curve of value and error in the order of values, or `None` for fewer than two values.
/// If `log` is true, values are interpolated by their logarithms.
pub(super) fn find(curve: &[(f64, f64)], log: bool) -> Option<Break> {
    if curve.len() < 2 {
        return None;
    }
    let beyond = |e: f64| e > LIMIT;
    let errors = || curve.iter().map(|(_, e)| *e);
    if !errors().any(beyond) {
        return Some(Break::Never);
    }
    if errors().all(beyond) {
        return Some(Break::Always);
    }
    let mut crossings = Vec::new();
    for pair in curve.windows(2) {
        let [(x0, e0), (x1, e1)] = [pair[0], pair[1]];
        if beyond(e0) == beyond(e1) {
            continue;
        }
        let [l0, l1] = [e0, e1].map(|e| e.max(LEAST).ln());
        let t = (LIMIT.ln() - l0) / (l1 - l0);
        let value = if log && x0 > 0.0 {
            (x0.ln() + t * (x1.ln() - x0.ln())).exp()
        } else {
            x0 + t * (x1 - x0)
        };
        crossings.push(Crossing {
            value,
            leaves: beyond(e1),
            between: [x0, x1],
        });
    }
    Some(Break::Crossings(crossings))
}

/// Returns crossings in words: `weighted-blended leaves 1 % RMSE at alpha 0.63`.
pub(super) fn sentence(method: &str, parameter: &str, crossings: &[Crossing]) -> String {
    let crossing = |(i, c): (usize, &Crossing)| {
        let verb = if c.leaves { "leaves" } else { "comes within" };
        let limit = if i == 0 { " 1\u{a0}% RMSE" } else { " it" };
        format!("{verb}{limit} at {parameter} {}", c.text())
    };
    let parts: Vec<String> = crossings.iter().enumerate().map(crossing).collect();
    format!("{method} {}", parts.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crossings(curve: &[(f64, f64)], log: bool) -> Vec<(f64, bool)> {
        match find(curve, log) {
            Some(Break::Crossings(crossings_found)) => crossings_found
                .iter()
                .map(|c| (c.value, c.leaves))
                .collect(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn breaks_are_interpolated_between_logarithms() {
        // Halfway between 0.001 and 0.1 on a logarithmic scale.
        let [(value, leaves)] = crossings(&[(0.0, 0.001), (1.0, 0.1)], false)[..] else {
            panic!()
        };
        assert!((value - 0.5).abs() < 1e-12 && leaves);
        let Some(Break::Crossings(crossings_found)) =
            find(&[(0.0, 0.1), (2.0, 0.1), (3.0, 0.001)], false)
        else {
            panic!()
        };
        assert_eq!(
            crossings_found[0].between,
            [2.0, 3.0],
            "what was measured beside it"
        );
        // A quarter of the way, falling.
        let [(value, leaves)] = crossings(&[(2.0, 0.1), (6.0, 1e-5)], false)[..] else {
            panic!()
        };
        assert!((value - 3.0).abs() < 1e-12 && !leaves);
        // On a logarithmic axis, the middle of 1 and 100 is 10.
        let [(value, _)] = crossings(&[(1.0, 0.1), (100.0, 0.001)], true)[..] else {
            panic!()
        };
        assert!((value - 10.0).abs() < 1e-9);
        // An error of zero counts as a millionth.
        let [(value, _)] = crossings(&[(0.0, 0.0), (1.0, 1.0)], false)[..] else {
            panic!()
        };
        assert!((value - 4.0 / 6.0).abs() < 1e-12);
        let there_and_back = [(0.0, 0.001), (1.0, 0.1), (2.0, 0.001)];
        assert_eq!(
            crossings(&there_and_back, false)
                .iter()
                .map(|c| c.1)
                .collect::<Vec<_>>(),
            [true, false]
        );
    }

    #[test]
    fn exactly_one_percent_is_not_beyond() {
        let never = find(&[(0.0, 0.01), (1.0, 0.002)], false);
        assert_eq!(never, Some(Break::Never));
        let always = find(&[(0.0, 0.02), (1.0, 0.5)], false);
        assert_eq!(always, Some(Break::Always));
        assert_eq!(find(&[(0.0, 1.0)], false), None);
        // A curve that starts at the limit crosses there.
        assert_eq!(crossings(&[(3.0, 0.01), (4.0, 0.5)], false), [(3.0, true)]);
    }

    #[test]
    fn crossings_are_described_in_sentences() {
        let sentence = |curve: &[(f64, f64)]| match find(curve, false) {
            Some(Break::Crossings(crossings)) => sentence("m", "alpha", &crossings),
            other => panic!("{other:?}"),
        };
        assert_eq!(
            sentence(&[(0.0, 0.001), (1.0, 0.1)]),
            "m leaves 1\u{a0}% RMSE at alpha 0.5"
        );
        assert_eq!(
            sentence(&[(0.0, 0.1), (1.0, 0.001), (2.0, 0.1)]),
            "m comes within 1\u{a0}% RMSE at alpha 0.5, leaves it at alpha 1.5"
        );
    }
}
