//! Runs and adapters that drew nothing.

use crate::output::say;
use etalon_record::{Run, Verdict};

/// Prints which adapters of a complete run drew no case. Returns true if none of them drew any, which is not a
/// success: a shard leaves that to the merged run.
pub(crate) fn report(run: &Run) -> bool {
    if run.header.settings.shard.is_some() || run.records.is_empty() {
        return false;
    }
    if run.is_idle() {
        say!("nothing was drawn: {}", counts(run, None));
        return true;
    }
    let adapters = run.idle_adapters();
    if !adapters.is_empty() {
        let texts = adapters
            .iter()
            .map(|name| format!("{name} drew no case: {}", counts(run, Some(name))));
        say!("{}", texts.collect::<Vec<_>>().join("; "));
    }
    false
}

/// Returns the numbers of records by verdict, of one adapter or of all.
fn counts(run: &Run, adapter: Option<&str>) -> String {
    let of_adapter = |name: &str| adapter.is_none_or(|adapter| adapter == name);
    let records = || run.records.iter().filter(|r| of_adapter(&r.adapter));
    let texts = Verdict::ALL.iter().filter_map(|verdict| {
        let number = records().filter(|r| r.verdict == *verdict).count();
        (number > 0).then(|| format!("{number} {verdict}"))
    });
    texts.collect::<Vec<_>>().join(", ")
}
