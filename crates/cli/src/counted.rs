//! Numbers with a noun in the singular or plural.

/// Returns a number with its noun: `1 run`, `2 runs`.
pub(crate) fn counted(n: u64, noun: &str) -> String {
    match n {
        1 => format!("1 {noun}"),
        n => format!("{n} {noun}s"),
    }
}
