//! Numbers as text. Measured values keep a fixed number of digits, so that columns line up and the precision
//! is visible. Chosen values (axis ticks, limits) drop trailing zeros.

use etalon_stats::quantile;

/// Returns `1 case` or `2 cases`.
pub(crate) fn count(n: u64, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

/// Returns a measured time with four significant digits: `1.234 ms`.
pub(crate) fn duration(seconds: f64) -> String {
    let (value, unit) = scaled(seconds);
    match value.abs() {
        v if v >= 1e6 => format!("{value:.1e} {unit}"),
        v if v >= 100.0 => format!("{value:.1} {unit}"),
        v if v >= 10.0 => format!("{value:.2} {unit}"),
        _ => format!("{value:.3} {unit}"),
    }
}

/// Returns a number of instructions with four significant digits: `1.234 M`.
pub(crate) fn instructions(n: f64) -> String {
    let (value, unit) = match n {
        n if n >= 1e9 => (n / 1e9, " G"),
        n if n >= 1e6 => (n / 1e6, " M"),
        n if n >= 1e3 => (n / 1e3, " k"),
        n => (n, ""),
    };
    let decimals = match value {
        v if v >= 100.0 => 1,
        v if v >= 10.0 => 2,
        _ => 3,
    };
    format!("{value:.decimals$}{unit}")
}

/// Returns a chosen time, such as a limit or an axis tick: `20 s`, `0.5 ms`.
pub(crate) fn round_duration(seconds: f64) -> String {
    let (value, unit) = scaled(seconds);
    format!("{} {unit}", digits(value, 3))
}

/// Returns a time in the unit that gives one to three digits before the decimal point.
fn scaled(seconds: f64) -> (f64, &'static str) {
    match seconds.abs() {
        0.0 => (0.0, "s"),
        s if s < 1e-6 => (seconds * 1e9, "ns"),
        s if s < 1e-3 => (seconds * 1e6, "µs"),
        s if s < 1.0 => (seconds * 1e3, "ms"),
        _ => (seconds, "s"),
    }
}

/// Returns the ends of a range: `1 ms to 2 ms`.
pub(crate) fn between([low, high]: [f64; 2], text: impl Fn(f64) -> String) -> String {
    format!("{} to {}", text(low), text(high))
}

/// Returns a ratio as a signed change, `+3.1 %`, or as a factor if it is at least two, `×2.50`.
pub(crate) fn change(ratio: f64) -> String {
    if !ratio.is_finite() {
        "∞".to_owned()
    } else if ratio >= 2.0 {
        format!("×{ratio:.2}")
    } else {
        format!("{:+.1} %", (ratio - 1.0) * 100.0)
    }
}

/// Returns a fraction as a percentage with this many decimals: `12.3 %`. Only 0 and 1 become `0 %` and `100
/// %`.
pub(crate) fn percent(share: f64, decimals: usize) -> String {
    match share {
        s if s <= 0.0 => "0 %".to_owned(),
        s if s >= 1.0 => "100 %".to_owned(),
        s => {
            let least = 0.1_f64.powi(decimals as i32);
            let value = (s * 100.0).clamp(least, 100.0 - least);
            format!("{value:.decimals$} %")
        }
    }
}

/// Returns a part of a whole, like [`percent`]; 0 % if the whole is 0.
pub(crate) fn percent_of(part: u64, whole: u64) -> String {
    percent(part as f64 / whole.max(1) as f64, 1)
}

/// Returns an error as a percentage of full brightness, with three significant digits: `0.25 %`.
pub(crate) fn share(value: f64) -> String {
    match value * 100.0 {
        0.0 => "0".to_owned(),
        v if v < 9.5e-5 => format!("{v:.0e}\u{a0}%"),
        v => format!("{}\u{a0}%", digits(v, 3)),
    }
}

/// Returns a number with this many significant digits, without trailing zeros.
pub(crate) fn digits(value: f64, significant: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = value.abs().log10().floor() as i32;
    if !(-7..15).contains(&magnitude) {
        return format!("{value:.2e}");
    }
    let decimals = usize::try_from(significant - 1 - magnitude).unwrap_or(0);
    trimmed(format!("{value:.decimals$}"))
}

/// Returns a text with its first letter in upper case.
pub(crate) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}

/// Returns a decimal number without trailing zeros after its point.
pub(crate) fn trimmed(text: String) -> String {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// Returns the median of the finite values, or `None` if no value is finite.
pub(crate) fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.filter(|v| v.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    quantile(&values, 0.5)
}

/// Returns digits in groups of three, separated by narrow no-break spaces.
pub(crate) fn thousands(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// Returns a size in memory: `512 B`, `1.5 MB`.
pub(crate) fn bytes(n: u64) -> String {
    match n {
        n if n < 10_000 => format!("{n}\u{a0}B"),
        n if n < 10_000_000 => format!("{}\u{a0}kB", digits(n as f64 / 1e3, 3)),
        n => format!("{}\u{a0}MB", digits(n as f64 / 1e6, 3)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_have_four_digits_and_a_unit() {
        assert_eq!(duration(1.5), "1.500 s");
        assert_eq!(duration(0.012_345_6), "12.35 ms");
        assert_eq!(duration(0.000_234_56), "234.6 µs");
        assert_eq!(duration(5e-9), "5.000 ns");
        assert_eq!(duration(0.0), "0.000 s");
        assert_eq!(duration(-0.25), "-250.0 ms");
        assert_eq!(duration(1e300), "1.0e300 s");
    }

    #[test]
    fn round_durations_have_no_zeros_at_their_end() {
        assert_eq!(round_duration(0.001_234_56), "1.23 ms");
        assert_eq!(round_duration(0.0002), "200 µs");
        assert_eq!(round_duration(12.0), "12 s");
        assert_eq!(round_duration(0.0), "0 s");
    }

    #[test]
    fn changes_have_a_sign() {
        assert_eq!(change(1.031), "+3.1 %");
        assert_eq!(change(0.9), "-10.0 %");
        assert_eq!(change(2.5), "×2.50");
        assert_eq!(change(f64::INFINITY), "∞");
    }

    #[test]
    fn a_share_that_is_not_all_or_nothing_is_not_rounded_to_it() {
        let shares = [(0, 9), (9, 9), (1, 1_000_000), (999_999, 1_000_000)];
        let texts = shares.map(|(part, whole)| percent_of(part, whole));
        assert_eq!(texts, ["0 %", "100 %", "0.1 %", "99.9 %"]);
        assert_eq!(percent(0.999_999, 2), "99.99 %");
        assert_eq!(percent(0.5, 2), "50.00 %");
    }

    #[test]
    fn figures_are_short() {
        assert_eq!(share(0.01), "1\u{a0}%");
        assert_eq!(share(0.00113), "0.113\u{a0}%");
        assert_eq!(share(0.0), "0");
        assert_eq!(share(1e-9), "1e-7\u{a0}%");
        assert_eq!(digits(1234.5, 3), "1234");
        assert_eq!(digits(0.63, 3), "0.63");
        assert_eq!(bytes(9_999), "9999\u{a0}B");
        assert_eq!(bytes(1_500_000), "1500\u{a0}kB");
    }

    #[test]
    fn digits_are_grouped_from_the_right() {
        assert_eq!(thousands(1_234_567), "1\u{202f}234\u{202f}567");
        assert_eq!(thousands(123), "123");
    }
}
