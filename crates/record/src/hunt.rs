//! The result of a hunt for planted bugs.

use crate::error::RecordError;
use crate::folder::HUNT_FILE;
use crate::innocent::InnocentRecord;
use crate::json::json_line;
use crate::json_lines::JsonLines;
use crate::line_writer::put;
use crate::output_folder::OutputFolder;
use crate::paths::open_below;
use crate::provenance::Provenance;
use crate::sighting::Sighting;
use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The format of `mutants.json` that this crate writes.
pub const HUNT_FORMAT: u32 = 2;

/// The maximum number of bytes of a hunt that are read.
const MAX_BYTES: u64 = 64 << 20;

/// The description of a planted bug.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MutantInfo {
    /// The stable name, its class first: `depth/write-ignored`.
    pub name: String,
    /// The bug's effect, in one sentence.
    pub about: String,
    /// The driver that once had the bug, or the kind of mistake.
    pub source: String,
    /// The area whose cases alone must catch it.
    pub area: String,
}

state_enum! {
    /// The outcome of a hunt for one planted bug.
    Catch {
        /// A case failed.
        Caught = "caught",
        /// A case was imprecise, and none failed.
        Noticed = "noticed",
        /// Every case passed.
        Survived = "survived",
        /// The cases could not be drawn, because the mutant itself is faulty.
        Broken = "broken",
    }
}

/// The verdicts of one area's cases on a planted bug.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AreaTally {
    /// The first part of the cases' ids: `depth`.
    pub area: String,
    /// Cases whose texels are all in the yardstick, or about which nothing is asserted.
    pub pass: u64,
    /// Cases with a legal texel outside the yardstick.
    pub imprecise: u64,
    /// Cases with a wrong texel.
    pub fail: u64,
    /// Cases that could not be drawn.
    pub broken: u64,
}

/// The result of one planted bug.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MutantRecord {
    /// The planted bug, described as in the registry.
    pub mutant: MutantInfo,
    /// The outcome over all areas: a violation in one of them is enough.
    pub outcome: Catch,
    /// The verdicts of each area, in the order of the cases.
    pub areas: Vec<AreaTally>,
    /// The first case that showed the bug.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first: Option<Sighting>,
}

impl MutantRecord {
    /// Returns true if the cases of the bug's own area are enough for the outcome.
    pub fn by_own_area(&self) -> bool {
        let tally = self.areas.iter().find(|a| a.area == self.mutant.area);
        tally.is_some_and(|area| match self.outcome {
            Catch::Caught => area.fail > 0,
            Catch::Noticed => area.imprecise > 0,
            Catch::Survived | Catch::Broken => false,
        })
    }

    /// Adds the result of the same bug with further cases.
    pub fn add(&mut self, other: Self) {
        for tally in other.areas {
            match self.areas.iter_mut().find(|a| a.area == tally.area) {
                Some(known) => {
                    known.pass += tally.pass;
                    known.imprecise += tally.imprecise;
                    known.fail += tally.fail;
                    known.broken += tally.broken;
                }
                None => self.areas.push(tally),
            }
        }
        let weight = |outcome| match outcome {
            Catch::Survived => 0,
            Catch::Noticed => 1,
            Catch::Caught => 2,
            Catch::Broken => 3,
        };
        if weight(other.outcome) > weight(self.outcome) {
            self.outcome = other.outcome;
            self.first = other.first;
        }
    }

    /// Returns what is wrong with the outcome: a bug was not caught.
    pub fn complaint(&self) -> Option<&'static str> {
        match self.outcome {
            Catch::Broken => Some("it could not be drawn"),
            Catch::Survived => Some("nothing noticed it"),
            Catch::Noticed => Some("no case failed"),
            Catch::Caught => None,
        }
    }
}

