//! The page in a browser: opened from the file system, used by clicks and keys.

use super::driver::{Chromium, Page};
use super::made::{self, CASES, CRASH, ODD};
use std::path::Path;

/// A check of the page at a path.
type Check = fn(&Chromium, &Path);

/// Every check, with its name.
pub(super) const CHECKS: [(&str, Check); 8] = [
    (
        "a case shows what it is meant to draw",
        a_case_shows_what_it_is_meant_to_draw,
    ),
    ("a gallery shows an area", a_gallery_shows_an_area),
    (
        "search and filters narrow the cases",
        search_and_filters_narrow_the_cases,
    ),
    (
        "what differs on one adapter only is found",
        what_differs_on_one_adapter_only_is_found,
    ),
    ("a link leads to a case", a_link_leads_to_a_case),
    ("the keyboard suffices", the_keyboard_suffices),
    (
        "a screen reader is told what everything is",
        a_screen_reader_is_told_what_everything_is,
    ),
    (
        "without scripts the page says what is missing",
        without_scripts_the_page_says_what_is_missing,
    ),
];

fn a_case_shows_what_it_is_meant_to_draw(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "#case=depth/compare/compare=less/write=true");
    page.wait("document.querySelector('#meant img')?.naturalWidth === 4");
    assert_eq!(page.text("#case > .about"), "What <b>compares</b>.");
    assert_eq!(
        page.text("#meant .scene"),
        "color: rgba8unorm, 4 by 4\n</script><i>pass 0"
    );
    page.run("for (const d of document.querySelectorAll('#meant details')) d.open = true");
    let folded = page.texts("#meant details");
    for word in [
        "\"compare\": \"less\"",
        "\"write\": true",
        "\"next\": \"equal\"",
    ] {
        assert!(folded[0].contains(word), "{folded:?}");
    }
    assert!(folded[1].contains("@fragment fn fs() {}"), "{folded:?}");
    // Another case of the area needs no further file.
    page.run("location.hash = '#case=depth/compare/compare=equal/write=false'");
    page.wait(
        "document.querySelector('#meant details')?.textContent.includes('\"next\": \"greater\"')",
    );
    // A missing script of an area shows nothing and breaks nothing.
    page.run("location.hash = '#case=stencil/masks/read=2'");
    page.wait("document.querySelector('#meant')?.hidden === true");
}

fn a_gallery_shows_an_area(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "#cases");
    page.wait_count("13 of 13 cases");
    page.click("#galleries a");
    page.wait("document.querySelectorAll('.gallery a').length === 6");
    page.wait("document.querySelector('.gallery img').naturalWidth === 4");
    page.run("document.querySelectorAll('.gallery a')[5].click()");
    page.wait_hash("#case=depth/compare/compare=less/write=true");
    page.run("history.back()");
    page.wait("document.querySelectorAll('.gallery a').length === 6");
    page.press("Escape");
    page.wait("document.querySelector('#case').hidden");
    page.run("location.hash = '#gallery=nothing'");
    page.wait("document.querySelector('#case [role=status]')?.textContent.includes('no pictures')");
}

const MASKS: &str = "stencil/masks/read=2";

