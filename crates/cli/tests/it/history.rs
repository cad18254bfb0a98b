//! `etalon history`, tested through the binary: a folder for runs and their history, and the tests of each command.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

mod add;
mod show;
mod triage;
mod writers;

use crate::etalon::{BINARY, etalon};
use assert_cmd::assert::Assert;
use etalon_record::{
    AdapterRecord, BENCH_FORMAT, BenchHeader, BenchLine, BenchWriter, FORMAT, Header, Picture,
    Provenance, Record, Round, Settings, ShaderCache, Verdict,
};
use rusqlite::Connection;
use serde_json::{Value, json};
use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use tempfile::TempDir;

const CASE: &str = "depth/made/n=1";
const OTHER: &str = "depth/made/n=2";

/// A folder for runs and their history.
pub(crate) struct HistoryFolder {
    pub(crate) folder: TempDir,
}

impl HistoryFolder {
    pub(crate) fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn db(&self) -> PathBuf {
        self.path("etalon.db")
    }

    /// Runs a history command on this folder's file.
    pub(crate) fn command(&self, arguments: &[&str]) -> Assert {
        let mut command = etalon(&["history"]);
        command.args(arguments).arg("--db").arg(self.db()).assert()
    }

    pub(crate) fn json(&self, arguments: &[&str]) -> Value {
        let assert = self.command(&[arguments, &["--format", "json"]].concat());
        serde_json::from_slice(&assert.code(0).get_output().stdout).unwrap()
    }

    /// Writes a run of `cpu` and returns its folder.
    pub(crate) fn run(&self, day: u32, version: &str, verdicts: &[(&str, Verdict)]) -> String {
        let folder = self.path(&format!("run-{day}"));
        fs::create_dir_all(&folder).unwrap();
        let header = header(day, version, verdicts.len() as u64);
        let mut text = serde_json::to_string(&header).unwrap() + "\n";
        for (case, verdict) in verdicts {
            text += &serde_json::to_string(&Record::new(*case, "cpu", *verdict)).unwrap();
            text.push('\n');
        }
        fs::write(folder.join("run.jsonl"), text).unwrap();
        folder.display().to_string()
    }

    /// Writes a bench of `cpu` with seven rounds, with about this frame time and ruler time.
    pub(crate) fn bench(&self, night: u32, seconds: f64, ruler: f64) -> String {
        let folder = self.path(&format!("bench-{night}"));
        let header = BenchHeader {
            format: BENCH_FORMAT,
            provenance: Provenance {
                etalon: "0.1.0".to_owned(),
                commit: Some(format!("{night:040x}")),
                started: started(night),
                command: vec!["etalon".to_owned()],
                ..Provenance::default()
            },
            profile: "quick".to_owned(),
            cases: 1,
            rounds: 7,
            shader_cache: ShaderCache::Warm,
            ruler: "counting".to_owned(),
            limits: Vec::new(),
            settings: Default::default(),
            adapters: vec![adapter("1.0")],
            absent: Vec::new(),
        };
        let mut writer = BenchWriter::create(&folder, &header).unwrap();
        let picture = Picture {
            case: "perf/made".to_owned(),
            adapter: "cpu".to_owned(),
            verdict: Verdict::Pass,
            asserted: 1.0,
            reasons: Vec::new(),
            work: None,
            accuracy: Vec::new(),
        };
        writer.append(&BenchLine::Picture(picture)).unwrap();
        for round in 0..7 {
            let jitter = 1.0 + f64::from((night * 7 + round * 5) % 11) / 2000.0;
            let time = seconds * jitter;
            let line = BenchLine::Round(Round {
                case: "perf/made".to_owned(),
                adapter: "cpu".to_owned(),
                round,
                at: f64::from(round),
                ruler: [ruler, ruler],
                prepare: 0.1,
                first: 0.1,
                warm_up: 1,
                wall: vec![time; 3],
                cpu: vec![time; 3],
                gpu: Vec::new(),
                clock: None,
                read_back: Vec::new(),
            });
            writer.append(&line).unwrap();
        }
        folder.display().to_string()
    }

    /// Returns all rows of all tables as text, so that changed rows show.
    fn dump(&self) -> String {
        let file = Connection::open(self.db()).unwrap();
        let names = "SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name";
        let mut names = file.prepare(names).unwrap();
        let names = names.query_map([], |row| row.get(0)).unwrap();
        let mut text = String::new();
        for name in names.map(|name: rusqlite::Result<String>| name.unwrap()) {
            let mut table = file.prepare(&format!("SELECT * FROM \"{name}\"")).unwrap();
            let columns = table.column_count();
            let mut rows = table.query([]).unwrap();
            while let Some(row) = rows.next().unwrap() {
                let values = (0..columns)
                    .map(|column| row.get::<_, rusqlite::types::Value>(column).unwrap());
                text += &format!("{name} {:?}\n", values.collect::<Vec<_>>());
            }
        }
        text
    }

    /// Starts the binary, which adds runs to this folder's file.
    fn spawn_add(&self, folders: &[String]) -> Child {
        let mut command = Command::new(BINARY);
        command.args(["history", "add"]).args(folders);
        command.arg("--db").arg(self.db()).stdout(Stdio::null());
        command.spawn().unwrap()
    }
}

/// Returns the start of a run; later days give later starts. Months have 28 days.
fn started(day: u32) -> String {
    format!(
        "20{:02}-{:02}-{:02}T02:00:00Z",
        24 + day / 336,
        day / 28 % 12 + 1,
        day % 28 + 1
    )
}

fn adapter(version: &str) -> AdapterRecord {
    let adapter = json!({
        "name": "cpu", "backend": "cpu", "device": "d", "driver": "etalon", "driver_version": version,
        "api_version": "1", "software": true,
        "limits": { "api": "vulkan", "sub_pixel_bits": 8, "max_size": 1024,
            "max_color_attachments": 8, "formats": {}, "features": [], "sample_positions": {} },
    });
    serde_json::from_value(adapter).unwrap()
}

fn header(day: u32, version: &str, cases: u64) -> Header {
    Header {
        format: FORMAT,
        provenance: Provenance {
            etalon: "0.1.0".to_owned(),
            commit: Some(format!("{day:040x}")),
            started: started(day),
            command: vec!["etalon".to_owned()],
            ..Provenance::default()
        },
        cases,
        settings: Settings {
            profile: Some("quick".to_owned()),
            ..Settings::default()
        },
        adapters: vec![adapter(version)],
        absent: Vec::new(),
    }
}

const GOOD: [(&str, Verdict); 2] = [(CASE, Verdict::Pass), (OTHER, Verdict::Pass)];
const BAD: [(&str, Verdict); 2] = [(CASE, Verdict::Fail), (OTHER, Verdict::Pass)];
