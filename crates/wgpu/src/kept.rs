//! Objects that are made once.

use etalon_backend::BackendError;
use std::cell::RefCell;
use std::collections::HashMap;
use std::hash::Hash;

/// The most objects kept; past it all go, which costs little when it happens that seldom.
const MOST: usize = 1024;

/// Objects by what they are made from.
pub(crate) struct Kept<K, T>(RefCell<HashMap<K, T>>);

impl<K, T> Default for Kept<K, T> {
    fn default() -> Self {
        Self(RefCell::default())
    }
}

impl<K: Eq + Hash, T: Clone> Kept<K, T> {
    /// The object, made now where it is not yet.
    pub(crate) fn get(
        &self,
        key: K,
        make: impl FnOnce(&K) -> Result<T, BackendError>,
    ) -> Result<T, BackendError> {
        if let Some(found) = self.0.borrow().get(&key) {
            return Ok(found.clone());
        }
        let made = make(&key)?;
        let mut kept = self.0.borrow_mut();
        if kept.len() >= MOST {
            kept.clear();
        }
        kept.insert(key, made.clone());
        Ok(made)
    }

    /// Forgets all.
    pub(crate) fn clear(&self) {
        self.0.borrow_mut().clear();
    }
}
