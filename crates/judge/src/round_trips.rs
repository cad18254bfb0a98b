//! Round trips: a format is uploaded and read back. Every judged frame was uploaded or read back this way,
//! so a run first draws the round trips that its cases depend on, and draws no case whose round trip
//! failed.
//!
//! Clears and draws block nothing: if one goes wrong, it is a `Fail` of its own, and other cases of the
//! format still say something about the driver.

use etalon_case::{Case, CaseError, Library};
use etalon_frame::TextureFormat;
use etalon_record::{FailedRoundTrip, LossKind, ProcessEnd, Reason, Record, Verdict};
use etalon_scene::AttachmentContents;
use std::collections::{BTreeMap, BTreeSet};

/// The start of the ids of round trips, before the format.
const FAMILY: &str = "capabilities/round-trip/format=";

/// Returns the round trips that the cases depend on: for each format, the first one in a library. A sharded
/// run passes all selected cases, so that every shard draws the same round trips.
///
/// # Errors
/// If the case file of the round trips is broken.
pub fn round_trips(libraries: &[&Library], cases: &[Case]) -> Result<Vec<Case>, CaseError> {
    let mut wanted: BTreeSet<TextureFormat> = cases.iter().flat_map(leans_on).collect();
    let mut found = Vec::new();
    for library in libraries {
        for case in library.cases_that_begin(FAMILY) {
            let case = case.build()?;
            if format_of(&case).is_some_and(|format| wanted.remove(&format)) {
                found.push(case);
            }
        }
    }
    Ok(found)
}

/// Returns the format that a case round-trips; `None` if it is not a round trip.
fn format_of(case: &Case) -> Option<TextureFormat> {
    if !case.id.starts_with(FAMILY) {
        return None;
    }
    case.scene.attachments.first().map(|a| a.format)
}

/// Returns the colour formats that a case uploads or reads back. A round trip depends on no other. Depth
/// and stencil are never uploaded, so they have no round trip.
fn leans_on(case: &Case) -> BTreeSet<TextureFormat> {
    if format_of(case).is_some() {
        return BTreeSet::new();
    }
    let mut formats = BTreeSet::new();
    for scene in case.scenes() {
        for (index, attachment) in scene.attachments.iter().enumerate() {
            let uploaded = matches!(attachment.contents, AttachmentContents::Texels(_));
            if attachment.format.is_color() && (uploaded || scene.read.contains(&index)) {
                formats.insert(attachment.format);
            }
        }
    }
    formats
}

/// The result of an adapter's round trips.
#[derive(Clone, Debug, Default)]
pub struct RoundTrips {
    failed: BTreeMap<TextureFormat, FailedTrip>,
    /// Formats whose round trip the expectations skip, with the reason.
    unchecked: BTreeMap<TextureFormat, String>,
    /// The reason why the driver no longer starts.
    not_started: Option<ProcessEnd>,
}

/// A round trip that failed.
#[derive(Clone, Debug)]
struct FailedTrip {
    trip: FailedRoundTrip,
    /// The reason why the failure is expected.
    expected: Option<String>,
}

/// The reason why a case is not drawn.
#[derive(Debug, PartialEq)]
pub struct Blocked {
    /// The ids of the round trips that failed.
    pub by: Vec<String>,
    /// The failures.
    pub reason: Reason,
    /// The reason why the case is expected to be blocked, if all these failures are expected.
    pub expected: Option<String>,
}

impl RoundTrips {
    /// Adds the record of a round trip.
    pub fn take(&mut self, case: &Case, record: &Record) {
        let Some(format) = format_of(case) else {
            return;
        };
        let not_started = |end: &&ProcessEnd| end.kind == LossKind::NotStarted;
        if let Some(end) = record.process.as_ref().filter(not_started) {
            // Nothing is known about the format, and no other case can be drawn either.
            self.not_started = Some(end.clone());
        } else if record.verdict == Verdict::Skipped {
            let reason = record.expected.as_ref();
            let reason = reason.map_or_else(String::new, |e| e.reason.clone());
            self.unchecked.insert(format, reason);
        } else if fails(record) {
            let failed = FailedTrip {
                trip: FailedRoundTrip {
                    case: case.id.clone(),
                    verdict: record.verdict,
                    wrong: record.wrong.first().cloned(),
                    why: why(record),
                },
                expected: record.expected.as_ref().map(|e| e.reason.clone()),
            };
            self.failed.insert(format, failed);
        }
    }

