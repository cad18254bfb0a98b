//! Reports made from run folders: their structure, their size, and what hostile names do to them.

use crate::synthetic::{self, adapter, header};
use etalon_frame::{Accuracy, Api, Aspect, Distance, Story, ToldLine};
use etalon_record::{
    Expected, Measured, Parameter, Reason, Record, Run, RunWriter, Times, Verdict,
};
use etalon_report::{RunReports, TableOptions, table, write};
use roxmltree::{Document, Node};
use std::collections::{BTreeMap, HashSet};
use std::ffi::OsString;
use std::fs;
use std::path::Path;

fn read(written: &RunReports) -> (String, String) {
    (
        fs::read_to_string(&written.html).unwrap(),
        fs::read_to_string(&written.junit).unwrap(),
    )
}

/// One case per verdict on one adapter, and one case each: expected, due, missed, better.
fn every_verdict(folder: &Path) -> Vec<Record> {
    let adapters = vec![adapter("gl:a", Api::OpenGl), adapter("gl:b", Api::OpenGl)];
    let cases = Verdict::ALL.len() as u64 + 4;
    let mut writer = RunWriter::create(folder, &header(cases, adapters)).unwrap();
    let mut records = Vec::new();
    for name in ["gl:a", "gl:b"] {
        for (i, verdict) in Verdict::ALL.into_iter().enumerate() {
            let id = format!("depth/all/verdict={verdict}");
            records.push(synthetic::record(&writer, &id, name, verdict, i as u32));
        }
        let mut expected = Record::new("blend/expected", name, Verdict::Crash);
        expected.expected = Some(Expected {
            reason: "bug 12 of the driver".to_owned(),
        });
        let mut better = Record::new("blend/better", name, Verdict::Pass);
        better.improves = Some(Verdict::Fail);
        let mut failing = Record::new("selftest/due", name, Verdict::Fail);
        failing.due_fail = true;
        let mut missed = Record::new("selftest/missed", name, Verdict::Pass);
        missed.due_fail = true;
        records.extend([expected, better, failing, missed]);
    }
    records.iter().for_each(|r| writer.append(r).unwrap());
    records
}

fn suite<'a>(xml: &'a Document<'_>, name: &str) -> Node<'a, 'a> {
    let is = |n: &Node<'_, '_>| n.has_tag_name("testsuite") && n.attribute("name") == Some(name);
    xml.descendants().find(is).unwrap()
}

fn case<'a>(suite: Node<'a, 'a>, name: &str) -> Node<'a, 'a> {
    let is = |n: &Node<'_, '_>| n.attribute("name") == Some(name);
    suite.children().find(is).unwrap()
}

/// `failure`, `error`, `skipped` or nothing.
fn outcome(case: Node<'_, '_>) -> Option<String> {
    let names = ["failure", "error", "skipped"];
    let found = case
        .children()
        .find(|c| names.contains(&c.tag_name().name()));
    found.map(|c| c.tag_name().name().to_owned())
}

#[test]
fn junit_distinguishes_failures_errors_and_skips() {
    let folder = tempfile::tempdir().unwrap();
    let records = every_verdict(folder.path());
    let (_, junit) = read(&write(folder.path()).unwrap());
    let xml = Document::parse(&junit).unwrap();
    for name in ["gl:a", "gl:b"] {
        let suite = suite(&xml, name);
        assert_eq!(suite.attribute("tests"), Some("20"));
        assert_eq!(suite.attribute("failures"), Some("6"));
        assert_eq!(suite.attribute("errors"), Some("6"));
        for verdict in Verdict::ALL {
            let found = outcome(case(suite, &format!("depth/all/verdict={verdict}")));
            let expected = match verdict {
                Verdict::Fail
                | Verdict::RequiredByCts
                | Verdict::Disputed
                | Verdict::Open
                | Verdict::Flaky => Some("failure"),
                Verdict::NotSupported | Verdict::Skipped => Some("skipped"),
                v if v.is_bad() => Some("error"),
                _ => None,
            };
            assert_eq!(found.as_deref(), expected, "{verdict}");
        }
        assert_eq!(outcome(case(suite, "blend/expected")), None);
        assert_eq!(outcome(case(suite, "selftest/due")), None);
        assert_eq!(outcome(case(suite, "blend/better")), None);
        let missed = outcome(case(suite, "selftest/missed"));
        assert_eq!(missed.as_deref(), Some("failure"));
    }
    let expected = case(suite(&xml, "gl:a"), "blend/expected");
    let text: String = expected.descendants().filter_map(|n| n.text()).collect();
    assert!(text.contains("expected: bug 12"), "{text}");
    let fail = case(suite(&xml, "gl:a"), "depth/all/verdict=fail");
    let text: String = fail.descendants().filter_map(|n| n.text()).collect();
    assert!(text.contains("17.3.4"), "the story is told: {text}");
    assert_eq!(
        outcome(case(suite(&xml, "etalon"), "the run is complete")),
        None
    );
    assert_eq!(records.len(), 2 * 20);
}

