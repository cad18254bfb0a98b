//! Reports of benches, made from bench folders.

use crate::synthetic::adapter;
use etalon_frame::{Accuracy, Api, Aspect, ChannelEncoding, Work};
use etalon_record::{
    BENCH_FORMAT, Bench, BenchHeader, BenchLine, BenchWriter, Ended, Machine, Picture,
    ProcessorLimits, Provenance, Reason, Round, ShaderCache, Time, Verdict,
};
use etalon_report::{
    OutcomeCounts, TableOptions, bench_table, diff, diff_table, write_bench, write_diff,
};
use etalon_stats::Conclusion;
use roxmltree::Document;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

pub(crate) fn header() -> BenchHeader {
    let mut card = adapter("vulkan:card", Api::Vulkan);
    card.info.software = false;
    BenchHeader {
        format: BENCH_FORMAT,
        provenance: Provenance {
            etalon: "0.1.0".to_owned(),
            commit: Some("abc".to_owned()),
            machine: Machine {
                os: "Linux".to_owned(),
                cpu: "A processor".to_owned(),
                cores: 2,
            },
            started: "2026-01-01T00:00:00Z".to_owned(),
            command: vec!["etalon".to_owned(), "bench".to_owned()],
        },
        profile: "quick".to_owned(),
        cases: 2,
        rounds: 9,
        shader_cache: ShaderCache::Warm,
        ruler: "a million multiplications".to_owned(),
        limits: vec![ProcessorLimits {
            threads: 2,
            bytes: 16e9,
            operations: 256e9,
        }],
        settings: Default::default(),
        adapters: vec![
            adapter("cpu", Api::Vulkan),
            adapter("vulkan:lavapipe", Api::Vulkan),
            adapter("gl:softpipe", Api::OpenGl),
            card,
        ],
        absent: Vec::new(),
    }
}

const CASES: [&str; 2] = ["perf/clear/size=256", "perf/<b>&quad/size=256"];

fn text(text: &str) -> Vec<Reason> {
    let text = Some(text).filter(|text| !text.is_empty());
    text.map(|t| Reason::Text(t.to_owned()))
        .into_iter()
        .collect()
}

fn picture(case: &str, adapter: &str, verdict: Verdict, message: &str) -> BenchLine {
    BenchLine::Picture(Picture {
        case: case.to_owned(),
        adapter: adapter.to_owned(),
        verdict,
        asserted: 0.995,
        reasons: text(message),
        work: Some(Work {
            texels: 65536,
            cleared: 131_072,
            ..Work::default()
        }),
        accuracy: vec![accuracy(adapter)],
    })
}

/// The distances of an adapter's pictures: only `cpu` is exact, and the card overflows once.
fn accuracy(adapter: &str) -> Accuracy {
    let mut accuracy = Accuracy {
        channels: 1000,
        ..Accuracy::none(Aspect::Color, Some(ChannelEncoding::Unorm(8)))
    };
    if adapter != "cpu" {
        (0..20).for_each(|_| accuracy.spread.count(1.0));
        (accuracy.mean, accuracy.max) = (0.02, 1.0);
    }
    accuracy.overflow = u64::from(adapter == "vulkan:card");
    accuracy
}

fn round(case: &str, adapter: &str, number: u32, median: f64, gpu: bool) -> BenchLine {
    let jitter = [0.3, -0.2, 0.1, 0.0, -0.4, 0.2, -0.1, 0.4, -0.3][number as usize % 9];
    let middle = median * (1.0 + jitter / 100.0);
    let wall = [0.98, 0.99, 1.0, 1.01, 1.4].map(|f| middle * f).to_vec();
    BenchLine::Round(Round {
        case: case.to_owned(),
        adapter: adapter.to_owned(),
        round: number,
        at: f64::from(number),
        ruler: [0.002, 0.002 * (1.0 + jitter / 1000.0)],
        prepare: 0.02,
        first: middle * 3.0,
        warm_up: 2,
        cpu: wall.iter().map(|t| t / 4.0).collect(),
        gpu: if gpu {
            wall.iter().map(|t| t / 2.0).collect()
        } else {
            Vec::new()
        },
        clock: None,
        read_back: Vec::new(),
        wall,
    })
}

