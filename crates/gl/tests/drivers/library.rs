//! A sample of the built-in cases on each context; `ETALON_TESTS=all` draws all of them.

use crate::drivers::is;
use etalon_backend::Backend;
use etalon_case::Profile;
use etalon_conformance::{CheckedBackend, Share, draw_library};

/// Full axes if states cost nothing to compile, otherwise the quick profile.
pub(crate) fn sample(backend: &dyn Backend) {
    let (profile, per_file) = if is(backend, "softpipe") {
        (Profile::Full, 2)
    } else {
        (Profile::Quick, 2)
    };
    draw_library(
        &CheckedBackend::new(backend, &[]),
        profile,
        Share::sample(per_file),
    );
}
