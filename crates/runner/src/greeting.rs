//! The greeting: a line of text before the first message. A parent uses it to recognize a worker of its own
//! version, as opposed to another version, or to a shell or a launcher that prints something.

use crate::loss::Loss;
use std::io::{self, BufRead, Read, Write};

/// The first words of each greeting.
const WORDS: &str = "etalon worker ";
/// The version of the messages after it. Any change of the messages needs a new version.
const PROTOCOL: u32 = 2;
/// The longest line, in bytes, that is read or quoted.
const MOST: u64 = 200;

/// Returns the greeting of a worker of this version.
fn own() -> String {
    format!("{WORDS}{}, protocol {PROTOCOL}", env!("CARGO_PKG_VERSION"))
}

/// Sends the greeting, which is flushed with the message after it.
pub(crate) fn send(to: &mut impl Write) -> io::Result<()> {
    to.write_all(format!("{}\n", own()).as_bytes())
}

/// Reads the greeting of a worker; returns false if the stream ends without one.
///
/// # Errors
/// If the greeting is from another version, or if something else was printed.
pub(crate) fn check(from: &mut impl BufRead, launched: bool) -> Result<bool, Loss> {
    let mut line = Vec::new();
    let read = from.take(MOST).read_until(b'\n', &mut line);
    read.map_err(|e| Loss::Garbage(e.to_string()))?;
    if line.is_empty() {
        return Ok(false);
    }
    let text = String::from_utf8_lossy(&line);
    let text = text.trim_end();
    if text == own() {
        return Ok(true);
    }
    if text.starts_with(WORDS) {
        return Err(Loss::NotStarted(format!(
            "the program that answered is `{}`, but this one is `{}`: start the same program there",
            text.escape_debug(),
            own()
        )));
    }
    let shown: String = text.chars().take(80).collect();
    let whose = if launched {
        "; a launcher must not print anything itself: its standard output is the worker's"
    } else {
        ""
    };
    Err(Loss::Garbage(format!(
        "`{}` in place of a greeting{whose}",
        shown.escape_debug()
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked(text: &str) -> Result<bool, Loss> {
        check(&mut text.as_bytes(), true)
    }

    #[test]
    fn a_greeting_is_recognized_and_other_output_is_quoted() {
        let mut pipe = Vec::new();
        send(&mut pipe).expect("sent");
        assert_eq!(check(&mut pipe.as_slice(), false), Ok(true));
        assert_eq!(checked(""), Ok(false));
        let Err(Loss::NotStarted(other)) = checked("etalon worker 9.9.9, protocol 1\n") else {
            panic!("another version is refused");
        };
        assert!(other.contains("9.9.9"), "{other}");
        assert!(other.contains("the same program"), "{other}");
        let Err(Loss::Garbage(shell)) = checked("Last login: today \u{1b}[31m\n") else {
            panic!("words are no greeting");
        };
        assert!(shell.contains("`Last login: today \\u{1b}[31m`"), "{shell}");
        assert!(shell.contains("must not print"), "{shell}");
        // A line without an end is read only up to the length that can be quoted.
        assert!(checked(&"x".repeat(1 << 20)).is_err());
    }
}