/// The HTML of the records of an area that are shown whole, by the case's place in the area and the adapter's column.
fn bodies(folder: &Path, area: usize) -> BTreeMap<String, String> {
    let path = folder.join(format!("records/{area}-pictures.js"));
    let script = fs::read_to_string(path).unwrap();
    let json = script.strip_prefix(&format!("etalonPictures(\"{area}\", "));
    serde_json::from_str(json.unwrap().strip_suffix(");\n").unwrap()).unwrap()
}

/// All scripts with records.
fn scripts(folder: &Path) -> String {
    let files = fs::read_dir(folder.join("records")).unwrap();
    let texts = files.map(|file| fs::read_to_string(file.unwrap().path()).unwrap());
    texts.collect()
}

#[test]
fn a_failing_case_is_its_picture() {
    let folder = tempfile::tempdir().unwrap();
    let records = every_verdict(folder.path());
    let (html, _) = read(&write(folder.path()).unwrap());
    let depth = bodies(folder.path(), 1);
    let mut ids: Vec<&str> = records.iter().map(|r| r.case.as_str()).collect();
    ids.retain(|id| id.starts_with("depth/"));
    ids.sort_unstable();
    ids.dedup();
    for record in records.iter().filter(|r| r.case.starts_with("depth/")) {
        let place = ids.iter().position(|id| *id == record.case).unwrap();
        let column = usize::from(record.adapter == "gl:b");
        let body = depth.get(&format!("{place} {column}"));
        assert!(body.is_some() || !record.verdict.is_bad(), "{record:?}");
        let Some(body) = body.filter(|_| record.verdict == Verdict::Fail) else {
            continue;
        };
        let parts = [
            "class=\"about\"",
            "class=\"violation\"",
            "<figcaption>allowed</figcaption>",
            "<figcaption>drawn</figcaption>",
            "<figcaption>difference</figcaption>",
            "17.3.4",
            "Wrong texels",
            "Commands",
        ];
        let places = parts.map(|part| body.find(part).unwrap_or_else(|| panic!("{part}: {body}")));
        assert!(places.is_sorted(), "{places:?}");
    }
    let all = scripts(folder.path());
    for text in ["bug 12 of the driver", "due to fail", "17.3.4", "sharpness"] {
        assert!(all.contains(text), "{text}");
    }
    assert!(!all.contains("http://") && !all.contains("https://"));
    assert!(!html.contains("http://") && !html.contains("https://"));
    links_lead_somewhere(&html);
    let details = fs::read_to_string(folder.path().join("details.html")).unwrap();
    assert!(details.contains("vulkan:radv"), "the absent adapter");
    links_lead_somewhere(&details);
}

