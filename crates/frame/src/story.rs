//! The story of one sample: the ruling on it, then the reference's operations on it as typed events.
//!
//! A story contains facts and no sentences. `etalon-report` turns the facts into sentences; symptoms, groups
//! and reductions read the facts.

use crate::band::Band;
use crate::compare::ChannelMismatch;
use crate::contents::Contents;
use crate::event::{Event, SceneName, Side};
use crate::format::Aspect;
use serde::{Deserialize, Deserializer, Serialize};

/// The ruling on one sample, and the operations on it in order.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Story {
    /// The ruling, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ruling: Option<Ruling>,
    /// The ruling on each of several scenes alone, in a story about two pictures that must be the same.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub alone: Vec<(SceneName, Ruling)>,
    /// The reference's operations on the sample, in the order of the pipeline; empty if only the ruling is known.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<Event>,
    /// True if later events were left out because the record was too long.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub cut: bool,
    /// The sentences of a story from a run folder before format 4. They are only displayed; no decision
    /// depends on them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub told: Vec<ToldLine>,
}

/// A line of a story in a run folder older than format 4.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ToldLine {
    /// The position in the scene; for a verdict, its subject.
    pub at: String,
    /// The operation; `verdict` for the first line of most stories.
    pub operation: String,
    /// The inputs and the outcome; for a verdict, its predicate.
    pub detail: String,
    /// The section of the specification, or the specification that a verdict is based on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub citation: Option<String>,
}

/// Stories of format 4 are objects; earlier ones are lists of lines.
impl<'de> Deserialize<'de> for Story {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;

        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Fields {
            ruling: Option<Ruling>,
            #[serde(default)]
            alone: Vec<(SceneName, Ruling)>,
            #[serde(default)]
            events: Vec<Event>,
            #[serde(default)]
            cut: bool,
            #[serde(default)]
            told: Vec<ToldLine>,
        }

        impl<'de> serde::de::Visitor<'de> for Visitor {
            type Value = Story;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a story")
            }

            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, seq: A) -> Result<Story, A::Error> {
                let lines = serde::de::value::SeqAccessDeserializer::new(seq);
                Ok(Story {
                    told: Vec::deserialize(lines)?,
                    ..Story::default()
                })
            }

            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<Story, A::Error> {
                let fields = serde::de::value::MapAccessDeserializer::new(map);
                let Fields {
                    ruling,
                    alone,
                    events,
                    cut,
                    told,
                } = Fields::deserialize(fields)?;
                Ok(Story {
                    ruling,
                    alone,
                    events,
                    cut,
                    told,
                })
            }
        }

        deserializer.deserialize_any(Visitor)
    }
}

/// The value that the rules demand for a sample, the reasons, and the value that came back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ruling {
    /// The variant that was drawn; `None` for the case's own scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variant: Option<String>,
    /// Column from the left and row from the top.
    pub texel: [u32; 2],
    /// The samples, if the attachments have several. Several listed samples share this ruling.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub samples: Vec<u32>,
    /// What the rules ask of the sample, and what came back instead.
    pub demand: Demand,
    /// The specification by which the sample is judged.
    pub rules: String,
    /// The cases that had to be drawn first in the same process.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub after: Vec<String>,
    /// The strength of the evidence against the value that came back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band: Option<Band>,
}

/// A demand on a sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Demand {
    /// The rules leave too many outcomes open to assert any.
    Open {
        /// The values that came back, if there is a frame.
        returned: Option<Vec<Contents>>,
        /// True if several colour attachments are read back.
        several_colors: bool,
    },
    /// The sample has one of these values.
    Values(Box<Values>),
    /// Two pictures have the same values.
    Same {
        /// The two pictures; the first one's texel is the ruling's.
        sides: [Side; 2],
        /// The texel of the second picture.
        texel: [u32; 2],
        /// The channels that differ. The first side's value is given as legal, the second side's as actual.
        channels: Vec<ChannelMismatch>,
        /// The clause that demands equality.
        citation: String,
    },
}