/// Two cases: softpipe's picture is wrong, lavapipe takes 3 ms, `cpu` a given time, the card 0.1 ms.
pub(crate) fn write(folder: &Path, header: &BenchHeader, cpu: f64, softpipe: Verdict) -> Bench {
    let mut writer = BenchWriter::create(folder, header).unwrap();
    for case in CASES {
        for (name, median) in [
            ("cpu", cpu),
            ("vulkan:lavapipe", 3e-3),
            ("vulkan:card", 1e-4),
        ] {
            let line = picture(case, name, Verdict::Pass, "");
            writer.append(&line).unwrap();
            for number in 0..header.rounds {
                let line = round(case, name, number, median, name == "vulkan:card");
                writer.append(&line).unwrap();
            }
        }
        let line = picture(case, "gl:softpipe", softpipe, "texel (1, 2) is <wrong>");
        writer.append(&line).unwrap();
        if softpipe == Verdict::Pass {
            for number in 0..header.rounds {
                writer
                    .append(&round(case, "gl:softpipe", number, 0.01, false))
                    .unwrap();
            }
        }
    }
    Bench::read(folder).unwrap()
}

fn page(path: &Path) -> String {
    let html = fs::read_to_string(path).unwrap();
    let body = html.strip_prefix("<!DOCTYPE html>").unwrap();
    // Elements without content are not closed in HTML; the rest is well-formed.
    let xml = body.replace("<br>", "<br/>").replace("<wbr>", "<wbr/>");
    let closed = |part: &str| part.replacen('>', "/>", 1);
    let mut parts = xml.split("<meta ");
    let mut xml = parts.next().unwrap().to_owned();
    for part in parts {
        xml.push_str("<meta ");
        xml.push_str(&closed(part));
    }
    Document::parse(&xml).unwrap();
    assert!(!html.contains("<script") && !html.contains("http-equiv=\"refresh\""));
    html
}

/// The pages of a bench, and of its comparison with a slower one.
pub(crate) fn pages(folder: &Path) -> [PathBuf; 2] {
    let before = write(&folder.join("before"), &header(), 2e-3, Verdict::Pass);
    let after = write(&folder.join("after"), &header(), 2.2e-3, Verdict::Fail);
    let found = diff(&before, &after, Time::Wall);
    let page = write_bench(&folder.join("after")).unwrap();
    [
        page.html,
        write_diff(&folder.join("diff.html"), &found).unwrap(),
    ]
}

#[test]
fn the_page_keeps_software_and_hardware_apart() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &header(), 2e-3, Verdict::Fail);
    let written = write_bench(folder.path()).unwrap();
    let html = page(&written.html);
    let software = html.find("Software adapters, wall time").unwrap();
    let hardware = html.find("Hardware adapters, wall time").unwrap();
    let ruler = html.find("id=\"ruler\"").unwrap();
    // The chart and its legend come first.
    let tables = &html[software..];
    let card = software + tables.find("vulkan:<wbr>card").unwrap();
    assert!(software < hardware && hardware < card && card < ruler);
    assert!(html[software..hardware].contains("2.000 ms"));
    assert!(!html[software..hardware].contains("100.0 µs"));
    assert!(html.contains("perf/&lt;b&gt;&amp;quad/size=256") && !html.contains("<b>&quad"));
    assert!(html.contains("texel (1, 2) is &lt;wrong&gt;"));
    assert!(
        html.contains("2 pictures</b>") || html.contains("2 pictures wrong"),
        "counted"
    );
    assert!(html.contains("<path class=\"band\"") && html.contains("<svg class=\"strip\""));
}

/// The part of a page between two of its texts.
fn part<'h>(html: &'h str, from: &str, to: &str) -> &'h str {
    let start = html.find(from).unwrap();
    let end = start + html[start..].find(to).unwrap();
    &html[start..end]
}

/// The panels of the chart: the title and the rest of each.
fn panels(html: &str) -> Vec<(&str, &str)> {
    let chart = part(html, "<section id=\"drivers\">", "</section>");
    let figures = chart.split("<figcaption class=\"head\">").skip(1);
    figures
        .map(|panel| panel.split_once("</figcaption>").unwrap())
        .collect()
}

