//! Matching: all steps that a text can have reached, character by character.

use crate::step::Step;

/// Returns true if the steps take the whole text.
pub(crate) fn is_match(steps: &[Step], text: &str) -> bool {
    let mut reached = vec![false; steps.len() + 1];
    let mut next = reached.clone();
    reached[0] = true;
    for c in text.chars() {
        next.fill(false);
        for (at, step) in steps.iter().enumerate() {
            if !reached[at] {
                continue;
            }
            let takes = match step {
                Step::Char(expected) => *expected == c,
                Step::Any => true,
                Step::Class { negated, ranges } => {
                    let inside = |(first, last): &(char, char)| (*first..=*last).contains(&c);
                    ranges.iter().any(inside) != *negated
                }
                Step::Star | Step::Jump(_) => {
                    skip(step, at, &mut reached);
                    next[at] |= matches!(step, Step::Star);
                    continue;
                }
            };
            next[at + 1] |= takes;
        }
        if !next.contains(&true) {
            return false;
        }
        std::mem::swap(&mut reached, &mut next);
    }
    for (at, step) in steps.iter().enumerate() {
        if reached[at] {
            skip(step, at, &mut reached);
        }
    }
    reached[steps.len()]
}

/// Marks the steps that a step reaches without a character; all of them are later ones.
fn skip(step: &Step, at: usize, reached: &mut [bool]) {
    match step {
        Step::Star => reached[at + 1] = true,
        Step::Jump(targets) => targets.iter().for_each(|target| reached[*target] = true),
        Step::Char(_) | Step::Any | Step::Class { .. } => {}
    }
}