fn search_and_filters_narrow_the_cases(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "#cases");
    page.wait_count("13 of 13 cases");
    assert_eq!(page.rows().len(), CASES);

    // All words must occur, in any order; a star stands for anything.
    page.click("#f-q");
    page.type_in("TRUE compare=l");
    page.wait_count("1 of 13 cases");
    assert_eq!(page.rows(), ["depth/compare/compare=less/write=true"]);
    page.wait_hash("#q=TRUE%20compare=l");
    page.click("#f-clear");
    page.wait_count("13 of 13 cases");
    page.click("#f-q");
    page.keys("dep*false");
    page.wait_count("3 of 13 cases");
    // Typed words are one step of the browser's history.
    page.run("history.back()");
    page.wait_count("13 of 13 cases");
    assert_eq!(
        page.eval::<String>("document.querySelector('#f-q').value"),
        ""
    );

    page.click("#f-q");
    page.type_in("assertion");
    page.wait_count("0 of 13 cases: no case fits");
    page.click("#f-messages");
    page.wait_count("1 of 13 cases");
    assert_eq!(page.rows(), [CRASH]);
    page.click("#f-clear");

    page.click("#f-unexpected");
    page.wait_count("3 of 13 cases");
    page.wait_hash("#unexpected=1");
    page.choose("#f-on", "gl:softpipe");
    page.wait_count("1 of 13 cases");
    assert_eq!(page.rows(), [ODD]);
    page.run("history.back()");
    page.click("#f-clear");
    page.choose("#f-verdict", "✗ fail");
    page.wait_count("4 of 13 cases");
    page.choose("#f-on", "cpu");
    page.wait_count("2 of 13 cases");
    page.wait_hash("#verdict=fail&on=cpu");
    page.choose("#f-verdict", "any bad one");
    page.wait_count("1 of 13 cases");
    assert_eq!(
        page.rows(),
        [MASKS],
        "a selftest that fails as due is not bad"
    );
    assert_eq!(
        page.texts("#case-table thead th")[2..],
        ["cpu", "What is wrong"]
    );
    page.wait("document.querySelector('.why').textContent !== ''");
    page.click("#f-clear");
    page.choose("#f-area", "stencil");
    page.wait_count("4 of 13 cases");
    assert!(page.rows().iter().all(|id| id.starts_with("stencil/")));
}

fn what_differs_on_one_adapter_only_is_found(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "#cases");
    page.wait_count("13 of 13");
    page.choose("#f-odd", "gl:softpipe (1)");
    page.wait_count("1 of 13 cases");
    assert_eq!(page.rows(), [ODD]);
    let odd = page.texts("#case-table td.says");
    assert_eq!(odd, ["only gl:softpipe differs: fail"]);
    assert_eq!(page.texts("#case-table td.odd:not(.says)").len(), 1);
    page.wait_hash("#odd=gl:softpipe");
    page.choose("#f-odd", "any one adapter (2)");
    page.wait_count("2 of 13 cases");
    page.choose("#f-odd", "–");
    page.click("#f-disagree");
    page.wait_count("3 of 13 cases");
    page.click("#f-clear");

    let says = |id: &str| -> String {
        page.eval(&format!(
            "[...document.querySelectorAll('#case-table tbody tr')].find(r => \
             r.querySelector('a')?.getAttribute('href') === '#case=' + {id:?}).cells[1].textContent"
        ))
    };
    assert_eq!(says("depth/clip/planes=1"), "split 1:1");
    assert_eq!(says(MASKS), "all agree: fail");
    let text = "all agree: pass; imprecise only on cpu";
    assert_eq!(says("stencil/masks/read=1"), text);
    assert_eq!(says("selftest/told/bug=1"), "due to fail");

    page.click("[data-sort=consensus]");
    page.wait_hash("#sort=consensus");
    assert_eq!(page.rows()[..3], ["depth/clip/planes=1", CRASH, ODD]);
    assert_eq!(
        page.eval::<Vec<String>>(
            "[...document.querySelectorAll('#case-table [aria-sort]')].map(e => e.ariaSort)"
        ),
        ["none", "ascending"]
    );
    page.click("[data-sort=case]");
    page.click("[data-sort=case]");
    page.wait_hash("#sort=-case");
    assert_eq!(
        page.rows()[..2],
        ["selftest/told/bug=1", "stencil/masks/read=3"]
    );
}

