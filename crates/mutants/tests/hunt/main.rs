//! Every mutant is caught by a candidate of its area and by a quick case, and no innocent is accused.
//!
//! One test per class, so that they run side by side. A mutant draws the cases of its area until one
//! fails; only frames that differ from the rasterizer's are judged. Quick leaves candidates out if a case of
//! any area has their power, so a mutant that quick cases of its area do not show draws the first of all cases.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

mod coarse;
mod innocents;
mod names;

use etalon_backend::Backend;
use etalon_case::{Case, Library, Profile};
use etalon_cpu::CpuBackend;
use etalon_frame::Frame;
use etalon_judge::Judge;
use etalon_mutants::{Mutant, MutantBackend, mutants};
use etalon_record::{Record, Verdict};
use etalon_runner::draw_frames;
use std::cell::OnceCell;
use std::collections::BTreeSet;
use std::fs;

/// A mutant that its area does not catch, and the area that does.
const CAUGHT_ELSEWHERE: (&str, &str) =
    ("format/bgra8unorm-write-mask-red-blue-swapped", "combined");

/// Declares a test for each class, and the list of them.
macro_rules! classes {
    ($($test:ident = $class:literal),+ $(,)?) => {
        const CLASSES: &[&str] = &[$($class),+];
        $(#[test]
        fn $test() {
            hunt($class);
        })+
    };
}

classes! {
    bias = "bias",
    blend = "blend",
    bounds = "bounds",
    capability = "capability",
    clear = "clear",
    clip_distance = "clip-distance",
    clipping = "clipping",
    combination = "combination",
    counter = "counter",
    cull = "cull",
    cull_distance = "cull-distance",
    depth = "depth",
    depth_range = "depth-range",
    discard = "discard",
    dual_source = "dual-source",
    early = "early",
    fetch = "fetch",
    format = "format",
    geometry = "geometry",
    held = "held",
    hierarchy = "hierarchy",
    input_mask = "input-mask",
    interpolation = "interpolation",
    invariance = "invariance",
    logic = "logic",
    own_pass = "own-pass",
    provoking = "provoking",
    read_only = "read-only",
    readback = "readback",
    resolve = "resolve",
    sample_coverage = "sample-coverage",
    sample_shading = "sample-shading",
    samples = "samples",
    scissor = "scissor",
    sequence = "sequence",
    shader_mask = "shader-mask",
    shaderless = "shaderless",
    size = "size",
    stencil = "stencil",
    stencil_export = "stencil-export",
    sticky = "sticky",
    targets = "targets",
    tessellation = "tessellation",
    texture = "texture",
    topology = "topology",
    upload = "upload",
    viewport = "viewport",
    write_mask = "write-mask",
}

fn class_of(mutant: &Mutant) -> &str {
    mutant.name.split('/').next().unwrap()
}

/// The area whose cases catch a mutant.
fn catching_area(mutant: &Mutant) -> &'static str {
    match CAUGHT_ELSEWHERE {
        (name, area) if name == mutant.name => area,
        _ => mutant.area,
    }
}

/// Returns the frames of a case.
fn draw(backend: &dyn Backend, case: &Case) -> Vec<Frame> {
    draw_frames(backend, case).unwrap()
}

/// Cases with the rasterizer's frames, drawn once.
struct Cases {
    faithful: CpuBackend,
    judge: Judge,
    all: Vec<(Case, OnceCell<Vec<Frame>>)>,
}

impl Cases {
    /// The cases of a profile in the library's order, if their ids are wanted.
    fn new(profile: Profile, wanted: impl Fn(&str) -> bool) -> Self {
        let library = Library::built_in();
        let chosen = library
            .cases(profile)
            .filter(|c| wanted(&c.id()))
            .map(|c| c.build().unwrap())
            // A selftest fails on every driver.
            .filter(|c| c.judged_as.is_none());
        Self {
            faithful: CpuBackend::spans("cpu"),
            judge: Judge::default(),
            all: chosen.map(|case| (case, OnceCell::new())).collect(),
        }
    }

    /// Scatters the cases, since neighbours in a file test much the same.
    fn scattered(mut self) -> Self {
        let mut placed: Vec<_> = self.all.into_iter().zip(0_u32..).collect();
        placed.sort_by_key(|(_, i)| i.wrapping_mul(2_654_435_761));
        self.all = placed.into_iter().map(|(case, _)| case).collect();
        self
    }

    /// The records of the cases that a mutant draws differently, in order; a case is drawn when its
    /// record is asked for.
    fn changed(&self, mutant: &Mutant) -> impl Iterator<Item = Record> {
        let backend = MutantBackend::new(&mutant.name).unwrap();
        let numbered = self.all.iter().enumerate();
        numbered.filter_map(move |(number, (case, faithful))| {
            let frames = draw(&backend, case);
            if frames == *faithful.get_or_init(|| draw(&self.faithful, case)) {
                return None;
            }
            let judged = self
                .judge
                .judge(number, case, &mutant.name, backend.limits(), &frames);
            let record = judged.record;
            assert_ne!(record.verdict, Verdict::InternalError, "{record:?}");
            Some(record)
        })
    }
}

/// Checks all mutants of a class.
fn hunt(class: &str) {
    let members: Vec<&Mutant> = mutants()
        .iter()
        .copied()
        .filter(|m| class_of(m) == class)
        .collect();
    let areas: BTreeSet<&str> = members.iter().map(|m| catching_area(m)).collect();
    let catches = |cases: &Cases, mutant: &Mutant| {
        let Some(record) = cases.changed(mutant).find(|r| r.verdict.is_violation()) else {
            return false;
        };
        // A violation shows what is wrong.
        let shown = !record.wrong.is_empty() || record.counters.iter().any(|c| c.band.is_some());
        assert!(shown, "{record:?}");
        true
    };
    let (mut survivors, mut elsewhere) = (Vec::new(), Vec::new());
    for area in areas {
        let of_area = |profile| {
            // Formats of few channels and of 16 bits are drawn as capabilities.
            let is_drawn = |a: &str| a == area || class == "format" && a == "capabilities";
            let cases = Cases::new(profile, |id| is_drawn(id.split('/').next().unwrap()));
            // Stale state of a case shows if the next case differs only in that state.
            match class {
                "sticky" => cases,
                _ => cases.scattered(),
            }
        };
        let (quick, candidates) = (of_area(Profile::Quick), of_area(Profile::Candidates));
        for mutant in members.iter().filter(|m| catching_area(m) == area) {
            if !catches(&quick, mutant) {
                elsewhere.push(*mutant);
                if !catches(&candidates, mutant) {
                    survivors.push(&mutant.name);
                }
            }
        }
    }
    assert!(
        survivors.is_empty(),
        "no case of their area fails: {survivors:#?}"
    );
    let order = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/order.txt");
    let order = fs::read_to_string(order).unwrap();
    let order: BTreeSet<&str> = order.lines().collect();
    let first = Cases::new(Profile::Quick, |id| order.contains(id));
    let missed: Vec<&String> = elsewhere
        .iter()
        .filter(|mutant| !catches(&first, mutant))
        .map(|mutant| &mutant.name)
        .collect();
    assert!(missed.is_empty(), "no quick case fails: {missed:#?}");
}

#[test]
fn every_class_has_its_test() {
    let classes: BTreeSet<&str> = mutants().iter().map(|m| class_of(m)).collect();
    assert_eq!(classes, CLASSES.iter().copied().collect());
}
