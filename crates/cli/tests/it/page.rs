//! The suite in a page (`ci/page`), in Chromium and Firefox: whole runs, stops and reloads, planted faults, and the
//! saved file, which commands read. Its records equal those of a run through the relay.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

mod server;

use crate::driven::Driven;
use crate::etalon::etalon;
use crate::house::root;
use crate::sample;
use etalon_record::{Record, Run, Seconds, Verdict};
use serde_json::Value;
use server::Server;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// Seconds in which `quick` is drawn.
const QUICK: u64 = 240;
/// True once a run has all its records.
const COMPLETE: &str = "document.body.dataset.state === 'complete'";

/// Builds the page into the folder `site` of a folder, so that no other test replaces its files, and serves it.
fn site(above: &Path) -> Server {
    let folder = above.join("site");
    let built = Command::new(root().join("ci/page"))
        .arg(&folder)
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&built.stderr);
    assert!(built.status.success(), "ci/page: {errors}");
    Server::start(&folder)
}

fn address(server: &Server, fragment: &str) -> String {
    // Without a query, a new fragment would not load the page again.
    format!("http://{}/?{}#{fragment}", server.address, fragment.len())
}

/// The number of colours in the mosaic.
const COLORS: &str = "(() => {
    const { width, height } = document.getElementById('tiles');
    const { data } = document.getElementById('tiles').getContext('2d').getImageData(0, 0, width, height);
    return new Set(new Uint32Array(data.buffer)).size;
})()";

fn text_of(browser: &Driven, id: &str) -> String {
    let text = browser.eval(&format!("document.getElementById('{id}').innerText"));
    text.as_str().unwrap().to_owned()
}

fn click(browser: &Driven, id: &str) {
    browser.eval(&format!("document.getElementById('{id}').click()"));
}

/// Writes the file of the page's run.
fn save(browser: &Driven, folder: &Path) -> PathBuf {
    let bytes =
        "run.file().then(file => file.arrayBuffer()).then(file => [...new Uint8Array(file)])";
    let bytes: Vec<u8> = serde_json::from_value(browser.eval(bytes)).unwrap();
    let path = folder.join("page.tar.gz");
    fs::write(&path, bytes).unwrap();
    path
}

/// Runs a command to its end.
fn run(arguments: &[&str], codes: &[i32]) -> String {
    let mut command = etalon(arguments);
    let output = command
        .timeout(Duration::from_secs(QUICK))
        .output()
        .unwrap();
    let code = output.status.code().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(codes.contains(&code), "{arguments:?}: {code}\n{errors}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Returns the records of a run by case, without their times.
fn records(folder: &Path) -> BTreeMap<String, Record> {
    let run = Run::read(folder).unwrap();
    let records = run.records.into_iter().map(|mut record| {
        record.seconds = Seconds::default();
        (record.case.clone(), record)
    });
    records.collect()
}

/// Compares a saved run with the same cases through the relay.
fn compare_with_relay(saved: &Path, adapter: &str, globs: &[&str]) {
    let above = saved.parent().unwrap();
    let relay = above.join("relay");
    let relay_text = relay.to_str().unwrap();
    let begun = Instant::now();
    // One job draws in the order of the cases, which decides the imprecise frames that are kept.
    let mut arguments = vec![
        "run",
        "--adapter",
        adapter,
        "--jobs",
        "1",
        "--keep-frames",
        "all",
        "--out",
        relay_text,
    ];
    arguments.extend(globs);
    run(&arguments, &[0]);
    println!("{adapter}, relay: {:.1?}", begun.elapsed());
    let saved_text = saved.to_str().unwrap();
    run(&["report", saved_text], &[0]);
    let folder = above.join("page");
    let (page, relay) = (records(&folder), records(&relay));
    assert_eq!(
        page.keys().collect::<Vec<_>>(),
        relay.keys().collect::<Vec<_>>()
    );
    for (case, record) in &page {
        assert_eq!(record, &relay[case], "{case}");
        if let Some(frame) = &record.frame {
            let frames =
                [&folder, &above.join("relay")].map(|f| Run::read_frame(f, frame).unwrap());
            assert_eq!(frames[0], frames[1], "{case}");
        }
    }
    run(&["diff", saved_text, relay_text], &[0]);
    let database = above.join("history.db");
    let added = run(
        &[
            "history",
            "add",
            saved_text,
            "--db",
            database.to_str().unwrap(),
        ],
        &[0],
    );
    assert!(added.contains(&format!("{} record", page.len())), "{added}");
    let merged = above.join("merged");
    run(
        &["merge", saved_text, "--out", merged.to_str().unwrap()],
        &[0],
    );
    assert_eq!(records(&merged), page);
}

/// Returns the globs of a run of `quick` in a page: a few areas, or none if everything runs.
fn of_quick(areas: &'static [&'static str]) -> &'static [&'static str] {
    if sample::all() {
        return &[];
    }
    println!("{}; ETALON_TESTS=all takes all of quick", areas.join(" "));
    areas
}

