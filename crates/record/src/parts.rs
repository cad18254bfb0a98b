//! Names by the parts of their texts.

use foldhash::HashMap;

/// The indices of names by each part that they have, three bytes as a number.
pub(crate) struct Parts(HashMap<u32, Vec<usize>>);

impl Parts {
    pub(crate) fn new(names: &[String]) -> Self {
        let mut parts: HashMap<u32, Vec<usize>> = HashMap::default();
        for (index, name) in names.iter().enumerate() {
            for part in parts_of(name.as_bytes()) {
                let indices = parts.entry(part).or_default();
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
        let parts = texts.flat_map(parts_of);
        let with = parts.map(|part| self.0.get(&part).map_or(&[][..], Vec::as_slice));
        with.min_by_key(|indices| indices.len())
    }
}

fn parts_of(text: &[u8]) -> impl Iterator<Item = u32> {
    let windows = text.array_windows();
    windows.map(|[a, b, c]| u32::from_be_bytes([0, *a, *b, *c]))
}
