//! Compares times of two runs.

use super::data::{AreaTime, MethodTime};
use crate::numbers::median;
use etalon_record::{Record, Verdict};
use maud::{Markup, html};
use std::collections::BTreeMap;

/// The caveat on the times of runs.
pub(super) const STATEMENT: &str = "A run takes each time once, beside other work: these times are an indication. Only \
    `etalon bench` and the diff of two benches prove a change.";

/// Returns the caveat with its command in the font of commands.
pub(super) fn statement() -> Markup {
    html! {
        @for (i, part) in STATEMENT.split('`').enumerate() {
            @if i % 2 == 1 { code { (part) } } @else { (part) }
        }
    }
}

/// Returns seconds of drawing by area, over the cases that were drawn in both runs.
pub(super) fn areas(adapter: [&str; 2], both: &[[&Record; 2]]) -> Vec<AreaTime> {
    let drawn = |r: &Record| {
        let none = matches!(r.verdict, Verdict::NotSupported | Verdict::Skipped);
        !none && r.seconds.draw > 0.0 && r.seconds.draw.is_finite()
    };
    let mut by_area: BTreeMap<&str, [Vec<f64>; 2]> = BTreeMap::new();
    for [old, new] in both.iter().filter(|b| b.iter().all(|r| drawn(r))) {
        let [before, after] = by_area.entry(old.parts().area()).or_default();
        before.push(old.seconds.draw);
        after.push(new.seconds.draw);
    }
    let areas = by_area.into_iter();
    areas
        .map(|(area, seconds)| AreaTime {
            adapter: adapter.map(str::to_owned),
            area: area.to_owned(),
            cases: seconds[0].len() as u64,
            sum: seconds.each_ref().map(|seconds| seconds.iter().sum()),
            median: seconds.map(|seconds| median(seconds.into_iter()).unwrap_or_default()),
        })
        .collect()
}

/// Returns frame times of the methods that both runs have.
pub(super) fn methods(both: &[[&Record; 2]]) -> Vec<MethodTime> {
    let mut found = Vec::new();
    for [old, new] in both {
        let times = [old, new].map(|r| r.measured.as_ref().and_then(|m| m.time));
        let [Some(before), Some(after)] = times else {
            continue;
        };
        found.push(MethodTime {
            case: old.case.clone(),
            adapter: [old.adapter.clone(), new.adapter.clone()],
            wall: [before.wall, after.wall],
            gpu: before.gpu.zip(after.gpu).map(|(b, a)| [b, a]),
            samples: [before.samples, after.samples],
        });
    }
    found
}
