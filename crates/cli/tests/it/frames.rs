//! Frames from files: what one program exports and draws, another one judges as a run does.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_record::{Run, Verdict};
use png::{BitDepth, ColorType, Encoder};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The cases whose frames are judged twice.
const GLOBS: [&str; 13] = [
    "blend",
    "capabilities",
    "combined",
    "cull",
    "depth",
    "early-z",
    "multisample",
    "order",
    "scissor",
    "selftest",
    "sequence",
    "stencil",
    "texture",
];
/// A case with a colour of 8 bits a channel, depth and no counter.
const CASE: &str = "depth/compare/compare=less/format=depth32float/write=true";

fn path(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Returns the verdicts of a run's cases, and whether a story explains them.
fn verdicts(folder: &Path) -> BTreeMap<String, (Verdict, bool)> {
    let run = Run::read(folder).unwrap();
    let records = run.records.into_iter();
    records
        .map(|r| (r.case, (r.verdict, r.story.is_some())))
        .collect()
}

/// Asserts that frames of an adapter, written to files, get the verdicts of a run. Returns the verdicts.
fn judged_as_in_a_run(adapter: &str, globs: &[&str]) -> BTreeMap<String, (Verdict, bool)> {
    let work = tempfile::tempdir().unwrap();
    let [exported, judged, drawn] = ["exported", "judged", "drawn"].map(|n| work.path().join(n));
    etalon(&[
        "export",
        "--no-values",
        "--adapter",
        adapter,
        "--out",
        path(&exported),
    ])
    .args(globs)
    .assert()
    .code(0);
    let code = |command: &[&str], folder: &Path| {
        let mut command = etalon(command);
        let output = command.args(["--out", path(folder)]).output().unwrap();
        output.status.code().unwrap()
    };
    let limits = exported.join("limits.json");
    let judge = [
        "judge",
        "--frame",
        path(&exported),
        "--limits",
        path(&limits),
        "--expect-only",
    ];
    let run = [
        &[
            "run",
            "--adapter",
            adapter,
            "--recheck",
            "off",
            "--keep-frames",
            "all",
            "--expect-only",
        ],
        globs,
    ]
    .concat();
    assert_eq!(code(&judge, &judged), code(&run, &drawn), "{adapter}");
    let (judged, mut drawn) = (verdicts(&judged), verdicts(&drawn));
    drawn.retain(|case, _| judged.contains_key(case));
    let differing = judged.iter().zip(&drawn).filter(|(a, b)| a != b);
    assert_eq!(differing.collect::<Vec<_>>(), []);
    judged
}

#[test]
fn frames_from_files_are_judged_as_in_a_run() {
    let verdicts = judged_as_in_a_run("cpu", &GLOBS);
    assert!(verdicts.len() >= 1000, "{}", verdicts.len());
}

#[test]
fn a_planted_fault_is_found_in_files_too() {
    let verdicts = judged_as_in_a_run(
        "gl:softpipe:call-fault=last-row",
        &["blend", "cull", "scissor"],
    );
    let fails = verdicts.values().filter(|v| **v == (Verdict::Fail, true));
    assert!(fails.count() > 100);
}

/// A folder with the frame of one case in raw bytes.
struct FrameFolder {
    work: tempfile::TempDir,
}

impl FrameFolder {
    fn new() -> Self {
        let work = tempfile::tempdir().unwrap();
        let frame = work.path().join("frame");
        etalon(&["export", CASE, "--adapter", "cpu", "--out", path(&frame)])
            .assert()
            .code(0);
        let folder = Self { work };
        for entry in ["color-color", "depth-depth"] {
            let file = fs::read(folder.case().join(format!("{entry}.npy"))).unwrap();
            let header = usize::from(u16::from_le_bytes([file[8], file[9]])) + 10;
            fs::write(folder.case().join(format!("{entry}.raw")), &file[header..]).unwrap();
        }
        folder
    }

    fn case(&self) -> std::path::PathBuf {
        self.work.path().join("frame").join(CASE)
    }

    fn bytes(&self) -> Vec<u8> {
        fs::read(self.case().join("color-color.raw")).unwrap()
    }

    /// Writes the manifest with these files of the colour.
    fn name(&self, color: &[&str]) {
        let images = json!([
            { "attachment": "depth", "aspect": "depth", "files": ["depth-depth.raw"] },
            { "attachment": "color", "aspect": "color", "files": color },
        ]);
        self.write(&json!({ "case": CASE, "frames": [{ "images": images }] }));
    }

    fn write(&self, manifest: &Value) {
        fs::write(self.case().join("frame.json"), manifest.to_string()).unwrap();
    }

    fn png(&self, name: &str, color: ColorType, bytes: &[u8], size: u32) {
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, size, size);
        encoder.set_color(color);
        encoder.set_depth(BitDepth::Eight);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(bytes).unwrap();
        writer.finish().unwrap();
        fs::write(self.case().join(name), file).unwrap();
    }

    /// Judges, and returns the exit code and the messages.
    fn judge(&self, flags: &[&str]) -> (i32, String) {
        let out = self.work.path().join("judged");
        let frame = self.work.path().join("frame");
        let mut command = etalon(&["judge", CASE, "--force", "--out", path(&out)]);
        let output = command
            .args(["--frame", path(&frame)])
            .args(flags)
            .output()
            .unwrap();
        let [text, errors] = [output.stdout, output.stderr].map(|b| String::from_utf8(b).unwrap());
        (output.status.code().unwrap(), text + &errors)
    }
}

