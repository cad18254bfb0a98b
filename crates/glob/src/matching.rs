//! Matching: all steps that a text can have reached, character by character. Steps without a jump need only one
//! of them.

use crate::step::MatchStep;

/// Steps that can take the next character.
struct ReachedSteps {
    steps: Vec<usize>,
    /// The number of characters before which each step was reached last, plus 1.
    marks: Vec<usize>,
    /// Steps that are not added yet.
    open: Vec<usize>,
}

/// Returns true if the steps take the whole text. No step is a jump.
pub(crate) fn is_match_without_jumps(steps: &[MatchStep], text: &str) -> bool {
    let (mut at, mut rest) = (0, text);
    // The step after the last star, and the text at which it was tried last. An earlier star never has to take more.
    let mut last: Option<(usize, &str)> = None;
    loop {
        let mut chars = rest.chars();
        match (steps.get(at), chars.next()) {
            (Some(MatchStep::Star), _) => {
                at += 1;
                last = Some((at, rest));
                continue;
            }
            (None, None) => return true,
            (Some(_), None) => return false,
            (Some(step), Some(c)) if step.takes(c) => {
                at += 1;
                rest = chars.as_str();
                continue;
            }
            _ => {}
        }
        let Some((after, tried)) = last else {
            return false;
        };
        // At the end of a glob, a star takes the rest.
        if after == steps.len() {
            return true;
        }
        let mut chars = tried.chars();
        chars.next();
        rest = chars.as_str();
        at = after;
        last = Some((after, rest));
    }
}

/// Returns true if the steps take the whole text.
pub(crate) fn is_match(steps: &[MatchStep], text: &str) -> bool {
    let mut reached = ReachedSteps {
        steps: Vec::new(),
        marks: vec![0; steps.len() + 1],
        open: Vec::new(),
    };
    let mut taken = 1;
    reached.add(steps, 0, taken);
    let mut before = Vec::new();
    for c in text.chars() {
        taken += 1;
        before.clear();
        std::mem::swap(&mut before, &mut reached.steps);
        for at in &before {
            let next = match steps.get(*at) {
                Some(MatchStep::Star) => Some(*at),
                Some(step) => step.takes(c).then_some(at + 1),
                None => None,
            };
            if let Some(next) = next {
                reached.add(steps, next, taken);
            }
        }
        if reached.steps.is_empty() {
            return false;
        }
    }
    reached.marks[steps.len()] == taken
}

impl ReachedSteps {
    /// Adds a step, and the ones that follow it without a character.
    fn add(&mut self, steps: &[MatchStep], first: usize, taken: usize) {
        self.open.push(first);
        while let Some(at) = self.open.pop() {
            if std::mem::replace(&mut self.marks[at], taken) == taken {
                continue;
            }
            match steps.get(at) {
                Some(MatchStep::Jump(targets)) => self.open.extend(targets),
                Some(MatchStep::Star) => {
                    self.steps.push(at);
                    self.open.push(at + 1);
                }
                _ => self.steps.push(at),
            }
        }
    }
}