/// A whole hunt: `mutants.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hunt {
    /// The format of the file; lower than [`HUNT_FORMAT`] if an earlier version wrote it.
    pub format: u32,
    /// The suite, machine, time and command.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Wall time in seconds.
    pub seconds: f64,
    /// The number of cases that were selected to be drawn with each bug.
    pub cases: u64,
    /// True if every case was drawn with every bug; otherwise drawing stopped in each area at the first
    /// `Fail`.
    pub full: bool,
    /// True if every built-in case was drawn: then each innocent must show what it does.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub every_case: bool,
    /// The result of each bug, in the registry's order.
    pub mutants: Vec<MutantRecord>,
    /// The result of each innocent, in the registry's order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub innocents: Vec<InnocentRecord>,
}

impl Hunt {
    /// Returns the number of bugs with this outcome.
    pub fn count(&self, outcome: Catch) -> usize {
        self.mutants.iter().filter(|m| m.outcome == outcome).count()
    }

    /// Returns the bugs whose outcome is wrong, and why.
    pub fn complaints(&self) -> impl Iterator<Item = (&MutantRecord, &'static str)> {
        let each = |m: &'_ MutantRecord| m.complaint();
        self.mutants
            .iter()
            .filter_map(move |m| each(m).map(|why| (m, why)))
    }

    /// Returns the innocents whose verdicts are wrong, with the specification and why. Some cases need not show what
    /// an innocent does.
    pub fn innocent_complaints(
        &self,
    ) -> impl Iterator<Item = (&InnocentRecord, &str, &'static str)> {
        self.innocents.iter().flat_map(|innocent| {
            let complaints = innocent.complaints(self.every_case);
            complaints.map(move |(specification, why)| (innocent, specification, why))
        })
    }

    /// Reads `mutants.json` in a folder.
    ///
    /// # Errors
    /// If the file cannot be read or does not parse.
    pub fn read(folder: &Path) -> Result<Self, RecordError> {
        let path = folder.join(HUNT_FILE);
        let lines = JsonLines {
            path: &path,
            format: HUNT_FORMAT,
            max_header: MAX_BYTES,
            max_line: 0,
            remedy: "record the hunt again",
        };
        let file = open_below(folder, HUNT_FILE)?;
        let (hunt, _) = lines.read(file, |hunt| hunt, |_, _: IgnoredAny| Ok(()))?;
        Ok(hunt)
    }

    /// Writes `mutants.json` into a folder, and creates the folder if it does not exist.
    ///
    /// # Errors
    /// If the folder cannot be written to.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, RecordError> {
        put(
            &OutputFolder::open(folder)?,
            HUNT_FILE,
            [json_line("a hunt", self)],
        )?;
        Ok(folder.join(HUNT_FILE))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worse_outcome_of_further_cases_stays() {
        let mut sum = record(Catch::Noticed);
        sum.add(record(Catch::Caught));
        sum.add(record(Catch::Survived));
        assert_eq!(sum.outcome, Catch::Caught);
        let tally = &sum.areas[0];
        assert_eq!((tally.pass, tally.imprecise, tally.fail), (3, 1, 1));
    }

    fn record(outcome: Catch) -> MutantRecord {
        let tally = AreaTally {
            area: "blend".to_owned(),
            pass: 1,
            imprecise: u64::from(outcome == Catch::Noticed),
            fail: u64::from(outcome == Catch::Caught),
            broken: 0,
        };
        MutantRecord {
            mutant: MutantInfo {
                name: "blend/x".to_owned(),
                about: "It.".to_owned(),
                source: "a test".to_owned(),
                area: "blend".to_owned(),
            },
            outcome,
            areas: vec![tally],
            first: None,
        }
    }

    #[test]
    fn a_bug_must_be_caught() {
        for (outcome, fine) in [
            (Catch::Caught, true),
            (Catch::Noticed, false),
            (Catch::Survived, false),
            (Catch::Broken, false),
        ] {
            let record = record(outcome);
            let complaint = record.complaint();
            assert_eq!(complaint.is_none(), fine, "{outcome:?}");
            let seen = matches!(outcome, Catch::Caught | Catch::Noticed);
            assert_eq!(record.by_own_area(), seen);
        }
    }
}
