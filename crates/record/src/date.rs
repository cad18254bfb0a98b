//! Days in files that people write.

use etalon_frame::shortened;

/// Checks that the value of a key is a date.
///
/// # Errors
/// The message, if it does not have the form `2027-01-31`.
pub(crate) fn check_date(key: &str, date: &str) -> Result<(), String> {
    if is_date(date) {
        return Ok(());
    }
    let date = shortened(date);
    Err(format!(
        "\"{key}\": {date:?} is not a day; days are written as \"2027-01-31\""
    ))
}

fn is_date(text: &str) -> bool {
    let form = |(i, c): (usize, char)| match i {
        4 | 7 => c == '-',
        _ => c.is_ascii_digit(),
    };
    let number = |range| text.get(range).and_then(|t: &str| t.parse::<u32>().ok());
    let date = (number(0..4), number(5..7), number(8..10));
    let exists = |(year, month, day)| match (year, month, day) {
        (Some(year), Some(month), Some(day)) => (1..=days(year, month)).contains(&day),
        _ => false,
    };
    text.len() == 10 && text.char_indices().all(form) && exists(date)
}

/// Returns the number of days in a month; 0 if no month has this number.
fn days(year: u32, month: u32) -> u32 {
    let leap = year.is_multiple_of(4) && !year.is_multiple_of(100) || year.is_multiple_of(400);
    match month {
        2 => 28 + u32::from(leap),
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_day_must_exist_in_its_month() {
        for day in ["2027-01-31", "2028-02-29", "2000-02-29", "2027-12-31"] {
            assert_eq!(check_date("expires", day), Ok(()));
        }
        for day in [
            "2027-02-29",
            "2027-02-30",
            "1900-02-29",
            "2027-04-31",
            "2027-13-01",
            "2027-00-01",
            "2027-01-00",
            "27-01-01",
            "2027-1-1",
            "2027/01/01",
            "",
        ] {
            assert!(check_date("expires", day).is_err(), "{day}");
        }
    }
}
