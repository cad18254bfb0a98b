//! Prepared scenes that are submitted repeatedly: the worker keeps them, and every frame is compared with the
//! first.

use crate::worker::{FAULT, launch, serve};
use etalon_backend::{Backend, BackendError, FrameTime, Prepared};
use etalon_case::{Case, CaseFile, Profile};
use etalon_cpu::CpuBackend;
use etalon_frame::{AdapterInfo, Frame, Limits};
use etalon_judge::Judge;
use etalon_record::{ComparedPair, Reason, Verdict};
use etalon_runner::{Worker, draw_frames};
use etalon_scene::Scene;

/// The rasterizer, with clears that are one code off from a certain submission of a prepared scene on.
struct Tiring {
    inner: CpuBackend,
    from: u32,
}

struct TiringScene<'a> {
    inner: Box<dyn Prepared + 'a>,
    from: u32,
    submissions: u32,
}

impl Backend for Tiring {
    fn adapter(&self) -> &AdapterInfo {
        self.inner.adapter()
    }

    fn limits(&self) -> &Limits {
        self.inner.limits()
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        Ok(Box::new(TiringScene {
            inner: self.inner.prepare(scene)?,
            from: self.from,
            submissions: 0,
        }))
    }
}

impl Prepared for TiringScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        self.submissions += 1;
        self.inner.submit()
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        let mut frame = self.inner.read_back()?;
        if self.submissions >= self.from {
            frame.images[0].codes[0] += 1;
        }
        Ok(frame)
    }
}

fn tiring(from: u32) -> Tiring {
    Tiring {
        inner: CpuBackend::new("tiring"),
        from,
    }
}

#[test]
#[ignore = "the worker's side, which the other tests start"]
fn worker() {
    let Ok(from) = std::env::var(FAULT) else {
        return;
    };
    serve(|| Ok(Box::new(tiring(from.parse().unwrap()))));
}

/// A clear to a colour with several legal codes.
fn case() -> Case {
    let text = r#"{
        "about": "A clear again.", "spec": ["none"],
        "scene": {
            "attachments": { "color": { "format": "rgba8unorm", "size": [4, 4], "clear": [0.1, 0, 0, 0] } },
            "passes": [{ "color": ["color"], "draws": [] }],
            "read": ["color"]
        },
        "submissions": [1, 2, 64]
    }"#;
    let file = CaseFile::parse("t.json", text).unwrap();
    file.cases(Profile::Full).next().unwrap().build().unwrap()
}

#[test]
fn a_frame_that_changes_with_the_submissions_is_no_longer_the_same() {
    let case = case();
    // After the first one, 1, 2 and 64 others: 2, 4 and 68 in all.
    for (from, variant) in [
        (2, "1-more"),
        (3, "2-more"),
        (5, "64-more"),
        (68, "64-more"),
    ] {
        let backend = tiring(from);
        let frames = draw_frames(&backend, &case).unwrap();
        assert_eq!(frames.len(), 4);
        let record = Judge::default()
            .judge(0, &case, "tiring", backend.limits(), &frames)
            .record;
        assert_eq!(record.verdict, Verdict::Fail, "{from}: {record:?}");
        let differs = |reason: &Reason| {
            let Reason::Difference { pair, citation, .. } = reason else {
                return false;
            };
            let ComparedPair::Variant(name) = pair else {
                return false;
            };
            name.contains(variant) && citation.contains("Invariance")
        };
        assert!(record.reasons.iter().any(differs), "{:?}", record.reasons);
        let mut worker =
            Worker::start(&launch("again::worker", "tiring", &from.to_string())).unwrap();
        assert_eq!(worker.draw(&case), Ok(frames));
    }
    let backend = tiring(69);
    let frames = draw_frames(&backend, &case).unwrap();
    let judged = Judge::default().judge(0, &case, "tiring", backend.limits(), &frames);
    assert!(!judged.record.verdict.is_violation(), "{:?}", judged.record);
}
