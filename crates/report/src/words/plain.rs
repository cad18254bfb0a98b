//! Text without control sequences for a terminal.

/// Returns at most `longest` characters of a text, with control characters, which a terminal would obey,
/// replaced.
pub fn plain(text: &str, longest: usize) -> String {
    let clean = |c: char| {
        // Invisible characters that change the reading direction could make one id look like another.
        let turns = matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        if c.is_control() || turns {
            '\u{fffd}'
        } else {
            c
        }
    };
    let mut result: String = text.chars().take(longest).map(clean).collect();
    if text.chars().nth(longest).is_some() {
        result.push('…');
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_do_not_pass() {
        assert_eq!(plain("a\u{1b}[2Jb\u{202e}", 9), "a\u{fffd}[2Jb\u{fffd}");
        assert_eq!(plain("aüb", 2), "aü…");
    }
}
