//! Which cases a run is about, so that its parts can be proven to be parts of one whole.

use crate::error::RecordError;
use crate::header::{AdapterRecord, Header};
use crate::writer::CASES_FILE;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{ErrorKind, Read};
use std::path::Path;

/// The most bytes of a list of cases.
const MAX_BYTES: u64 = 256 << 20;

/// FNV-1a, 64 bits, over the bytes of a text: stable over releases, unlike the standard library's hasher.
pub(crate) fn fnv(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// The digest of a selection, for [`Settings::selection`](crate::Settings::selection): how many ids, and
/// a hash of them in sorted order.
pub fn selection_digest<'a>(ids: impl IntoIterator<Item = &'a str>) -> String {
    let sorted: BTreeSet<&str> = ids.into_iter().collect();
    let bytes = sorted.iter().flat_map(|id| id.bytes().chain([b'\n']));
    format!("{}-{:016x}", sorted.len(), fnv(bytes))
}

/// Which of `count` shards an id belongs to, from 1. It depends on nothing but the id, so that a new case
/// moves no other.
pub fn shard_of(id: &str, count: u32) -> u32 {
    // FNV mixes the last bytes badly, and ids differ at their ends: MurmurHash3's finaliser mixes them.
    let mut hash = fnv(id.bytes());
    for factor in [0xff51_afd7_ed55_8ccd, 0xc4ce_b9fe_1a85_ec53] {
        hash = (hash ^ (hash >> 33)).wrapping_mul(factor);
    }
    let high = hash >> 32;
    ((high * u64::from(count.max(1))) >> 32) as u32 + 1
}

/// The ids in a run folder's list of cases; `None` where it has none.
///
/// # Errors
/// When the list cannot be read, or is not the one that the header's digest names.
pub fn read_cases(folder: &Path, header: &Header) -> Result<Option<Vec<String>>, RecordError> {
    let path = folder.join(CASES_FILE);
    let mut text = String::new();
    let file = match File::open(&path) {
        Ok(file) => file,
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(None),
        Err(e) => return Err(RecordError::io("read", &path)(e)),
    };
    file.take(MAX_BYTES)
        .read_to_string(&mut text)
        .map_err(RecordError::io("read", &path))?;
    let ids: Vec<String> = text.lines().map(str::to_owned).collect();
    if selection_digest(ids.iter().map(String::as_str)) != header.settings.selection {
        return Err(RecordError::Parse {
            path,
            line: 1,
            message: "these are not the cases that run.jsonl names".to_owned(),
            remedy: "copy the folder anew, or record the run again",
        });
    }
    Ok(Some(ids))
}

pub(crate) fn write_cases<'a>(
    folder: &Path,
    ids: impl IntoIterator<Item = &'a str>,
) -> Result<(), RecordError> {
    let path = folder.join(CASES_FILE);
    let beside = folder.join(format!(".{CASES_FILE}.{}", std::process::id()));
    let mut text = String::new();
    for id in ids {
        text.push_str(id);
        text.push('\n');
    }
    fs::write(&beside, text)
        .and_then(|()| fs::rename(&beside, &path))
        .map_err(RecordError::io("write", &path))
}

impl Header {
    /// What keeps records of a run with this header from standing beside records of one with the other:
    /// another selection, other settings, another version of the suite. `None` where nothing does.
    /// Shards, adapters, time and memory limits are not looked at.
    pub fn conflict(&self, other: &Self) -> Option<String> {
        let (a, b) = (&self.settings, &other.settings);
        let differ = |what: &str, x: String, y: String| {
            (x != y).then(|| format!("{what} was {x} there and is {y} here"))
        };
        let text = |n: Option<u64>| n.map_or_else(|| "none".to_owned(), |n| n.to_string());
        differ(
            "the version of etalon",
            self.etalon.clone(),
            other.etalon.clone(),
        )
        .or_else(|| {
            differ(
                "the commit of etalon",
                self.commit.clone().unwrap_or_default(),
                other.commit.clone().unwrap_or_default(),
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
            let cache = |s: &crate::Settings| s.shader_cache.map_or("warm", |c| c.name());
            differ("--shader-cache", cache(a).to_owned(), cache(b).to_owned())
        })
        .or_else(|| differ("--validate", a.validate.to_string(), b.validate.to_string()))
    }
}

impl AdapterRecord {
    /// What keeps this from being the same driver as another adapter of the same name; `None` where
    /// nothing does.
    pub fn conflict(&self, other: &Self) -> Option<String> {
        let who = |a: &Self| format!("{}, {}, {}", a.device, a.driver_text(), a.api_version);
        if who(self) != who(other) {
            return Some(format!(
                "{} was {} there and is {} here",
                self.name,
                who(self),
                who(other)
            ));
        }
        (self.limits != other.limits).then(|| format!("the limits of {} have changed", self.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_balanced_and_a_case_keeps_its_own() {
        let ids: Vec<String> = (0..4000)
            .map(|n| format!("depth/compare/compare=less/n={n}"))
            .collect();
        for count in [1, 2, 3, 7, 10] {
            let mut sizes = vec![0; count as usize];
            for id in &ids {
                sizes[shard_of(id, count) as usize - 1] += 1;
            }
            let due = 4000 / count as i32;
            for size in &sizes {
                assert!((size - due).abs() < due / 4 + 1, "{count}: {sizes:?}");
            }
        }
        assert_eq!(shard_of("depth/a", 0), 1);
        // Released ids may not move.
        assert_eq!(
            [2, 5, 9].map(|n| shard_of("depth/compare/compare=less", n)),
            [1, 3, 5]
        );
    }

    #[test]
    fn a_selection_is_the_same_in_any_order() {
        assert_eq!(selection_digest(["b", "a"]), selection_digest(["a", "b"]));
        assert_ne!(selection_digest(["a"]), selection_digest(["a", "b"]));
        assert_ne!(selection_digest(["ab"]), selection_digest(["a", "b"]));
    }
}
