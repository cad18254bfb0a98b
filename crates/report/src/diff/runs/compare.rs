//! Compares two records of a case.

use super::data::{CaseChange, Detail};
use super::pairs::Folder;
use super::pixels;
use crate::words::{channel_of, headline};
use etalon_frame::{Accuracy, WrongTexel};
use etalon_record::{MAX_WRONG_TEXELS, Record};
use serde::Serialize;
use serde_json::json;
use std::collections::{BTreeMap, HashMap};

/// Returns the differences of two records of a case, or `None` if only times differ.
pub(super) fn change(
    folders: &[Folder<'_>; 2],
    adapter: [&str; 2],
    both: &[&Record; 2],
) -> Option<CaseChange> {
    let [before, after] = *both;
    let details = details(before, after);
    let (frame, frame_error) = match pixels::compare(folders, both) {
        None => (None, None),
        Some(Ok(frame)) => (Some(frame), None),
        Some(Err(error)) => (None, Some(error)),
    };
    let mut what = Vec::new();
    if before.verdict != after.verdict {
        what.push("verdict");
    }
    if before.unexpected() != after.unexpected()
        || before.expected.is_some() != after.expected.is_some()
        || before.improves != after.improves
    {
        what.push("expectation");
    }
    if frame.as_ref().is_some_and(|f| !f.equal()) {
        what.push("frame");
    }
    for detail in &details {
        if !what.contains(&detail.what) {
            what.push(detail.what);
        }
    }
    (!what.is_empty()).then(|| CaseChange {
        case: before.case.clone(),
        case_file: before.parts().file().to_owned(),
        adapter: adapter.map(str::to_owned),
        direction: etalon_record::Change::between(before, after).into(),
        what,
        verdict: both.map(|r| r.verdict),
        unexpected: both.map(Record::unexpected),
        headline: both.map(headline),
        details,
        frame,
        frame_error,
    })
}

/// The differences found so far.
#[derive(Default)]
struct Details(Vec<Detail>);

impl Details {
    fn add<T: PartialEq + Serialize>(
        &mut self,
        what: &'static str,
        name: impl Into<String>,
        before: T,
        after: T,
    ) {
        if before != after {
            self.0.push(Detail {
                what,
                name: name.into(),
                before: json!(before),
                after: json!(after),
            });
        }
    }
}

fn details(before: &Record, after: &Record) -> Vec<Detail> {
    let mut found = Details::default();
    // A missing frame has no texels. The verdict already shows that it is missing.
    let both_read = before.texels.total > 0 && after.texels.total > 0;
    if both_read {
        let [b, a] = [&before.texels, &after.texels];
        found.add("texels", "all", b.total, a.total);
        found.add("texels", "wrong", b.wrong, a.wrong);
        found.add("texels", "imprecise", b.imprecise, a.imprecise);
        found.add("texels", "open", b.open, a.open);
        wrong(&mut found, before, after);
        accuracy(&mut found, &before.accuracy, &after.accuracy);
    }
    let counters: HashMap<&str, _> = after
        .counters
        .iter()
        .map(|c| (c.name.as_str(), c))
        .collect();
    for old in &before.counters {
        if let Some(new) = counters.get(old.name.as_str()) {
            found.add("counters", old.name.as_str(), old.actual, new.actual);
            let [b, a] = [old.range().to_string(), new.range().to_string()];
            found.add("counters", format!("{}, legal", old.name), b, a);
        }
    }
    if let (Some(b), Some(a)) = (&before.measured, &after.measured) {
        let [d, e] = [&b.distance, &a.distance];
        found.add("distance", "RMSE", d.rmse, e.rmse);
        found.add("distance", "largest", d.max, e.max);
        found.add("distance", "FLIP", d.flip, e.flip);
        found.add("distance", "share of wrong texels", d.wrong, e.wrong);
        found.add(
            "distance",
            "error of the truth",
            d.truth_error,
            e.truth_error,
        );
        found.add("cost", "passes", b.passes, a.passes);
        found.add("cost", "draws", b.draws, a.draws);
        found.add("cost", "fragments", b.fragments, a.fragments);
        found.add("cost", "bytes", b.bytes, a.bytes);
    }
    let lost = [before, after].map(|r| {
        let end = r.process.as_ref();
        // The duration and the process's output differ each time.
        end.map(|end| json!({ "kind": end.kind, "signal": end.signal, "exit": end.exit }))
    });
    let [b, a] = lost;
    found.add("process", "end", b, a);
    found.add("repeats", "verdicts", &before.repeats, &after.repeats);
    found.add("order", "only after", &before.after, &after.after);
    // Messages contain addresses, so their text differs each time. Only their number is compared.
    let said = [before, after].map(|r| r.validation.len());
    found.add("validation", "messages", said[0], said[1]);
    found.0
}

/// Adds the differences of the listed wrong texels. If a known failure's list was cut, only as many
/// texels are compared as both records list.
fn wrong(found: &mut Details, before: &Record, after: &Record) {
    let both = [before, after];
    let is_cut = |r: &&Record| {
        r.excuse().is_some() && (r.wrong.len() as u64) < r.texels.wrong + r.texels.imprecise
    };
    let most = if both.iter().any(is_cut) {
        before.wrong.len().min(after.wrong.len())
    } else {
        MAX_WRONG_TEXELS
    };
    let [b, a] = both.map(|r| {
        let place = |t: &WrongTexel| (t.y, t.x, t.sample);
        let texels = r.wrong.iter().take(most).map(|t| (place(t), codes(t)));
        texels.collect::<BTreeMap<_, _>>()
    });
    let gone = b.keys().filter(|place| !a.contains_key(place)).count();
    let come = a.keys().filter(|place| !b.contains_key(place)).count();
    if gone + come > 0 {
        // The two counts describe different lists, so equal counts are a difference too.
        found.0.push(Detail {
            what: "wrong",
            name: "listed there only".to_owned(),
            before: json!(gone),
            after: json!(come),
        });
    }
    let other = |place, codes| a.get(place).filter(|new| *new != codes);
    let mut differ = b
        .iter()
        .filter_map(|(p, old)| Some((p, old, other(p, old)?)));
    if let Some(((y, x, _), old, new)) = differ.next() {
        let name = match differ.count() {
            0 => format!("codes at ({x}, {y})"),
            more => format!("codes at ({x}, {y}), and at {more} more"),
        };
        found.add("wrong", name, old, new);
    }
}

/// Returns the wrong channels of a texel with their codes.
fn codes(texel: &WrongTexel) -> BTreeMap<String, u32> {
    let channels = texel.channels.iter();
    channels.map(|c| (channel_of(c), c.actual)).collect()
}

/// Adds the differences of the distances from the ideal. An aspect that a record does not name is exact.
fn accuracy(found: &mut Details, before: &[Accuracy], after: &[Accuracy]) {
    let all = || before.iter().chain(after);
    // Old formats add up several encodings, so their figures compare with each other only.
    let is_old = all().any(|a| a.encoding.is_none());
    let exact = |like: &Accuracy| Accuracy {
        channels: like.channels,
        ..Accuracy::none(like.aspect, like.encoding)
    };
    let mut seen: Vec<&Accuracy> = Vec::new();
    for like in all() {
        if seen.iter().any(|a| a.is_alike(like)) {
            continue;
        }
        seen.push(like);
        let [old, new] = [before, after].map(|record| {
            let entry = record.iter().find(|a| a.is_alike(like)).copied();
            entry.or((!is_old).then(|| exact(like)))
        });
        let (Some(old), Some(new)) = (old, new) else {
            continue;
        };
        let aspect = match like.encoding {
            Some(encoding) => format!("{} in {encoding}", like.aspect),
            None => like.aspect.to_string(),
        };
        found.add("accuracy", format!("{aspect} mean"), old.mean, new.mean);
        found.add("accuracy", format!("{aspect} largest"), old.max, new.max);
        let overflow = format!("{aspect} overflows");
        found.add("accuracy", overflow, old.overflow, new.overflow);
    }
}
