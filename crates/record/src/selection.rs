//! The selection of a run: the ids of its cases, their digest and their shards.
//!
//! The digest lets runs that have only some of the records prove that they are parts of one run.

use crate::error::RecordError;
use crate::folder::CASES_FILE;
use crate::hash::fnv;
use crate::header::Header;
use crate::output_folder::OutputFolder;
use crate::paths::open_below;
use etalon_frame::without_mark;
use std::collections::BTreeSet;
use std::io::Read;
use std::path::Path;

/// The maximum number of bytes of a list of cases.
const MAX_BYTES: u64 = 256 << 20;

/// Returns the digest of a selection, for [`Settings::selection`](crate::Settings::selection): the number
/// of ids and a hash of them in sorted order.
pub fn selection_digest<'a>(ids: impl IntoIterator<Item = &'a str>) -> String {
    let sorted: BTreeSet<&str> = ids.into_iter().collect();
    let bytes = sorted.iter().flat_map(|id| id.bytes().chain([b'\n']));
    format!("{}-{:016x}", sorted.len(), fnv(bytes))
}

/// Returns the number, from 1, of the shard out of `count` that an id belongs to. It depends only on the id,
/// so that a new case never moves other cases to another shard.
pub fn shard_of(id: &str, count: u32) -> u32 {
    // FNV mixes the last bytes badly, and ids often differ only at the end. MurmurHash3's finaliser therefore
    // mixes the hash again.
    let mut hash = fnv(id.bytes());
    for factor in [0xff51_afd7_ed55_8ccd, 0xc4ce_b9fe_1a85_ec53] {
        hash = (hash ^ (hash >> 33)).wrapping_mul(factor);
    }
    let high = hash >> 32;
    ((high * u64::from(count.max(1))) >> 32) as u32 + 1
}

/// Returns the ids in a run folder's list of cases; `None` if the folder has no list.
///
/// # Errors
/// If the list cannot be read, or does not match the header's digest.
pub fn read_cases(folder: &Path, header: &Header) -> Result<Option<Vec<String>>, RecordError> {
    let path = folder.join(CASES_FILE);
    let mut text = String::new();
    let file = match open_below(folder, CASES_FILE) {
        Ok(file) => file,
        Err(e) if e.is_missing() => return Ok(None),
        Err(e) => return Err(e),
    };
    file.take(MAX_BYTES)
        .read_to_string(&mut text)
        .map_err(RecordError::io("read", &path))?;
    let ids: Vec<String> = without_mark(&text).lines().map(str::to_owned).collect();
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
    out: &OutputFolder,
    ids: impl IntoIterator<Item = &'a str>,
) -> Result<(), RecordError> {
    let mut text = String::new();
    for id in ids {
        text.push_str(id);
        text.push('\n');
    }
    out.write(CASES_FILE, text.as_bytes()).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_balanced_and_a_case_keeps_its_shard() {
        let ids: Vec<String> = (0..4000)
            .map(|n| format!("depth/compare/compare=less/n={n}"))
            .collect();
        for count in [1, 2, 3, 7, 10] {
            let mut sizes = vec![0; count as usize];
            for id in &ids {
                sizes[shard_of(id, count) as usize - 1] += 1;
            }
            let expected = 4000 / count as i32;
            for size in &sizes {
                assert!(
                    (size - expected).abs() < expected / 4 + 1,
                    "{count}: {sizes:?}"
                );
            }
        }
        assert_eq!(shard_of("depth/a", 0), 1);
        // Released ids must stay in their shards.
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
