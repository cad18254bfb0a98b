//! The frame times of `etalon run --timed`: a short bench in a folder of the run.

use crate::commands::bench::{self, DoneBench};
use crate::failure::Failure;
use crate::flags::{AdapterFileArguments, CaseArguments, CaseProfile, OutputFormat};
use etalon_record::{Content, FolderKind, OutputFolder, Shard, TIMED_FOLDER};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// A case of each kind of work, at a size that keeps a processor and a graphics card busy.
const CASES: [&str; 10] = [
    "perf/clear/size=1280x720",
    "perf/quad/size=1280x720",
    "perf/blended-layers/size=1280x720",
    "perf/depth-order/order=front-to-back/size=1280x720",
    "perf/stencil/size=1280x720",
    "perf/textured-discard/size=1280x720",
    "perf/triangles-100k/size=1280x720",
    "perf/multisample-blended-layers/size=1280x720",
    "perf/matrix/resolve/format=rgba8unorm/layers=2/samples=4/size=1024x1024",
    "perf/read-back/format=rgba8unorm/size=1280x720",
];

/// Twelve rounds of these seconds for a frame of each case; an adapter's rounds end after [`LIMIT`] seconds.
const SECONDS: f64 = 0.02;
const ROUNDS: u32 = 12;
const LIMIT: f64 = 5.0;

/// Measures the timed set on the adapters of a run, into the run's folder.
pub(crate) fn time(
    run: &Path,
    adapters: &[String],
    file: &AdapterFileArguments,
    timeout: f64,
    cold: bool,
    resume: bool,
    stop: &AtomicBool,
) -> Result<DoneBench, Failure> {
    let set = bench::Arguments {
        selection: CaseArguments {
            globs: CASES.map(str::to_owned).to_vec(),
            cases: None,
            gltf: None,
            profile: CaseProfile::Full,
        },
        file: file.clone(),
        adapters: adapters.to_vec(),
        out: run.join(TIMED_FOLDER),
        resume,
        force: !resume,
        // Every part of a run is drawn on a machine of its own.
        shard: Some(Shard { index: 1, count: 1 }),
        timeout,
        rounds: ROUNDS,
        seconds: SECONDS,
        within: None,
        limit: Some(LIMIT),
        instructions: false,
        cold,
        format: OutputFormat::Text,
    };
    bench::timed(&set, stop)
}

/// Removes the frame times of the run that a new one replaces.
pub(crate) fn forget(folder: &Path) -> Result<(), Failure> {
    let folder = folder.join(TIMED_FOLDER);
    match Content::of(&folder).map_err(Failure::of)? {
        Content::Recorded(FolderKind::Bench) => {
            let out = OutputFolder::open(&folder).map_err(Failure::of)?;
            out.clear(None).map_err(Failure::of)
        }
        _ => Ok(()),
    }
}
