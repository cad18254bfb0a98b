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

/// Returns true if a terminal obeys a character instead of showing it, or if it cannot be seen: control characters, and
/// characters that change the direction of reading, break lines or have no width.
pub fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}'
            | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

/// Returns at most `longest` characters of a text from outside, with each hidden character as its escape, such as
/// `\u{1b}`. A text that is cut ends in `…`.
pub fn printable(text: &str, longest: usize) -> String {
    let mut result = String::new();
    let mut left = longest;
    for c in text.chars() {
        let Some(rest) = left.checked_sub(1) else {
            result.push('…');
            break;
        };
        left = rest;
        match c {
            '\n' | '\r' | '\t' => result.extend(c.escape_default()),
            c if is_hidden(c) => result.extend(c.escape_unicode()),
            c => result.push(c),
        }
    }
    result
}

/// Returns a text without the byte order mark that some editors write at its beginning.
pub fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hidden_characters_are_escaped_and_long_texts_are_cut() {
        let text = "a\u{1b}[2J\u{9b}\u{7f}\u{202e}\u{200b}\u{2028}\n\tü";
        let shown = r"a\u{1b}[2J\u{9b}\u{7f}\u{202e}\u{200b}\u{2028}\n\tü";
        assert_eq!(printable(text, 20), shown);
        assert_eq!(printable("aüb", 2), "aü…");
        assert_eq!(printable("aü", 2), "aü");
    }

    #[test]
    fn short_messages_stay_and_long_ones_lose_their_middle() {
        assert_eq!(shortened("unknown key"), "unknown key");
        let long = shortened(&format!("key {} end", "ü".repeat(5000)));
        assert!(long.len() < 700 && long.starts_with("key ü") && long.ends_with("ü end"));
    }
}
