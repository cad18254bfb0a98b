//! The headers of two runs, compared.

use super::data::Fact;
use super::pairs::Folder;
use crate::numbers::count;
use crate::words;
use etalon_frame::Limits;
use etalon_record::{AdapterRecord, Header};

/// Returns true if two runs should draw the same cases. Runs without a digest of their selection count as the
/// same selection if they have the same number of cases.
pub(super) fn same_selection(before: &Header, after: &Header) -> bool {
    let (b, a) = (&before.settings, &after.settings);
    let known = !b.selection.is_empty() && !a.selection.is_empty();
    before.cases == after.cases && b.shard == a.shard && (!known || b.selection == a.selection)
}

/// Returns the facts of the runs.
pub(super) fn of_headers(before: &Header, after: &Header) -> Vec<Fact> {
    facts([before, after], |h| {
        let machine = &h.provenance.machine;
        vec![
            ("started", h.provenance.started.clone()),
            ("etalon", h.provenance.etalon.clone()),
            ("commit", h.provenance.commit.clone().unwrap_or_default()),
            ("command", h.provenance.command.join(" ")),
            ("processor", machine.cpu.clone()),
            ("cores", machine.cores.to_string()),
            ("system", machine.os.clone()),
            ("cases", h.cases.to_string()),
            ("settings", words::settings(&h.settings).join(", ")),
        ]
    })
}

/// Returns the facts of two adapters.
pub(super) fn of_adapters(folders: &[Folder<'_>; 2], adapter: [&str; 2]) -> Vec<Fact> {
    let found = [0, 1].map(|i| folders[i].run.header.adapter(adapter[i]));
    let [Some(before), Some(after)] = found else {
        return Vec::new();
    };
    let mut found = facts([before, after], |a: &AdapterRecord| {
        let l = &a.limits;
        let counts = l.sample_positions.keys().map(u32::to_string);
        vec![
            ("device", a.info.device.clone()),
            ("driver", a.driver_text()),
            ("driver id", a.info.driver_id.clone()),
            ("API", a.info.api_version.clone()),
            ("rules", l.api.name().to_owned()),
            ("sub-pixel bits", l.sub_pixel_bits.to_string()),
            ("largest attachment", l.max_size.to_string()),
            ("color attachments", l.max_color_attachments.to_string()),
            ("sample counts", joined(counts)),
        ]
    });
    let [b, a] = [&before.limits, &after.limits];
    let features = |x: &Limits, y: &Limits| {
        let alone = x.features.difference(&y.features);
        joined(alone.map(|f| f.name().to_owned()))
    };
    let formats = |x: &Limits, y: &Limits| {
        let alone = x.formats.keys().filter(|f| !y.formats.contains_key(f));
        joined(alone.map(|f| f.name().to_owned()))
    };
    let mut only = |name, before, after| {
        found.push(Fact {
            name,
            before,
            after,
        });
    };
    only("features that only one has", features(b, a), features(a, b));
    only("formats that only one has", formats(b, a), formats(a, b));
    let unlike = b.formats.iter().filter(|(f, support)| {
        let other = a.formats.get(f);
        other.is_some_and(|other| other != *support)
    });
    let unlike = unlike.count() as u64;
    if unlike > 0 {
        let other = format!("{} with other support than before", count(unlike, "format"));
        only("formats", String::new(), other);
    }
    // Drops facts that neither adapter states.
    found.retain(|fact| !fact.before.is_empty() || !fact.after.is_empty());
    found
}

fn joined(names: impl Iterator<Item = String>) -> String {
    names.collect::<Vec<_>>().join(", ")
}

fn facts<T>(sides: [&T; 2], facts_of: impl Fn(&T) -> Vec<(&'static str, String)>) -> Vec<Fact> {
    let [before, after] = sides.map(facts_of);
    before
        .into_iter()
        .zip(after)
        .filter(|((_, b), (_, a))| !b.is_empty() || !a.is_empty())
        .map(|((name, before), (_, after))| Fact {
            name,
            before,
            after,
        })
        .collect()
}