#[test]
fn every_linked_example_has_its_picture() {
    let folder = tempfile::tempdir().unwrap();
    let adapters = vec![adapter("gl:a", Api::OpenGl)];
    let mut writer = RunWriter::create(folder.path(), &header(503, adapters)).unwrap();
    // More failures than an area shows whole; the last of them is the example of another area's.
    for number in 0..502 {
        let id = format!("blend/file-{number:03}/case");
        let mut record = Record::new(&id, "gl:a", Verdict::Fail);
        if number == 501 {
            record = synthetic::record(&writer, &id, "gl:a", Verdict::Fail, 1);
        }
        let reason = "a known bug".to_owned();
        record.expected = Some(Expected { reason });
        writer.append(&record).unwrap();
    }
    let mut record = Record::new("depth/other", "gl:a", Verdict::Fail);
    record.expected = Some(Expected {
        reason: "a known bug".to_owned(),
    });
    record.example = Some("blend/file-501/case".to_owned());
    writer.append(&record).unwrap();
    write(folder.path()).unwrap();
    let blend = bodies(folder.path(), 0);
    assert!(blend.len() < 502, "{}", blend.len());
    assert!(blend["501 0"].contains("<img "));
    assert!(bodies(folder.path(), 1).is_empty(), "the example shows it");
}

/// Every link of the page leads to an element of the page, to a case, or to a filter of cases.
fn links_lead_somewhere(html: &str) {
    let after = |key: &str| -> HashSet<String> {
        let parts = html.split(key).skip(1);
        parts
            .map(|p| p.split('"').next().unwrap().to_owned())
            .collect()
    };
    let (links, ids) = (after("href=\"#"), after("id=\""));
    for link in links.difference(&ids) {
        let views = [
            "case=",
            "q=",
            "on=",
            "area=",
            "reason=",
            "verdict=",
            "unexpected=",
            "gallery=",
        ];
        let leads = link.is_empty() || views.iter().any(|v| link.starts_with(v));
        assert!(leads, "{link}");
        assert!(!link.contains(['<', '>', '"', ' ', '\'']), "{link}");
    }
}

#[test]
fn hostile_names_stay_text() {
    let folder = tempfile::tempdir().unwrap();
    let hostile = "\"><script>alert(1)</script><i class='x' onload=\"y\">&amp;]]>\u{1b}[2J\u{7}";
    let mut header = header(1, vec![adapter(hostile, Api::Vulkan)]);
    header.provenance.started = hostile.to_owned();
    header.provenance.command = vec![hostile.to_owned()];
    header.absent[0].remedy = hostile.to_owned();
    let mut writer = RunWriter::create(folder.path(), &header).unwrap();
    let id = format!("{hostile}/{hostile}/a={hostile}");
    let mut record = synthetic::record(&writer, &id, hostile, Verdict::Fail, 1);
    record.reasons = vec![Reason::Text(hostile.to_owned())];
    record.story = Some(Story {
        told: vec![ToldLine {
            at: hostile.to_owned(),
            operation: hostile.to_owned(),
            detail: hostile.to_owned(),
            citation: Some(hostile.to_owned()),
        }],
        ..Story::default()
    });
    record.wrong[0].channels[0].attachment = hostile.to_owned();
    writer.append(&record).unwrap();
    let (html, junit) = read(&write(folder.path()).unwrap());
    assert_eq!(html.matches("<script>").count(), 1, "our own");
    assert!(!html.contains("<i class='x'"));
    assert!(!html.contains("\"><script"));
    links_lead_somewhere(&html);
    let xml = Document::parse(&junit).unwrap();
    let fails = xml.descendants().filter(|n| n.has_tag_name("failure"));
    assert_eq!(fails.count(), 1);

    let run = Run::read(folder.path()).unwrap();
    let text = table(&run, TableOptions::default());
    assert!(
        !text.contains('\u{1b}') && !text.contains('\u{7}'),
        "{text:?}"
    );
}