#[test]
fn the_page_opens_with_a_chart_that_has_every_adapter_and_ends_with_the_ruler() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &header(), 2e-3, Verdict::Fail);
    let html = page(&write_bench(folder.path()).unwrap().html);
    let order = ["drivers", "cases", "adapters", "about", "ruler"]
        .map(|id| html.find(&format!("<section id=\"{id}\">")).unwrap());
    assert!(order.is_sorted(), "{order:?}");
    assert!(order[0] < html.find("wall time per frame").unwrap());
    let command = html.find("<dt>Command</dt>").unwrap();
    assert!(order[3] < command && command < order[4]);

    let panels = panels(&html);
    let titles: Vec<&str> = panels.iter().map(|(title, _)| *title).collect();
    assert_eq!(titles, ["Clear, 1 case", "&lt;b&gt;&amp;quad, 1 case"]);
    for (_, panel) in &panels {
        let marks = panel.matches("class=\"mark ").count();
        let rings = panel.matches("class=\"ring\"").count();
        assert_eq!((marks, rings), (3, 1), "{panel}");
        for adapter in ["cpu", "vulkan:lavapipe", "vulkan:card"] {
            assert!(panel.contains(&format!(">{adapter}</text>")), "{panel}");
        }
    }
    // 3 ms for 131,072 cleared texels; the card has timestamps, which are half of its wall time.
    let hovers = [
        "<title>cpu: 15.26 ms per megatexel; error exact</title>",
        "<title>vulkan:lavapipe: 22.89 ms per megatexel; error 0.02 / 1 / 1 codes</title>",
        "<title>vulkan:card: 381.5 µs per megatexel; error 0.02 / 1 / 1 codes, 1 overflow</title>",
    ];
    for hover in hovers {
        assert!(panels[0].1.contains(hover), "{hover}: {}", panels[0].1);
    }
    // An adapter without a time has no mark, and the legend says so.
    let legend = part(&html, "<p class=\"legend\">", "<div class=\"charts\">");
    assert_eq!(legend.matches("class=\"keymark\"").count(), 4);
    assert!(legend.contains("gl:<wbr>softpipe<small> not timed</small>"));
    assert_eq!(legend.matches("not timed").count(), 1);
}

#[test]
fn marks_are_means_over_the_cases_that_all_adapters_have() {
    let folder = tempfile::tempdir().unwrap();
    let mut writer = BenchWriter::create(folder.path(), &header()).unwrap();
    let timed = [
        ("perf/quad/size=1", "cpu", 1e-3),
        ("perf/quad/size=1", "vulkan:lavapipe", 2e-3),
        ("perf/quad/size=2", "cpu", 4e-3),
        ("perf/quad/size=2", "vulkan:lavapipe", 8e-3),
        // Only one adapter has this case, so it does not slow its mark down.
        ("perf/quad/size=3", "cpu", 1.0),
    ];
    for (case, adapter, median) in timed {
        let line = picture(case, adapter, Verdict::Pass, "");
        writer.append(&line).unwrap();
        writer
            .append(&round(case, adapter, 0, median, false))
            .unwrap();
    }
    let html = page(&write_bench(folder.path()).unwrap().html);
    let panels = panels(&html);
    assert_eq!(panels.len(), 1);
    assert_eq!(panels[0].0, "Fill, 2 cases");
    // The geometric means are 2 ms and 4 ms for 65,536 texels, and the jitter of round 0 adds 0.3 %.
    for hover in ["cpu: 30.61 ms per", "vulkan:lavapipe: 61.22 ms per"] {
        assert!(panels[0].1.contains(hover), "{hover}: {}", panels[0].1);
    }
}

