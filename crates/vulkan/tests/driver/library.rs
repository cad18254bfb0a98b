//! Built-in cases, and everything again with the validation layer.

use crate::drivers::{backend, is_lavapipe, lavapipe};
use etalon_backend::Backend;
use etalon_case::Profile;
use etalon_conformance::{CheckedBackend, Share, draw_area, draw_library, run_all};

pub(crate) fn sample(backend: &dyn Backend) {
    let subject = CheckedBackend::new(backend, &[]);
    draw_library(&subject, Profile::Quick, Share::sample(4));
}

/// One pass with the layer: every check, then cases of every file.
#[test]
fn the_validation_layer_is_silent() {
    let backend = backend(true);
    if is_lavapipe() {
        run_all(&backend, &lavapipe());
    }
    draw_library(
        &CheckedBackend::new(&backend, &[]),
        Profile::Full,
        Share::sample(3),
    );
}

/// Every file of paths, with several values of each key.
#[test]
fn the_validation_layer_is_silent_on_every_path() {
    let backend = backend(true);
    let subject = CheckedBackend::new(&backend, &[]);
    draw_area(&subject, "paths/", Profile::Quick, Share::All);
}
