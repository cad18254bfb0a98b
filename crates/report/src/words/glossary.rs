//! The words of reports, for readers who never saw one.

use maud::{Markup, html};

/// The words, each with its meaning.
pub(crate) const GLOSSARY: [(&str, &str); 16] = [
    (
        "case",
        "One scene that a driver draws, with the values that the API allows for each texel. Its id is a path: the case file, then a value for each axis.",
    ),
    (
        "adapter",
        "One way to reach one driver. gl:es:softpipe is the driver softpipe through OpenGL ES.",
    ),
    (
        "selftest",
        "A case that is made to fail. It shows that the suite notices a wrong picture.",
    ),
    (
        "asserted",
        "The API decides this value: some codes are allowed, and others are not.",
    ),
    (
        "open",
        "Nothing could be asserted: the API allows every value that the driver could write.",
    ),
    (
        "imprecise",
        "The API allows the value, but it is less exact than the yardstick.",
    ),
    (
        "yardstick",
        "The quality that 32-bit arithmetic reaches: one rounding within 0.6 codes, edges by the top-left rule.",
    ),
    (
        "known",
        "A finding describes this bug of the driver, with the clause that it violates and the releases that have it.",
    ),
    (
        "looks like a known bug",
        "The failure reduces to the same states and the same wrong value as a known bug.",
    ),
    (
        "expected",
        "A bad verdict that does not count, because the bug is known or your own list names it.",
    ),
    (
        "broken",
        "There is no picture to judge: the driver crashed or hung, the case is blocked, or its verdicts differ.",
    ),
    (
        "blocked",
        "Not drawn, because a case that shows whether the format works at all failed.",
    ),
    (
        "code",
        "The number that is stored in a channel. In rgba8unorm, code 255 is the value 1.",
    ),
    (
        "world",
        "One consistent set of the choices that the API leaves to the driver, such as whether an edge covers a sample. A texel is right if it is right in one world.",
    ),
    (
        "setting",
        "The parameter of a rendering method, such as its number of layers or samples.",
    ),
    (
        "ruler",
        "A fixed computation that is timed in each round of a bench. It shows whether the machine itself became faster or slower.",
    ),
];

/// Returns the list of words, folded, at the end of a page. Links to `#words` open it.
pub(crate) fn glossary() -> Markup {
    html! {
        details {
            summary { "What the words mean" }
            dl.words id="words" { @for (word, meaning) in GLOSSARY { dt { (word) } dd { (meaning) } } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::path::Path;

    #[test]
    fn the_page_of_words_has_the_same_list() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../glossary.md");
        let rows = GLOSSARY.map(|(word, meaning)| format!("| {word} | {meaning} |\n"));
        let table = format!("| word | meaning |\n|---|---|\n{}", rows.concat());
        assert!(
            fs::read_to_string(path).unwrap().contains(&table),
            "expected:\n{table}"
        );
    }
}