#[test]
fn a_bench_of_an_older_version_has_no_chart_and_says_why() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &header(), 2e-3, Verdict::Pass);
    let path = folder.path().join("bench.jsonl");
    let lines = fs::read_to_string(&path).unwrap();
    let old = lines.lines().map(|line| {
        let mut line: serde_json::Value = serde_json::from_str(line).unwrap();
        if let Some(picture) = line.get_mut("picture").and_then(|p| p.as_object_mut()) {
            assert!(picture.remove("accuracy").is_some() && picture.remove("work").is_some());
        }
        line.to_string() + "\n"
    });
    let old: String = old.collect();
    fs::write(&path, old).unwrap();
    let html = page(&write_bench(folder.path()).unwrap().html);
    let chart = part(&html, "<section id=\"drivers\">", "</section>");
    assert!(chart.contains("An older version recorded this bench") && !chart.contains("<svg"));
    assert!(html.contains("Software adapters, wall time per frame"));
}

/// Bencher's schema: an object of objects of metrics, each with a value and two optional bounds.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Metric {
    value: f64,
    lower_value: Option<f64>,
    upper_value: Option<f64>,
}

/// `BenchmarkResult` of github-action-benchmark.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ActionResult {
    name: String,
    value: f64,
    range: Option<String>,
    unit: String,
    extra: Option<String>,
}

#[test]
fn files_for_dashboards_have_the_published_shape() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &header(), 2e-3, Verdict::Fail);
    let written = write_bench(folder.path()).unwrap();
    let text = fs::read(&written.bencher).unwrap();
    let metrics_of: BTreeMap<String, BTreeMap<String, Metric>> =
        serde_json::from_slice(&text).unwrap();
    assert_eq!(metrics_of.len(), 6, "a wrong picture has no time");
    let metrics = &metrics_of["perf/clear/size=256 vulkan:lavapipe"];
    let latency = &metrics["latency"];
    assert!((latency.value - 3e6).abs() < 1.0, "{}", latency.value);
    let (low, high) = (latency.lower_value.unwrap(), latency.upper_value.unwrap());
    assert!(low < latency.value && latency.value < high && high < 3.1e6);
    assert!(!metrics.contains_key("gpu-time"));
    assert!(metrics_of["perf/clear/size=256 vulkan:card"].contains_key("gpu-time"));
    for (name, measures) in &metrics_of {
        assert!(name.len() <= 1024 && measures.keys().all(|m| m.len() <= 64));
    }

    let text = fs::read(&written.action).unwrap();
    let results: Vec<ActionResult> = serde_json::from_slice(&text).unwrap();
    assert_eq!(results.len(), 6);
    let cpu = results
        .iter()
        .find(|r| r.name == "perf/clear/size=256 cpu")
        .unwrap();
    assert!((cpu.value - 2e6).abs() < 1.0 && cpu.unit == "ns");
    assert!(cpu.range.as_ref().unwrap().starts_with("± "));
    let extra = cpu.extra.as_ref().unwrap();
    assert!(
        extra.starts_with("9 rounds, 45 samples, 18 discarded as warm-up"),
        "{extra}"
    );
}

#[test]
fn the_table_ranks_within_a_kind() {
    let folder = tempfile::tempdir().unwrap();
    let bench = write(folder.path(), &header(), 3.003e-3, Verdict::Pass);
    let text = bench_table(
        &bench,
        TableOptions {
            width: 200,
            color: false,
        },
    );
    let rank = |adapter: &str, from: &str| {
        let part = text.split(from).nth(1).unwrap();
        let cells = |line: &str| {
            line.split('│')
                .map(|c| c.trim().to_owned())
                .collect::<Vec<_>>()
        };
        let mut rows = part.lines().map(cells);
        let row = rows
            .find(|r| r.get(3).is_some_and(|c| c == adapter))
            .unwrap();
        row[2].clone()
    };
    // 0.1 % apart, which cannot be distinguished; softpipe is third.
    assert_eq!(rank("vulkan:lavapipe", "Software"), "1");
    assert_eq!(rank("cpu", "Software"), "1");
    assert_eq!(rank("gl:softpipe", "Software"), "3");
    assert_eq!(rank("vulkan:card", "Hardware"), "1");
    assert!(text.ends_with('\n'));
}

