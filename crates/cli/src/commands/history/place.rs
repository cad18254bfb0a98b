//! A place in a history in words: run, driver and commit.

use etalon_history::{History, RunId, RunInfo, format_time};
use etalon_report::plain;
use serde_json::{Value, json};

/// The largest number of characters of a version or a label.
const LONGEST: usize = 80;

/// Returns a run in words: its number and day.
pub(super) fn run_text(history: &History, run: RunId) -> String {
    match history.run(run) {
        Some(info) => format!("run {run} ({})", info.day()),
        None => format!("run {run}"),
    }
}

/// Returns the driver's version and the suite's commit in a run.
pub(super) fn versions(history: &History, run: RunId, timeline: &str) -> [String; 2] {
    let driver = history
        .adapter(run, timeline)
        .map(|part| plain(part.adapter.shown_version(), LONGEST))
        .filter(|version| !version.is_empty());
    let commit = history.run(run).map(|info| match &info.commit {
        Some(commit) => plain(commit, 12).trim_end_matches('…').to_owned(),
        None => plain(&info.etalon, LONGEST),
    });
    [driver, commit].map(|text| text.unwrap_or_else(|| "unknown".to_owned()))
}

/// Returns the versions of driver and suite in two runs, in words.
pub(super) fn range_text(
    history: &History,
    timeline: &str,
    [earlier, later]: [RunId; 2],
) -> String {
    let [before, now] = [earlier, later].map(|run| versions(history, run, timeline));
    let field = |what: &str, i: usize| {
        if before[i] == now[i] {
            format!("{what} {}", now[i])
        } else {
            format!("{what} {} to {}", before[i], now[i])
        }
    };
    format!("{}, {}", field("driver", 0), field("suite", 1))
}

/// Returns a run as JSON.
pub(super) fn run_json(history: &History, run: RunId, timeline: &str) -> Value {
    let info = history.run(run);
    let part = history.adapter(run, timeline);
    json!({
        "run": run.number(),
        "digest": info.map(RunInfo::digest_text),
        "time": info.map(|info| format_time(info.time())),
        "kind": info.map(|info| info.kind.name()),
        "driver": part.map(|part| &part.adapter.info.driver),
        "driver_version": part.map(|part| part.adapter.shown_version()),
        "commit": info.and_then(|info| info.commit.as_ref()),
        "labels": info.map(|info| &info.labels),
    })
}
