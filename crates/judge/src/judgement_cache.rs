//! The cache of legal sets. Adapters share a set if their limits are equal and their rules agree on every
//! permission that the judge asked for; cases share it if their scenes differ only in what the judge does not
//! see.

use etalon_case::Case;
use etalon_frame::{LegalSet, Limits};
use etalon_reference::{
    Geometries, Judgement, KnownSets, Rules, SceneKey, Texels, judgements_by, legal_set_of_texels,
};
use etalon_scene::Scene;
use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The maximum size of all cached legal sets, in bytes.
const CACHE_BYTES: usize = 512 << 20;

/// Returns the texels of a case's images that are judged: all, except in large pictures that exist to be
/// measured. These are judged on a lattice that meets every row and column; the other texels count as not
/// asserted.
pub(crate) fn judged_texels(case: &Case) -> Texels {
    if case.measured {
        Texels::AtMost(4096)
    } else {
        Texels::All
    }
}

/// Everything but the rules that legal sets depend on.
type JudgementKey = (SceneKey, Texels, Limits);
type CachedJudgements = Arc<Mutex<KnownSets>>;

/// Legal sets by scene, limits and permissions.
#[derive(Debug, Default)]
pub(crate) struct JudgementCache {
    /// The keys of the scenes judged so far, by the number of the case and the index of the scene.
    scenes: Mutex<HashMap<(usize, usize), SceneKey>>,
    cache: Mutex<CacheMap>,
    geometries: Geometries,
}

#[derive(Debug, Default)]
struct CacheMap {
    entries: HashMap<JudgementKey, CachedJudgements>,
    /// The keys of all sets, oldest first, with the size of each set in bytes.
    order: VecDeque<(JudgementKey, usize)>,
    bytes: usize,
}

impl JudgementCache {
    /// Returns the judgements of one of a case's scenes; `number` identifies the case.
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

    /// Returns the legal sets of one of a case's scenes, which are computed when they are first asked for.
    pub(crate) fn sets(
        &self,
        number: usize,
        case: &Case,
        index: usize,
    ) -> impl Fn(&Limits, &Rules) -> Arc<LegalSet> {
        let index = case.judged_index(index);
        let (scene, texels) = (judged_scene(case, index), judged_texels(case));
        let known = lock(&self.scenes).get(&(number, index)).copied();
        let scene_key = known.unwrap_or_else(|| {
            let key = SceneKey::of(scene);
            lock(&self.scenes).insert((number, index), key);
            key
        });
        move |limits, rules| {
            let key = (scene_key, texels, limits.clone());
            self.set(key, rules, |rules| {
                legal_set_of_texels(scene, limits, rules, texels, &self.geometries)
            })
        }
    }

    /// Returns the set of a key under some rules. A cached set from other rules is used if both agree on
    /// every permission that its computation asked for.
    fn set(
        &self,
        key: JudgementKey,
        rules: &Rules,
        compute: impl FnOnce(&Rules) -> LegalSet,
    ) -> Arc<LegalSet> {
        let entry = Arc::clone(lock(&self.cache).entries.entry(key.clone()).or_default());
        // A second caller waits for the first, because most sets serve both.
        let mut weight = None;
        let set = lock(&entry).get(rules, |rules| {
            let set = compute(rules);
            weight = Some(set.weight());
            set
        });
        let Some(weight) = weight else {
            return set;
        };
        let mut cache = lock(&self.cache);
        cache.bytes += weight;
        cache.order.push_back((key, weight));
        while cache.bytes > CACHE_BYTES {
            let Some((oldest, weight)) = cache.order.pop_front() else {
                break;
            };
            // Removes the entry with all its sets, although only its first set is this old.
            cache.entries.remove(&oldest);
            cache.bytes = cache.bytes.saturating_sub(weight);
        }
        set
    }
}

/// Returns the scene that a frame is judged by: the case's own, or a variant's.
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

/// Locks a mutex, ignoring poison: the guarded data are consistent at every step.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