#[test]
fn a_diff_lists_what_is_worse() {
    let folders = [(); 3].map(|()| tempfile::tempdir().unwrap());
    let before = write(folders[0].path(), &header(), 2e-3, Verdict::Pass);
    let same = write(folders[1].path(), &header(), 2e-3, Verdict::Pass);
    let unchanged = diff(&before, &same, Time::Wall);
    assert!(!unchanged.worse() && unchanged.notes.is_empty());
    let undecided = OutcomeCounts {
        undecided: 8,
        ..OutcomeCounts::default()
    };
    assert_eq!(unchanged.counts(), undecided);

    let mut other = header();
    other.adapters[1].info.driver_version = "26.0.0".to_owned();
    other.ruler = "another".to_owned();
    let after = write(folders[2].path(), &other, 2.2e-3, Verdict::Fail);
    let found = diff(&before, &after, Time::Wall);
    assert_eq!((found.counts().slower, found.counts().faster), (2, 0));
    let slower = found
        .changes
        .iter()
        .find(|c| c.outcome == Conclusion::Slower)
        .unwrap();
    assert_eq!(slower.adapter, "cpu");
    assert!((slower.ratio - 1.1).abs() < 0.005 && slower.ruled.is_none());
    assert_eq!(found.gone.len(), 2);
    assert!(
        found
            .gone
            .iter()
            .all(|g| g.worse && g.is_missing_after && g.why.contains("fail"))
    );
    let notes = found.notes.join("\n");
    assert!(
        notes.contains("26.0.0") && notes.contains("rulers differ"),
        "{notes}"
    );
    assert!(
        diff(&after, &before, Time::Wall)
            .gone
            .iter()
            .all(|g| !g.worse)
    );
    assert_eq!(diff(&after, &before, Time::Wall).counts().faster, 2);
    // Only the card has GPU times, and no ruler applies to them.
    let gpu = diff(&before, &same, Time::Gpu);
    assert!(gpu.changes.len() == 2 && gpu.changes.iter().all(|c| c.ruled.is_none()));

    let mut incomplete = same;
    incomplete.truncated = true;
    let notes = |after: &Bench| diff(&before, after, Time::Wall).notes;
    assert_eq!(
        notes(&incomplete),
        ["The file of the second bench ends within a line."]
    );
    incomplete.records[0].rounds.pop();
    assert_eq!(
        notes(&incomplete),
        ["The second bench is incomplete: it lacks 1 round."]
    );

    let text = diff_table(
        &found,
        TableOptions {
            width: 160,
            color: false,
        },
    );
    assert!(text.contains("2 slower, 0 faster, 4 undecided"), "{text}");
    let software = text.find("Software, wall times").unwrap();
    let hardware = text.find("Hardware, wall times").unwrap();
    assert!(!text[software..hardware].contains("vulkan:card"));
    let json: serde_json::Value = serde_json::to_value(&found).unwrap();
    assert_eq!(json["changes"].as_array().unwrap().len(), 6);

    let path = folders[0].path().join("diff.html");
    let html = page(&write_diff(&path, &found).unwrap());
    assert!(html.contains("2 slower; 2 no longer right; 4 of 6 comparisons cannot tell."));
}

#[test]
fn a_bench_that_was_cut_short_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let mut writer = BenchWriter::create(folder.path(), &header()).unwrap();
    writer
        .append(&picture(CASES[0], "cpu", Verdict::Pass, ""))
        .unwrap();
    for number in 0..3 {
        writer
            .append(&round(CASES[0], "cpu", number, 1e-3, false))
            .unwrap();
    }
    let ended = Ended {
        case: CASES[0].to_owned(),
        adapter: "cpu".to_owned(),
        verdict: Verdict::Crash,
        reasons: text("signal 11"),
    };
    writer.append(&BenchLine::Ended(ended)).unwrap();
    let written = write_bench(folder.path()).unwrap();
    let html = page(&written.html);
    assert!(
        html.contains("Incomplete") && html.contains("signal 11"),
        "{html}"
    );
    let bench = Bench::read(folder.path()).unwrap();
    // Seven pairs were never begun.
    assert_eq!(bench.missing(), 7 * 9);
    let text = bench_table(&bench, TableOptions::default());
    assert!(text.contains("63 rounds missing"), "{text}");
}
