//! `etalon merge`.

use crate::args::MergeArguments;
use crate::failure::Failure;

/// Makes one run of several, and proves that nothing is missing.
pub(crate) fn run(arguments: &MergeArguments) -> Result<u8, Failure> {
    Err(Failure::usage(format!("{arguments:?}")))
}
