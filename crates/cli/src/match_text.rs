//! Matches of failures with findings, in words.

use etalon_diagnose::Match;

/// Returns the reason why a failure matches a finding.
pub(crate) fn why(found: &Match) -> String {
    let Match { case, states, .. } = found;
    let Some(difference) = &found.difference else {
        return format!("{case} reduces to the same states and violation");
    };
    let mut text = format!("matches the reduced {case} ({states})");
    if let Some(violation) = &difference.violation {
        text.push_str(&format!(", which violates {violation}"));
    }
    if !difference.states.is_empty() {
        text.push_str(&format!("; also {}", difference.states));
    } else if difference.violation.is_none() {
        text.push_str(", with other values");
    }
    text
}

/// Returns the sentence about a finding in a case file's description.
pub(crate) fn match_sentence(found: &Match) -> String {
    let Match { finding, title, .. } = found;
    let word = if found.is_exact() {
        "Known"
    } else {
        "Looks like"
    };
    format!("{word}: {finding} ({title}): {}.", why(found))
}
