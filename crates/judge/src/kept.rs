//! The results of its drawings that a record keeps: validation messages, verdicts that differ, and fewer wrong
//! texels if a frame file shows the rest.

use etalon_record::{Fresh, MAX_VALIDATION, Reason, Record, Verdict};

/// The number of frame files and stories of imprecise cases that are kept per adapter and case file if all known
/// failures are kept; otherwise one is.
pub const IMPRECISE_FRAMES: u32 = 3;
/// The number of wrong samples that the record of an imprecise case or a known failure lists next to a frame file.
const SHOWN_WRONG: usize = 8;
/// The maximum number of bytes of one validation message that a record keeps.
const MESSAGE_BYTES: usize = 1000;

/// The amount of detail in the record of a failure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ShownDetail {
    /// Everything: the failure is new, or all known ones are kept.
    Whole,
    /// An example of all cases with the same known failure.
    Example,
    /// The first wrong sample; the record of this case shows the rest.
    By(String),
}

/// Shortens a record to what it shows. `has_frame` is true if its frame is kept in a file.
pub fn shorten(record: &mut Record, shown: ShownDetail, has_frame: bool) {
    record.accuracy.retain(|figures| !figures.is_exact());
    match shown {
        _ if record.verdict == Verdict::Imprecise => {
            // There can be hundreds of legal deviations, and one texel shows what kind they are.
            record
                .wrong
                .truncate(if has_frame { SHOWN_WRONG } else { 1 });
            if !has_frame {
                record.story = None;
            }
        }
        ShownDetail::Whole if !record.due_fail => {}
        // The case itself makes this failure, so its cause needs no search.
        ShownDetail::Example if record.due_fail => {
            record.wrong.truncate(1);
            record.story = None;
        }
        // The frame file, if it is kept, shows the rest.
        ShownDetail::Whole | ShownDetail::Example => record.wrong.truncate(SHOWN_WRONG),
        ShownDetail::By(case) => record.refer_to(case),
    }
}

/// Records the messages of validation. Calls that break the API's rules are an error of the suite: their
/// result says nothing about the driver.
pub fn note_validation(record: &mut Record, messages: Vec<String>) {
    let Some(first) = messages.first() else {
        return;
    };
    if record.verdict.is_judged() || record.verdict == Verdict::Measured {
        record.reasons = vec![Reason::Validation {
            messages: messages.len(),
            otherwise: record.verdict,
            first: first.clone(),
        }];
        record.verdict = Verdict::InternalError;
    }
    let short = |mut text: String| {
        let end = text.floor_char_boundary(MESSAGE_BYTES);
        text.truncate(end);
        text
    };
    record.validation = messages
        .into_iter()
        .take(MAX_VALIDATION)
        .map(short)
        .collect();
}

/// Makes the record of the worst of several drawings `Flaky`. `fresh` says what was new for each of them.
pub fn mark_flaky(worst: &mut Record, first: Verdict, repeats: Vec<Verdict>, fresh: Fresh) {
    let mut verdicts = vec![first];
    verdicts.extend(&repeats);
    worst.verdict = Verdict::Flaky;
    worst.repeats = repeats;
    worst.reasons.insert(0, Reason::Flaky { verdicts, fresh });
}