#[test]
fn quick_in_a_page_of_chromium_is_a_run_of_the_browser() {
    let globs = of_quick(&[
        "cull/*",
        "depth/*",
        "multisample/*",
        "order/*",
        "sequence/*",
    ]);
    let folder = tempfile::tempdir().unwrap();
    let server = site(folder.path());
    let browser = Driven::start("webgpu:chromium");
    let begun = Instant::now();
    let cases = globs.join(" ");
    browser.go(&address(&server, &format!("cases={cases}")));
    browser.wait(20, "!document.getElementById('start').disabled");
    let facts = text_of(&browser, "facts");
    for fact in [
        "swiftshader",
        "in Chromium",
        "cases of the quick profile",
        "a first guess",
    ] {
        assert!(facts.contains(fact), "{facts}");
    }
    assert_eq!(browser.eval("run"), Value::Null);
    let colors = browser.eval(COLORS).as_u64().unwrap();
    assert!(colors <= 3, "{colors}");
    click(&browser, "start");
    browser.wait(20, "run?.done > 200");
    let colors = browser.eval(COLORS).as_u64().unwrap();
    assert!(colors > 8, "{colors}");
    click(&browser, "stop");
    browser.wait(10, "document.body.dataset.state === 'stopped'");
    let stopped = text_of(&browser, "sentence");
    assert!(stopped.starts_with("Stopped after"), "{stopped}");
    // A tile is a case, whose name the caption shows and whose page a click opens.
    let on_tile = |event: &str| {
        browser.eval(&format!(
            "(() => {{
                const {{ left, top }} = document.getElementById('tiles').getBoundingClientRect();
                const at = {{ clientX: left + 3, clientY: top + 3, bubbles: true }};
                document.getElementById('tiles').dispatchEvent(new PointerEvent('{event}', at));
            }})()"
        ));
    };
    on_tile("pointermove");
    let named = text_of(&browser, "tile-name");
    on_tile("click");
    browser.wait(10, "!document.getElementById('view').hidden");
    assert_eq!(text_of(&browser, "view-title"), named);
    browser.eval("history.back()");
    browser.wait(10, "document.getElementById('view').hidden");
    click(&browser, "resume");
    browser.wait(60, "run.done > 600");
    let done = browser.eval("run.done").as_u64().unwrap();
    let started = browser.eval("JSON.parse(run.opened.header).started");
    // The mark goes with the old page, which answers until the new one is there.
    browser.eval("window.isOld = true, location.reload()");
    browser.wait(
        30,
        "!window.isOld && typeof run === 'object' && run?.running && run.done > 300",
    );
    let kept = browser.eval("run.done").as_u64().unwrap();
    assert!(
        kept + 100 > done.min(600),
        "{kept} of {done} records are left"
    );
    browser.wait(QUICK, COMPLETE);
    println!("webgpu:chromium, page: {:.1?}", begun.elapsed());
    let lines = browser.eval("[...run.records.values()].map(r => JSON.parse(new TextDecoder().decode(r.line))).filter(r => r.seconds?.draw > 0)");
    let judged = lines.as_array().unwrap().iter();
    let judging: f64 = judged
        .map(|r| r["seconds"]["judge"].as_f64().unwrap())
        .sum();
    assert!(judging > 0.1, "{judging}");
    assert_eq!(
        browser.eval("JSON.parse(run.opened.header).started"),
        started
    );
    assert_eq!(
        browser.eval("document.getElementById('bad').childElementCount"),
        0
    );
    let known = browser.eval("document.getElementById('known').childElementCount");
    assert!(known.as_u64().unwrap() > 10, "{known}");
    let sentence = text_of(&browser, "sentence");
    assert!(sentence.contains("software renderer draws"), "{sentence}");
    let end = "wrong, all because of known bugs.";
    assert!(sentence.ends_with(end), "{sentence}");
    browser.wait(
        10,
        "document.querySelectorAll('#cards .card img').length >= 9",
    );
    let saved = save(&browser, folder.path());
    click(&browser, "copy");
    browser.wait(10, "document.querySelector('#copied a')");
    let link = browser.eval("document.querySelector('#copied a').href");
    browser.eval("window.isOld = true");
    browser.go(link.as_str().unwrap());
    browser.wait(
        20,
        "!window.isOld && !document.getElementById('start').disabled",
    );
    assert_eq!(browser.eval("run"), Value::Null);
    assert_eq!(
        browser.eval("document.getElementById('globs').value"),
        cases
    );
    let facts = text_of(&browser, "facts");
    for fact in [
        "made on a device of this name",
        "as the last run in this browser",
    ] {
        assert!(facts.contains(fact), "{facts}");
    }
    drop(browser);
    compare_with_relay(&saved, "webgpu:chromium", globs);
    // The page asks for its own files and for nothing else.
    let requested = server.requested.lock().unwrap();
    for name in requested.iter().filter(|name| *name != "favicon.ico") {
        assert!(folder.path().join("site").join(name).is_file(), "{name}");
    }
}

