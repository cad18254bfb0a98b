//! The matrix of areas and adapters, and the order of a run's page.

use crate::synthetic::{self, adapter, header};
use etalon_frame::Api;
use etalon_record::{Expected, Record, Run, RunWriter, Verdict};
use etalon_report::{NewsEntry, RunNews, RunReport, Since, write};
use roxmltree::{Document, Node};
use std::fs;
use std::path::Path;

/// Twenty adapters of four APIs and five drivers.
fn adapters() -> Vec<(String, Api)> {
    let apis = [
        ("vulkan", Api::Vulkan),
        ("gl", Api::OpenGl),
        ("gl:es", Api::OpenGlEs),
        ("wgpu:vulkan", Api::WebGpu),
    ];
    let drivers = [
        "lavapipe",
        "swiftshader",
        "llvmpipe@24.1",
        "softpipe",
        "zink",
    ];
    let of_api = |(way, api): (&str, Api)| drivers.map(|driver| (format!("{way}:{driver}"), api));
    apis.into_iter().flat_map(of_api).collect()
}

/// A run in which each adapter has one verdict more than the one before it has: 2 unexpected and 3 known failures,
/// 4 cases that it draws right, 5 that it cannot draw, in each of three areas.
pub(crate) fn write_twenty(folder: &Path) {
    let names = adapters();
    let adapters = names.iter().map(|(name, api)| adapter(name, *api));
    let mut writer = RunWriter::create(folder, &header(3 * 14, adapters.collect())).unwrap();
    for (name, _) in &names {
        for area in ["blend", "depth", "multisample"] {
            for number in 0..14 {
                let verdict = match number {
                    0..5 => Verdict::Fail,
                    5..9 => Verdict::Pass,
                    _ => Verdict::NotSupported,
                };
                let file = ["compare", "states/several-draws"][number % 2];
                let id = format!("{area}/{file}/number={number:02}");
                let mut record = Record::new(&id, name, verdict);
                if (2..5).contains(&number) {
                    let reason = "a known bug".to_owned();
                    record.expected = Some(Expected { reason });
                }
                writer.append(&record).unwrap();
            }
        }
    }
}

/// The page of the run, and the page of its details.
fn pages(folder: &Path) -> [String; 2] {
    write(folder).unwrap();
    ["index.html", "details.html"].map(|name| fs::read_to_string(folder.join(name)).unwrap())
}

/// The tables of a class, as XML.
fn tables(html: &str, class: &str) -> Vec<String> {
    let start = format!("<table class=\"{class}");
    let tables = html.match_indices(&start).map(|(offset, _)| {
        let (table, _) = html[offset..].split_once("</table>").unwrap();
        format!("{}</table>", table.replace("<wbr>", ""))
    });
    tables.collect()
}

fn text(node: Node<'_, '_>) -> String {
    node.descendants()
        .filter(|n| n.is_text())
        .filter_map(|n| n.text())
        .collect()
}

/// The elements below a node by name.
fn below<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> Vec<Node<'a, 'i>> {
    node.descendants()
        .filter(|n| n.has_tag_name(name))
        .collect()
}

#[test]
fn a_cell_is_a_number_and_a_bar() {
    let [twenty, large, verdicts] = [(); 3].map(|()| tempfile::tempdir().unwrap());
    write_twenty(twenty.path());
    synthetic::write(large.path(), 1);
    crate::verdicts::every_verdict(verdicts.path());
    for folder in [&twenty, &large, &verdicts] {
        let found: Vec<String> = pages(folder.path())
            .iter()
            .flat_map(|html| tables(html, "matrix"))
            .collect();
        assert_eq!(found.len(), 2);
        for table in found {
            let table = Document::parse(&table).unwrap();
            let [cells, heads] = ["td", "th"].map(|name| below(table.root_element(), name));
            assert!(cells.len() >= 4);
            for cell in cells {
                let shown = text(cell);
                assert!(shown == "–" || shown.parse::<u64>().is_ok(), "{shown}");
                let parts = cell.descendants().skip(1).filter(Node::is_element);
                let parts: Vec<&str> = parts.map(|n| n.tag_name().name()).collect();
                assert!(
                    [&["a", "i"][..], &["i"], &[]].contains(&&*parts),
                    "{parts:?}"
                );
                // The words are there, but not in the way.
                assert!(
                    cell.attribute("title")
                        .is_some_and(|words| words.contains(' '))
                );
            }
            for head in heads {
                assert!(head.has_attribute("scope"), "{}", text(head));
            }
        }
    }
}