#[test]
fn a_report_makes_every_page_and_script_anew() {
    let folder = tempfile::tempdir().unwrap();
    crate::browser::made::write(folder.path());
    let path = |name: &str| folder.path().join(name);
    let evil = "<script>evil</script>";
    fs::create_dir_all(path("cases")).unwrap();
    let planted = [
        ("index.html", evil.to_owned()),
        ("methods.html", evil.to_owned()),
        ("cases/depth.js", "etalonArea(evil)".to_owned()),
        ("cases/other.js", "etalonArea(evil)".to_owned()),
    ];
    // As in a folder from elsewhere, without a list and with one.
    let own = fs::read_to_string(path(".files")).unwrap();
    let mark = own.lines().next().unwrap();
    let names = "run.jsonl\nindex.html\nmethods.html\ncases/other.js\ncases/depth.js\n";
    for list in [None, Some(format!("{mark}\n{names}"))] {
        let _ = fs::remove_file(path(".files"));
        if let Some(list) = &list {
            fs::write(path(".files"), list).unwrap();
        }
        for (name, text) in &planted {
            fs::write(path(name), text).unwrap();
        }
        for name in ["junit.xml", "summary.md", "details.html"] {
            let _ = fs::remove_file(path(name));
        }
        for name in ["results", "records"] {
            let _ = fs::remove_dir_all(path(name));
        }
        write(folder.path()).unwrap();
        assert!(
            !fs::read_to_string(path("index.html"))
                .unwrap()
                .contains("evil")
        );
        for (name, _) in &planted[1..] {
            assert!(!path(name).exists(), "{name} {list:?}");
        }
    }
    // A page that no list names is somebody else's.
    fs::write(path("methods.html"), evil).unwrap();
    let refused = write(folder.path()).unwrap_err().to_string();
    assert!(
        refused.contains("methods.html is not a file of etalon"),
        "{refused}"
    );
}

#[test]
fn a_junit_file_is_well_formed_whatever_a_text_holds() {
    let folder = tempfile::tempdir().unwrap();
    let texts = (0..0x1_1000).filter_map(char::from_u32);
    let texts: Vec<char> = texts
        .filter(|c| !('\u{a0}'..'\u{d000}').contains(c))
        .collect();
    let mut writer = RunWriter::create(
        folder.path(),
        &header(texts.len() as u64, vec![adapter("cpu", Api::Vulkan)]),
    )
    .unwrap();
    for (number, c) in texts.iter().enumerate() {
        let id = format!("a/{number}{c}");
        let mut record = Record::new(&id, "cpu", Verdict::Crash);
        record.reasons = vec![Reason::Text(format!("<{c}>"))];
        writer.append(&record).unwrap();
    }
    let (_, junit) = read(&write(folder.path()).unwrap());
    let xml = Document::parse(&junit).unwrap();
    let errors = xml.descendants().filter(|n| n.has_tag_name("error"));
    assert_eq!(errors.count(), texts.len());
}

#[test]
fn a_record_cannot_name_files_outside_the_folder() {
    let outer = tempfile::tempdir().unwrap();
    fs::write(outer.path().join("secret"), "the secret").unwrap();
    let folder = outer.path().join("run");
    let header = header(1, vec![adapter("cpu", Api::Vulkan)]);
    let mut writer = RunWriter::create(&folder, &header).unwrap();
    let mut record = Record::new("a/b", "cpu", Verdict::Fail);
    record.frame = Some("../secret".to_owned());
    writer.append(&record).unwrap();
    let refused = write(&folder).unwrap_err().to_string();
    assert!(
        refused.contains("run.jsonl:2:") && refused.contains("../secret"),
        "{refused}"
    );
}

#[test]
fn an_empty_run_is_not_green() {
    let folder = tempfile::tempdir().unwrap();
    RunWriter::create(folder.path(), &header(0, Vec::new())).unwrap();
    let (html, junit) = read(&write(folder.path()).unwrap());
    assert!(html.contains("No case was run"));
    assert!(!html.contains("nothing unexpected"));
    links_lead_somewhere(&html);
    let xml = Document::parse(&junit).unwrap();
    let complete = case(suite(&xml, "etalon"), "the run is complete");
    assert_eq!(outcome(complete).as_deref(), Some("error"));
    let text = table(&Run::read(folder.path()).unwrap(), TableOptions::default());
    assert!(text.contains("No case was run"), "{text}");
}

