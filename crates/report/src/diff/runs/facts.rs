//! The headers of two runs side by side.

use super::data::Fact;
use super::pairs::Folder;
use crate::numbers::count;
use crate::words;
use etalon_record::{AdapterRecord, Header};

/// True if two runs were to draw the same cases. Runs without a digest of their selection count as the same
/// selection if they have as many cases.
pub(super) fn same_selection(before: &Header, after: &Header) -> bool {
    let (b, a) = (&before.settings, &after.settings);
    let known = !b.selection.is_empty() && !a.selection.is_empty();
    before.cases == after.cases && b.shard == a.shard && (!known || b.selection == a.selection)
}

/// The facts of the runs.
pub(super) fn of_headers(before: &Header, after: &Header) -> Vec<Fact> {
    facts([before, after], |h| {
        let machine = &h.machine;
        vec![
            ("started", h.started.clone()),
            ("etalon", h.etalon.clone()),
            ("commit", h.commit.clone().unwrap_or_default()),
            ("command", h.command.join(" ")),
            ("processor", machine.cpu.clone()),
            ("cores", machine.cores.to_string()),
            ("system", machine.os.clone()),
            ("cases", h.cases.to_string()),
            ("settings", words::settings(&h.settings).join(", ")),
        ]
    })
}

/// The facts of two adapters.
pub(super) fn of_adapters(folders: &[Folder<'_>; 2], adapter: [&str; 2]) -> Vec<Fact> {
    let found = [0, 1].map(|i| folders[i].run.header.adapter(adapter[i]));
    let [Some(before), Some(after)] = found else {
        return Vec::new();
    };
    let mut found = facts([before, after], |a: &AdapterRecord| {
        let l = &a.limits;
        let positions = l.sample_positions.iter();
        vec![
            ("device", a.device.clone()),
            ("driver", a.driver_text()),
            ("driver id", a.driver_id.clone()),
            ("API", a.api_version.clone()),
            ("rules", l.api.name().to_owned()),
            ("sub-pixel bits", l.sub_pixel_bits.to_string()),
            ("largest attachment", l.max_size.to_string()),
            ("color attachments", l.max_color_attachments.to_string()),
            (
                "sample counts",
                positions
                    .map(|(samples, _)| samples.to_string())
                    .collect::<Vec<_>>()
                    .join(", "),
            ),
        ]
    });
    let [b, a] = [&before.limits, &after.limits];
    found.push(lacking(
        "features that only one has",
        b.features.difference(&a.features).map(|f| f.name()),
        a.features.difference(&b.features).map(|f| f.name()),
    ));
    let only = |x: &etalon_frame::Limits, y: &etalon_frame::Limits| {
        let alone = x.formats.iter().filter(|(f, _)| !y.formats.contains_key(f));
        alone.map(|(f, _)| f.name()).collect::<Vec<_>>()
    };
    found.push(lacking("formats that only one has", only(b, a), only(a, b)));
    let unlike = b.formats.iter().filter(|(f, support)| {
        let other = a.formats.get(f);
        other.is_some_and(|other| other != *support)
    });
    let unlike = unlike.count() as u64;
    if unlike > 0 {
        found.push(Fact {
            name: "formats",
            before: String::new(),
            after: format!("{} with other support than before", count(unlike, "format")),
        });
    }
    // What neither states says nothing.
    found.retain(|fact| !fact.before.is_empty() || !fact.after.is_empty());
    found
}

fn lacking<'a>(
    name: &'static str,
    before: impl IntoIterator<Item = &'a str>,
    after: impl IntoIterator<Item = &'a str>,
) -> Fact {
    let join = |names: &mut dyn Iterator<Item = &'a str>| names.collect::<Vec<_>>().join(", ");
    Fact {
        name,
        before: join(&mut before.into_iter()),
        after: join(&mut after.into_iter()),
    }
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
