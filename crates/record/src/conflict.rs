//! Differences that prevent resuming a run, or merging two runs.

use crate::adapter::AdapterRecord;
use crate::bench::BenchHeader;
use crate::header::{Header, Settings};

impl Header {
    /// Returns the first difference in selection, settings or version of the suite that prevents this run
    /// and another from being parts of one run, or `None`. Shards, adapters, and time and memory limits are
    /// not compared.
    pub fn conflict(&self, other: &Self) -> Option<String> {
        let (a, b) = (&self.settings, &other.settings);
        let differ = |what: &str, x: String, y: String| {
            let [there, here] = [&x, &y].map(|value| match &value[..] {
                "" => "unknown",
                value => value,
            });
            (x != y).then(|| format!("{what} was {there} there and is {here} here"))
        };
        let text = |n: Option<u64>| n.map_or_else(|| "none".to_owned(), |n| n.to_string());
        differ(
            "the version of etalon",
            self.provenance.etalon.clone(),
            other.provenance.etalon.clone(),
        )
        .or_else(|| {
            differ(
                "the commit of etalon",
                self.provenance.commit.clone().unwrap_or_default(),
                other.provenance.commit.clone().unwrap_or_default(),
            )
        })
        .or_else(|| {
            differ(
                "the selection of cases",
                a.selection.clone(),
                b.selection.clone(),
            )
        })
        .or_else(|| differ("--shuffle", text(a.shuffle), text(b.shuffle)))
        .or_else(|| {
            let times = |n: Option<u32>| text(n.map(u64::from));
            differ("--repeat", times(a.repeat), times(b.repeat))
        })
        .or_else(|| {
            let cache = |s: &Settings| s.shader_cache.map_or("warm", |c| c.name());
            differ("--shader-cache", cache(a).to_owned(), cache(b).to_owned())
        })
        .or_else(|| {
            let sizes = |s: &Settings| match s.sizes.as_slice() {
                [] => "none".to_owned(),
                sizes => sizes
                    .iter()
                    .map(|[w, h]| format!("{w}x{h}"))
                    .collect::<Vec<_>>()
                    .join(","),
            };
            differ("--sizes", sizes(a), sizes(b))
        })
        .or_else(|| differ("--validate", a.validate.to_string(), b.validate.to_string()))
    }
}

impl AdapterRecord {
    /// Returns the first difference from another adapter with the same name; `None` if it is the same
    /// driver.
    pub fn conflict(&self, other: &Self) -> Option<String> {
        let who = |a: &Self| {
            format!(
                "{}, {}, {}",
                a.info.device,
                a.driver_text(),
                a.info.api_version
            )
        };
        if who(self) != who(other) {
            return Some(format!(
                "{} was {} there and is {} here",
                self.info.name,
                who(self),
                who(other)
            ));
        }
        (self.limits != other.limits)
            .then(|| format!("the limits of {} have changed", self.info.name))
    }
}

/// Returns the first difference that prevents resuming the bench of one header with the other, if any.
pub(crate) fn bench_conflict(there: &BenchHeader, here: &BenchHeader) -> Option<String> {
    let differ = |what: &str, x: &str, y: &str| {
        (x != y).then(|| format!("{what} was {x} there and is {y} here"))
    };
    let shard = |h: &BenchHeader| {
        h.settings
            .shard
            .map_or("none".to_owned(), |s| s.to_string())
    };
    let seconds = |h: &BenchHeader| {
        h.settings
            .seconds
            .map_or("unknown".to_owned(), |s| s.to_string())
    };
    let within = |h: &BenchHeader| {
        h.settings
            .within
            .map_or("none".to_owned(), |share| share.to_string())
    };
    let commit = |h: &BenchHeader| h.provenance.commit.clone().unwrap_or_default();
    let names = |h: &BenchHeader| -> Vec<String> {
        h.adapters.iter().map(|a| a.info.name.clone()).collect()
    };
    differ(
        "the version of etalon",
        &there.provenance.etalon,
        &here.provenance.etalon,
    )
    .or_else(|| differ("the commit of etalon", &commit(there), &commit(here)))
    .or_else(|| {
        let (a, b) = (&there.settings.selection, &here.settings.selection);
        differ("the selection of cases", a, b)
    })
    .or_else(|| differ("the shard", &shard(there), &shard(here)))
    .or_else(|| {
        differ(
            "--rounds",
            &there.rounds.to_string(),
            &here.rounds.to_string(),
        )
    })
    .or_else(|| differ("--seconds", &seconds(there), &seconds(here)))
    .or_else(|| differ("--within", &within(there), &within(here)))
    .or_else(|| {
        differ(
            "the shader cache",
            there.shader_cache.name(),
            here.shader_cache.name(),
        )
    })
    .or_else(|| differ("the ruler", &there.ruler, &here.ruler))
    .or_else(|| {
        differ(
            "the list of adapters",
            &names(there).join(", "),
            &names(here).join(", "),
        )
    })
    .or_else(|| {
        there
            .adapters
            .iter()
            .zip(&here.adapters)
            .find_map(|(a, b)| a.conflict(b))
    })
}

/// Returns the first difference that prevents resuming the run of one header with the other, if any.
pub(crate) fn resume_conflict(there: &Header, here: &Header) -> Option<String> {
    if let Some(conflict) = there.conflict(here) {
        return Some(conflict);
    }
    if there.format != here.format {
        let (before, now) = (there.format, here.format);
        return Some(format!("its format is {before}, and {now} is written now"));
    }
    let shard = |h: &Header| match h.settings.shard {
        Some(shard) => format!("shard {shard}"),
        None => "not sharded".to_owned(),
    };
    if shard(there) != shard(here) {
        return Some(format!("it is {} and not {}", shard(there), shard(here)));
    }
    for adapter in &there.adapters {
        match here.adapter(&adapter.info.name) {
            None => return Some(format!("{} was there and is not here", adapter.info.name)),
            Some(now) => {
                if let Some(conflict) = adapter.conflict(now) {
                    return Some(conflict);
                }
            }
        }
    }
    let new = here.adapters.iter();
    new.map(|a| &a.info.name)
        .find(|name| there.adapter(name).is_none())
        .map(|name| format!("{name} is here and was not there"))
}
