//! Days in files that people write.

use etalon_frame::shortened;

/// Checks that the value of a key is a day.
///
/// # Errors
/// The message, if it does not have the form `2027-01-31`.
pub(crate) fn check_date(key: &str, date: &str) -> Result<(), String> {
    if is_date(date) {
        return Ok(());
    }
    let date = shortened(date);
    Err(format!(
        "\"{key}\": {date:?} is no day; days are written as \"2027-01-31\""
    ))
}

fn is_date(text: &str) -> bool {
    let form = |(i, c): (usize, char)| match i {
        4 | 7 => c == '-',
        _ => c.is_ascii_digit(),
    };
    let number = |range| text.get(range).and_then(|t: &str| t.parse::<u32>().ok());
    text.len() == 10
        && text.char_indices().all(form)
        && number(5..7).is_some_and(|m| (1..=12).contains(&m))
        && number(8..10).is_some_and(|d| (1..=31).contains(&d))
}
