//! The share of a long test that runs by default; `ETALON_TESTS=all` in the environment runs everything.

/// Returns true if everything runs.
pub(crate) fn all() -> bool {
    std::env::var_os("ETALON_TESTS").is_some_and(|value| value == "all")
}

/// Returns `whole` if everything runs, otherwise `few`, and prints the number.
pub(crate) fn count(what: &str, few: usize, whole: usize) -> usize {
    let count = if all() { whole } else { few };
    println!("{count} of {whole} {what}; ETALON_TESTS=all takes all");
    count
}
