//! The performance matrix, made from bench folders with planted times.

use crate::bench::header;
use etalon_frame::Work;
use etalon_record::{Bench, BenchHeader, BenchLine, BenchWriter, Picture, Reason, Round, Verdict};
use etalon_report::{TableOptions, matrix_table, write_bench};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

const TEXELS: u64 = 1 << 20;
/// Seconds that a frame costs in addition to its layers.
const FIXED: f64 = 0.004;
/// Cells with the seconds that a layer takes.
const CELLS: [(&str, f64); 4] = [
    (
        "fill/blend=none/format=rgba8unorm/LAYERS/samples=1/size=512x512",
        1e-3,
    ),
    (
        "fill/blend=over/format=rgba8unorm/LAYERS/samples=1/size=512x512",
        2e-3,
    ),
    (
        "depth/blend=none/depth=write/depth_format=depth32float/format=rgba8unorm/LAYERS/samples=1/size=512x512",
        0.0,
    ),
    ("clear/format=rgba8unorm/LAYERS/size=512x512", 5e-4),
];
const ADAPTERS: [(&str, f64); 2] = [("cpu", 1.0), ("vulkan:lavapipe", 0.5)];

fn matrix_header() -> BenchHeader {
    let mut header = header();
    header.cases = 2 * CELLS.len() as u64 + 2;
    header.adapters.truncate(2);
    header
}

fn picture(case: &str, adapter: &str, verdict: Verdict, layers: u64) -> BenchLine {
    let clears = case.contains("/clear/");
    BenchLine::Picture(Picture {
        case: case.to_owned(),
        adapter: adapter.to_owned(),
        verdict,
        asserted: 1.0,
        reasons: match verdict {
            Verdict::Pass => Vec::new(),
            _ => vec![Reason::Text("format <r8unorm>, \"missing\"".to_owned())],
        },
        work: Some(Work {
            triangles: layers,
            texels: if clears { 64 * layers } else { TEXELS * layers },
            cleared: if clears { TEXELS * layers } else { 0 },
            resolved: 0,
            read: TEXELS,
            bytes: 8 * TEXELS * layers,
            operations: 16 * TEXELS * layers,
            read_bytes: 0,
        }),
        accuracy: Vec::new(),
    })
}

fn round(case: &str, adapter: &str, number: u32, time: f64) -> BenchLine {
    let jitter = 1.0 + f64::from(number % 5) / 1000.0;
    let wall: Vec<f64> = [0.999, 1.0, 1.001].map(|f| f * jitter * time).to_vec();
    BenchLine::Round(Round {
        case: case.to_owned(),
        adapter: adapter.to_owned(),
        round: number,
        at: f64::from(number),
        ruler: [0.002, 0.002],
        prepare: 0.02,
        first: time,
        warm_up: 2,
        cpu: wall.clone(),
        gpu: Vec::new(),
        clock: Some([2500.0, 2600.0]),
        read_back: Vec::new(),
        wall,
    })
}

/// A bench with every cell of [`CELLS`], and a cell that the second adapter lacks.
pub(crate) fn write(folder: &Path) -> Bench {
    let header = matrix_header();
    let mut writer = BenchWriter::create(folder, &header).unwrap();
    let mut add = |line: BenchLine| writer.append(&line).unwrap();
    for (cell, seconds) in CELLS {
        for layers in [4, 12] {
            let case = format!(
                "perf/matrix/{}",
                cell.replace("LAYERS", &format!("layers={layers}"))
            );
            for (adapter, factor) in ADAPTERS {
                add(picture(&case, adapter, Verdict::Pass, layers));
                for number in 0..header.rounds {
                    let time = FIXED + f64::from(layers as u32) * seconds * factor;
                    add(round(&case, adapter, number, time));
                }
            }
        }
    }
    for layers in [4, 12] {
        let case = format!(
            "perf/matrix/fill/blend=none/format=r8unorm/layers={layers}/samples=1/size=512x512"
        );
        add(picture(&case, "cpu", Verdict::Pass, layers));
        add(picture(
            &case,
            "vulkan:lavapipe",
            Verdict::NotSupported,
            layers,
        ));
    }
    Bench::read(folder).unwrap()
}

/// The fields of a line of CSV.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut quoted) = (vec![String::new()], false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => {
                fields.last_mut().unwrap().push(letters.next().unwrap())
            }
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            other => fields.last_mut().unwrap().push(other),
        }
    }
    fields
}

