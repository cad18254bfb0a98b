//! The reasons of a verdict, as facts; `report` has the words.

use crate::process_end::ProcessEnd;
use crate::verdict::Verdict;
use etalon_frame::{Api, ApiVersion, CounterOutcome, Requirement, TextureFormat, WrongTexel};
use serde::de::{self, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;

/// One fact about a record that its other fields do not have.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Reason {
    /// The words of a driver, a backend or a browser. Formats before 6 have all reasons in this form.
    Text(String),

    /// The expectations skip the case, for this reason.
    Skipped(String),
    /// The case was not drawn within the run's time, in seconds.
    OutOfTime(f64),
    /// The adapter lacks what the case needs.
    Missing(Requirement),
    /// This API and version do not require the thing that the adapter lacks.
    NotRequired(Api, ApiVersion),
    /// The adapter denies what the case needs, against its API.
    Denied(Denial),
    /// The case is not drawn because the adapter denies what it needs, against its API.
    BlockedByDenial(Denial),
    /// The case is not drawn because these round trips failed.
    FailedRoundTrips(Vec<FailedRoundTrip>),
    /// The case is drawn although the round trip of this format was skipped.
    UncheckedRoundTrip {
        /// The format.
        format: TextureFormat,
        /// The reason why the round trip was skipped.
        reason: String,
    },

    /// Counters are outside their legal ranges.
    Counters(Vec<CounterOutcome>),
    /// A line has too few fragments.
    LineGap {
        /// The pass, the draw and the primitive.
        origin: [usize; 3],
        /// The least legal number of fragments, and the greatest number that the frame can contain.
        fragments: [usize; 2],
        /// The clause of the specification.
        citation: String,
    },
    /// Only a part of the picture was judged.
    Share {
        /// The number of judged samples.
        judged: u64,
        /// The number of samples.
        total: u64,
    },
    /// A literal value of the case is outside the legal set, so the case or the reference is wrong.
    IllegalLiteral {
        /// The literal value.
        value: f64,
        /// The channel of the texel that the value is for.
        channel: u8,
        /// Its texel.
        at: [u32; 2],
    },
    /// This texel is not the literal value of the case.
    MissedLiteral([u32; 2]),
    /// Frames or attachments that must be equal differ.
    Difference {
        /// The number of samples that differ.
        samples: u64,
        /// Where the first difference was found.
        pair: ComparedPair,
        /// The clause of the specification.
        citation: String,
    },
    /// The verdict is that of the case's scene in this variant.
    Variant(String),
    /// The frames do not fit the case.
    Unfit(String),
    /// No frame came back.
    NoFrame,
    /// The picture was judged, but calls broke the API's rules.
    Validation {
        /// The number of messages.
        messages: usize,
        /// The verdict on the picture.
        otherwise: Verdict,
        /// The first message.
        first: String,
    },

    /// The drawings disagree.
    Flaky {
        /// The verdicts in order.
        verdicts: Vec<Verdict>,
        /// The thing that was new for each of them.
        fresh: Fresh,
    },
    /// The verdict appears only after this number of other cases in the same process.
    AfterOthers(usize),
    /// The frames were being timed.
    WhileTimed,
    /// Frames of this size are not timed, because a frame of a smaller one already takes this many seconds.
    LongFrames(f64),
    /// Frames of this size are not drawn, because their attachments take this many bytes, more than a worker may use.
    LargeFrames(u64),
    /// The worker had no case left.
    AfterLastCase,
    /// The bench had been stopped and was resumed.
    WhenResumed,
    /// The picture after a round differs from the judged picture, against this clause.
    ChangedPicture(String),
    /// The device of a page did not answer within this time, in seconds.
    NoAnswer(f64),
    /// The end of the process that drew the case, in lines that have no field of their own for it.
    Process(Box<ProcessEnd>),
    /// The number of wrong samples and the position of the first, in lines that do not list them.
    FirstWrong {
        /// The number of wrong and imprecise samples.
        samples: u64,
        /// The position of the first.
        at: [u32; 2],
    },

    /// The expectation of the verdict has expired.
    Expired {
        /// The last day on which the expectation counted.
        day: String,
        /// The reason of the expectation.
        reason: String,
    },
    /// The verdict is the expected one, but what is wrong is not, by the expectation with this reason.
    OtherSymptom(String),
    /// The parts of a merged run disagree.
    PartsDisagree(Verdict, Verdict),
}

