//! Serialization of codes between processes: in a binary format, as bytes of the narrowest width that fits
//! all codes; in a human-readable one, as a list of numbers. Writing numbers one at a time costs more than
//! drawing a small picture.

use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// Writes codes. The first byte is the width of a code in bytes: 1, 2 or 4.
pub(crate) fn serialize<S: Serializer>(codes: &[u32], to: S) -> Result<S::Ok, S::Error> {
    if to.is_human_readable() {
        return codes.serialize(to);
    }
    to.serialize_bytes(&encoded(codes))
}

/// Reads codes.
pub(crate) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<u32>, D::Error> {
    if from.is_human_readable() {
        return Vec::deserialize(from);
    }
    from.deserialize_bytes(Bytes)
}

struct Bytes;

impl<'de> Visitor<'de> for Bytes {
    type Value = Vec<u32>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a width of 1, 2 or 4 and codes of as many bytes")
    }

    fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Vec<u32>, E> {
        decoded(bytes).ok_or_else(|| E::custom("codes of an unknown width, or a part of a code"))
    }
}

/// Returns the bytes of codes, their width before them. Not generic, and so compiled for speed with this crate.
fn encoded(codes: &[u32]) -> Vec<u8> {
    match codes.iter().fold(0, |bits, code| bits | code) {
        0..=0xff => narrow(codes, |code| [code as u8]),
        0x100..=0xffff => narrow(codes, |code| (code as u16).to_le_bytes()),
        _ => narrow(codes, u32::to_le_bytes),
    }
}

/// Returns `N`, and the bytes of codes of `N` bytes each.
fn narrow<const N: usize>(codes: &[u32], bytes: impl Fn(u32) -> [u8; N]) -> Vec<u8> {
    let mut written = vec![N as u8; 1 + codes.len() * N];
    let (places, _) = written[1..].as_chunks_mut();
    for (place, code) in places.iter_mut().zip(codes) {
        *place = bytes(*code);
    }
    written
}

/// Returns the codes in bytes; `None` if their width is unknown or a part of a code is left over.
fn decoded(bytes: &[u8]) -> Option<Vec<u32>> {
    match bytes.split_first()? {
        (1, rest) => Some(rest.iter().map(|byte| u32::from(*byte)).collect()),
        (2, rest) => wide(rest, |pair| u32::from(u16::from_le_bytes(pair))),
        (4, rest) => wide(rest, u32::from_le_bytes),
        _ => None,
    }
}

/// Returns the codes of `N` bytes each; `None` if a part of a code is left over.
fn wide<const N: usize>(bytes: &[u8], code: impl Fn([u8; N]) -> u32) -> Option<Vec<u32>> {
    let (codes, rest) = bytes.as_chunks::<N>();
    rest.is_empty()
        .then(|| codes.iter().map(|bytes| code(*bytes)).collect())
}