#[test]
fn frames_are_raw_bytes_arrays_or_pictures() {
    let folder = FrameFolder::new();
    let size = (folder.bytes().len() as f64 / 4.0).sqrt() as u32;
    folder.png("color.png", ColorType::Rgba, &folder.bytes(), size);
    for name in ["color-color.raw", "color-color.npy", "color.png"] {
        folder.name(&[name]);
        for rules in ["vulkan", "opengl", "opengl-es", "webgpu"] {
            let (code, text) = folder.judge(&["--rules", rules]);
            assert_eq!(code, 0, "{name} {rules}: {text}");
        }
    }
    let mut wrong = folder.bytes();
    wrong[0] ^= 255;
    folder.png("wrong.png", ColorType::Rgba, &wrong, size);
    folder.name(&["wrong.png"]);
    let (code, text) = folder.judge(&[]);
    assert_eq!(code, 1, "{text}");
    assert!(text.contains("texel 0,0 must be"), "{text}");
    let schema = etalon(&["schema", "--frame"]).assert().code(0);
    let schema: Value = serde_json::from_slice(&schema.get_output().stdout).unwrap();
    let manifest = fs::read(folder.case().join("frame.json")).unwrap();
    let manifest: Value = serde_json::from_slice(&manifest).unwrap();
    assert!(jsonschema::is_valid(&schema, &manifest));
    assert!(!jsonschema::is_valid(&schema, &json!({ "case": CASE })));
    let run = folder.work.path().join("judged");
    etalon(&["report", path(&run)]).assert().code(1);
    etalon(&["diff", path(&run), path(&run)]).assert().code(0);
}

#[test]
fn a_wrong_frame_folder_is_bad_input() {
    let folder = FrameFolder::new();
    let bytes = folder.bytes();
    let size = (bytes.len() as f64 / 4.0).sqrt() as u32;
    let texels = bytes.len() / 4;
    folder.png("rgb.png", ColorType::Rgb, &vec![0; texels * 3], size);
    folder.png(
        "large.png",
        ColorType::Rgba,
        &vec![0; 4 * texels * 4],
        size * 2,
    );
    fs::write(folder.case().join("short.raw"), &bytes[1..]).unwrap();
    fs::write(folder.case().join("long.raw"), vec![0; 1 << 20]).unwrap();
    fs::write(folder.case().join("bad.npy"), &bytes).unwrap();
    fs::write(folder.case().join("bad.png"), &bytes).unwrap();
    fs::write(folder.case().join("color.tiff"), &bytes).unwrap();
    fs::copy(
        folder.case().join("depth-depth.npy"),
        folder.case().join("f4.npy"),
    )
    .unwrap();
    for (files, words) in [
        (&["rgb.png"][..], "needs Rgba"),
        (&["large.png"], "but one sample of color has"),
        (&["short.raw"], "has 1023 bytes"),
        (&["long.raw"], "has more than"),
        (&["bad.npy"], "no .npy file"),
        (&["bad.png"], "no PNG"),
        (&["f4.npy"], "an array of <f4"),
        (&["color.tiff"], "must end in .npy, .png or .raw"),
        (&["absent.raw"], "absent.raw"),
        (&["../frame.json"], "frame.json"),
        (&["/etc/hostname"], "/etc/hostname"),
        (&["short.raw", "short.raw"], "color has 2 files"),
        (&[], "color has 0 files"),
    ] {
        folder.name(files);
        let (code, text) = folder.judge(&[]);
        assert_eq!(code, 64, "{files:?}: {text}");
        assert!(text.contains(words), "{files:?}: {text}");
    }
    let color = json!({ "attachment": "color", "aspect": "color", "files": ["color-color.raw"] });
    for (manifest, words) in [
        (json!({}), "missing field `case`"),
        (
            json!({ "case": CASE, "frames": [] }),
            "scene: it is missing",
        ),
        (
            json!({ "case": CASE, "frames": [{ "images": [color] }] }),
            "depth of depth is missing",
        ),
        (
            json!({ "case": CASE, "frames": [{ "images": [color, color] }] }),
            "color is there twice",
        ),
        (
            json!({ "case": CASE, "frames": [{ "images": [], "counters": [1] }] }),
            "0 counters",
        ),
        (
            json!({ "case": CASE, "frames": [{ "variant": "x", "images": [] }] }),
            "no variant `x`",
        ),
        (
            json!({ "case": "depth/x", "frames": [] }),
            "no case `depth/x`",
        ),
    ] {
        folder.write(&manifest);
        let (code, text) = folder.judge(&[]);
        let unknown = manifest["case"] == "depth/x";
        assert_eq!(code, if unknown { 4 } else { 64 }, "{manifest}: {text}");
        assert!(unknown || text.contains(words), "{manifest}: {text}");
    }
    folder.name(&["color-color.raw"]);
    let (code, text) = folder.judge(&["--limits", path(&folder.case().join("scene.json"))]);
    assert_eq!(code, 64);
    assert!(text.contains("first line of the open protocol"), "{text}");
}