#[test]
fn a_page_of_firefox_makes_a_run_of_the_browser() {
    let globs = of_quick(&["blend/*", "stencil/*"]);
    let folder = tempfile::tempdir().unwrap();
    let server = site(folder.path());
    let browser = Driven::start("webgpu:firefox");
    let begun = Instant::now();
    browser.go(&address(&server, &format!("run={}", globs.join(" "))));
    browser.wait(60, "run?.done > 300");
    browser.eval("void location.reload()");
    browser.wait(QUICK, COMPLETE);
    println!("webgpu:firefox, page: {:.1?}", begun.elapsed());
    let saved = save(&browser, folder.path());
    drop(browser);
    compare_with_relay(&saved, "webgpu:firefox", globs);
}

#[test]
fn a_page_of_a_browser_survives_a_lost_device() {
    let folder = tempfile::tempdir().unwrap();
    let server = site(folder.path());
    let browser = Driven::start("webgpu:chromium");
    browser.go(&address(&server, "run=sequence/* stencil/*"));
    browser.wait(60, "run?.done > 100");
    browser.kill_gpu();
    browser.wait(120, COMPLETE);
    let bad = "[...run.records.values()].map(record => record.outcome).filter(outcome => outcome.unexpected)";
    let bad = browser.eval(&format!(
        "{bad}.map(outcome => [outcome.verdict, outcome.headline])"
    ));
    let bad: Vec<(Verdict, String)> = serde_json::from_value(bad).unwrap();
    // A lane loses at most the case that it draws, which is right on a fresh device.
    assert!(bad.len() <= 8, "{bad:?}");
    for (verdict, why) in bad {
        assert_eq!(verdict, Verdict::Flaky, "{why}");
        assert!(why.contains("device-lost, then pass"), "{why}");
    }
}

#[test]
fn a_page_of_a_browser_charts_the_methods_of_a_question() {
    let folder = tempfile::tempdir().unwrap();
    let server = site(folder.path());
    let browser = Driven::start("webgpu:chromium");
    browser.narrow();
    browser.go(&address(&server, "methods=stencil-effects"));
    browser.wait(QUICK, COMPLETE);
    browser.wait(30, "!document.getElementById('charts').hidden");
    let state = browser.eval("document.getElementById('state').innerText");
    assert!(
        state.as_str().unwrap().contains("clock has steps of"),
        "{state}"
    );
    let wide = "document.documentElement.scrollWidth > innerWidth";
    assert_eq!(browser.eval(wide), false);
    let charts = "document.querySelectorAll('#charts .charts svg .of path.spread').length";
    assert!(browser.eval(charts).as_u64().unwrap() > 3);
    // The script of the charts compares pictures with the truth.
    browser.eval("document.querySelector('#charts figure.shot').scrollIntoView()");
    browser.wait(20, "document.querySelector('#charts .compared canvas')");
    let questions = browser.eval(
        "[...document.querySelectorAll('#questions a')].map(a => a.hash.replace('#methods=', ''))",
    );
    let questions: Vec<String> = serde_json::from_value(questions).unwrap();
    let folders = fs::read_dir(root().join("cases/methods"))
        .unwrap()
        .flatten();
    let mut folders: Vec<String> = folders
        .map(|folder| folder.file_name().into_string().unwrap())
        .collect();
    folders.sort();
    assert_eq!(questions, folders);
    let points = browser.eval("document.querySelector('#charts .card').dataset.points");
    let points: Value = serde_json::from_str(points.as_str().unwrap()).unwrap();
    let answer = browser.eval("document.querySelector('#charts .answer').textContent");
    let saved = save(&browser, folder.path());
    drop(browser);
    let text = run(&["report", saved.to_str().unwrap()], &[0]);
    assert!(text.contains(answer.as_str().unwrap()), "{answer}:\n{text}");
    let page = folder.path().join("page");
    let html = fs::read_to_string(page.join("methods.html")).unwrap();
    let (_, rest) = html.split_once("data-points=\"").unwrap();
    let (in_report, _) = rest.split_once('"').unwrap();
    let in_report: Value = serde_json::from_str(&in_report.replace("&quot;", "\"")).unwrap();
    assert!(is_close(&points, &in_report), "{points}\n{in_report}");
    compare_measurements(folder.path(), "webgpu:chromium");
}

