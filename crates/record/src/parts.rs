//! Names by the parts of their texts.

use foldhash::HashMap;

/// The length of a part in bytes.
const LENGTH: usize = 3;

/// The indices of names by each part that they have.
pub(crate) struct Parts(HashMap<[u8; LENGTH], Vec<usize>>);

impl Parts {
    pub(crate) fn new(names: &[String]) -> Self {
        let mut parts: HashMap<[u8; LENGTH], Vec<usize>> = HashMap::default();
        for (index, name) in names.iter().enumerate() {
            for part in name.as_bytes().array_windows() {
                let indices = parts.entry(*part).or_default();
                if indices.last() != Some(&index) {
                    indices.push(index);
                }
            }
        }
        Self(parts)
    }

    /// Returns the indices of the names with the rarest part of some texts, in ascending order: all names that have all
    /// these texts are among them. `None` if every text is shorter than a part.
    pub(crate) fn rarest<'t>(&self, texts: impl Iterator<Item = &'t [u8]>) -> Option<&[usize]> {
        let parts = texts.flat_map(|text| text.array_windows());
        let with = parts.map(|part| self.0.get(part).map_or(&[][..], Vec::as_slice));
        with.min_by_key(|indices| indices.len())
    }
}