#[test]
fn a_cut_run_says_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let header = header(3, vec![adapter("cpu", Api::Vulkan)]);
    let mut writer = RunWriter::create(folder.path(), &header).unwrap();
    let pass = |n: u32| Record::new(format!("a/{n}"), "cpu", Verdict::Pass);
    writer.append(&pass(0)).unwrap();
    writer.append(&pass(1)).unwrap();
    let path = folder.path().join("run.jsonl");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, &text[..text.len() - 9]).unwrap();
    let (html, junit) = read(&write(folder.path()).unwrap());
    assert!(html.contains("2 of 3 records are missing"));
    assert!(html.contains("The last record was cut off"));
    let xml = Document::parse(&junit).unwrap();
    let complete = case(suite(&xml, "etalon"), "the run is complete");
    assert_eq!(outcome(complete).as_deref(), Some("error"));
    let run = Run::read(folder.path()).unwrap();
    let text = table(&run, TableOptions::default());
    assert!(text.contains("2 of 3 records are missing"), "{text}");
}

#[test]
fn the_table_counts_and_lists() {
    let folder = tempfile::tempdir().unwrap();
    every_verdict(folder.path());
    let run = Run::read(folder.path()).unwrap();
    let text = table(&run, TableOptions::default());
    assert!(!text.contains('\u{1b}'));
    assert!(text.contains("24 unexpected records"), "{text}");
    // Every outcome of a case is counted in one column; the last column has the rate.
    let options = TableOptions {
        width: 200,
        color: false,
    };
    let wide = table(&run, options);
    let row = wide.lines().find(|l| l.starts_with("│ gl:a")).unwrap();
    let cells: Vec<&str> = row.split('│').map(str::trim).collect();
    let counts = cells[2..cells.len() - 2].iter();
    let sum: u64 = counts.filter_map(|c| c.parse::<u64>().ok()).sum();
    assert_eq!(sum, Verdict::ALL.len() as u64 + 4, "{wide}");
    assert!(wide.contains(" skipped "), "{wide}");
    assert!(text.contains("2 improvements"), "{text}");
    assert!(text.contains("depth/all/verdict=crash: Aborted"));
    assert!(text.contains("depth allowed 0x"), "{text}");
    for width in [20, 60, 80] {
        let narrow = table(&run, TableOptions { width, color: true });
        let top = narrow.lines().next().unwrap().chars().count();
        assert!(top <= width.max(40), "{narrow}");
    }
    let colored = table(
        &run,
        TableOptions {
            width: 120,
            color: true,
        },
    );
    assert!(colored.contains("\u{1b}[31m"));
}

#[test]
fn a_large_run_stays_small() {
    let folder = tempfile::tempdir().unwrap();
    let records = synthetic::write(folder.path(), 2);
    assert_eq!(records, synthetic::cases().len() * 2 * 8);
    let (html, junit) = read(&write(folder.path()).unwrap());
    assert!(html.len() < 500_000, "{}", html.len());
    let elements = html.matches('<').count() - html.matches("</").count();
    assert!(elements < 5000, "{elements}");
    links_lead_somewhere(&html);
    assert!(Document::parse(&junit).is_ok());
    let leftovers = fs::read_dir(folder.path()).unwrap();
    let names: Vec<_> = leftovers.map(|e| e.unwrap().file_name()).collect();
    let hidden = |name: &OsString| name.to_string_lossy().starts_with('.');
    let hidden = names.iter().filter(|name| hidden(name));
    assert_eq!(hidden.collect::<Vec<_>>(), [".files"]);
}

