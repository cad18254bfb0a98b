//! Serialization of vertices and indices between processes of one machine: in a binary format, as their bytes;
//! in a human-readable one, as lists. A large mesh takes longer to write number by number than to draw.

use bytemuck::Pod;
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::marker::PhantomData;

/// Items that are written and read as bytes.
struct PodBytes<T>(T);

impl<T: Pod + Serialize> Serialize for PodBytes<&[T]> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        if to.is_human_readable() {
            self.0.serialize(to)
        } else {
            to.serialize_bytes(bytemuck::cast_slice(self.0))
        }
    }
}

impl<'de, T: Pod + Deserialize<'de>> Deserialize<'de> for PodBytes<Vec<T>> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        if from.is_human_readable() {
            Vec::deserialize(from).map(Self)
        } else {
            from.deserialize_bytes(Items(PhantomData))
        }
    }
}

struct Items<T>(PhantomData<T>);

impl<T: Pod> Visitor<'_> for Items<T> {
    type Value = PodBytes<Vec<T>>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "items of {} bytes", size_of::<T>())
    }

    fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Self::Value, E> {
        if !bytes.len().is_multiple_of(size_of::<T>()) {
            return Err(E::custom("a part of an item is left over"));
        }
        Ok(PodBytes(bytemuck::pod_collect_to_vec(bytes)))
    }
}

/// Writes items.
pub(crate) fn serialize<T, S>(items: &[T], to: S) -> Result<S::Ok, S::Error>
where
    T: Pod + Serialize,
    S: Serializer,
{
    PodBytes(items).serialize(to)
}

/// Reads items.
pub(crate) fn deserialize<'de, T, D>(from: D) -> Result<Vec<T>, D::Error>
where
    T: Pod + Deserialize<'de>,
    D: Deserializer<'de>,
{
    PodBytes::deserialize(from).map(|items| items.0)
}

/// The same for items that can be absent.
pub(crate) mod optional {
    use super::{Deserialize, Deserializer, Pod, PodBytes, Serialize, Serializer};

    /// Writes items, if there are any.
    pub(crate) fn serialize<T, S>(items: &Option<Vec<T>>, to: S) -> Result<S::Ok, S::Error>
    where
        T: Pod + Serialize,
        S: Serializer,
    {
        items.as_deref().map(PodBytes).serialize(to)
    }

    /// Reads items, if there are any.
    pub(crate) fn deserialize<'de, T, D>(from: D) -> Result<Option<Vec<T>>, D::Error>
    where
        T: Pod + Deserialize<'de>,
        D: Deserializer<'de>,
    {
        let items = Option::<PodBytes<Vec<T>>>::deserialize(from)?;
        Ok(items.map(|items| items.0))
    }
}
