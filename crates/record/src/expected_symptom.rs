//! The symptom of an expected failure. Another wrong value of the same case is another failure.

use crate::verdict::Verdict;
use etalon_frame::{
    Aspect, Band, ChannelMismatch, CounterKind, CounterOutcome, WrongTexel, state_enum,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The side of the legal values on which a value is.
    Side: array {
        /// Above the highest value.
        High = "high",
        /// Below the lowest value.
        Low = "low",
    }
}

/// The parts of a record that a symptom is compared with.
#[derive(Clone, Copy, Debug)]
pub struct SymptomParts<'a> {
    /// The verdict, which an expectation compares with its own.
    pub verdict: Verdict,
    /// The wrong samples that the record lists.
    pub wrong: &'a [WrongTexel],
    /// All counters of the record, wrong or not.
    pub counters: &'a [CounterOutcome],
}

/// Facts that are true of every wrong value that a record lists.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExpectedSymptom {
    /// The attachment of all wrong channels; any attachment if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attachment: Option<String>,
    /// The aspect of all wrong channels; any aspect if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub aspect: Option<Aspect>,
    /// The codes of all wrong channels; any codes if empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub codes: Vec<u32>,
    /// The side of the legal range on which the wrong values are; either side if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub side: Option<Side>,
    /// The wrong counter, if all texels are right.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub counter: Option<CounterKind>,
}

impl ExpectedSymptom {
    /// Returns true if the symptom states no fact.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Returns true if the symptom is about texels.
    fn names_texels(&self) -> bool {
        let counter = self.counter;
        *self
            != Self {
                counter,
                ..Self::default()
            }
    }

    /// Returns true if a record shows this symptom and nothing else.
    pub fn is_shown_by(&self, record: SymptomParts<'_>) -> bool {
        let texels = record.wrong.iter().filter(|w| w.band > Band::Imprecise);
        let mut channels = texels.flat_map(|w| &w.channels).peekable();
        let has_texels = channels.peek().is_some();
        let mut counters = record
            .counters
            .iter()
            .filter(|c| c.band > Some(Band::Imprecise));
        let counter = counters.clone().next().is_some();
        if self.names_texels() {
            has_texels && channels.all(|channel| self.fits(channel))
        } else {
            counter && !has_texels && counters.all(|c| Some(c.kind) == self.counter)
        }
    }

    fn fits(&self, channel: &ChannelMismatch) -> bool {
        let order = |code| channel.encoding.order_of_code(code);
        self.attachment
            .as_ref()
            .is_none_or(|name| *name == channel.attachment)
            && self.aspect.is_none_or(|aspect| aspect == channel.aspect)
            && (self.codes.is_empty() || self.codes.contains(&channel.actual))
            && match self.side {
                None => true,
                Some(Side::High) => order(channel.actual) > order(channel.high),
                Some(Side::Low) => order(channel.actual) < order(channel.low),
            }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Record;
    use etalon_frame::ChannelEncoding;

    fn record(channels: &[(&str, Aspect, u32)]) -> Record {
        let channels = channels
            .iter()
            .map(|(attachment, aspect, actual)| ChannelMismatch {
                attachment: (*attachment).to_owned(),
                aspect: *aspect,
                channel: 0,
                encoding: ChannelEncoding::Unorm(8),
                low: 10,
                high: 20,
                actual: *actual,
            });
        let mut record = Record::new("a", "gl:x", Verdict::Fail);
        record.wrong = channels
            .map(|channel| WrongTexel {
                x: 0,
                y: 0,
                sample: 0,
                band: Band::Fail,
                channels: vec![channel],
            })
            .collect();
        record
    }

    fn symptom(text: &str) -> ExpectedSymptom {
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn every_wrong_value_must_be_the_expected_one() {
        let shown = [("color", Aspect::Color, 5), ("color", Aspect::Color, 7)];
        let fits = |text: &str| symptom(text).is_shown_by(record(&shown).shown());
        assert!(fits(
            r#"{ "attachment": "color", "aspect": "color", "codes": [5, 7], "side": "low" }"#
        ));
        assert!(fits(r#"{ "side": "low" }"#));
        for other in [
            r#"{ "attachment": "depth" }"#,
            r#"{ "aspect": "depth" }"#,
            r#"{ "codes": [5] }"#,
            r#"{ "side": "high" }"#,
            r#"{ "counter": "samples-passed" }"#,
        ] {
            assert!(!fits(other), "{other}");
        }
        let mut imprecise = record(&shown);
        imprecise.wrong[1].band = Band::Imprecise;
        assert!(symptom(r#"{ "codes": [5] }"#).is_shown_by(imprecise.shown()));
        let none = Record::new("a", "gl:x", Verdict::Fail);
        assert!(!symptom(r#"{ "aspect": "color" }"#).is_shown_by(none.shown()));
    }

    #[test]
    fn a_counter_symptom_needs_right_texels() {
        let occlusion = symptom(r#"{ "counter": "samples-passed" }"#);
        let mut counted = record(&[]);
        counted.counters = vec![CounterOutcome {
            name: "passed".to_owned(),
            kind: occlusion.counter.unwrap(),
            low: 4,
            high: Some(4),
            actual: 0,
            band: Some(Band::Fail),
        }];
        assert!(occlusion.is_shown_by(counted.shown()));
        let wrong = record(&[("color", Aspect::Color, 5)]);
        counted.wrong = wrong.wrong;
        assert!(!occlusion.is_shown_by(counted.shown()));
    }
}