/// The values that the rules allow at a sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Values {
    /// True for the yardstick, which demands quality rather than legality.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub yardstick: bool,
    /// The first outcomes; each lists the values of the aspects that the ruling is about.
    pub allowed: Vec<Vec<Allowed>>,
    /// The number of legal outcomes that `allowed` leaves out.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub more_outcomes: usize,
    /// The operations that decide, in order.
    pub reasons: Vec<DecidingStep>,
    /// The number of further draws that do not reach the sample.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub more_draws: usize,
    /// The values that came back, if there is a frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub returned: Option<Returned>,
    /// True if several colour attachments are read back, so that colours must be named.
    pub several_colors: bool,
    /// True if the scene has several passes, so that draws must be numbered by pass.
    pub several_passes: bool,
}

fn is_zero(n: &usize) -> bool {
    *n == 0
}

/// An allowed value of one aspect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Allowed {
    /// The codes that the aspect can have.
    pub contents: Contents,
    /// The source of the initial contents, if the value is still the initial one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept: Option<Initial>,
}

/// The source of an attachment's initial contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Initial {
    /// The attachment was cleared.
    Clear,
    /// Texels were uploaded.
    Upload,
}

/// An operation that decides the value of a sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum DecidingStep {
    /// A draw stores the value in only some outcomes; the event leaves it open.
    Open(Event),
    /// A draw stores the value.
    Stored {
        /// The store.
        store: Event,
        /// The output of the shader, for a stored colour.
        shade: Option<Box<Event>>,
        /// True if the colour is blended.
        blended: bool,
    },
    /// A clear stores the value.
    Cleared(Event),
    /// A resolve stores the value.
    Resolved(Event),
    /// A draw passes its tests and leaves the value unchanged.
    Kept(Event),
    /// Draws do not reach the sample, all for the same reason.
    Ended {
        /// The event that ends the first draw.
        by: Event,
        /// The number of draws.
        draws: usize,
    },
    /// A draw does not write the aspect.
    Unwritten {
        /// The number of the pass.
        pass: usize,
        /// The number of the draw in its pass.
        draw: usize,
        /// The aspect.
        aspect: Aspect,
    },
}

/// The values that a driver returned.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Returned {
    /// An allowed outcome.
    Allowed(Vec<Contents>),
    /// A forbidden outcome.
    Wrote(Vec<Contents>),
    /// Earlier contents, although a later draw had to store others.
    Kept {
        /// The contents.
        contents: Contents,
        /// The operation that stored the earlier contents.
        from: ContentSource,
    },
}

/// The operation that stored contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ContentSource {
    /// The initial contents.
    Initial(Initial),
    /// A clear or a resolve between draws.
    Operation,
    /// A draw.
    Draw {
        /// The number of the pass.
        pass: usize,
        /// The number of the draw in its pass.
        draw: usize,
    },
}

impl Story {
    /// Returns true if a draw must or may store the value that the attachment has already, so that the picture does not show
    /// whether it did.
    pub fn stores_initial_contents(&self) -> bool {
        let Some(Demand::Values(values)) = self.ruling.as_ref().map(|ruling| &ruling.demand) else {
            return false;
        };
        let kept = values
            .allowed
            .iter()
            .flatten()
            .any(|allowed| allowed.kept.is_some());
        let stored = |step: &DecidingStep| {
            matches!(step, DecidingStep::Stored { .. } | DecidingStep::Open(_))
        };
        kept && values.reasons.iter().any(stored)
    }

    /// Returns true if the driver left earlier contents although a later draw had to replace them.
    pub fn keeps_earlier_contents(&self) -> bool {
        match self.ruling.as_ref().map(|ruling| &ruling.demand) {
            Some(Demand::Values(values)) => matches!(values.returned, Some(Returned::Kept { .. })),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_earlier_formats_are_read_as_text() {
        let old = r#"[{"at":"texel 1,1","operation":"verdict","detail":"must be 0"}]"#;
        let story: Story = serde_json::from_str(old).unwrap();
        assert_eq!((story.told.len(), story.events.len()), (1, 0));
        assert!(story.ruling.is_none() && !story.keeps_earlier_contents());
        let again = serde_json::to_string(&story).unwrap();
        assert_eq!(serde_json::from_str::<Story>(&again).unwrap(), story);
        assert!(serde_json::from_str::<Story>(r#"{"sentence":""}"#).is_err());
    }
}
