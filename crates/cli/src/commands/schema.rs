//! `etalon schema`.

use crate::failure::Failure;
use crate::output::print_json;

/// Prints the JSON schema of case files.
pub(crate) fn run() -> Result<u8, Failure> {
    print_json(&etalon_case::schema())?;
    Ok(0)
}
