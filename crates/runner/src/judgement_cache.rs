//! The cache of judgements, which adapters with the same limits share.

use crate::sync::lock;
use etalon_case::Case;
use etalon_frame::{ApiVersion, Limits};
use etalon_reference::{Judgement, Rules, Texels, judgements_of};
use etalon_scene::Scene;
use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, OnceLock};

/// The most bytes of cached legal sets.
const CACHE_BYTES: usize = 512 << 20;

/// The texels of a case's images that are judged: all, but for the large pictures that exist to be
/// measured. Of these a lattice that meets every row and column; the texels left out count as not asserted.
pub(crate) fn judged_texels(case: &Case) -> Texels {
    if case.method.is_some() || case.area() == "perf" {
        Texels::AtMost(4096)
    } else {
        Texels::All
    }
}

/// A case, one of its scenes, the limits it is judged by, and the values of the permissions.
type Key = (usize, usize, Limits, String);
type Entry = Arc<OnceLock<Arc<Vec<Judgement>>>>;

/// Judgements by case, scene and limits.
#[derive(Debug, Default)]
pub(crate) struct JudgementCache(Mutex<Cache>);

#[derive(Debug, Default)]
struct Cache {
    entries: HashMap<Key, Entry>,
    order: VecDeque<Key>,
    bytes: usize,
}

impl JudgementCache {
    /// The judgements of one of a case's scenes; `number` tells the case from others.
    pub(crate) fn get(
        &self,
        number: usize,
        case: &Case,
        index: usize,
        limits: &Limits,
    ) -> Arc<Vec<Judgement>> {
        let index = case.judged_index(index);
        let permissions = Rules::of(limits).values();
        let key = (number, index, limits_that_matter(limits), permissions);
        let entry = {
            let mut cache = lock(&self.0);
            match cache.entries.get(&key) {
                Some(entry) => Arc::clone(entry),
                None => {
                    let entry = Entry::default();
                    cache.entries.insert(key.clone(), Arc::clone(&entry));
                    entry
                }
            }
        };
        let mut fresh = false;
        let sets = Arc::clone(entry.get_or_init(|| {
            fresh = true;
            let scene = judged_scene(case, index);
            Arc::new(judgements_of(scene, limits, judged_texels(case)))
        }));
        if fresh {
            let weight = |all: &[Judgement]| -> usize {
                all.iter()
                    .map(|j| j.legal.weight() + j.yardstick.weight())
                    .sum()
            };
            let mut cache = lock(&self.0);
            cache.bytes += weight(&sets);
            cache.order.push_back(key);
            while cache.bytes > CACHE_BYTES {
                let Some(oldest) = cache.order.pop_front() else {
                    break;
                };
                if let Some(old) = cache.entries.remove(&oldest) {
                    let freed = old.get().map_or(0, |sets| weight(sets));
                    cache.bytes = cache.bytes.saturating_sub(freed);
                }
            }
        }
        sets
    }
}

/// The scene that a frame is judged by: the case's own, or that of a variant.
pub(crate) fn judged_scene(case: &Case, index: usize) -> &Scene {
    match case
        .judged_index(index)
        .checked_sub(1)
        .and_then(|v| case.variants.get(v))
    {
        Some(variant) => &variant.scene,
        None => case.judged_scene(),
    }
}

/// The limits that legal sets depend on; without the others, more adapters share one set.
fn limits_that_matter(limits: &Limits) -> Limits {
    let mut key = limits.clone();
    key.features.clear();
    key.max_size = 0;
    // The values of the permissions stand for both; several versions share them.
    key.version = ApiVersion::UNKNOWN;
    key.properties.clear();
    for support in key.formats.values_mut() {
        support.samples.clear();
    }
    key
}
