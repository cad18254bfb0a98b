//! The version number in the text that a driver reports.

use semver::Version;

/// The version in a text such as `4.5 (Core Profile) Mesa 22.3.6`: the number after `Mesa`, else the first
/// one with a dot. Missing parts of three are 0, further parts are dropped; `None` if there is no such
/// number.
pub(crate) fn driver_version(text: &str) -> Option<Version> {
    let after_mesa = text.split_once("Mesa ").map(|(_, rest)| rest);
    after_mesa
        .and_then(|rest| number(rest.split_whitespace().next()?))
        .or_else(|| text.split([' ', ',', '(', ')']).find_map(number))
}

fn number(word: &str) -> Option<Version> {
    let end = word.find(|c: char| !c.is_ascii_digit() && c != '.');
    let digits = &word[..end.unwrap_or(word.len())];
    let mut parts = digits.trim_end_matches('.').split('.');
    let mut next = || parts.next().map(|p| p.parse::<u64>().ok());
    let major = next()??;
    let minor = next()??;
    let patch = match next() {
        None => 0,
        Some(patch) => patch?,
    };
    Some(Version::new(major, minor, patch))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drivers_say_it_in_many_ways() {
        let of = |text: &str| driver_version(text).map(|v| v.to_string());
        for (text, due) in [
            ("Mesa 22.3.6 (LLVM 15.0.6)", Some("22.3.6")),
            ("4.5 (Core Profile) Mesa 25.0.7-2~bpo12+1", Some("25.0.7")),
            ("550.54.14", Some("550.54.14")),
            ("535.183.01.02", Some("535.183.1")),
            ("25.1", Some("25.1.0")),
            ("0x1400000", None),
            ("", None),
            ("7", None),
            ("1.99999999999999999999", None),
        ] {
            assert_eq!(of(text).as_deref(), due, "{text}");
        }
    }
}