#[test]
fn the_csv_gives_the_planted_rates_back() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path());
    let [_, path] = write_bench(folder.path()).unwrap().matrix.unwrap();
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(fields);
    let head = lines.next().unwrap();
    let rows: Vec<BTreeMap<String, String>> = lines
        .map(|line| {
            assert_eq!(line.len(), head.len(), "{line:?}");
            head.iter().cloned().zip(line).collect()
        })
        .collect();
    assert_eq!(rows.len(), 2 * (CELLS.len() + 1));
    let find = |cell: &str, adapter: &str| {
        let mut candidates = rows.iter();
        candidates
            .find(|r| r["cell"].contains(cell) && r["adapter"] == adapter)
            .unwrap()
    };
    let number = |row: &BTreeMap<String, String>, key: &str| row[key].parse::<f64>().unwrap();
    for (cell, seconds) in CELLS {
        for (adapter, factor) in ADAPTERS {
            let row = find(&cell.replace("/LAYERS", ""), adapter);
            assert_eq!(row["work"], (8 * TEXELS).to_string());
            if seconds == 0.0 {
                assert_eq!(
                    (row["state"].as_str(), row["rate"].as_str()),
                    ("below-resolution", "")
                );
                continue;
            }
            let expected = TEXELS as f64 / (seconds * factor) / 1e9;
            let rate = number(row, "rate");
            assert!(
                (rate / expected - 1.0).abs() < 0.005,
                "{cell}: {rate} {expected}"
            );
            assert!(number(row, "low") <= rate && rate <= number(row, "high"));
            assert_eq!(
                (row["state"].as_str(), row["unit"].as_str()),
                ("measured", "Gpix/s")
            );
            for (key, base) in [("of_base", 1e-3), ("of_clear", 5e-4)] {
                let share = number(row, key);
                assert!(
                    (share / (base / seconds) - 1.0).abs() < 0.01,
                    "{cell}: {share}"
                );
            }
        }
    }
    let missing = find("format=r8unorm", "vulkan:lavapipe");
    assert_eq!(missing["state"], "not-supported");
    assert_eq!(missing["message"], "format <r8unorm>, \"missing\"");
    assert_eq!(find("format=r8unorm", "cpu")["state"], "incomplete");
}

#[test]
fn the_page_holds_every_cell_of_every_adapter_and_its_samples() {
    let folder = tempfile::tempdir().unwrap();
    let bench = write(folder.path());
    let [path, _] = write_bench(folder.path()).unwrap().matrix.unwrap();
    let html = fs::read_to_string(path).unwrap();
    assert!(!html.contains("<r8unorm>"));
    // Links lead to samples, and each place occurs once.
    let ids: Vec<&str> = html
        .split(" id=\"s-")
        .skip(1)
        .map(|t| t.split('"').next().unwrap())
        .collect();
    let links: Vec<&str> = html
        .split("href=\"#s-")
        .skip(1)
        .map(|t| t.split('"').next().unwrap())
        .collect();
    let cells = CELLS.len() + 1;
    assert_eq!(ids.len(), 2 * cells);
    assert_eq!(links.len(), 2 * cells);
    assert!(links.iter().all(|link| ids.contains(link)));
    assert_eq!(html.matches("<section class=\"adapter\"").count(), 2);
    for words in [
        "1.05",
        "below",
        "not-supported",
        "2500 to 2600 MHz",
        "test and write",
    ] {
        assert!(html.contains(words), "{words}");
    }
    let text = matrix_table(
        &bench,
        TableOptions {
            width: 160,
            color: false,
        },
    );
    assert_eq!(text.matches("below").count(), 3, "{text}");
    assert!(
        text.contains("fill blend=over format=rgba8unorm") && text.contains("100%"),
        "{text}"
    );
    let index = fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(index.contains("href=\"matrix.html\""));
}

#[test]
fn a_bench_without_cells_has_no_matrix() {
    let folder = tempfile::tempdir().unwrap();
    let bench = crate::bench::write(folder.path(), &header(), 2e-3, Verdict::Fail);
    assert_eq!(write_bench(folder.path()).unwrap().matrix, None);
    assert_eq!(matrix_table(&bench, TableOptions::default()), "");
    assert!(!folder.path().join("matrix.html").exists());
}
