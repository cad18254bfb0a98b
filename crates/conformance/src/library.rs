//! Drawing the built-in cases without judging them.

use crate::subject::{CheckedBackend, check_shape};
use etalon_backend::BackendError;
use etalon_case::{Library, Profile};
use etalon_frame::{Feature, Requirement};
use std::env;

/// The part of the built-in cases that a test draws.
#[derive(Clone, Copy, Debug)]
pub enum Share {
    /// This many cases of each file, spread over its axes.
    Sample(usize),
    /// Every case.
    All,
}

impl Share {
    /// Returns a sample of this many cases of each file, or every case if the variable `ETALON_TESTS` is
    /// `all`.
    pub fn sample(per_file: usize) -> Self {
        if env::var_os("ETALON_TESTS").is_some_and(|v| v == "all") {
            Self::All
        } else {
            Self::Sample(per_file)
        }
    }
}

/// wgpu's OpenGL does not reset the factors of draws with two sources, and Mesa then drops later draws to
/// several targets.
const TWO_SOURCES: Requirement = Requirement::Feature(Feature::DualSourceBlending);

/// Draws a subset of the built-in cases, and prints its size. Only cases that the limits deny may fail, and
/// validation must report nothing.
///
/// # Panics
/// If anything fails, or if nothing was drawn.
pub fn draw_library(subject: &CheckedBackend<'_>, profile: Profile, share: Share) {
    draw_area(subject, "", profile, share);
}

/// Draws a subset of the built-in cases whose files' names begin with `area`, as [`draw_library`] does.
///
/// # Panics
/// If anything fails, or if nothing was drawn.
pub fn draw_area(subject: &CheckedBackend<'_>, area: &str, profile: Profile, share: Share) {
    let library = Library::built_in();
    let (mut denied, mut total) = (0, 0);
    let mut chosen = Vec::new();
    for file in library.files_where(|stem| stem.starts_with(area)) {
        let cases: Vec<_> = file.cases(profile).collect();
        total += cases.len();
        let step = match share {
            Share::Sample(most) => cases.len().div_ceil(most).max(1),
            Share::All => 1,
        };
        for case in cases.into_iter().step_by(step) {
            let case = case.build().unwrap();
            let requirements = case.scene.requirements();
            if subject.limits().missing(&requirements).is_some() {
                denied += 1;
            } else {
                chosen.push((requirements.contains(&TWO_SOURCES), case));
            }
        }
    }
    chosen.sort_by_key(|(two_sources, _)| *two_sources);
    let mut drawn = 0;
    for (_, case) in &chosen {
        let frame = subject.backend.prepare(&case.scene).and_then(|mut p| {
            p.submit()?;
            p.read_back()
        });
        // A device can support a path, but not with every format.
        if let Err(BackendError::NotSupported(Requirement::Path(_))) = frame {
            denied += 1;
            continue;
        }
        drawn += 1;
        let frame = frame.unwrap_or_else(|e: BackendError| panic!("{}: {e}", case.id));
        check_shape(&case.scene, &frame);
        subject.check_silence(&case.id.to_string());
    }
    println!("{share:?} of {profile:?}: {drawn} drawn, {denied} denied, of {total} cases");
    assert!(drawn > 0, "no built-in case can be drawn");
}