#[test]
fn a_frame_lies_between_the_exported_least_and_largest_values() {
    let folder = FrameFolder::new();
    let bytes = folder.bytes();
    let mut exact = 0;
    for api in ["vulkan", "opengl", "opengl-es", "webgpu"] {
        let values = |end: &str| {
            let name = folder.case().join(format!("{api}/color-color.{end}.npy"));
            let file = fs::read(name).unwrap();
            file[file.len() - bytes.len()..].to_vec()
        };
        let (least, largest) = (values("least"), values("largest"));
        for (value, (least, largest)) in bytes.iter().zip(least.iter().zip(&largest)) {
            assert!((least..=largest).contains(&value), "{api}");
            exact += usize::from(least == largest);
        }
    }
    assert!(exact > bytes.len() * 2, "{exact}");
    for name in ["case.json", "scene.json", "vulkan/color-color.least.png"] {
        assert!(folder.case().join(name).is_file(), "{name}");
    }
}

/// Returns true if one reading allows all samples, of one colour of 8 bits a channel and of 32-bit depth.
fn is_legal(worlds: &Value, colors: &[u8], depths: &[f32]) -> bool {
    let list = |value: &Value| value.as_array().unwrap().clone();
    let allows = |reading: &Value| {
        let [group] = &list(&reading["groups"])[..] else {
            panic!("all images have one size");
        };
        let (runs, sets) = (list(&group["runs"]), list(&group["sets"]));
        depths.iter().enumerate().all(|(sample, depth)| {
            let colors = colors[4 * sample..4 * sample + 4].iter();
            let drawn: Vec<f64> = colors
                .map(|c| f64::from(*c))
                .chain([f64::from(*depth)])
                .collect();
            let run = runs
                .iter()
                .find(|run| run[0].as_u64().unwrap() > sample as u64);
            let boxes = list(&sets[run.unwrap()[1].as_u64().unwrap() as usize]);
            let is_inside = |bounds: &Value| {
                let bounds = list(bounds);
                assert_eq!(bounds.len(), drawn.len());
                bounds.iter().zip(&drawn).all(|(bounds, value)| {
                    let [low, high] = [&bounds[0], &bounds[1]].map(Value::as_f64);
                    low.is_none_or(|low| low <= *value) && high.is_none_or(|high| *value <= high)
                })
            };
            boxes.is_empty() || boxes.iter().any(is_inside)
        })
    };
    list(&worlds["readings"]).iter().any(allows)
}

#[test]
fn a_frame_is_legal_by_the_exported_worlds_alone() {
    let folder = FrameFolder::new();
    let file = |name: &str| fs::read(folder.case().join(name)).unwrap();
    let depth = file("depth-depth.npy");
    for api in ["vulkan", "opengl", "opengl-es", "webgpu"] {
        let worlds: Value = serde_json::from_slice(&file(&format!("{api}/worlds.json"))).unwrap();
        let mut colors = folder.bytes();
        let depths = depth[depth.len() - colors.len()..].chunks(4);
        let depths = depths.map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap()));
        let mut depths: Vec<f32> = depths.collect();
        assert!(is_legal(&worlds, &colors, &depths), "{api}");
        colors[0] ^= 0x80;
        assert!(!is_legal(&worlds, &colors, &depths), "{api}");
        colors[0] ^= 0x80;
        depths[17] += 0.125;
        assert!(!is_legal(&worlds, &colors, &depths), "{api}");
    }
}
