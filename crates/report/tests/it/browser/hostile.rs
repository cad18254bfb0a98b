//! Names that try to become something other than text.

use super::driver::Chromium;
use crate::synthetic::{self, adapter, header};
use etalon_frame::{
    Api, Aspect, Contents, Effect, Event, Origin, SceneName, Step, Story, ToldLine,
};
use etalon_record::{Expected, LossKind, ProcessEnd, Reason, Record, RunWriter, Verdict};

/// Texts that a careless page runs as a script, takes as markup, or shows as something else.
const HOSTILE: [&str; 12] = [
    "<script>window.hacked=1</script>",
    "</script><img src=x onerror=window.hacked=2>",
    "\"><svg onload=\"window.hacked=3\">",
    "' onmouseover='window.hacked=4' autofocus onfocus='window.hacked=4",
    "</title></style></textarea></noscript><script>window.hacked=5</script>",
    "<!--<script>window.hacked=6//-->",
    "javascript:window.hacked=7",
    "{{constructor.constructor('window.hacked=8')()}}${window.hacked=8}`",
    "__proto__",
    "\u{202e}gnp.exe\u{2066}\u{200b}",
    "a\nb\tc\u{1b}[31m\u{7}\u{0}d\u{feff}\u{2028}",
    "&lt;b&gt;&#60;script&#62;\\u003cscript\\u003e%3Cscript%3E",
];

pub(super) fn hostile_names_stay_text(chromium: &Chromium) {
    let folder = tempfile::tempdir().unwrap();
    let adapters: Vec<_> = HOSTILE.iter().map(|h| adapter(h, Api::Vulkan)).collect();
    let mut header = header(HOSTILE.len() as u64, adapters);
    let hostile = HOSTILE.join(" ");
    header.provenance.started = hostile.clone();
    header.provenance.command = vec![hostile.clone()];
    header.provenance.machine.cpu = hostile.clone();
    header.provenance.machine.os = hostile.clone();
    header.provenance.commit = Some(hostile.clone());
    header.absent[0].name = hostile.clone();
    header.absent[0].reason = hostile.clone();
    header.absent[0].remedy = hostile.clone();
    for adapter in &mut header.adapters {
        adapter.info.device = hostile.clone();
        adapter.info.driver = hostile.clone();
        adapter.info.driver_version = hostile.clone();
        adapter.info.api_version = hostile.clone();
        adapter.info.backend = hostile.clone();
    }
    let mut writer = RunWriter::create(folder.path(), &header).unwrap();
    let id = |text: &str| format!("{text}/{text}/axis={text}");
    for text in HOSTILE {
        for (column, name) in HOSTILE.iter().enumerate() {
            // Records that pass are not under Findings: only the script shows them.
            let verdict = [Verdict::Fail, Verdict::Crash, Verdict::Pass][column % 3];
            let record = record(&writer, &id(text), name, verdict, &hostile);
            writer.append(&record).unwrap();
        }
    }
    drop(writer);
    let path = etalon_report::write(folder.path()).unwrap().html;

    // The table of cases.
    let page = chromium.open(&path, "#cases");
    page.wait_count("12 of 12 cases");
    let ids: Vec<String> = page.rows();
    for text in HOSTILE {
        assert!(ids.contains(&id(text)), "{text:?} in {ids:?}");
    }
    let heads = page.texts("#case-table thead th");
    assert_eq!(heads[2..], HOSTILE, "the script shows every character");
    let details = chromium.open(&path.with_file_name("details.html"), "");
    let report = page.text("#report") + &details.text("main");
    for text in HOSTILE.iter().filter(|h| !h.contains('\u{0}')) {
        assert!(report.contains(text), "{text:?}");
    }
    let foreign = "document.querySelectorAll('svg:not(.chart), img:not([src^=\"data:image/png\"]), iframe, object, \
                   [onerror], [onload], [onmouseover], [onfocus], [autofocus], a:not([href^=\"#\"]):not([href^=\"details.html#\"]):not([href^=\"index.html\"])').length";
    for page in [&page, &details] {
        assert_eq!(page.eval::<u64>(foreign), 0);
    }
    assert_eq!(
        page.eval::<u64>("document.scripts.length"),
        2,
        "the data and our own"
    );

    // Views of cases, by clicks; every view holds every hostile text as adapter, message and all else.
    for text in [0, 1, 6, 8, 10].map(|i: usize| HOSTILE[i]) {
        let find = format!(
            "[...document.querySelectorAll('#case-table tbody th a')].findIndex(a => \
             decodeURIComponent(a.getAttribute('href').slice(6)) === {})",
            serde_json::to_string(&id(text)).unwrap()
        );
        let index: usize = page.eval(&find);
        page.run("document.querySelector('#wanted')?.removeAttribute('id')");
        page.run(&format!(
            "document.querySelectorAll('#case-table tbody th a')[{index}].id = 'wanted'"
        ));
        page.click("#wanted");
        let title = serde_json::to_string(&id(text)).unwrap();
        page.wait(&format!(
            "document.querySelector('#case-title')?.textContent === {title}"
        ));
        assert_eq!(page.text("#case-title"), id(text));
        let view = page.text("#case");
        for hostile in HOSTILE {
            assert!(
                view.contains(hostile) || hostile.contains('\u{0}'),
                "{hostile:?} for {text:?}"
            );
        }
        let facts = page.texts("#case dd pre");
        assert!(
            facts.contains(&hostile),
            "the script shows every character, {facts:?}"
        );
        assert_eq!(page.eval::<u64>(foreign), 0);
        page.press("Escape");
        page.wait("document.querySelector('#case').hidden");
    }
    // The lists of the filters show the names too.
    for (option, default) in [("#f-on", "any"), ("#f-odd", "–")] {
        page.choose(option, "__pro");
        page.choose(option, default);
    }
    page.click("#f-q");
    page.type_in(HOSTILE[1]);
    page.wait_count("1 of 12 cases");
    // A link to a case that does not exist.
    let linked = chromium.open(&path, &format!("#case={}", HOSTILE[1]));
    assert_eq!(
        linked.text("#case-title"),
        HOSTILE[1],
        "no such case, but its name is text"
    );
    for page in [page, linked] {
        assert!(page.eval::<bool>("window.hacked === undefined && ({}).hacked === undefined"));
        assert!(page.eval::<bool>("Object.keys(Object.prototype).length === 0"));
    }
}