/// Compares the methods of a saved run with the same cases through the relay.
fn compare_measurements(above: &Path, adapter: &str) {
    let [page, relay] = ["page", "relay"].map(|name| above.join(name));
    let arguments = [
        "run",
        "methods/stencil-effects",
        "--sizes",
        "none",
        "--adapter",
        adapter,
    ];
    run(
        &[&arguments[..], &["--out", relay.to_str().unwrap()]].concat(),
        &[0],
    );
    let [found, expected] = [&page, &relay].map(|folder| records(folder));
    assert_eq!(found.len(), 10);
    for (case, mut record) in found {
        let mut other = expected[&case].clone();
        let [Some(measured), Some(by_relay)] = [&mut record.measured, &mut other.measured] else {
            panic!("{case} is not measured");
        };
        assert!(measured.time.take().unwrap().interval.is_some(), "{case}");
        assert!(by_relay.time.take().is_some(), "{case}");
        // A power of a tiny difference enlarges the last digit of a mathematical function.
        let flips = [measured.distance.flip, by_relay.distance.flip];
        assert!((flips[0] - flips[1]).abs() < 1e-9, "{case}: {flips:?}");
        measured.distance.flip = by_relay.distance.flip;
        for path in [&measured.picture, &measured.truth_picture]
            .into_iter()
            .flatten()
        {
            let [picture, by_relay] =
                [&page, &relay].map(|folder| fs::read(folder.join(path)).unwrap());
            assert!(picture == by_relay, "{path}");
        }
        assert_eq!(record, other, "{case}");
    }
}

/// Returns true if two values differ in the last digits of numbers only: a number that was read from JSON can be off
/// by one digit.
fn is_close(left: &Value, right: &Value) -> bool {
    match (left, right) {
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_close(a, b))
        }
        (Value::Number(a), Value::Number(b)) => {
            let [a, b] = [a, b].map(|n| n.as_f64().unwrap());
            (a - b).abs() <= 1e-12 * a.abs()
        }
        (a, b) => a == b,
    }
}

#[test]
fn a_page_of_firefox_charts_the_methods_of_a_question() {
    let folder = tempfile::tempdir().unwrap();
    let server = site(folder.path());
    let browser = Driven::start("webgpu:firefox");
    browser.go(&address(&server, "methods=stencil-effects"));
    browser.wait(QUICK, COMPLETE);
    browser.wait(30, "document.querySelector('#charts figure.shot')");
    browser.eval("document.querySelector('#charts figure.shot').scrollIntoView()");
    browser.wait(20, "document.querySelector('#charts .compared canvas')");
    let saved = save(&browser, folder.path());
    drop(browser);
    run(&["report", saved.to_str().unwrap()], &[0]);
    compare_measurements(folder.path(), "webgpu:firefox");
}

