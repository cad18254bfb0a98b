//! `etalon bundle` on wgpu: packages are built offline and run, pages run in Chromium.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::bundling::{PROGRAMS, bundle, last_line, run_as_told};
use crate::driven::Driven;
use crate::sample;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// The seconds that a page may take.
const PATIENCE: u64 = 60;

/// The answer of a page in Chromium over SwiftShader.
#[derive(Clone, Copy, Debug)]
enum Page {
    /// WebGPU lacks a feature.
    Absent,
    Right,
    Wrong,
}

/// Cases that an adapter fails, with the other Vulkan driver if the bug is the driver's own, and the page's
/// result.
const FAILING: [(&str, &str, Option<&str>, Page); 16] = [
    (
        "scissor/clip-distances/samples/planes=row/samples=4",
        "wgpu:vulkan:swiftshader",
        Some("llvmpipe"),
        Page::Wrong,
    ),
    (
        "scissor/samples/mask=all/rect=row/samples=4",
        "wgpu:vulkan:lavapipe",
        Some("SwiftShader"),
        Page::Right,
    ),
    (
        "paths/discard/commands=secondary/draws=direct/state=dynamic",
        "wgpu:vulkan:lavapipe",
        None,
        Page::Right,
    ),
    (
        "order/repeat-multisample/compare=less/depth=depth24plus",
        "wgpu:vulkan:swiftshader",
        Some("llvmpipe"),
        Page::Wrong,
    ),
    (
        "scissor/clip-distances/early-tests/counter=any-samples-passed/early_tests=forced/planes=row",
        "wgpu:vulkan:swiftshader",
        Some("llvmpipe"),
        Page::Absent,
    ),
    (
        "paths/resolve-away/pass=dynamic-rendering/target=cube-face",
        "wgpu:vulkan:lavapipe",
        Some("SwiftShader"),
        Page::Right,
    ),
    (
        // lavapipe resolves to a wrong face.
        "paths/resolve-away/pass=dynamic-rendering/target=cube-face",
        "wgpu:vulkan:swiftshader",
        None,
        Page::Wrong,
    ),
    (
        "stencil/masks-zero/compare=less/format=stencil8",
        "wgpu:vulkan:lavapipe",
        None,
        Page::Right,
    ),
    (
        "depth/bias-linear/format=depth16unorm",
        "wgpu:vulkan:lavapipe",
        None,
        // SwiftShader adds 258 units instead of 255.
        Page::Wrong,
    ),
    (
        "scissor/clip-distances/samples/planes=row/samples=4",
        "wgpu:gl:llvmpipe",
        None,
        Page::Right,
    ),
    (
        "paths/srgb/end=copy/start=transfer/target=cube-face",
        "wgpu:gl:llvmpipe",
        None,
        Page::Right,
    ),
    (
        "cull/provoking/clipped/mesh=left/provoking=first",
        "wgpu:gl:llvmpipe",
        None,
        Page::Right,
    ),
    (
        "paths/depth-stencil/area=full/start=draw/target=array-layer",
        "wgpu:gl:llvmpipe",
        None,
        Page::Right,
    ),
    (
        "sequence/again/resolves/samples=4",
        "wgpu:gl:llvmpipe",
        None,
        Page::Right,
    ),
    (
        "paths/strip/commands=one/draws=restart/pass=dynamic-rendering",
        "wgpu:gl:llvmpipe",
        None,
        Page::Right,
    ),
    (
        "capabilities/round-trip/format=rgba8snorm",
        "wgpu:gl:llvmpipe",
        None,
        Page::Right,
    ),
];