#[test]
fn methods_get_a_page_of_charts() {
    let folder = tempfile::tempdir().unwrap();
    let records = synthetic::methods::write(folder.path());
    let written = write(folder.path()).unwrap();
    let page = fs::read_to_string(written.methods.as_ref().unwrap()).unwrap();
    links_lead_somewhere(&page);
    assert_eq!(page.matches("<script").count(), 1, "its own");
    // The elements that need the script say so.
    assert!(page.contains("<noscript>") && page.contains("disabled"));
    assert!(!page.contains("http://") && !page.contains("https://"));
    // Two questions, three scenes on four adapters, and one chart of stability for each scene, since the made-up errors
    // are the same everywhere.
    let charts: Vec<&str> = page.split("<svg class=\"chart").skip(1).collect();
    assert_eq!(charts.len(), 2 + 3 * 4 + 3);
    let place = |text: &str| page.find(text).unwrap_or_else(|| panic!("{text}"));
    let order = [
        "id=\"overview\"",
        "id=\"breaks\"",
        "id=\"q0\"",
        "id=\"claims\"",
    ]
    .map(place);
    assert!(order.is_sorted(), "{order:?}");
    for chart in &charts {
        let chart = chart.split("</svg>").next().unwrap();
        assert!(chart.contains("role=\"img\"") && chart.contains("<title>"));
        let xml = format!("<svg class=\"chart{chart}</svg>");
        assert!(Document::parse(&xml).is_ok(), "{xml}");
    }
    assert_eq!(
        page.matches("Hardware adapters").count(),
        3,
        "never among the others"
    );
    // Every record is in a table, and every scene has its command.
    let rows = |html: &str| html.matches("<tr><th scope=\"row\"").count();
    let tables = page.split("<table class=\"numbers sortable\">").skip(1);
    let of_methods: usize = tables
        .map(|t| rows(t.split("</table>").next().unwrap()))
        .sum();
    assert!(of_methods > 10, "{of_methods} rows of methods and scenes");
    assert_eq!(rows(&page), records + claims(&page) + of_methods);
    assert!(
        page.contains("etalon run &#39;methods/transparency/windows/*&#39;")
            || page.contains("etalon run 'methods/transparency/windows/*'")
    );
    for text in ["above from <b>0.53</b>", "reproduced", "not measured"] {
        assert!(page.contains(text), "{text}");
    }

    let (index, _) = read(&written);
    links_lead_somewhere(&index);
    assert!(index.contains("href=\"methods.html#s"));
    let details = fs::read_to_string(folder.path().join("details.html")).unwrap();
    links_lead_somewhere(&details);
    for text in ["href=\"#accuracy\"", "median frame time"] {
        assert!(details.contains(text), "{text}");
    }
    assert!(index.len() < 200_000, "{}", index.len());
    let text = table(&Run::read(folder.path()).unwrap(), TableOptions::default());
    assert!(
        text.contains("transparency/windows at alpha 0.5 (hardware): depth-peeling 0;"),
        "{text}"
    );
    terminal_and_page_agree(&text, &page);
}

/// The terminal answers each question with the sentences of the page, and keeps the page's order.
fn terminal_and_page_agree(text: &str, page: &str) {
    let order = [
        "Methods: accuracy against time",
        "Break points",
        "Scenes:",
        "Claims",
    ];
    let places = order.map(|title| {
        text.find(title)
            .unwrap_or_else(|| panic!("{title}: {text}"))
    });
    assert!(places.is_sorted(), "{text}");
    let answers: Vec<&str> = page
        .split("<p class=\"answer\">")
        .skip(1)
        .map(|rest| rest.split("</p>").next().unwrap())
        .collect();
    let first = &text[places[0]..places[1]];
    assert_eq!(first.lines().count(), 1 + 2 * (1 + 4) + 1, "{first}");
    for answer in &answers {
        assert!(
            first.contains(&format!("    {answer}\n")),
            "{answer}: {first}"
        );
    }
    assert_eq!(answers.len(), 2, "of the first adapter");
    let breaks = &text[places[1]..places[2]];
    assert!(
        breaks.contains("weighted-blended leaves 1\u{a0}% RMSE at alpha 0.53"),
        "{breaks}"
    );
}

fn claims(page: &str) -> usize {
    page.matches("<td data-head=\"Outcome\" class=\"verdict")
        .count()
}

