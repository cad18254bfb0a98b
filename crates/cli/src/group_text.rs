//! Groups of failing scenes as text and as JSON.

use crate::failure_groups::FailureGroup;
use crate::match_text::why;
use etalon_diagnose::Match;
use serde_json::{Value, json};

pub(crate) fn json(group: &FailureGroup) -> Value {
    let scene = &group.scene;
    json!({
        "adapter": scene.adapter,
        "file": scene.file,
        "count": group.count,
        "reduced": group.reduced,
        "index": scene.index,
        "verdict": group.verdict,
        "violation": group.way(),
        "sentence": scene.sentence,
        "clause": scene.clause,
        "states": scene.states,
        "keys": scene.keys,
        "steady": group.steady,
        "known": group.known.as_ref().map(match_json),
    })
}

pub(crate) fn text(group: &FailureGroup) -> String {
    let scene = &group.scene;
    let mut text = format!("\n  {}\n", headline(group));
    for line in [&scene.states, &scene.sentence] {
        if !line.is_empty() {
            text.push_str(&format!("    {line}\n"));
        }
    }
    if let Some(clause) = &scene.clause {
        text.push_str(&format!("    [{clause}]\n"));
    }
    text.push_str(&format!("    {}\n", scene.file.display()));
    text
}

/// Returns a short form, for a group listed below the finding that it resembles.
pub(crate) fn short(group: &FailureGroup) -> String {
    let scene = &group.scene;
    format!(
        "    {}: {}\n      {}\n      {}\n",
        headline(group),
        scene.states,
        group.known.as_ref().map(why).unwrap_or_default(),
        scene.file.display()
    )
}

fn headline(group: &FailureGroup) -> String {
    format!(
        "{} × {}: {}{}",
        group.count,
        group.verdict,
        group.way(),
        if group.steady { "" } else { " (unsteady)" }
    )
}

fn match_json(found: &Match) -> Value {
    json!({
        "finding": found.finding,
        "title": found.title,
        "match": if found.is_exact() { "exact" } else { "alike" },
        "case": found.case,
        "why": why(found),
    })
}