    /// Returns why the driver no longer starts; every other case is recorded with this reason.
    pub fn not_started(&self) -> Option<&ProcessEnd> {
        self.not_started.as_ref()
    }

    /// Returns why a case must not be drawn; `None` if it can be.
    pub fn blocks(&self, case: &Case) -> Option<Blocked> {
        if self.failed.is_empty() {
            return None;
        }
        let formats = leans_on(case);
        let failed = formats.iter().filter_map(|format| self.failed.get(format));
        let failed: Vec<&FailedTrip> = failed.collect();
        if failed.is_empty() {
            return None;
        }
        let reasons: Option<Vec<String>> = failed
            .iter()
            .map(|f| {
                f.expected
                    .as_ref()
                    .map(|why| format!("{}: {why}", f.trip.case))
            })
            .collect();
        Some(Blocked {
            by: failed.iter().map(|f| f.trip.case.clone()).collect(),
            reason: Reason::FailedRoundTrips(failed.iter().map(|f| f.trip.clone()).collect()),
            expected: reasons.map(|texts| texts.join("; ")),
        })
    }

    /// Notes on a case that is drawn that a round trip that it depends on was skipped.
    pub fn annotate(&self, case: &Case, record: &mut Record) {
        if self.unchecked.is_empty() {
            return;
        }
        let formats = leans_on(case);
        let skipped = self.unchecked.iter().filter(|(f, _)| formats.contains(f));
        let reasons = skipped.map(|(format, reason)| Reason::UncheckedRoundTrip {
            format: *format,
            reason: reason.clone(),
        });
        record.reasons.extend(reasons);
    }
}

/// Returns true if a round trip did not show that the format comes back as it was uploaded. An adapter does
/// not offer a format that it does not support, so that blocks nothing.
fn fails(record: &Record) -> bool {
    // A validation message is a separate error; here the picture decides.
    let judged = record.texels.total > 0 && record.texels.open < record.texels.total;
    let right = record.verdict == Verdict::InternalError
        && !record.validation.is_empty()
        && judged
        && record.texels.wrong == 0;
    record.verdict.is_bad() && !right
}

