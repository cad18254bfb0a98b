//! A small made-up run with known remarkable cases.

use crate::synthetic::{adapter, header};
use etalon_frame::{Api, Aspect, ChannelEncoding, Frame, Image, ReadPath};
use etalon_record::{Expected, ProcessEnd, Record, Run, RunWriter, Seconds, Verdict};
use etalon_report::{Catalogue, CatalogueCase, RunReport};
use std::path::{Path, PathBuf};

pub(crate) const ADAPTERS: [&str; 4] = ["cpu", "gl:llvmpipe", "gl:softpipe", "vulkan:lavapipe"];
/// Fails on `gl:softpipe` and nowhere else.
pub(crate) const ODD: &str = "depth/compare/compare=greater/write=true";
/// Crashes on `vulkan:lavapipe`, with everything that is recorded about a lost process.
pub(crate) const CRASH: &str = "blend/order/draws=2";
/// The number of cases.
pub(crate) const CASES: usize = 6 + 1 + 4 + 1 + 1;

/// Writes the run with its reports, and returns the path of the page.
pub(crate) fn write(folder: &Path) -> PathBuf {
    let adapters = ADAPTERS.map(|name| adapter(name, Api::Vulkan)).to_vec();
    let mut writer = RunWriter::create(folder, &header(CASES as u64, adapters)).unwrap();
    for id in ids() {
        for (column, name) in ADAPTERS.into_iter().enumerate() {
            writer.append(&record(&id, column, name)).unwrap();
        }
    }
    drop(writer);
    let report = RunReport {
        folder,
        run: &Run::read(folder).unwrap(),
        catalogue: Some(&catalogue()),
        news: None,
        deqp: true,
    };
    report.write().unwrap().html
}

/// The catalogue of the depth cases, one with a hostile text.
pub(crate) fn catalogue() -> Catalogue {
    let frame = Frame {
        images: vec![Image {
            attachment: "color".to_owned(),
            aspect: Aspect::Color,
            size: [4, 4],
            samples: 1,
            channels: vec![ChannelEncoding::Unorm(8); 4],
            read: ReadPath::Copy,
            codes: (0..64).map(|n| n * 4).collect(),
        }],
        counters: Vec::new(),
    };
    let file = serde_json::json!({
        "about": "What <b>compares</b>.", "spec": ["Vulkan: Depth Comparison"], "key": "scene",
        "scene": { "passes": [{ "compare": "$compare", "write": "$write", "next": "$next" }] },
        "axes": { "compare": [["equal", "equal"], ["greater", "greater"], ["less", "less"]],
            "write": [["false", false], ["true", true]] },
        "derived": { "next": ["compare", 1, null] },
    });
    let mut catalogue = Catalogue::default();
    catalogue.files.insert("depth/compare".to_owned(), file);
    catalogue
        .shaders
        .insert("uniform_color", "@fragment fn fs() {}");
    for id in ids()
        .into_iter()
        .filter(|id| id.starts_with("depth/compare"))
    {
        catalogue.cases.push(CatalogueCase {
            id,
            file: "depth/compare".to_owned(),
            lines: vec![
                "color: rgba8unorm, 4 by 4".to_owned(),
                "</script><i>pass 0".to_owned(),
            ],
            shaders: vec!["uniform_color"],
            picture: etalon_report::Thumbnails::default().uri(&frame.images[0]),
        });
    }
    catalogue
}

fn ids() -> Vec<String> {
    let mut ids = Vec::new();
    for compare in ["equal", "greater", "less"] {
        for write in ["false", "true"] {
            ids.push(format!("depth/compare/compare={compare}/write={write}"));
        }
    }
    ids.push("depth/clip/planes=1".to_owned());
    ids.extend((0..4).map(|read| format!("stencil/masks/read={read}")));
    ids.push(CRASH.to_owned());
    ids.push("selftest/told/bug=1".to_owned());
    assert_eq!(ids.len(), CASES);
    ids
}

fn record(id: &str, column: usize, name: &str) -> Record {
    let verdict = match (id, column) {
        (ODD, 2) => Verdict::Fail,
        ("depth/clip/planes=1", _) => {
            let each = [
                Verdict::Pass,
                Verdict::NotSupported,
                Verdict::Skipped,
                Verdict::Fail,
            ];
            each[column]
        }
        ("stencil/masks/read=1", 0) => Verdict::Imprecise,
        ("stencil/masks/read=2", _) => Verdict::Fail,
        (CRASH, 3) => Verdict::Crash,
        ("selftest/told/bug=1", _) => Verdict::Fail,
        _ => Verdict::Pass,
    };
    let mut record = Record::new(id, name, verdict);
    record.seconds = Seconds {
        draw: 0.0125,
        judge: 2.5,
    };
    record.due_fail = id.starts_with("selftest");
    if id == "stencil/masks/read=2" {
        record.expected = Some(Expected {
            reason: "masks are known to be wrong, bug 99".to_owned(),
        });
    }
    if verdict == Verdict::Crash {
        record.process = Some(ProcessEnd {
            signal: Some(11),
            stderr: "lavapipe: assertion of the shader's stack\nlast line".to_owned(),
            seconds: 0.75,
            ..ProcessEnd::default()
        });
        record.validation = vec!["VUID-vkCmdDraw-None-02699: no descriptor".to_owned()];
        record.repeats = vec![Verdict::Crash, Verdict::Crash, Verdict::Pass];
        record.after = vec![ODD.to_owned()];
    }
    record
}
