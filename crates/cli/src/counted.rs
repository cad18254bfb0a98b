//! Numbers with a noun in the singular or plural.

/// `1 run`, `2 runs`.
pub(crate) fn counted(n: u64, noun: &str) -> String {
    match n {
        1 => format!("1 {noun}"),
        n => format!("{n} {noun}s"),
    }
}
