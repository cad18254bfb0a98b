//! Pools of GPU objects that outlive a scene.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Deref;

/// Unused objects, grouped by interchangeability, up to a total weight.
pub(crate) struct KeyedPool<K, T> {
    idle: RefCell<HashMap<K, Vec<T>>>,
    weight: Cell<u64>,
    most: u64,
    generation: Cell<u64>,
}

/// An object in use. It returns to its pool on drop.
pub(crate) struct Lease<'a, K: Clone + Eq + Hash, T: Clone> {
    pool: &'a KeyedPool<K, T>,
    key: K,
    item: T,
    weight: u64,
    generation: u64,
}

impl<K: Clone + Eq + Hash, T: Clone> KeyedPool<K, T> {
    /// Returns a pool that keeps unused objects up to this total weight.
    pub(crate) fn new(most: u64) -> Self {
        Self {
            idle: RefCell::default(),
            weight: Cell::new(0),
            most,
            generation: Cell::new(0),
        }
    }

    /// Returns an unused object or a new one.
    pub(crate) fn take(&self, key: K, weight: u64, make: impl FnOnce() -> T) -> Lease<'_, K, T> {
        let idle = self.idle.borrow_mut().get_mut(&key).and_then(Vec::pop);
        if idle.is_some() {
            self.weight.set(self.weight.get() - weight);
        }
        Lease {
            pool: self,
            item: idle.unwrap_or_else(make),
            key,
            weight,
            generation: self.generation.get(),
        }
    }

    /// Removes all objects. Objects in use are removed when they return, since their state after an error is
    /// unknown.
    pub(crate) fn clear(&self) {
        self.idle.borrow_mut().clear();
        self.weight.set(0);
        self.generation.set(self.generation.get() + 1);
    }
}

impl<K: Clone + Eq + Hash, T: Clone> Deref for Lease<'_, K, T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.item
    }
}

impl<K: Clone + Eq + Hash, T: Clone> Drop for Lease<'_, K, T> {
    fn drop(&mut self) {
        let weight = self.pool.weight.get() + self.weight;
        if self.generation == self.pool.generation.get() && weight <= self.pool.most {
            self.pool.weight.set(weight);
            let mut idle = self.pool.idle.borrow_mut();
            let list = idle.entry(self.key.clone()).or_default();
            list.push(self.item.clone());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_are_reused_within_the_bound_and_not_after_an_error() {
        let pool = KeyedPool::new(2);
        let made = Cell::new(0);
        let take = || {
            pool.take("key", 1, || {
                made.set(made.get() + 1);
                made.get()
            })
        };
        drop((take(), take(), take()));
        assert_eq!(made.get(), 3);
        let again = (take(), take(), take());
        assert_eq!(made.get(), 4, "two were kept");
        pool.clear();
        drop(again);
        assert_eq!(*take(), 5, "what was in use at the error is not kept");
    }
}