#[test]
fn a_page_of_a_browser_shows_planted_faults() {
    let folder = tempfile::tempdir().unwrap();
    let server = site(folder.path());
    let browser = Driven::start("webgpu:chromium");
    browser.narrow();
    browser.go(&address(
        &server,
        "run=capabilities/round-trip blend/factors&fault=read-fault=off-by-one",
    ));
    browser.wait(60, COMPLETE);
    let verdicts = browser
        .eval("run.opened.cases.map((_, number) => run.records.get(number).outcome.verdict)");
    let verdicts: Vec<Verdict> = serde_json::from_value(verdicts).unwrap();
    let count = |verdict| verdicts.iter().filter(|v| **v == verdict).count();
    assert!(
        count(Verdict::Fail) >= 5 && count(Verdict::Blocked) >= 3,
        "{verdicts:?}"
    );
    assert_eq!(count(Verdict::Pass), 0, "{verdicts:?}");
    let wide = "document.documentElement.scrollWidth > innerWidth";
    assert_eq!(browser.eval(wide), false);
    let wrong = format!("{} of ", count(Verdict::Fail));
    let sentence = text_of(&browser, "sentence");
    assert!(sentence.contains(&wrong), "{sentence}");
    browser.wait(
        10,
        "document.querySelectorAll('#cards .card img').length >= 3",
    );
    browser.eval("location.hash = [...document.querySelectorAll('#bad a')].map(a => a.getAttribute('href')).find(a => a.includes('round-trip'))");
    browser.wait(20, "document.querySelectorAll('#view img').length >= 3");
    let text = browser.eval("document.getElementById('view').innerText");
    let text = text.as_str().unwrap();
    assert!(
        text.contains("texel 0,0 must keep") && text.contains("Wrong texels"),
        "{text}"
    );
    assert_eq!(browser.eval(wide), false);
    assert_eq!(browser.eval("document.activeElement.id"), "view-title");
    browser.eval("history.back()");
    browser.wait(10, "document.getElementById('view').hidden");
    browser.go(&address(&server, "run=nothing/*"));
    browser.wait(
        20,
        "document.getElementById('problem').innerText.includes('no case matches')",
    );
    // Without a secure context, browsers have no WebGPU.
    let insecure = address(&server, "").replace("127.0.0.1", "0.0.0.0");
    browser.go(&insecure);
    browser.wait(20, "!document.getElementById('facts').hidden");
    let problem = text_of(&browser, "problem");
    for part in ["needs a secure context", "Nothing is drawn instead"] {
        assert!(problem.contains(part), "{problem}");
    }
    assert_eq!(
        browser.eval("document.getElementById('start').disabled"),
        true
    );
}

#[test]
fn a_case_of_a_saved_run_has_the_bundle_of_the_same_case_through_the_relay() {
    let folder = tempfile::tempdir().unwrap();
    let server = site(folder.path());
    let browser = Driven::start("webgpu:chromium");
    let case = "order/repeat-multisample/compare=less/depth=depth24plus";
    browser.go(&address(&server, &format!("run={case}")));
    browser.wait(60, COMPLETE);
    let saved = save(&browser, folder.path());
    let relay = folder.path().join("relay");
    let named = [case, "--adapter", "webgpu:chromium", "--out"];
    run(
        &[&["run"], &named[..], &[relay.to_str().unwrap()]].concat(),
        &[0],
    );
    let bundle = |from: &Path, code: i32| {
        let out = folder.path().join("bundles");
        let from = ["--run", from.to_str().unwrap(), "--force"];
        let arguments = [&["bundle"], &named[..], &[out.to_str().unwrap()], &from].concat();
        run(&arguments, &[code]);
        let name = "order-repeat-multisample-compare-less-depth-depth24plus.webgpu-chromium";
        out.join(name)
    };
    let program = bundle(&relay, 0).join("repro.html");
    let by_relay = fs::read_to_string(&program).unwrap();
    let bundled = bundle(&saved, 0);
    assert_eq!(fs::read_to_string(&program).unwrap(), by_relay);
    let report = fs::read_to_string(bundled.join("report.md")).unwrap();
    assert!(report.contains("come from a saved run"), "{report}");
    browser.go(&format!("file://{}", program.display()));
    browser.wait(60, "document.title.includes(' is wrong: ')");
    // Earlier runs do not state what the device offers.
    let lines = relay.join("run.jsonl");
    let text = fs::read_to_string(&lines).unwrap();
    let (header, rest) = text.split_once('\n').unwrap();
    let mut header: Value = serde_json::from_str(header).unwrap();
    let offer = header["adapters"][0]
        .as_object_mut()
        .unwrap()
        .remove("offer");
    assert!(offer.unwrap()["limits"]["maxTextureDimension2D"].is_u64());
    fs::write(&lines, format!("{header}\n{rest}")).unwrap();
    bundle(&relay, 1);
}