/// A denial of an adapter against its API.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Denial {
    /// The requirement that the adapter's limits do not meet.
    pub needed: Requirement,
    /// The API whose specification demands it.
    pub api: Api,
    /// The version that the adapter reports, which requires it of every implementation.
    pub version: ApiVersion,
    /// The clause of the specification.
    pub citation: String,
}

/// A round trip that failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FailedRoundTrip {
    /// The id of the round trip's case.
    pub case: String,
    /// The verdict on it, which blocks the cases that lean on it.
    pub verdict: Verdict,
    /// The first wrong texel; `None` if no texel is wrong, or none was read back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wrong: Option<WrongTexel>,
    /// The reasons, if no texel is wrong; of standard error only the last line.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub why: Vec<Reason>,
}

/// The two sides that a relation compares.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ComparedPair {
    /// The case's scene and this variant of it.
    Variant(String),
    /// Two attachments of one frame.
    Attachments(String, String),
    /// Samples of one frame whose colours a draw computes from the same source and the same destination.
    Operands,
}

/// The thing that is new for each of several drawings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fresh {
    /// The process.
    Process,
    /// The device of a page.
    Device,
}

impl Reason {
    /// Returns the text in it that can be long.
    pub(crate) fn text_mut(&mut self) -> Option<&mut String> {
        match self {
            Self::Text(text)
            | Self::Skipped(text)
            | Self::Unfit(text)
            | Self::Validation { first: text, .. } => Some(text),
            Self::Process(end) => Some(&mut end.stderr),
            _ => None,
        }
    }
}

/// Reads reasons: a list, or the message of a format before 6.
pub(crate) fn read<'de, D: Deserializer<'de>>(input: D) -> Result<Vec<Reason>, D::Error> {
    input.deserialize_any(MessageOrReasons)
}

struct MessageOrReasons;

impl<'de> Visitor<'de> for MessageOrReasons {
    type Value = Vec<Reason>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of reasons, or a message")
    }

    fn visit_str<E: de::Error>(self, message: &str) -> Result<Self::Value, E> {
        let message = Some(message).filter(|text| !text.is_empty());
        let reasons = message.map(|text| Reason::Text(text.to_owned()));
        Ok(reasons.into_iter().collect())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
        let mut reasons = Vec::new();
        while let Some(reason) = list.next_element()? {
            reasons.push(reason);
        }
        Ok(reasons)
    }
}

#[cfg(test)]
mod tests {
    use crate::{Record, Verdict};

    #[test]
    fn a_message_of_an_earlier_format_is_read_as_text() {
        let written = |reasons: &str| {
            let line = format!(r#"{{"case":"a/b","adapter":"cpu","verdict":"crash",{reasons}}}"#);
            serde_json::from_str::<Record>(&line)
        };
        let text = super::Reason::Text("slot 3 is free".to_owned());
        let old = written(r#""message":"slot 3 is free""#).expect("it parses");
        assert_eq!(old.reasons, [text]);
        assert_eq!(
            written(r#""reasons":[{"text":"slot 3 is free"}]"#).expect("it parses"),
            old
        );
        assert_eq!(written(r#""message":"""#).expect("it parses").reasons, []);
        let wrong = written(r#""reasons":[{"tekst":"a"}]"#).expect_err("no such reason");
        let wrong = wrong.to_string();
        let start = "unknown variant `tekst`, expected one of ";
        assert!(wrong.starts_with(start), "{wrong}");
        let now = serde_json::to_value(&old).expect("it is written");
        assert_eq!(
            now["reasons"],
            serde_json::json!([{ "text": "slot 3 is free" }])
        );
        assert_eq!(old.verdict, Verdict::Crash);
    }
}
