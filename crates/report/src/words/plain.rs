//! Text without control sequences for a terminal.

/// Returns at most `longest` characters of a text, with hidden characters escaped.
pub fn plain(text: &str, longest: usize) -> String {
    etalon_frame::printable(text, longest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_do_not_pass() {
        assert_eq!(plain("a\u{1b}[2Jb\u{202e}", 9), r"a\u{1b}[2Jb\u{202e}");
        assert_eq!(plain("aüb", 2), "aü…");
    }
}