#[test]
fn hostile_names_of_methods_stay_text() {
    let folder = tempfile::tempdir().unwrap();
    let hostile = "\"><script>alert(1)</script><i class='x' onload=\"y\">&amp;]]>\u{1b}[2J\u{7}";
    let mut header = header(1, vec![adapter(hostile, Api::Vulkan)]);
    header.provenance.command = vec![hostile.to_owned()];
    let mut writer = RunWriter::create(folder.path(), &header).unwrap();
    let [first, second] = [0.1, 2.0].map(|value| {
        let mut record = Record::new(format!("{hostile}/b={hostile}"), hostile, Verdict::Measured);
        record.accuracy = vec![Accuracy {
            channels: 1,
            mean: value,
            max: 1e300,
            ..Accuracy::none(Aspect::Color, None)
        }];
        record.measured = Some(Measured {
            question: hostile.to_owned(),
            scene: hostile.to_owned(),
            method: hostile.to_owned(),
            parameter: Some(Parameter {
                name: hostile.to_owned(),
                value,
            }),
            distance: Distance {
                rmse: value / 10.0,
                ..Distance::default()
            },
            time: Some(Times {
                samples: 1,
                wall: value,
                cpu: 1e300,
                gpu: Some(-1.0),
                interval: None,
            }),
            sizes: Vec::new(),
            cost: None,
            passes: u32::MAX,
            draws: 0,
            fragments: Some(u64::MAX),
            bytes: u64::MAX,
            picture: Some("pictures/secret.png".to_owned()),
            truth_picture: Some(
                "pictures/\"><script>alert(1)</script><i class='x'>.png".to_owned(),
            ),
        });
        record
    });
    writer.append(&first).unwrap();
    writer.append(&second).unwrap();
    let written = write(folder.path()).unwrap();
    let page = fs::read_to_string(written.methods.as_ref().unwrap()).unwrap();
    assert!(!page.contains("<script>alert") && !page.contains("<i class='x'"));
    assert_eq!(page.matches("<script").count(), 1);
    assert!(
        !page.contains("<img "),
        "nothing outside of the folder is read"
    );
    assert!(page.contains("above from <b>"));
    links_lead_somewhere(&page);
    let (index, _) = read(&written);
    assert!(!index.contains("<i class='x'"));
    let text = table(&Run::read(folder.path()).unwrap(), TableOptions::default());
    assert!(
        !text.contains('\u{1b}') && !text.contains('\u{7}'),
        "{text:?}"
    );
}

#[test]
fn pictures_of_methods_are_shown_only_if_they_are_pictures() {
    let folder = tempfile::tempdir().unwrap();
    synthetic::methods::write(folder.path());
    let mut run = Run::read(folder.path()).unwrap();
    let mut writer = RunWriter::create(&folder.path().join("with"), &run.header).unwrap();
    for (record, name) in run
        .records
        .iter_mut()
        .zip(["a.png", "b.png", "c.png", "d.png", "e.png"])
    {
        let measured = record.measured.as_mut().unwrap();
        measured.picture = Some(format!("pictures/{name}"));
        measured.truth_picture = Some("pictures/truth.png".to_owned());
        writer.append(record).unwrap();
    }
    let pictures = folder.path().join("with/pictures");
    fs::create_dir_all(&pictures).unwrap();
    let png = b"\x89PNG\r\n\x1a\nand so on";
    fs::write(pictures.join("truth.png"), png).unwrap();
    fs::write(pictures.join("c.png"), png).unwrap();
    let written = write(&folder.path().join("with")).unwrap();
    let page = fs::read_to_string(written.methods.as_ref().unwrap()).unwrap();
    // The truth is next to every setting, the picture at its own.
    let images = |page: &str| {
        (
            page.matches("<img ").count(),
            page.matches("class=\"shot").count(),
        )
    };
    assert_eq!(images(&page), (6, 1));
    fs::write(pictures.join("c.png"), "<svg onload='alert(1)'>").unwrap();
    let written = write(&folder.path().join("with")).unwrap();
    let page = fs::read_to_string(written.methods.as_ref().unwrap()).unwrap();
    assert_eq!(images(&page), (5, 0), "no picture, but the truth");
}
