//! Matching: all steps that a text can have reached, character by character.

use crate::step::Step;

/// Steps that can take the next character.
struct Reached {
    steps: Vec<usize>,
    /// The number of characters before which each step was reached last, plus 1.
    marks: Vec<usize>,
    /// Steps that are not added yet.
    open: Vec<usize>,
}

/// Returns true if the steps take the whole text.
pub(crate) fn is_match(steps: &[Step], text: &str) -> bool {
    let mut reached = Reached {
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
                Some(Step::Char(expected)) => (*expected == c).then_some(at + 1),
                Some(Step::Any) => Some(at + 1),
                Some(Step::Class { negated, ranges }) => {
                    let inside = |(first, last): &(char, char)| (*first..=*last).contains(&c);
                    (ranges.iter().any(inside) != *negated).then_some(at + 1)
                }
                Some(Step::Star) => Some(*at),
                Some(Step::Jump(_)) | None => None,
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

impl Reached {
    /// Adds a step, and the ones that follow it without a character.
    fn add(&mut self, steps: &[Step], first: usize, taken: usize) {
        self.open.push(first);
        while let Some(at) = self.open.pop() {
            if std::mem::replace(&mut self.marks[at], taken) == taken {
                continue;
            }
            match steps.get(at) {
                Some(Step::Jump(targets)) => self.open.extend(targets),
                Some(Step::Star) => {
                    self.steps.push(at);
                    self.open.push(at + 1);
                }
                _ => self.steps.push(at),
            }
        }
    }
}
