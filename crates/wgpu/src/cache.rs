//! A cache of objects by key.

use etalon_backend::BackendError;
use std::cell::RefCell;
use std::collections::HashMap;
use std::hash::Hash;

/// The largest number of objects kept. A full cache is cleared, which is rare enough to be cheap.
const MOST: usize = 1024;

/// Objects, by the description that they are created from.
pub(crate) struct Cache<K, T>(RefCell<HashMap<K, T>>);

impl<K, T> Default for Cache<K, T> {
    fn default() -> Self {
        Self(RefCell::default())
    }
}

impl<K: Eq + Hash, T: Clone> Cache<K, T> {
    /// Returns the object of a key, created on first use.
    pub(crate) fn get(
        &self,
        key: K,
        make: impl FnOnce(&K) -> Result<T, BackendError>,
    ) -> Result<T, BackendError> {
        if let Some(found) = self.0.borrow().get(&key) {
            return Ok(found.clone());
        }
        let made = make(&key)?;
        let mut objects = self.0.borrow_mut();
        if objects.len() >= MOST {
            objects.clear();
        }
        objects.insert(key, made.clone());
        Ok(made)
    }

    /// Removes all objects.
    pub(crate) fn clear(&self) {
        self.0.borrow_mut().clear();
    }
}
