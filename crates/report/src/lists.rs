//! Lists in the order in which their items are first met.

use serde::{Serialize, Serializer};
use std::collections::HashMap;
use std::hash::Hash;

/// The values, each once.
pub(crate) fn distinct<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut all = Vec::new();
    for value in values {
        if !all.contains(&value) {
            all.push(value);
        }
    }
    all
}

/// The values by key; keys in the order in which they are first met.
pub(crate) fn grouped<K: Hash + Eq + Clone, V>(
    values: impl IntoIterator<Item = (K, V)>,
) -> Vec<(K, Vec<V>)> {
    let mut keys = Interner::default();
    let mut groups: Vec<Vec<V>> = Vec::new();
    for (key, value) in values {
        let place = keys.place(key);
        groups.resize_with(keys.values.len(), Vec::new);
        groups[place].push(value);
    }
    keys.values.into_iter().zip(groups).collect()
}

/// Moves one item of each kind before the second of any; else their order is kept.
pub(crate) fn spread<T, K: Hash + Eq>(items: &mut [T], kind: impl Fn(&T) -> K) {
    let mut seen: HashMap<K, usize> = HashMap::new();
    items.sort_by_cached_key(|item| {
        let rank = seen.entry(kind(item)).or_default();
        *rank += 1;
        *rank
    });
}

/// Values, each once, by the place at which they were first met.
pub(crate) struct Interner<T> {
    places: HashMap<T, usize>,
    pub(crate) values: Vec<T>,
}

impl<T> Default for Interner<T> {
    fn default() -> Self {
        Self {
            places: HashMap::new(),
            values: Vec::new(),
        }
    }
}

impl<T: Serialize> Serialize for Interner<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.values.serialize(serializer)
    }
}

impl<T: Hash + Eq + Clone> Interner<T> {
    /// True if the value has a place.
    pub(crate) fn has(&self, value: &T) -> bool {
        self.places.contains_key(value)
    }

    /// The place of a value.
    pub(crate) fn place(&mut self, value: T) -> usize {
        if let Some(place) = self.places.get(&value) {
            return *place;
        }
        self.places.insert(value.clone(), self.values.len());
        self.values.push(value);
        self.values.len() - 1
    }
}
