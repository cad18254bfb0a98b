//! Times: whole seconds since 1970 in UTC.

use std::time::{Duration, UNIX_EPOCH};

/// Parses an RFC 3339 time or a date in UTC as seconds since 1970; `None` if it is neither, or is before
/// 1970.
pub fn parse_time(text: &str) -> Option<i64> {
    let number = |text: &str| {
        let time = humantime::parse_rfc3339(text).ok()?;
        let since = time.duration_since(UNIX_EPOCH).ok()?;
        i64::try_from(since.as_secs()).ok()
    };
    match text.len() {
        10 => number(&format!("{text}T00:00:00Z")),
        _ => number(text),
    }
}

/// Formats seconds since 1970 as an RFC 3339 time in UTC.
pub fn format_time(seconds: i64) -> String {
    // The latest time that the formatter supports is the end of the year 9999.
    let since = Duration::from_secs(u64::try_from(seconds).unwrap_or(0).min(253_402_300_799));
    humantime::format_rfc3339_seconds(UNIX_EPOCH + since).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formatted_times_parse_equal() {
        for text in ["2026-11-23T06:09:58Z", "1970-01-01T00:00:00Z"] {
            assert_eq!(format_time(parse_time(text).unwrap()), text);
        }
        let date = parse_time("2022-09-29").unwrap();
        assert_eq!(format_time(date), "2022-09-29T00:00:00Z");
        for text in ["", "yesterday", "2022-13-01", "1969-12-31T23:59:59Z"] {
            assert_eq!(parse_time(text), None, "{text}");
        }
        assert_eq!(format_time(i64::MAX), "9999-12-31T23:59:59Z");
        assert_eq!(format_time(-5), "1970-01-01T00:00:00Z");
    }
}
