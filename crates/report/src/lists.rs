//! Lists in the order in which their items first occur.

use serde::{Serialize, Serializer};
use std::collections::HashMap;
use std::hash::Hash;

/// Returns the values without repetitions.
pub(crate) fn distinct<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut distinct_values = Vec::new();
    for value in values {
        if !distinct_values.contains(&value) {
            distinct_values.push(value);
        }
    }
    distinct_values
}

/// Groups the values by key. Keys are in the order in which they first occur.
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

/// Moves the first item of every kind before all second items, and otherwise keeps the order.
pub(crate) fn spread<T, K: Hash + Eq>(items: &mut [T], kind: impl Fn(&T) -> K) {
    let mut seen: HashMap<K, usize> = HashMap::new();
    items.sort_by_cached_key(|item| {
        let rank = seen.entry(kind(item)).or_default();
        *rank += 1;
        *rank
    });
}

/// Distinct values in the order in which they first occurred.
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
    /// Returns true if the list contains the value.
    pub(crate) fn has(&self, value: &T) -> bool {
        self.places.contains_key(value)
    }

    /// Returns the index of a value, and adds the value if it is new.
    pub(crate) fn place(&mut self, value: T) -> usize {
        if let Some(place) = self.places.get(&value) {
            return *place;
        }
        self.places.insert(value.clone(), self.values.len());
        self.values.push(value);
        self.values.len() - 1
    }
}