/// Returns why a round trip without a wrong texel failed.
fn why(record: &Record) -> Vec<Reason> {
    if !record.wrong.is_empty() {
        return Vec::new();
    }
    let end = record.process.clone().map(|mut end| {
        let last = end.stderr.lines().rev().find(|l| !l.trim().is_empty());
        end.stderr = last.unwrap_or_default().to_owned();
        Reason::Process(Box::new(end))
    });
    end.into_iter()
        .chain(record.reasons.iter().cloned())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_case::Profile;
    use etalon_record::Expected;

    fn built(glob: &str) -> Vec<Case> {
        let library = Library::built_in();
        let globs = [glob.to_owned()];
        let selection = etalon_case::select(library, Profile::Full, &globs).expect("a glob");
        let cases = selection.cases.iter();
        cases.map(|c| c.build().expect("a case")).collect()
    }

    fn trip(format: &str) -> Case {
        let mut cases = built(&format!("{FAMILY}{format}"));
        cases.pop().expect("a round trip")
    }

    #[test]
    fn every_colour_format_has_its_round_trip_and_no_other_format_has() {
        let found: BTreeSet<TextureFormat> = built(&format!("{FAMILY}*"))
            .iter()
            .filter_map(format_of)
            .collect();
        let formats: BTreeSet<TextureFormat> = TextureFormat::ALL
            .into_iter()
            .filter(|f| f.is_color())
            .collect();
        assert_eq!(found, formats);
    }

    #[test]
    fn a_case_leans_on_what_it_uploads_and_reads_and_on_nothing_else() {
        use TextureFormat::{Rgba8Unorm, Rgba32Float};
        let leaned = |glob: &str| {
            let cases = built(glob);
            assert!(!cases.is_empty(), "{glob}");
            cases.iter().flat_map(leans_on).collect::<BTreeSet<_>>()
        };
        let depth = leaned("depth/clear");
        assert_eq!(depth, BTreeSet::from([Rgba8Unorm]), "no depth format");
        assert_eq!(
            leaned("blend/factors"),
            BTreeSet::from([Rgba8Unorm, Rgba32Float])
        );
        assert_eq!(leaned("capabilities/round-trip"), BTreeSet::new());
        let library = Library::built_in();
        let trips = round_trips(&[library, library], &built("blend/factors")).expect("trips");
        let ids: BTreeSet<&str> = trips.iter().map(|c| c.id.as_str()).collect();
        assert_eq!(trips.len(), 2, "each once: {ids:?}");
    }

    #[test]
    fn bad_round_trips_block_their_format_and_good_ones_nothing() {
        let trip = trip("rgba32float");
        let [inside, outside] = ["blend/factors", "cull/triangle-list"].map(|glob| {
            let mut cases = built(glob);
            cases.pop().expect("a case")
        });
        for verdict in Verdict::ALL {
            let mut found = RoundTrips::default();
            found.take(&trip, &Record::new(&trip.id, "x", verdict));
            assert_eq!(
                found.blocks(&inside).is_some(),
                verdict.is_bad(),
                "{verdict}"
            );
            assert_eq!(found.blocks(&outside), None, "{verdict}");
            assert_eq!(found.blocks(&trip), None, "a round trip leans on nothing");
            let skipped = verdict == Verdict::Skipped;
            let mut drawn = Record::new(&inside.id, "x", Verdict::Pass);
            found.annotate(&inside, &mut drawn);
            assert_eq!(!drawn.reasons.is_empty(), skipped, "{verdict}");
        }
    }

    #[test]
    fn a_driver_that_does_not_start_tells_nothing_about_a_format() {
        let trip = trip("rgba32float");
        let mut record = Record::new(&trip.id, "x", Verdict::Crash);
        record.process = Some(ProcessEnd {
            kind: LossKind::NotStarted,
            error: "gone".to_owned(),
            ..ProcessEnd::default()
        });
        let mut found = RoundTrips::default();
        found.take(&trip, &record);
        assert_eq!(found.not_started(), record.process.as_ref());
        assert!(found.failed.is_empty());
    }

    #[test]
    fn a_validation_message_blocks_only_with_a_wrong_picture() {
        let trip = trip("rgba32float");
        let mut record = Record::new(&trip.id, "x", Verdict::InternalError);
        assert!(fails(&record), "no picture at all");
        record.validation = vec!["VUID".to_owned()];
        assert!(fails(&record), "no picture at all");
        record.texels.total = 9;
        assert!(!fails(&record));
        record.texels.open = 9;
        assert!(fails(&record), "nothing was asserted");
        record.texels.open = 0;
        record.texels.wrong = 1;
        assert!(fails(&record));
    }

    #[test]
    fn a_case_is_expected_to_be_blocked_if_all_its_failures_are_expected() {
        let (float, other) = (trip("rgba32float"), trip("rgba8unorm"));
        let case = built("blend/factors").pop().expect("a case");
        let mut known = Record::new(&float.id, "x", Verdict::Fail);
        known.expected = Some(Expected {
            reason: "bug 12".to_owned(),
        });
        let mut found = RoundTrips::default();
        found.take(&float, &known);
        let blocked = found.blocks(&case).expect("it is blocked");
        let reason = format!("{}: bug 12", float.id);
        assert_eq!(blocked.expected, Some(reason));
        assert_eq!(blocked.by, std::slice::from_ref(&float.id));
        let failed = FailedRoundTrip {
            case: float.id.clone(),
            verdict: Verdict::Fail,
            wrong: None,
            why: Vec::new(),
        };
        assert_eq!(blocked.reason, Reason::FailedRoundTrips(vec![failed]));
        found.take(&other, &Record::new(&other.id, "x", Verdict::Crash));
        let blocked = found.blocks(&case).expect("it is blocked");
        assert_eq!((blocked.expected, blocked.by.len()), (None, 2));
    }
}
