//! The pages of a history in a browser.

use super::driver::Chromium;
use crate::history_made::{self, BROKEN, HOSTILE, SLOWER};
use etalon_history::History;
use etalon_record::Labels;

pub(super) fn news_lead_to_cases_runs_and_back(chromium: &Chromium) {
    let folder = tempfile::tempdir().unwrap();
    let database = folder.path().join("etalon.db");
    history_made::write(&database);
    let to = folder.path().join("page");
    let history = History::open_read(&database).unwrap();
    let written = etalon_report::write_history(&history, &Labels::new(), &to, true).unwrap();

    let page = chromium.open(&written.html, "");
    page.wait("performance.getEntriesByName('etalon-ready').length");
    let lines = page.texts("#news li");
    assert!(lines.iter().any(|line| line.contains(BROKEN)), "{lines:?}");
    page.click(&format!("#news a[href='#case={BROKEN}']"));
    page.wait("!document.querySelector('#view').hidden");
    assert_eq!(page.text("#view-title"), BROKEN);
    assert_eq!(page.focused(), "view-title");
    let text = page.text("#view-body");
    for expected in [
        "vulkan:first",
        "vulkan:second",
        "✗ broken",
        "✓ pass → ✗ fail",
        "same driver version",
        "run 4",
        "0404",
    ] {
        assert!(text.contains(expected), "{expected} in {text}");
    }
    // Every drawing has a name, and no link or table is without one. Chromium has no names yet for what it has not
    // laid out because of `content-visibility`, so all of it is laid out first.
    page.run(
        "document.head.append(Object.assign(document.createElement('style'), \
         { textContent: '.course { content-visibility: visible !important }' }))",
    );
    let nameless = "[...document.querySelectorAll('svg[role=img], a, table, summary')]\
                    .filter(e => e.checkVisibility() && !e.computedName).map(e => e.outerHTML.slice(0, 200))";
    assert_eq!(page.eval::<Vec<String>>(nameless), [] as [&str; 0]);
    page.click("#view-body td a[href='#run=5']");
    page.wait("document.querySelector('#view-title').textContent === 'Run 5'");
    let text = page.text("#view-body");
    assert!(
        text.contains("✗ broken: 6 cases") && text.contains("Against"),
        "{text}"
    );
    let job: String = page.eval("document.querySelector('#view-body dd a').href");
    assert_eq!(job, "https://example.org/job/1");

    // By keys: back, search, the first match.
    page.press("Escape");
    page.wait("!document.querySelector('#start').hidden");
    page.press("/");
    assert_eq!(page.focused(), "q");
    page.keys("perf fill");
    page.wait("document.querySelector('#view-state').textContent === '1 case'");
    assert_eq!(page.focused(), "q");
    page.press("Enter");
    assert_eq!(page.focused(), SLOWER);
    page.press("Enter");
    page.wait("document.querySelector('svg.times')");
    let text = page.text("#view-body");
    for expected in [
        "Frame times on vulkan:first",
        "+20 %",
        "the ruler stayed where it was",
        "real",
        "would be found",
    ] {
        assert!(text.contains(expected), "{expected} in {text}");
    }
    page.press("Escape");
    page.wait("!document.querySelector('#start').hidden");

    let adapter = chromium.open(&written.html, "#adapter=vulkan:first");
    adapter.wait("document.querySelectorAll('#view-body tbody tr').length === 5");
    for hash in [
        "#case=nothing",
        "#run=99",
        "#adapter=nobody",
        "#case=%ZZ",
        "#__proto__=1",
    ] {
        let page = chromium.open(&written.html, hash);
        page.wait(
            "document.querySelector('[role=alert]') || !document.querySelector('#start').hidden",
        );
    }

    // Hostile names stay text.
    for hash in ["", "#all-news", "#run=5", "#q=script"] {
        let page = chromium.open(&written.html, hash);
        page.wait("performance.getEntriesByName('etalon-ready').length");
        page.wait("document.body.innerText.includes('window.hacked')");
        assert!(page.eval::<bool>("window.hacked === undefined"));
    }
    for text in HOSTILE {
        let id = format!("{text}/{text}/a={text}");
        let page = chromium.open(&written.html, "");
        page.run(&format!(
            "location.hash = '#case=' + encodeURIComponent({id:?})"
        ));
        page.wait("document.querySelector('svg.strip')");
        assert_eq!(page.text("#view-title"), id);
        assert!(page.eval::<bool>("window.hacked === undefined"));
    }
    let bare = chromium.open_without_scripts(&written.html);
    let text: String = bare.eval("document.body.innerText");
    assert!(
        text.contains("need scripts") && text.contains(BROKEN),
        "{text}"
    );
}
