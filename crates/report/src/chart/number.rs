//! Coordinates as text.

/// A coordinate with one decimal at most.
pub(crate) fn n(value: f64) -> String {
    let text = format!("{value:.1}");
    match text.strip_suffix(".0") {
        Some("-0") => "0".to_owned(),
        Some(whole) => whole.to_owned(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn coordinates_are_short() {
        assert_eq!(super::n(-0.04), "0");
        assert_eq!(super::n(12.0), "12");
        assert_eq!(super::n(12.34), "12.3");
    }
}
