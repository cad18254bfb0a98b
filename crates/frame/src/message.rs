//! Messages about user input.

/// The number of bytes kept from the beginning and from the end of a long message.
const HEAD: usize = 400;
const TAIL: usize = 200;

/// Returns a message without its middle if it is long: an error that quotes its input can quote a whole file.
pub fn shortened(text: &str) -> String {
    if text.len() <= HEAD + TAIL {
        return text.to_owned();
    }
    let head = &text[..text.floor_char_boundary(HEAD)];
    let tail = &text[text.ceil_char_boundary(text.len() - TAIL)..];
    format!("{head} […] {tail}")
}

/// Returns a text without the byte order mark that some editors write at its beginning.
pub fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_short_stays_and_what_is_long_loses_its_middle() {
        assert_eq!(shortened("unknown key"), "unknown key");
        let long = shortened(&format!("key {} end", "ü".repeat(5000)));
        assert!(long.len() < 700 && long.starts_with("key ü") && long.ends_with("ü end"));
    }
}
