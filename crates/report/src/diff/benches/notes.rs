//! Facts that make two benches hard to compare, in words.

use crate::numbers::count;
use etalon_record::{AdapterRecord, Bench};

/// Returns facts that make two benches hard to compare.
pub(super) fn notes(before: &Bench, after: &Bench) -> Vec<String> {
    let (b, a) = (&before.header, &after.header);
    let mut notes = Vec::new();
    if b.provenance.machine != a.provenance.machine {
        notes.push(
            "The machines differ, so they can cause changes instead of the driver.".to_owned(),
        );
    }
    if b.ruler != a.ruler {
        notes.push(format!(
            "The rulers differ ({}; {}), so a change of the machine's speed stays unnoticed.",
            b.ruler, a.ruler
        ));
    }
    let mut differs = |what: String, before: &str, after: &str| {
        if before != after {
            notes.push(format!("{what} {before} before, {after} after."));
        }
    };
    differs("Profiles:".to_owned(), &b.profile, &a.profile);
    let caches = [b, a].map(|h| h.shader_cache.name());
    differs("Shader caches:".to_owned(), caches[0], caches[1]);
    for old in &b.adapters {
        let Some(new) = a.adapter(&old.info.name) else {
            continue;
        };
        let facts = |a: &AdapterRecord| {
            [
                a.info.device.clone(),
                a.driver_text(),
                a.info.api_version.clone(),
            ]
        };
        let names = ["device", "driver", "API"].into_iter();
        for (name, (b, a)) in names.zip(facts(old).into_iter().zip(facts(new))) {
            differs(format!("{}: {name}", old.info.name), &b, &a);
        }
    }
    for (bench, name) in [(before, "first"), (after, "second")] {
        match bench.missing() {
            0 if bench.truncated => {
                notes.push(format!("The file of the {name} bench ends within a line."));
            }
            0 => {}
            n => notes.push(format!(
                "The {name} bench is incomplete: it lacks {}.",
                count(n, "round")
            )),
        }
    }
    notes
}