#[test]
fn the_number_counts_new_failures_or_else_known_ones() {
    let folder = tempfile::tempdir().unwrap();
    write_twenty(folder.path());
    let [by_api, by_driver] = &pages(folder.path()).map(|html| tables(&html, "matrix").remove(0));
    let by_api = Document::parse(by_api).unwrap();
    let rows = below(by_api.root_element(), "tr");
    let row = |name: &str| {
        let named = |row: &&Node<'_, '_>| {
            below(**row, "th")
                .first()
                .is_some_and(|th| text(*th) == name)
        };
        **rows
            .iter()
            .filter(named)
            .collect::<Vec<_>>()
            .first()
            .unwrap()
    };
    let area = cells(row("depth"));
    assert_eq!(area.len(), 20);
    for (number, cell) in &area {
        assert_eq!(number, "2");
        assert_eq!(
            cell.attribute("title"),
            Some("2 fail, 4 pass, 5 not supported, 3 fail (expected)")
        );
        let bar = below(*cell, "i")[0].attribute("style");
        assert_eq!(bar, Some("--x:15%;--y:36%;--z:65%"));
    }
    assert_eq!(cells(row("all"))[0].0, "6");

    let groups = |table: &Document<'_>| -> Vec<(String, String)> {
        let heads = below(table.root_element(), "th").into_iter();
        let heads = heads.filter(|th| th.attribute("scope") == Some("colgroup"));
        heads
            .map(|th| (text(th), th.attribute("colspan").unwrap().to_owned()))
            .collect()
    };
    let pairs = |names: &[&str], span: &str| -> Vec<(String, String)> {
        names
            .iter()
            .map(|name| ((*name).to_owned(), span.to_owned()))
            .collect()
    };
    assert_eq!(
        groups(&by_api),
        pairs(&["Vulkan", "OpenGL", "OpenGL ES", "WebGPU"], "5")
    );
    let by_driver = Document::parse(by_driver).unwrap();
    let drivers = ["lavapipe", "swiftshader", "llvmpipe", "softpipe", "zink"];
    assert_eq!(groups(&by_driver), pairs(&drivers, "4"));
}

/// The cells of a row with their texts.
fn cells<'a, 'i>(row: Node<'a, 'i>) -> Vec<(String, Node<'a, 'i>)> {
    let cells = below(row, "td").into_iter();
    cells.map(|cell| (text(cell), cell)).collect()
}

/// The parts of a run's page, by their ids or words, in their order.
const ORDER: [&str; 10] = [
    "Since the last run: ",
    "120 new failures",
    "Known: ",
    "Not drawn: ",
    "id=\"changed\"",
    "id=\"causes\"",
    "id=\"matrix\"",
    "id=\"known\"",
    "id=\"undrawn\"",
    "aria-label=\"Details\"",
];

/// The parts of the page of details, in their order.
const DETAILS: [&str; 6] = [
    "class=\"totals\"",
    "id=\"asserted\"",
    "id=\"by-driver\"",
    "id=\"reasons\"",
    "<section id=\"adapters\"",
    "<section id=\"about\"",
];

#[test]
fn a_page_lists_changed_new_known_and_undrawn_cases() {
    let folder = tempfile::tempdir().unwrap();
    write_twenty(folder.path());
    let run = Run::read(folder.path()).unwrap();
    let entry = |case: &str| NewsEntry {
        case: case.to_owned(),
        adapter: "gl:zink".to_owned(),
        verdict: Verdict::Fail,
        note: "pass before".to_owned(),
    };
    let news = RunNews {
        since: vec![Since {
            adapter: "gl:zink".to_owned(),
            run: Some("run 7".to_owned()),
        }],
        broken: (0..12)
            .map(|n| entry(&format!("depth/compare/number={n:02}")))
            .collect(),
        ..RunNews::default()
    };
    let written = RunReport {
        folder: folder.path(),
        run: &run,
        catalogue: None,
        news: Some(&news),
        deqp: false,
    }
    .write()
    .unwrap();
    let html = fs::read_to_string(written.html).unwrap();
    let (_, body) = html.split_once("<div id=\"report\">").unwrap();
    let places = ORDER.map(|part| body.find(part).unwrap_or_else(|| panic!("{part}")));
    assert!(places.is_sorted(), "{places:?}");
    let details = fs::read_to_string(folder.path().join("details.html")).unwrap();
    let places = DETAILS.map(|part| details.find(part).unwrap_or_else(|| panic!("{part}")));
    assert!(places.is_sorted(), "{places:?}");
    for part in [
        "12 broken, 0 fixed",
        "<h3>12 broken</h3>",
        "7 more",
        "run 7",
        "pass before",
    ] {
        assert!(body.contains(part), "{part}");
    }
    // Without a history, the page speaks of none.
    let html = fs::read_to_string(write(folder.path()).unwrap().html).unwrap();
    assert!(!html.contains("last run"));
}
