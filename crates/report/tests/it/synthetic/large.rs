//! A made-up run as large as a nightly one: 8,000 cases on ten adapters.

use crate::synthetic::{ADAPTERS, cases, repeated, write_on};
use etalon_frame::Api;
use std::path::Path;

const CASES: usize = 8000;

/// Writes the run. Returns how many records it has.
pub(crate) fn write(folder: &Path) -> usize {
    let mut ids = repeated(CASES.div_ceil(cases().len()));
    ids.truncate(CASES);
    let mut adapters = ADAPTERS.to_vec();
    adapters.push(("gl:zink:lavapipe", Api::OpenGl));
    adapters.push(("gl:es:angle:swiftshader", Api::OpenGlEs));
    write_on(folder, &ids, &adapters)
}
