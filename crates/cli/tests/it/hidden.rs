//! What comes from outside never commands a terminal: each source, in the output of each command that shows it.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::{BINARY, REMOVED};
use etalon_frame::is_hidden;
use etalon_record::{Reason, Record, Run, Verdict};
use serde_json::{Value, json};
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Command, Stdio};
use tungstenite::{Message, WebSocket};

/// Text that clears a screen, sets a title, turns the direction of reading, and hides.
const EVIL: &str = "\u{1b}[2J\u{1b}]0;x\u{7}\u{9b}31m\u{7f}\u{202e}\u{200b}\u{2028}evil";

/// Returns what a command prints, after a check that nothing of it is hidden.
fn printed(words: &[&str]) -> String {
    let mut command = Command::new(BINARY);
    for name in REMOVED {
        command.env_remove(name);
    }
    let output = command.args(words).output().unwrap();
    shown(&words.join(" "), &[output.stdout, output.stderr].concat())
}

fn shown(what: &str, bytes: &[u8]) -> String {
    let text = String::from_utf8(bytes.to_vec()).unwrap();
    let hidden = text.chars().find(|c| is_hidden(*c) && !"\n\t".contains(*c));
    assert_eq!(hidden, None, "{what}: {text:?}");
    let longest = text.lines().map(str::len).max().unwrap_or(0);
    assert!(longest < 50_000, "{what}: a line of {longest} bytes");
    text
}

fn described(folder: &Path, entry: &Value) -> String {
    let mut entry = entry.clone();
    entry["name"] = json!("there");
    let path = folder.join("mine.json");
    fs::write(&path, json!([entry]).to_string()).unwrap();
    path.display().to_string()
}

#[test]
fn the_words_of_drivers_and_launchers_are_printable() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out").display().to_string();
    let script = format!("printf '%s' '{EVIL}' >&2; exit 3");
    for launcher in [
        json!(["sh", "-c", script]),
        json!(["printf", EVIL]),
        json!([EVIL]),
    ] {
        let file = described(
            folder.path(),
            &json!({ "backend": "cpu", "launcher": launcher }),
        );
        for words in [
            &["adapters"][..],
            &[
                "run",
                "cull/lines",
                "--adapter",
                "there",
                "--force",
                "--out",
                &out,
            ],
            &["bench", "perf/*", "--adapter", "there", "--out", &out],
            &["fuzz", "--adapter", "there", "--count", "1", "--out", &out],
            &[
                "explain",
                "cull/lines/cull=front-and-back/front_face=ccw",
                "--texel",
                "0,0",
                "--adapter",
                "there",
            ],
        ] {
            let text = printed(&[words, &["--adapters", &file]].concat());
            assert!(
                text.contains("evil") || text.contains("unexpected"),
                "{words:?}: {text}"
            );
        }
    }
}

#[test]
fn names_in_records_lists_and_commands_are_printable() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (before, after) = (path("before"), path("after"));
    for out in [&before, &after] {
        printed(&[
            "run",
            "cull/lines",
            "cull/points",
            "--adapter",
            "cpu",
            "--out",
            out,
        ]);
        let mut run = Run::read(out.as_ref()).unwrap();
        let adapter = &mut run.header.adapters[0];
        adapter.info.device = EVIL.repeat(100);
        adapter.info.driver = EVIL.to_owned();
        adapter.info.driver_version = EVIL.to_owned();
        run.header.provenance.machine.cpu = EVIL.to_owned();
        run.header.provenance.command.push(EVIL.to_owned());
        for (number, record) in run.records.iter_mut().enumerate() {
            *record = Record::new(&record.case, "cpu", Verdict::Crash);
            record.reasons = vec![Reason::Text(EVIL.repeat(3))];
            if number == 0 && *out == after {
                record.verdict = Verdict::Fail;
            }
        }
        run.replace_in(out.as_ref()).unwrap();
    }
    let case = Run::read(after.as_ref()).unwrap().records[0].case.clone();
    let db = path("etalon.db");
    let list = path("fails.txt");
    fs::write(&list, format!("{EVIL},Fail\ncull/{EVIL}\n")).unwrap();
    let archive = path(EVIL);
    fs::write(&archive, "no archive").unwrap();
    for words in [
        &["report", &after][..],
        &["report", &archive],
        &["report", EVIL],
        &["diff", &before, &after],
        &["diff", &before, &after, "--format", "json"],
        &["merge", &after, "--out", &path("merged")],
        &["site", &path("site"), &after],
        &["history", "add", &before, &after, "--db", &db],
        &["history", "show", &case, "--db", &db],
        &["history", "triage", "--db", &db],
        &["history", "add", EVIL, "--db", &db],
        &["list", EVIL],
        &["show", EVIL],
        &["run", EVIL],
        &["run", "cull/lines", "--adapter", EVIL],
        &["run", "cull/lines", "--adapter", "cpu", "--expect", EVIL],
        &["check", EVIL],
        &[
            "expectations",
            "import",
            "--adapter",
            "*",
            "--reason",
            "r",
            "--evidence",
            "e",
            "--fails",
            &list,
            "--out",
            &path("list.json"),
        ],
    ] {
        printed(words);
    }
}

