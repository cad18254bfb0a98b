//! The cache of legal sets. Adapters share those of equal limits under rules that agree on all that the
//! judge asked for.

use etalon_case::Case;
use etalon_frame::{LegalSet, Limits};
use etalon_reference::{Judgement, KnownSets, Rules, Texels, judgements_by, legal_set_of_texels};
use etalon_scene::Scene;
use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The most bytes of cached legal sets.
const CACHE_BYTES: usize = 512 << 20;

/// The texels of a case's images that are judged: all, but for the large pictures that exist to be
/// measured. Of these a lattice that meets every row and column; the texels left out count as not asserted.
pub(crate) fn judged_texels(case: &Case) -> Texels {
    if case.measured {
        Texels::AtMost(4096)
    } else {
        Texels::All
    }
}

/// A case, one of its scenes, and the limits that its sets depend on.
type Key = (usize, usize, Limits);
type Entry = Arc<Mutex<KnownSets>>;

/// Legal sets by case, scene, limits and permissions.
#[derive(Debug, Default)]
pub(crate) struct JudgementCache(Mutex<Cache>);

#[derive(Debug, Default)]
struct Cache {
    entries: HashMap<Key, Entry>,
    /// The entries of all sets, the oldest first, with the bytes that each set takes.
    order: VecDeque<(Key, usize)>,
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
    ) -> Vec<Judgement> {
        let (scene, texels) = (judged_scene(case, index), judged_texels(case));
        judgements_by(scene, limits, texels, &self.sets(number, case, index))
    }

    /// The legal sets of one of a case's scenes, which are computed when they are first asked for.
    pub(crate) fn sets(
        &self,
        number: usize,
        case: &Case,
        index: usize,
    ) -> impl Fn(&Limits, &Rules) -> Arc<LegalSet> {
        let index = case.judged_index(index);
        let (scene, texels) = (judged_scene(case, index), judged_texels(case));
        move |limits, rules| {
            let key = (number, index, limits.clone());
            self.set(key, rules, |rules| {
                legal_set_of_texels(scene, limits, rules, texels)
            })
        }
    }

    /// The set of a key by some rules. One that other rules gave is taken if these have the same values, as
    /// far as they were asked for.
    fn set(
        &self,
        key: Key,
        rules: &Rules,
        compute: impl FnOnce(&Rules) -> LegalSet,
    ) -> Arc<LegalSet> {
        let entry = Arc::clone(lock(&self.0).entries.entry(key.clone()).or_default());
        // Who comes second waits: most sets serve both.
        let mut weight = None;
        let set = lock(&entry).get(rules, |rules| {
            let set = compute(rules);
            weight = Some(set.weight());
            set
        });
        let Some(weight) = weight else {
            return set;
        };
        let mut cache = lock(&self.0);
        cache.bytes += weight;
        cache.order.push_back((key, weight));
        while cache.bytes > CACHE_BYTES {
            let Some((oldest, weight)) = cache.order.pop_front() else {
                break;
            };
            // Of an entry with several sets all are forgotten with the first.
            cache.entries.remove(&oldest);
            cache.bytes = cache.bytes.saturating_sub(weight);
        }
        set
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

/// Locks a mutex. What it guards stays consistent at every step, so a poisoned one is used on.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