fn record(writer: &RunWriter, id: &str, name: &str, verdict: Verdict, hostile: &str) -> Record {
    let mut record = synthetic::record(writer, id, name, verdict, 1);
    record.reasons = vec![Reason::Text(hostile.to_owned())];
    record.expected = (verdict == Verdict::Fail).then(|| Expected {
        reason: hostile.to_owned(),
    });
    record.process = Some(ProcessEnd {
        kind: LossKind::Garbage,
        exit: Some(1),
        stderr: hostile.to_owned(),
        seconds: 1.0,
        ..ProcessEnd::default()
    });
    record.validation = vec![hostile.to_owned()];
    record.after = HOSTILE.map(str::to_owned).to_vec();
    if verdict == Verdict::Fail {
        record.frame = Some("frames/javascript:window.hacked=9.json".to_owned());
        record.wrong[0].channels[0].attachment = hostile.to_owned();
        record.story = Some(Story {
            told: vec![ToldLine {
                at: hostile.to_owned(),
                operation: hostile.to_owned(),
                detail: hostile.to_owned(),
                citation: Some(hostile.to_owned()),
            }],
            events: vec![Event {
                scene: Some(SceneName::Variant(hostile.to_owned())),
                origin: Origin::Attachment(hostile.to_owned()),
                step: Step::Upload(vec![Contents {
                    attachment: hostile.to_owned(),
                    aspect: Aspect::Stencil,
                    codes: Vec::new(),
                }]),
                effect: Effect::None,
                citation: Some(hostile.to_owned()),
            }],
            ..Story::default()
        });
    }
    record
}
