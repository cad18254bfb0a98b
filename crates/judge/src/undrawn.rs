//! Cases that are not drawn, and what expectations say about a record.

use crate::denial::note_denial;
use crate::judge::is_due_to_fail;
use crate::requirement::note_requirement;
use crate::round_trips::RoundTrips;
use etalon_case::Case;
use etalon_record::{AdapterRecord, Expectations, Expected, Reason, Record, Verdict};

/// Returns the record of a case that is not drawn on an adapter; `None` if it must be drawn. The round trips are
/// `None` until all are drawn.
pub fn undrawn(
    case: &Case,
    adapter: &AdapterRecord,
    expectations: &Expectations,
    round_trips: Option<&RoundTrips>,
) -> Option<Record> {
    let mut record = if let Some(entry) = expectations.skips(adapter, &case.id) {
        let mut record = Record::new(&case.id, &adapter.info.name, Verdict::Skipped);
        record.expected = Some(Expected {
            reason: entry.reason.clone(),
        });
        record.reasons = vec![Reason::Skipped(entry.reason.clone())];
        record
    } else if let Some(missing) = adapter.limits.missing(&case.requirements()) {
        let mut record = Record::new(&case.id, &adapter.info.name, Verdict::NotSupported);
        record.reasons = vec![Reason::Missing(missing)];
        if case.is_requirement() {
            note_requirement(&mut record, case, &adapter.limits);
        } else {
            note_denial(&mut record, case, adapter, expectations);
        }
        record
    } else {
        let blocked = round_trips?.blocks(case)?;
        let mut record = Record::new(&case.id, &adapter.info.name, Verdict::Blocked);
        record.reasons = vec![blocked.reason];
        record.blocked_by = blocked.by;
        record.expected = blocked.expected.map(|reason| Expected { reason });
        record
    };
    record.due_fail = is_due_to_fail(case, &adapter.limits);
    Some(record)
}

/// Returns a record with what the expectations say about it. A case that is not drawn for an expected reason is
/// expected itself.
pub fn settled(mut record: Record, expectations: &Expectations, adapter: &AdapterRecord) -> Record {
    if record.verdict != Verdict::Skipped {
        let inherited = record.expected.take();
        record.expect(expectations, adapter);
        record.expected = record.expected.take().or(inherited);
    }
    record
}

/// Returns true if a verdict is bad, and neither the expectations nor the case expect it: another drawing should
/// confirm it.
pub fn is_unexpectedly_bad(
    record: &Record,
    expectations: &Expectations,
    adapter: &AdapterRecord,
) -> bool {
    // Most verdicts are good, and a record is copied to ask for the expectations.
    record.verdict.is_bad() && {
        let mut expected = record.clone();
        expected.expect(expectations, adapter);
        expected.unexpected()
    }
}