#[test]
fn a_bundled_package_shows_the_bug_and_its_page_starts() {
    let count = sample::count("failing cases of adapters of wgpu", 3, FAILING.len());
    for (case, adapter, other, shown) in FAILING[..count].iter().copied() {
        let (out, empty) = (TempDir::new().unwrap(), TempDir::new().unwrap());
        let (code, summary, error) = bundle(case, adapter, out.path(), &[]);
        assert_eq!(code, 0, "{case} on {adapter}: {error}");
        let folder = Path::new(summary["folder"].as_str().unwrap());
        built(folder, empty.path());
        let report = fs::read_to_string(folder.join("report.md")).unwrap();
        let accused = run_as_told(&report, empty.path());
        let line = last_line(&accused);
        assert_eq!(
            accused.status.code(),
            Some(1),
            "{case} on {adapter}: {line}"
        );
        let is_reported = report.contains(&format!("ends with 1: `{line}`"));
        assert!(is_reported, "{line}: {report}");
        if let Some(other) = other {
            let sound = Command::new(empty.path().join("repro"))
                .arg(other)
                .env("XDG_RUNTIME_DIR", "/tmp")
                .env("VK_DRIVER_FILES", drivers())
                .env("VK_ICD_FILENAMES", drivers())
                .output()
                .unwrap();
            let line = last_line(&sound);
            assert_eq!(sound.status.code(), Some(0), "{case} on {other}: {line}");
        }
        let page = folder.join("repro.html");
        match shown {
            Page::Absent => assert!(!page.exists(), "{case}"),
            Page::Right => assert_eq!(answer(&page), "right", "{case} on {adapter}"),
            Page::Wrong => {
                let answer = answer(&page);
                assert!(answer.contains("is wrong: "), "{case}: {answer}");
            }
        }
    }
}

#[test]
fn a_page_shows_the_bug_of_a_browser() {
    let out = TempDir::new().unwrap();
    let case = "order/repeat-multisample/compare=less/depth=depth24plus";
    let (code, summary, error) = bundle(case, "webgpu:chromium", out.path(), &[]);
    assert_eq!(code, 0, "{error}");
    assert!(error.contains("open repro.html in the browser"), "{error}");
    // Each run is the start of a browser.
    assert_eq!([&summary["failed"], &summary["runs"]], [5, 5]);
    let folder = Path::new(summary["folder"].as_str().unwrap());
    assert!(!folder.join("main.rs").exists());
    let report = fs::read_to_string(folder.join("report.md")).unwrap();
    assert!(
        report.contains("Open `repro.html` in the browser"),
        "{report}"
    );
    let answer = answer(&folder.join("repro.html"));
    assert!(answer.contains("is wrong: "), "{answer}");
}

/// Builds the package in an empty folder, with the versions of its lock file.
fn built(folder: &Path, empty: &Path) {
    for file in ["main.rs", "Cargo.toml", "Cargo.lock"] {
        fs::copy(folder.join(file), empty.join(file)).unwrap();
    }
    let target = Path::new(PROGRAMS).join("etalon-programs/target");
    let output = Command::new("cargo")
        .args(["build", "--offline", "--locked", "--target-dir"])
        .arg(&target)
        .env("CARGO_INCREMENTAL", "0")
        .env("CARGO_PROFILE_DEV_DEBUG", "0")
        .current_dir(empty)
        .output()
        .unwrap();
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{}: {errors}", folder.display());
    assert!(!errors.contains("warning"), "{errors}");
    fs::copy(target.join("debug/repro"), empty.join("repro")).unwrap();
}

/// The Vulkan drivers: lavapipe and SwiftShader.
fn drivers() -> String {
    let folder = Path::new("/usr/share/vulkan/icd.d");
    let files = fs::read_dir(folder).unwrap();
    let lavapipe = files
        .map(|file| file.unwrap().path())
        .find(|path| path.display().to_string().contains("lvp_icd"));
    format!(
        "{}:/usr/lib/chromium/vk_swiftshader_icd.json",
        lavapipe.unwrap().display()
    )
}

/// Opens a page in Chromium over SwiftShader. Returns the title that the page sets.
fn answer(page: &Path) -> String {
    let browser = Driven::start("webgpu:chromium");
    browser.go(&format!("file://{}", page.display()));
    browser.wait(
        PATIENCE,
        "document.title.includes(' is wrong: ') \
         || ['right', 'not supported: ', 'a call fails: '].some(word => document.title.startsWith(word))",
    );
    browser.eval("document.title").as_str().unwrap().to_owned()
}