fn a_link_leads_to_a_case(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, &format!("#case={CRASH}"));
    page.wait("!document.querySelector('#case').hidden");
    assert_eq!(page.text("#case-title"), CRASH);
    assert_eq!(
        page.eval::<String>("document.title"),
        format!("{CRASH} – etalon")
    );
    assert_eq!(page.focused(), "case-title");
    assert!(!page.eval::<bool>("document.querySelector('#report').checkVisibility()"));
    let text = page.text("#case");
    for expected in [
        "only vulkan:lavapipe differs: crash",
        "died of signal 11 (SIGSEGV), after 750.0 ms",
        "lavapipe: assertion of the shader's stack\nlast line",
        "VUID-vkCmdDraw-None-02699",
        "2 × crash, pass",
        "12.5 ms",
        "2.50 s",
        "differs only here",
        "etalon run blend/order/draws=2 --adapter vulkan:lavapipe",
    ] {
        assert!(text.contains(expected), "{expected} in {text}");
    }
    // The case that must be drawn first.
    page.click(&format!("#case a[href='#case={ODD}']"));
    page.wait_hash(&format!("#case={ODD}"));
    page.wait(&format!(
        "document.querySelector('#case-title').textContent === {ODD:?}"
    ));
    page.click("#case-on");
    page.wait_hash("#case=depth/compare/compare=less/write=false");
    page.run("history.back()");
    page.wait(&format!(
        "document.querySelector('#case-title').textContent === {ODD:?}"
    ));
    page.click("#back");
    page.wait("document.querySelector('#case').hidden");
    page.wait_hash("#cases");
    assert_eq!(
        page.focused(),
        "compare=greater/write=true",
        "where one came from"
    );
    assert_eq!(
        page.eval::<String>("document.title"),
        "3 unexpected – etalon 2026-01-02T03:04:05Z"
    );

    let reason = chromium.open(path, &format!("#case={MASKS}"));
    assert_eq!(reason.text("#case").matches("bug 99").count(), 4);
    // The text was not encoded, so it is used unchanged.
    let unknown = chromium.open(path, "#case=depth/no%2Fsuch%ZZ%3Cb%3E");
    assert_eq!(
        unknown.text("#case [role=alert]"),
        "This run has no case of this name."
    );
    assert_eq!(unknown.text("#case-title"), "depth/no%2Fsuch%ZZ%3Cb%3E");

    let filter = chromium.open(path, "#q=compare&odd=gl:softpipe");
    filter.wait_count("1 of 13 cases");
    assert_eq!(
        filter.eval::<String>("document.querySelector('#f-q').value"),
        "compare"
    );
    let other = chromium.open(
        path,
        "#q=zzz&verdict=nonsense&on=nobody&page=-3&__proto__=1",
    );
    other.wait_count("0 of 13 cases");
    let entry = chromium.open(path, "#findings");
    assert!(!entry.eval::<bool>("document.querySelector('#report').hidden"));
}

fn the_keyboard_suffices(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "");
    page.press("/");
    assert_eq!(page.focused(), "find-q");
    page.type_in("softpipe depth");
    page.press("Enter");
    page.wait_hash("#q=softpipe%20depth");
    page.wait_count("7 of 13 cases");
    assert_eq!(page.texts("#case-table thead th")[2], "gl:softpipe");

    let page = chromium.open(path, "#page=1");
    page.wait_count("13 of 13");
    page.press("Tab");
    assert_eq!(page.focused(), "Skip to the content");
    page.press("Enter");
    assert_eq!(page.focused(), "main");
    page.press("/");
    assert_eq!(page.focused(), "f-q");
    assert_eq!(
        page.eval::<String>("document.querySelector('#f-q').value"),
        ""
    );
    let mut order = Vec::new();
    for _ in 0..13 {
        page.press("Tab");
        order.push(page.focused());
    }
    let expected = [
        "f-messages",
        "f-verdict",
        "f-on",
        "f-area",
        "f-odd",
        "f-unexpected",
        "f-disagree",
        "f-clear",
        "f-groups",
    ];
    assert_eq!(order[..9], expected);
    assert_eq!(
        order[9..12],
        ["Case", "Consensus", "▾ blend/order"],
        "one row for the tabulator"
    );

    page.press("/");
    page.keys("greater");
    page.wait_count("2 of 13 cases");
    page.press("Enter");
    assert_eq!(page.focused(), "compare=greater/write=false");
    page.press("j");
    assert_eq!(page.focused(), "compare=greater/write=true");
    page.press("k");
    page.press("ArrowDown");
    page.press("Enter");
    page.wait_hash(&format!("#case={ODD}"));
    page.wait("document.activeElement.id === 'case-title'");
    page.press("Escape");
    page.wait_hash("#q=greater");
    page.wait("document.activeElement.textContent === 'compare=greater/write=true'");
    page.press("Home");
    assert_eq!(page.focused(), "▾ depth/compare");
    page.press("ArrowLeft");
    assert_eq!(page.rows().len(), 0, "the group is closed");
    assert_eq!(
        page.eval::<String>("document.activeElement.ariaExpanded"),
        "false"
    );
    page.press("Enter");
    assert_eq!(page.rows().len(), 2);
    page.press("Escape");
    assert_eq!(page.focused(), "f-q");
    page.press("Escape");
    page.wait_count("13 of 13");
    page.wait_hash("#cases");
}

