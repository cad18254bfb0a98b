//! Dead expectations in words.

use crate::numbers::count;
use crate::words::plain;
use etalon_record::{Dead, DeadKind};

/// The maximum number of lines of each kind.
const LISTED: usize = 5;

/// Returns the meaning of a kind.
pub(crate) fn meaning(kind: DeadKind) -> &'static str {
    match kind {
        DeadKind::NoCase => "no case matches",
        DeadKind::NoAdapter => "no adapter matches",
        DeadKind::Covered => "covered by another",
        DeadKind::NeverMatched => "all cases drawn, never matched",
        DeadKind::Expired => "expired",
    }
}

/// Returns the dead expectations for a terminal: their number, then at most five of each kind. The text does
/// not end in a newline.
pub fn dead_lines(dead: &[Dead]) -> String {
    let mut text = count(dead.len() as u64, "dead expectation");
    for kind in DeadKind::ALL {
        let these: Vec<&Dead> = dead.iter().filter(|d| d.kind == kind).collect();
        for entry in these.iter().take(LISTED) {
            let line = format!("{}: {}: {}", meaning(kind), entry.place, entry.about);
            text += &format!("\n  {}", plain(&line, 240));
        }
        if these.len() > LISTED {
            text += &format!("\n  {}: {} more", meaning(kind), these.len() - LISTED);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dead_expectations_are_grouped_and_few_are_listed() {
        let entry = |kind, n: u32| Dead {
            kind,
            place: format!("e.json: entry {n}"),
            about: "a/*".to_owned(),
        };
        let mut entries: Vec<Dead> = (1..=7).map(|n| entry(DeadKind::NoCase, n)).collect();
        entries.push(entry(DeadKind::Covered, 8));
        let text = dead_lines(&entries);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "8 dead expectations");
        assert_eq!(lines[1], "  no case matches: e.json: entry 1: a/*");
        assert_eq!(lines[6], "  no case matches: 2 more");
        assert_eq!(lines[7], "  covered by another: e.json: entry 8: a/*");
        assert_eq!(lines.len(), 8);
    }
}
