//! Comments and pages say what is so in plain words: phrases that make a reader stop are refused.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::house::{files, root};
use regex::{Regex, RegexBuilder};
use std::fs;

/// Phrases to avoid, each with what to write instead.
const STUMBLES: [(&str, &str); 19] = [
    (r"\bof (which|whom|theirs)\b", "a noun or a second sentence"),
    (r"\bso many\b", "the name of the number"),
    (r"\b(is|are) none\b", "what happens without it"),
    (r"\bas far as\b", "if, or when"),
    (r"\b(a|an|one) [a-z]{3,} more\b", "another"),
    (r"\b(is|are|was|were|be) told\b", "who says it"),
    (
        r"\bstands? (beside|there|here|once|in|behind|before)\b",
        "a verb that says more",
    ),
    (r"\bthose (that|which|who)\b", "the noun"),
    (r"\b(is|are|be) held\b", "who keeps or checks it"),
    (r"\b(mends?|mended|the telling)\b", "fix"),
    (r"\b(is|are|be) said\b", "who says it"),
    (r"\blies? (in|on|beside|between|there)\b", "is"),
    (r"\bno text\b", "no specification"),
    (r"\bnobody\b", "what is true without anybody"),
    (r"\bthe one (that|which)\b", "the noun"),
    (r"\bas such\b", "nothing"),
    (r"\bmay be (gone|read|drawn|asked)\b", "can, or might"),
    (r"\bfor itself\b", "alone, or nothing"),
    (r"\bsuch as (are|is|have|has)\b", "the noun"),
];

/// Lines that use such a phrase rightly: a file, a part of the line, and the reason.
const EXCEPTIONS: [(&str, &str, &str); 1] = [(
    "reports/upstream/softpipe-3/report.md",
    "lies on a common edge",
    "geometry: a centre lies on an edge",
)];

/// Returns the prose of a line: a comment of a source file, or a line of a page outside of code.
fn prose(line: &str, is_page: bool, fenced: &mut bool) -> Option<String> {
    let trimmed = line.trim_start();
    if !is_page {
        return trimmed.starts_with("//").then(|| trimmed.to_owned());
    }
    if trimmed.starts_with("```") {
        *fenced = !*fenced;
    }
    let outside_of_code = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
    (!*fenced).then_some(outside_of_code)
}

fn patterns() -> Vec<Regex> {
    let regex = |(pattern, _): &(&str, &str)| {
        let mut builder = RegexBuilder::new(pattern);
        builder.case_insensitive(true).build().unwrap()
    };
    STUMBLES.iter().map(regex).collect()
}

#[test]
fn no_comment_and_no_page_makes_its_reader_stumble() {
    let patterns = patterns();
    let mut found = Vec::new();
    let mut excused = vec![false; EXCEPTIONS.len()];
    for name in files() {
        let is_page = name.ends_with(".md");
        let is_source = name.ends_with(".rs") && name.contains("/src/");
        if !(is_page || is_source) {
            continue;
        }
        let text = fs::read_to_string(root().join(&name)).unwrap();
        let mut fenced = false;
        for (number, line) in text.lines().enumerate() {
            let Some(prose) = prose(line, is_page, &mut fenced) else {
                continue;
            };
            for (pattern, (_, instead)) in patterns.iter().zip(STUMBLES) {
                let Some(phrase) = pattern.find(&prose) else {
                    continue;
                };
                let excuse = |&(file, part, _): &(&str, &str, &str)| {
                    name.ends_with(file) && line.contains(part)
                };
                match EXCEPTIONS.iter().position(excuse) {
                    Some(exception) => excused[exception] = true,
                    None => found.push(format!(
                        "{name}:{}: `{}`: write {instead}",
                        number + 1,
                        phrase.as_str()
                    )),
                }
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
    assert!(
        excused.iter().all(|e| *e),
        "exceptions without a line: {excused:?}"
    );
}

#[test]
fn the_phrases_of_a_translation_are_found() {
    let patterns = patterns();
    for stumbling in [
        "Runs of whole triangles, of which every three are one",
        "Rounds to so many bits",
        "`None` if they are none",
        "A run more takes 0.6 ms",
        "as often as is told by its number",
        "Those that name none have the default",
    ] {
        assert!(
            patterns.iter().any(|p| p.is_match(stumbling)),
            "{stumbling}"
        );
    }
    for plain in [
        "Runs of whole triangles",
        "Appending a run takes 0.6 ms",
        "Ignores a logic operation that the format does not support.",
    ] {
        assert!(!patterns.iter().any(|p| p.is_match(plain)), "{plain}");
    }
}

#[test]
fn code_is_not_searched_for_phrases() {
    let mut fenced = false;
    let line = |text: &str, is_page, fenced: &mut bool| prose(text, is_page, fenced);
    assert_eq!(line("let nobody = 1;", false, &mut fenced), None);
    assert_eq!(
        line("Call `nobody` first.", true, &mut fenced).as_deref(),
        Some("Call ` first.")
    );
    line("```text", true, &mut fenced);
    assert_eq!(line("nobody", true, &mut fenced), None);
}
