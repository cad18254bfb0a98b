//! The story of one sample: the verdict in one sentence, then the reference's operations on it, step by
//! step.
//!
//! The verdict is a line like the others, the first one, so that a story stays a plain list: stories
//! without a verdict, of older records, are read as they are.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The operation of the line that holds the verdict.
const VERDICT: &str = "verdict";

/// One operation on one sample.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoryLine {
    /// The place in the scene: `pass 0, draw 2, primitive 1`.
    pub at: String,
    /// The operation: `depth test`, `blend`, `store`.
    pub operation: String,
    /// Inputs and outcome in words and numbers.
    pub detail: String,
    /// The section of the specification that permits this outcome, where one was applied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub citation: Option<String>,
}

impl StoryLine {
    /// Returns the line of a verdict: its subject (`sample 2 of texel 1,1`), the rest of the sentence, and
    /// the text by which it is judged.
    pub fn verdict(subject: String, predicate: String, judged_by: String) -> Self {
        Self {
            at: subject,
            operation: VERDICT.to_owned(),
            detail: predicate,
            citation: Some(judged_by),
        }
    }
}

/// The operations on one sample, in order, after the verdict on it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Story {
    /// The verdict, if there is one, and the operations.
    pub lines: Vec<StoryLine>,
}

impl Story {
    /// Returns the line of the verdict.
    pub fn verdict(&self) -> Option<&StoryLine> {
        self.lines.first().filter(|l| l.operation == VERDICT)
    }

    /// Returns the line of the verdict, to be changed.
    pub fn verdict_mut(&mut self) -> Option<&mut StoryLine> {
        self.lines.first_mut().filter(|l| l.operation == VERDICT)
    }

    /// Returns the verdict as a sentence.
    pub fn sentence(&self) -> Option<String> {
        self.verdict().map(|l| format!("{} {}", l.at, l.detail))
    }

    /// Returns the operations, without the verdict.
    pub fn operations(&self) -> &[StoryLine] {
        &self.lines[usize::from(self.verdict().is_some())..]
    }
}

impl fmt::Display for Story {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let (Some(sentence), Some(line)) = (self.sentence(), self.verdict()) {
            writeln!(f, "{sentence}")?;
            if let Some(judged_by) = &line.citation {
                writeln!(f, "  {judged_by}")?;
            }
        }
        let mut place = "";
        for line in self.operations() {
            if line.at != place {
                place = &line.at;
                writeln!(f, "{place}")?;
            }
            writeln!(f, "  {}: {}", line.operation, line.detail)?;
            if let Some(citation) = &line.citation {
                writeln!(f, "      [{citation}]")?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_verdict_leads_and_is_no_operation() {
        let operation = StoryLine {
            at: "pass 0, draw 0".to_owned(),
            operation: "scissor".to_owned(),
            detail: "outside".to_owned(),
            citation: Some("Vulkan: Scissor Test".to_owned()),
        };
        let mut story = Story {
            lines: vec![operation.clone()],
        };
        assert_eq!(story.sentence(), None);
        assert_eq!(story.operations(), std::slice::from_ref(&operation));
        let text = |s: &str| s.to_owned();
        let verdict = StoryLine::verdict(
            text("sample 2 of texel 1,1"),
            text("must be 0"),
            text("judged by Vulkan 1.3"),
        );
        story.lines.insert(0, verdict);
        assert_eq!(story.operations(), [operation]);
        assert_eq!(
            story.to_string(),
            "sample 2 of texel 1,1 must be 0\n  judged by Vulkan 1.3\npass 0, draw 0\n  \
             scissor: outside\n      [Vulkan: Scissor Test]\n"
        );
        assert_eq!(Story::default().operations(), []);
    }
}