fn a_screen_reader_is_told_what_everything_is(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "#cases");
    page.wait_count("13 of 13");
    let nameless = |page: &Page<'_>| -> Vec<String> {
        page.eval(
            "[...document.querySelectorAll('a, button, input, select, summary, table, nav, form, img')]\
             .filter(e => e.checkVisibility() && !e.computedName).map(e => e.outerHTML.slice(0, 200))",
        )
    };
    // Tables in closed details have no name; visible ones must have one.
    assert_eq!(nameless(&chromium.open(path, "")), [] as [&str; 0]);
    assert_eq!(nameless(&page), [] as [&str; 0]);
    let names = "['f-q', 'f-messages', 'f-verdict', 'f-on', 'f-area', 'f-odd', 'f-unexpected', 'f-disagree']\
                 .map(id => document.getElementById(id)).map(e => e.computedRole + ' ' + e.computedName)";
    assert_eq!(
        page.eval::<Vec<String>>(names),
        [
            "searchbox Search",
            "checkbox search messages too",
            "combobox Verdict",
            "combobox On adapter",
            "combobox Area",
            "combobox Differs only on",
            "checkbox unexpected only (3)",
            "checkbox adapters disagree (3 cases)",
        ]
    );
    let table = "[...document.querySelector('#case-table').rows[4].cells].map(c => c.computedRole + ' ' + c.innerText)";
    let cells: Vec<String> = page.eval(table);
    assert!(cells[0].starts_with("rowheader "), "{cells:?}");
    assert!(cells[1].starts_with("cell "), "{cells:?}");
    // A verdict is a word, not only a sign or a colour.
    let words: Vec<String> = page.eval(
        "[...document.querySelectorAll('#case-table td:not(.says)')].map(td => td.querySelector('span').textContent)",
    );
    assert_eq!(words.len(), CASES * made::ADAPTERS.len());
    assert!(words.iter().all(|w| !w.is_empty()));
    let live = "(e => e.computedRole + ' ' + e.ariaLive)(document.querySelector('#count'))";
    assert_eq!(page.eval::<String>(live), "status polite");
    let headless: Vec<String> = page.eval(
        "[...document.querySelectorAll('th')].filter(th => !th.scope && !th.closest('details'))\
         .map(th => th.outerHTML.slice(0, 200))",
    );
    assert_eq!(headless, [] as [&str; 0]);

    let case = chromium.open(path, &format!("#case={CRASH}"));
    case.wait("!document.querySelector('#case').hidden");
    assert_eq!(nameless(&case), [] as [&str; 0]);
    let main = "document.querySelector('#case').computedRole + ' ' + document.querySelector('#case').computedName";
    assert_eq!(case.eval::<String>(main), format!("article {CRASH}"));
}

fn without_scripts_the_page_says_what_is_missing(chromium: &Chromium, path: &Path) {
    let page = chromium.open_without_scripts(path);
    let text: String = page.eval("document.body.innerText");
    for expected in [
        "need scripts",
        "3 new failures",
        "Areas and adapters",
        "masks are known to be wrong, bug 99",
        "What was asserted",
    ] {
        assert!(text.contains(expected), "{expected}");
    }
    assert!(!page.eval::<bool>("document.querySelector('#filter').checkVisibility()"));
}
