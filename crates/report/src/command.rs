//! Command lines in reports, for people to copy.

use etalon_record::Record;

/// Returns a word, quoted for a POSIX shell if it needs quotes.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._=+-:,@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// Returns the command that draws a case again.
pub(crate) fn run(case: &str, adapter: &str) -> String {
    format!("etalon run {} --adapter {}", quoted(case), quoted(adapter))
}

/// Returns the command that explains the first wrong texel of a record. Without a wrong texel, it draws the
/// case again.
pub(crate) fn explain(record: &Record) -> String {
    match record.wrong.first() {
        Some(texel) => format!(
            "etalon explain {} --texel {},{} --adapter {}",
            quoted(&record.case),
            texel.x,
            texel.y,
            quoted(&record.adapter)
        ),
        None => run(&record.case, &record.adapter),
    }
}

/// Returns the commands that turn a wrong picture into a bug report, each with a description of its result.
pub(crate) fn onward(record: &Record) -> [(&'static str, String); 3] {
    let (case, adapter) = (quoted(&record.case), quoted(&record.adapter));
    [
        (
            "Smallest case",
            format!("etalon reduce {case} --adapter {adapter}"),
        ),
        (
            "Releases that have it",
            format!("etalon bisect {case} --line LINE --adapters FILE"),
        ),
        (
            "A program that shows it, and a report",
            format!("etalon bundle {case} --adapter {adapter}"),
        ),
    ]
}

#[cfg(test)]
mod tests {
    #[test]
    fn words_are_quoted_for_a_shell() {
        assert_eq!(super::quoted("gl:es/a=1"), "gl:es/a=1");
        assert_eq!(super::quoted("a'; rm b"), "'a'\\''; rm b'");
        assert_eq!(super::quoted(""), "''");
    }
}
