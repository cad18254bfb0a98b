//! Names that try to become something other than text.

use super::driver::Chromium;
use crate::synthetic::{self, adapter, header};
use etalon_frame::{
    Api, Aspect, Contents, Effect, Event, Origin, SceneName, Step, Story, ToldLine,
};
use etalon_record::{Expected, LossKind, ProcessEnd, Record, RunWriter, Verdict};

/// Texts that would run as a script, each alone and all of them together.
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
    let all = HOSTILE.join(" ");
    header.started = all.clone();
    header.command = vec![all.clone()];
    header.machine.cpu = all.clone();
    header.machine.os = all.clone();
    header.commit = Some(all.clone());
    header.absent[0].name = all.clone();
    header.absent[0].reason = all.clone();
    header.absent[0].remedy = all.clone();
    for adapter in &mut header.adapters {
        adapter.device = all.clone();
        adapter.driver = all.clone();
        adapter.driver_version = all.clone();
        adapter.api_version = all.clone();
        adapter.backend = all.clone();
    }
    let mut writer = RunWriter::create(folder.path(), &header).unwrap();
    let id = |text: &str| format!("{text}/{text}/axis={text}");
    for text in HOSTILE {
        for (column, name) in HOSTILE.iter().enumerate() {
            // The last kind has no entry under Findings, so the script shows all of it.
            let verdict = [Verdict::Fail, Verdict::Crash, Verdict::Pass][column % 3];
            let record = record(&writer, &id(text), name, verdict, &all);
            writer.append(&record).unwrap();
        }
    }
    drop(writer);
    let path = etalon_report::write(folder.path()).unwrap().html;

    let page = chromium.open(&path, "");
    page.wait_count("12 of 12 cases");
    let ids: Vec<String> = page.rows();
    for text in HOSTILE {
        assert!(ids.contains(&id(text)), "{text:?} in {ids:?}");
    }
    let heads = page.texts("#case-table thead th");
    assert_eq!(heads[2..], HOSTILE.map(|h| h.replace('\u{0}', "")));
    let report = page.text("#report");
    for text in HOSTILE.iter().filter(|h| !h.contains('\u{0}')) {
        assert!(report.contains(text), "{text:?}");
    }
    let foreign = "document.querySelectorAll('svg:not(.chart), img:not([src^=\"data:image/png\"]), iframe, object, \
                   [onerror], [onload], [onmouseover], [onfocus], [autofocus], a:not([href^=\"#\"])').length";
    assert_eq!(page.eval::<u64>(foreign), 0);
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
        let at: usize = page.eval(&find);
        page.run("document.querySelector('#wanted')?.removeAttribute('id')");
        page.run(&format!(
            "document.querySelectorAll('#case-table tbody th a')[{at}].id = 'wanted'"
        ));
        page.click("#wanted");
        let due = serde_json::to_string(&id(text)).unwrap();
        page.wait(&format!(
            "document.querySelector('#case-title')?.textContent === {due}"
        ));
        assert_eq!(page.text("#case-title"), id(text));
        let view = page.text("#case");
        for told in HOSTILE {
            assert!(
                view.contains(told) || told.contains('\u{0}'),
                "{told:?} for {text:?}"
            );
        }
        let facts = page.texts("#case dd pre");
        assert!(
            facts.contains(&all),
            "the script shows every character, {facts:?}"
        );
        assert_eq!(page.eval::<u64>(foreign), 0);
        page.press("Escape");
        page.wait("document.querySelector('#case').hidden");
    }
    for (option, none) in [("#f-on", "any"), ("#f-odd", "–")] {
        page.choose(option, &HOSTILE[8][..5]);
        page.choose(option, none);
    }
    page.click("#f-q");
    page.type_in(HOSTILE[1]);
    page.wait_count("1 of 12 cases");
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

fn record(writer: &RunWriter, id: &str, name: &str, verdict: Verdict, all: &str) -> Record {
    let mut record = synthetic::record(writer, id, name, verdict, 1);
    record.message = all.to_owned();
    record.expected = (verdict == Verdict::Fail).then(|| Expected {
        reason: all.to_owned(),
    });
    record.process = Some(ProcessEnd {
        kind: LossKind::Garbage,
        signal: None,
        exit: Some(1),
        stderr: all.to_owned(),
        seconds: 1.0,
    });
    record.validation = vec![all.to_owned()];
    record.after = HOSTILE.map(str::to_owned).to_vec();
    if verdict == Verdict::Fail {
        record.frame = Some("javascript:window.hacked=9".to_owned());
        record.wrong[0].channels[0].attachment = all.to_owned();
        record.story = Some(Story {
            told: vec![ToldLine {
                at: all.to_owned(),
                operation: all.to_owned(),
                detail: all.to_owned(),
                citation: Some(all.to_owned()),
            }],
            events: vec![Event {
                scene: Some(SceneName::Variant(all.to_owned())),
                origin: Origin::Attachment(all.to_owned()),
                step: Step::Upload(vec![Contents {
                    attachment: all.to_owned(),
                    aspect: Aspect::Stencil,
                    codes: Vec::new(),
                }]),
                effect: Effect::None,
                citation: Some(all.to_owned()),
            }],
            ..Story::default()
        });
    }
    record
}