/// Opens the WebSocket of a waiting worker.
fn opened(url: &str) -> WebSocket<TcpStream> {
    let address = url.trim_start_matches("http://").split('/').next().unwrap();
    let request = tungstenite::http::Request::get(format!("{}socket", url.replace("http", "ws")))
        .header("Host", address)
        .header("Origin", format!("http://{address}"))
        .header("Connection", "Upgrade")
        .header("Upgrade", "websocket")
        .header("Sec-WebSocket-Version", "13")
        .header("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ==")
        .body(())
        .unwrap();
    let stream = TcpStream::connect(address).unwrap();
    tungstenite::client(request, stream).unwrap().0
}

#[test]
fn the_words_of_a_page_are_printable_and_short() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let port = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = port.local_addr().unwrap().to_string();
    drop(port);
    let file = described(
        folder.path(),
        &json!({ "backend": "webgpu", "listen": address }),
    );
    let hello = json!({
        "protocol": 1,
        "browser": { "name": EVIL, "version": EVIL },
        "adapter": { "vendor": EVIL.repeat(1000), "architecture": EVIL, "device": EVIL, "description": EVIL, "fallback": false },
        "features": [],
        "limits": {
            "maxTextureDimension2D": 8192, "maxTextureDimension3D": 2048, "maxColorAttachments": 8,
            "maxColorAttachmentBytesPerSample": 32, "maxStorageBuffersPerShaderStage": 8,
            "minUniformBufferOffsetAlignment": 256, "minStorageBufferOffsetAlignment": 256
        }
    });
    let unavailable = json!({ "protocol": 1, "unavailable": EVIL.repeat(10_000) });
    for greeting in [hello, unavailable] {
        let mut command = Command::new(BINARY);
        for name in REMOVED {
            command.env_remove(name);
        }
        let mut run = command
            .args([
                "run",
                "depth/clear",
                "--adapter",
                "there",
                "--recheck",
                "off",
            ])
            .args(["--force", "--adapters", &file, "--out"])
            .arg(&out)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut errors = BufReader::new(run.stderr.take().unwrap());
        let mut said = Vec::new();
        let url = loop {
            errors.read_until(b'\n', &mut said).unwrap();
            let text = String::from_utf8_lossy(&said).into_owned();
            if let Some((_, url)) = text.split_once("open ") {
                break url.split(' ').next().unwrap().to_owned();
            }
        };
        let mut socket = std::iter::from_fn(|| {
            std::thread::sleep(std::time::Duration::from_millis(50));
            Some(TcpStream::connect(&address))
        })
        .find_map(Result::ok)
        .map(|_| opened(&url))
        .unwrap();
        socket.send(Message::text(greeting.to_string())).unwrap();
        // Each scene is answered with an error, until the run ends.
        std::thread::spawn(move || {
            while let Ok(message) = socket.read() {
                let request = message.into_data();
                let Some(length) = request.first_chunk() else {
                    break;
                };
                let header = &request[4..4 + u32::from_le_bytes(*length) as usize];
                let header: Value = serde_json::from_slice(header).unwrap();
                let error =
                    json!({ "kind": "resource", "what": EVIL, "message": EVIL.repeat(1000) });
                let answer = json!({
                    "number": header["number"], "times": [], "error": error, "messages": [EVIL]
                })
                .to_string();
                let length = (answer.len() as u32).to_le_bytes();
                let answer = [&length, answer.as_bytes()].concat();
                if socket.send(Message::binary(answer)).is_err() {
                    break;
                }
            }
        });
        errors.read_to_end(&mut said).unwrap();
        let output = run.wait_with_output().unwrap();
        let text = shown("run", &[output.stdout, said].concat());
        assert!(text.contains("evil"), "{text}");
    }
    printed(&["report", out.to_str().unwrap()]);
}
