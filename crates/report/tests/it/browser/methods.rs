//! The page of methods in a browser: legend, slider, enlarged pictures, break points.

use super::driver::{Chromium, Page};
use crate::synthetic;
use etalon_record::{Record, Run, RunWriter};
use image::RgbImage;
use std::fs;
use std::path::{Path, PathBuf};

type Check = fn(&Chromium, &Path);

macro_rules! checks {
    ($($check:ident),+ $(,)?) => { [$((stringify!($check), $check as Check)),+] };
}

/// Every check, with its name.
pub(super) const CHECKS: [(&str, Check); 14] = checks![
    a_sentence_keeps_the_budget,
    the_choice_is_kept_in_the_address,
    a_damaged_address_changes_nothing,
    a_mark_leads_to_its_scene_or_to_its_row,
    a_legend_highlights_its_method,
    a_slider_swaps_pictures_and_moves_the_mark,
    pictures_stand_side_by_side_on_one_scale,
    pictures_are_enlarged_by_click_and_by_keys,
    the_pages_flip_is_that_of_its_authors_code,
    break_points_lead_to_the_pictures_beside_them,
    break_points_are_those_of_the_chosen_device,
    a_narrow_window_does_not_scroll_sideways,
    texts_of_charts_do_not_overlap,
    without_scripts_the_page_says_so,
];

const SIZE: [u32; 2] = [16, 8];

/// The scene for which [`write`] adds pictures of `cpu`.
const WINDOWS: &str = "[data-name='transparency/windows']";

/// As in `crates/truth/tests/truth/distances.rs`.
fn truth(x: u32, y: u32) -> [u8; 3] {
    [(x * 16) as u8, (y * 32) as u8, (x * y * 2) as u8]
}

/// A wrong picture.
fn wrong_picture(x: u32, y: u32) -> [u8; 3] {
    let [r, g, b] = truth(x, y);
    if x >= 8 {
        [255 - r, g, b]
    } else {
        [r, g / 2, b]
    }
}

/// Writes a run with pictures, and its page.
pub(super) fn write(folder: &Path) -> PathBuf {
    let without_pictures = folder.join("plain-methods");
    synthetic::methods::write(&without_pictures);
    let run = Run::read(&without_pictures).unwrap();
    let out = folder.join("methods");
    let mut writer = RunWriter::create(&out, &run.header).unwrap();
    fs::create_dir_all(out.join("pictures")).unwrap();
    let save = |name: &str, color: &dyn Fn(u32, u32) -> [u8; 3]| {
        let picture = RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| image::Rgb(color(x, y)));
        picture.save(out.join("pictures").join(name)).unwrap();
    };
    save("truth.png", &truth);
    save("drawn.png", &wrong_picture);
    save("near.png", &|x, y| truth(x, y).map(|c| c ^ 1));
    // On `cpu`, one method lacks a scene, which then counts for no method.
    let lacks = |r: &Record| r.adapter == "cpu" && r.case.contains("panes/method=moment-based/");
    for record in run.records.into_iter().filter(|r| !lacks(r)) {
        let mut record = record;
        if record.adapter == "vulkan:example-8000" && record.case.contains("weighted-blended") {
            record.measured.as_mut().unwrap().distance.rmse = 0.001;
        }
        if record.adapter == "cpu" && record.case.contains("/windows/") {
            let measured = record.measured.as_mut().unwrap();
            let picture = match measured.method.as_str() {
                "sorted" => "truth.png",
                "front-to-back" => "near.png",
                _ => "drawn.png",
            };
            measured.picture = Some(format!("pictures/{picture}"));
            measured.truth_picture = Some("pictures/truth.png".to_owned());
        }
        writer.append(&record).unwrap();
    }
    drop(writer);
    etalon_report::write(&out).unwrap().methods.unwrap()
}

/// The script and the page that was written say the same at the beginning, and the script keeps any budget.
fn a_sentence_keeps_the_budget(chromium: &Chromium, path: &Path) {
    let written = std::fs::read_to_string(path).unwrap();
    let written: Vec<String> = written
        .split("<p class=\"answer\">")
        .skip(1)
        .map(|part| part.split("</p>").next().unwrap().replace("&amp;", "&"))
        .collect();
    let page = chromium.open(path, "");
    let answers = || -> Vec<String> {
        page.eval("[...document.querySelectorAll('.card .answer')].map(p => p.textContent)")
    };
    assert!(written.len() > 1);
    assert_eq!(answers(), written, "the script says what the page says");
    let count =
        |what: &str| -> u64 { page.eval(&format!("document.querySelectorAll(\"{what}\").length")) };
    let marks = count(".card .marks .mark");
    assert!(marks > 4, "{marks}");
    // No method draws in so short a time.
    set(&page, "most-time", "0");
    assert_eq!(page.text("#budget output[for=most-time]"), "100 µs");
    assert!(
        answers()
            .iter()
            .all(|text| text.starts_with("Within 100 µs at ")),
        "{:?}",
        answers()
    );
    assert!(count(".card .of.beyond") > 0);
    set(&page, "most-time", "$('most-time').max");
    set(&page, "most-error", "0");
    assert_eq!(page.text("#budget output[for=most-error]"), "0");
    assert!(
        answers()
            .iter()
            .all(|text| text.starts_with("Within 0 at "))
    );
    // Another adapter has its own marks.
    set(&page, "most-error", "$('most-error').max");
    let before = answers();
    set(&page, "on", "1");
    assert!(answers().iter().all(|text| text.starts_with("At ")));
    assert_ne!(answers(), before);
}

/// Chooses the stop or option of a control, as a reader does.
fn set(page: &Page<'_>, id: &str, value: &str) {
    page.run(&format!(
        "$('{id}').value = {value}; for (const kind of ['input', 'change']) $('{id}').dispatchEvent(new Event(kind, {{ bubbles: true }}))"
    ));
}

/// Returns the texts of device, size and limits.
fn choice(page: &Page<'_>) -> Vec<String> {
    page.eval(
        "[...['on', 'frame'].map(id => $(id).selectedOptions[0].textContent), ...[...document.querySelectorAll('#budget output')].map(o => o.textContent)]",
    )
}

fn hash(page: &Page<'_>) -> String {
    page.eval("location.hash")
}

fn the_choice_is_kept_in_the_address(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "");
    assert_eq!(hash(&page), "", "nothing is chosen yet");
    let entries = || -> u64 { page.eval("history.length") };
    let before = entries();
    for (id, stop) in [("on", 1), ("most-time", 4), ("most-error", 3)] {
        set(&page, id, &stop.to_string());
    }
    let measured = "#device=vulkan:lavapipe&size=1280x720&time=2ms&error=0.2pct";
    assert_eq!(hash(&page), measured);
    assert_eq!(entries(), before, "Back leaves the page");
    set(&page, "frame", "'computed'");
    set(&page, "texels", "70");
    let [first, second] = [measured, &hash(&page)].map(|hash| {
        let again = chromium.open(path, hash);
        let choice = choice(&again);
        assert_eq!(choice[..1], ["vulkan:lavapipe"]);
        assert_eq!(choice[3..], ["2 ms", "0.2\u{a0}%"]);
        choice
    });
    assert_eq!(first[1], "1280×720");
    assert_eq!(second, choice(&page));
    assert!(hash(&page).contains("&size=1.22MP&"), "{}", hash(&page));
    // A link within the page adds its target.
    page.click("nav a[href='#claims']");
    page.wait("location.hash.endsWith('&error=0.2pct&at=claims')");
    let again = chromium.open(path, &hash(&page));
    let in_view = "(r => r.top < innerHeight && r.bottom > 0)($('claims').getBoundingClientRect())";
    again.wait(in_view);
    // The page that measures in a browser has parameters of its own, and no charts while it draws.
    let other = chromium.open(path, "#methods=transparency");
    set(&other, "most-time", "4");
    assert!(hash(&other).starts_with("#methods=transparency&device=cpu&"));
    other.run("{ $('budget').remove(); follow(); }");
    // A link that names no choice.
    let linked = chromium.open(path, "#claims");
    linked.wait(in_view);
    assert_eq!(hash(&linked), "#claims");
    linked.run("location.hash = '#time=any'");
    linked.wait("document.querySelector('#budget output[for=most-time]').textContent === 'any'");
}

fn a_damaged_address_changes_nothing(chromium: &Chromium, path: &Path) {
    let untouched = choice(&chromium.open(path, ""));
    for damaged in [
        "#device=nothing&size=0x0&time=-1ms&error=NaN&at=nowhere",
        "#device=%E0%A4%A&size=%&time&=error&&at=",
        "#size=1e999MP&size=computed&device=0&device=constructor",
    ] {
        let page = chromium.open(path, damaged);
        assert_eq!(choice(&page), untouched, "{damaged}");
        // An error would end the script, and be one of this call too.
        page.run("follow()");
        page.click("table.sortable thead th");
        page.wait("document.querySelector('th[aria-sort]')");
        assert_eq!(hash(&page), damaged);
    }
}

fn a_mark_leads_to_its_scene_or_to_its_row(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "");
    let target =
        || -> String { page.eval("document.querySelector(':target')?.textContent.trim() ?? ''") };
    let in_view = "(r => r.top > -1 && r.top < innerHeight)(document.querySelector(':target').getBoundingClientRect())";
    let focus = "document.querySelector('.card .marks a').focus()";
    // The page and its script lead to the same places.
    let written = std::fs::read_to_string(path).unwrap();
    let marks = written.split("<g class=\"marks\">").skip(1);
    let links = marks.flat_map(|m| m.split("</g>").next().unwrap().split("href=\"").skip(1));
    let links: Vec<&str> = links.map(|l| l.split('"').next().unwrap()).collect();
    assert_eq!(
        page.eval::<Vec<String>>(
            "[...document.querySelectorAll('.marks a')].map(a => a.getAttribute('href'))"
        ),
        links
    );
    // On the first adapter only one scene counts.
    page.run(focus);
    page.press("Enter");
    page.wait("document.querySelector(':target')");
    assert!(target().starts_with("Windows"), "{}", target());
    page.wait(in_view);
    // On the second one, a mark is the median of two scenes.
    set(&page, "on", "1");
    page.run("scrollTo(0, 0)");
    page.click(".card .marks a .mark");
    page.wait("document.querySelector('th:target')");
    assert_eq!(target(), "alpha-test");
    page.wait(in_view);
}

fn opacity(page: &Page<'_>, class: &str) -> String {
    page.eval(&format!(
        "getComputedStyle(document.querySelector(\"{WINDOWS} .chart g:not(.off) > .of{class}\")).opacity"
    ))
}

fn a_legend_highlights_its_method(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "");
    let [sorted, other] = ["sorted", "unsorted"].map(|method| {
        page.eval::<String>(&format!(
            "'.' + [...[...document.querySelectorAll(\"{WINDOWS} .legend .key\")]\
             .find(k => k.textContent.trim() === {method:?}).classList].find(c => /^m[0-9]+$/.test(c))"
        ))
    });
    let key = format!("{WINDOWS} .legend .key{sorted}");
    assert_eq!(opacity(&page, &other), "1");
    page.hover(&key);
    page.wait(&format!(
        "document.querySelector(\"{key}\").matches(':hover')"
    ));
    assert_eq!(
        (opacity(&page, &sorted), opacity(&page, &other)),
        ("1".into(), "0.1".into())
    );
    page.hover("h1");
    assert_eq!(opacity(&page, &other), "1");
    // Only by keys, and pinned.
    page.run(&format!(
        "document.querySelector(\"{key}\").previousElementSibling.focus()"
    ));
    page.press("Tab");
    assert_eq!(page.focused(), "sorted");
    assert_eq!(opacity(&page, &other), "0.1");
    page.press("Enter");
    page.press("Tab");
    page.press("Tab");
    assert_eq!(
        page.eval::<u64>("document.querySelectorAll('.key[aria-pressed=true]').length"),
        1
    );
    page.run("document.activeElement.blur()");
    assert_eq!(opacity(&page, &other), "0.1", "pinned");
    page.click(&key);
    page.hover("h1");
    page.run("document.activeElement.blur()");
    assert_eq!(opacity(&page, &other), "1");
    // Every method of every scene has its key.
    let unnamed: u64 = page.eval(
        "[...document.querySelectorAll('.scene')].filter(s => [...s.querySelectorAll('.chart .of')]\
         .some(o => ![...s.querySelectorAll('.key')].some(k => [...k.classList].some(c => /^m[0-9]/.test(c) && o.classList.contains(c))))).length",
    );
    assert_eq!(unnamed, 0);
}

fn shown(page: &Page<'_>, what: &str) -> Vec<String> {
    page.eval(&format!(
        "[...document.querySelectorAll(\"{WINDOWS} {what}\")].filter(e => !e.closest('.off')).map(e => e.dataset.at)"
    ))
}

fn a_slider_swaps_pictures_and_moves_the_mark(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "");
    let text = || page.text(&format!("{WINDOWS} .setting output"));
    assert_eq!(text(), "alpha 0.5");
    assert_eq!(shown(&page, ".pictures"), ["2"]);
    let mark = format!(
        "(e => e.getBoundingClientRect().x)(document.querySelector(\"{WINDOWS} .cursor:not(.off)\"))"
    );
    let before: f64 = page.eval(&mark);
    page.run(&format!(
        "document.querySelector(\"{WINDOWS} .setting input\").focus()"
    ));
    page.press("ArrowRight");
    assert_eq!(text(), "alpha 0.7");
    assert_eq!(shown(&page, ".pictures"), ["3"]);
    assert!(
        page.eval::<f64>(&mark) > before,
        "the mark on the curve moves"
    );
    // One group of marks per adapter, all at the same setting.
    let marks = shown(&page, "g.at");
    assert!(
        marks.len() == 4 && marks.iter().all(|m| m == "3"),
        "{marks:?}"
    );
    let name = format!("document.querySelector(\"{WINDOWS} .setting input\").ariaValueText");
    assert_eq!(page.eval::<String>(&name), "alpha 0.7");
    for _ in 0..9 {
        page.press("ArrowLeft");
    }
    assert_eq!(text(), "alpha 0.1");
    // The other scenes stay.
    assert_eq!(
        page.text("[data-name='transparency/intersecting-panes'] .setting output"),
        "alpha 0.5"
    );
}

/// Returns the selector of a method's pictures in [`WINDOWS`].
fn pictures_of(method: &str) -> String {
    format!("{WINDOWS} .pictures:not(.off) [data-method={method}]")
}

/// The pictures of [`WINDOWS`] that are compared.
fn compared(what: &str) -> String {
    format!("{WINDOWS} .pictures:not(.off) .compared {what}")
}

/// Compares the pictures of a method with the truth.
fn choose(page: &Page<'_>, method: &str) {
    let button = format!("{} button", pictures_of(method));
    page.wait(&format!("document.querySelector(\"{button}\")"));
    page.click(&button);
    page.wait(&format!(
        "document.querySelector(\"{button}\").ariaPressed === 'true'"
    ));
}

/// Opens the page where its pictures are compared.
fn with_pictures<'c>(chromium: &'c Chromium, path: &Path) -> Page<'c> {
    let page = chromium.open(path, "");
    page.run(&format!(
        "document.querySelector(\"{}\").scrollIntoView({{block: 'center'}})",
        pictures_of("unsorted")
    ));
    choose(&page, "unsorted");
    page
}

fn pictures_stand_side_by_side_on_one_scale(chromium: &Chromium, path: &Path) {
    let page = with_pictures(chromium, path);
    let boxes = || -> Vec<[f64; 2]> {
        page.eval(&format!(
            "[...document.querySelectorAll(\"{}\")].map(c => c.getBoundingClientRect()).map(r => [r.width, r.top])",
            compared("canvas")
        ))
    };
    for (width, height, least) in [(1366, 768, 256.0), (390, 844, 340.0)] {
        page.resize(width, height);
        page.wait(&format!("innerWidth === {width}"));
        let boxes = boxes();
        assert_eq!(boxes.len(), 4);
        assert!(boxes.iter().all(|b| b[0] >= least), "{boxes:?}");
        assert_eq!(boxes[0][1] == boxes[3][1], width > 400, "{boxes:?}");
    }
    assert_eq!(
        page.eval::<String>(&format!(
            "getComputedStyle(document.querySelector(\"{}\")).imageRendering",
            compared("canvas")
        )),
        "pixelated"
    );
    let brightest = || -> u8 {
        page.eval(&format!(
            "(c => Math.max(...c.getContext('2d').getImageData(0, 0, c.width, c.height).data.filter((_, i) => i % 4 < 3)))(document.querySelector(\"{}\"))",
            compared("[data-mode=difference] canvas")
        ))
    };
    // The largest difference of all methods is white; that of one code is as dark as it is small.
    for (method, largest, code) in [
        ("unsorted", 225, 255),
        ("front-to-back", 1, 1),
        ("sorted", 0, 0),
    ] {
        choose(&page, method);
        let captions = page.texts(&compared("figcaption"));
        assert_eq!(
            captions[..3],
            [
                "truth".to_owned(),
                method.to_owned(),
                format!("difference, white = 225 of 255 codes; here at most {largest}"),
            ]
        );
        assert!(
            captions[3].starts_with("FLIP, white = 1; here 0."),
            "{captions:?}"
        );
        assert_eq!(brightest(), code, "{method}");
    }
    // The method stays at another setting.
    page.run(&format!("show(document.querySelector(\"{WINDOWS}\"), 3)"));
    page.wait(&format!(
        "document.querySelector(\"{}\")",
        compared("figcaption")
    ));
    assert_eq!(page.texts(&compared("figcaption"))[1], "sorted");
}

fn pictures_are_enlarged_by_click_and_by_keys(chromium: &Chromium, path: &Path) {
    let page = with_pictures(chromium, path);
    page.click(&compared("[data-mode=picture]"));
    page.wait("document.querySelector('dialog').open");
    assert_eq!(
        page.text("#viewer-title"),
        "transparency/windows: unsorted at alpha 0.5 on cpu"
    );
    let values = || page.text("dialog .values");
    let values_at = |x: u32, y: u32| {
        let codes = |color: [u8; 3]| color.map(|c| format!("{c:4}")).concat();
        format!(
            "texel {x},{y}\npicture    {}\ntruth      {}\n",
            codes(wrong_picture(x, y)),
            codes(truth(x, y))
        )
    };
    assert!(values().starts_with(&values_at(8, 4)), "{}", values());
    page.press("ArrowRight");
    page.press("ArrowUp");
    assert!(values().starts_with(&values_at(9, 3)), "{}", values());
    assert!(values().contains("difference  -33"), "{}", values());
    assert!(values().contains("etalon explain methods/transparency/windows/method=unsorted/alpha=0.5 --texel 9,3 --adapter cpu"));
    // Below the pointer.
    page.run("{ const c = document.querySelector('dialog canvas'), r = c.getBoundingClientRect(); \
              c.dispatchEvent(new PointerEvent('pointermove', { clientX: r.x + r.width * 2.5 / 16, clientY: r.y + r.height * 6.5 / 8 })); }");
    assert!(values().starts_with(&values_at(2, 6)), "{}", values());
    page.press("3");
    assert_eq!(page.texts("dialog [aria-pressed=true]"), ["difference"]);
    assert!(
        page.text("dialog .scale")
            .contains("225 of 255 codes per channel")
    );
    page.press("4");
    assert!(page.text("dialog .scale").contains("67 pixels per degree"));
    // Texels are visible: a grid between them, at least eight times their size.
    assert!(page.eval::<u64>("document.querySelector('dialog canvas').width") >= 16 * 8);
    page.press("Escape");
    page.wait("!document.querySelector('dialog').open");
    let focused: String = page.eval("document.activeElement.ariaLabel");
    assert_eq!(focused, "Enlarge: picture of unsorted");
    page.press("Tab");
    page.press("Enter");
    page.wait("document.querySelector('dialog').open");
    assert_eq!(page.texts("dialog [aria-pressed=true]"), ["difference"]);
}

/// The mean of the authors' code for these pictures, as in `crates/truth/tests/truth/distances.rs`.
const AUTHORS_MEAN: f64 = 0.7392;

fn the_pages_flip_is_that_of_its_authors_code(chromium: &Chromium, path: &Path) {
    let page = with_pictures(chromium, path);
    let mean = || -> f64 {
        let caption = page.text(&compared("figure:last-child figcaption"));
        let words = caption.split(' ');
        words.filter_map(|w| w.parse().ok()).next_back().unwrap()
    };
    assert!((mean() - AUTHORS_MEAN).abs() < 2e-3, "{}", mean());
    choose(&page, "sorted");
    assert_eq!(mean(), 0.0);
}

fn break_points_lead_to_the_pictures_beside_them(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "");
    page.run("[...document.querySelectorAll('#break-rows tr')].find(r => \
              r.textContent.startsWith('transparency/windows') && r.textContent.includes('weighted-blended'))\
              .querySelectorAll('a[data-go]').forEach((a, i) => { a.id = 'side' + i; })");
    assert_eq!(
        (page.text("#side0"), page.text("#side1")),
        ("0.5".to_owned(), "0.7".to_owned())
    );
    page.click("#side1");
    assert_eq!(shown(&page, ".pictures"), ["3"]);
    assert_eq!(
        page.text(&format!("{WINDOWS} .setting output")),
        "alpha 0.7"
    );
    let in_view = format!(
        "(r => r.top >= 0 && r.top < innerHeight)(document.querySelector(\"{WINDOWS} .pictures:not(.off)\").getBoundingClientRect())"
    );
    page.wait(&in_view);
    page.click("#side0");
    assert_eq!(shown(&page, ".pictures"), ["2"]);
}

fn break_points_are_those_of_the_chosen_device(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "");
    let weighted = || -> [String; 2] {
        page.eval(
            "(row => [row.lastElementChild.innerText, [...row.querySelectorAll('.strip')].filter(s => s.offsetWidth).map(s => s.dataset.on).join()])\
             ([...document.querySelectorAll('#break-rows tr')].find(r => r.textContent.includes('weighted-blended')))",
        )
    };
    let [text, strip] = weighted();
    assert!(text.starts_with("above from 0.5"), "{text}");
    assert_eq!(strip, "0");
    set(&page, "on", "3");
    assert_eq!(weighted(), ["never above 1 %", "3"]);
    assert_eq!(
        page.eval::<String>("document.querySelector('#breaks .cap:not(.off)').textContent"),
        "On vulkan:example-8000."
    );
}

fn a_narrow_window_does_not_scroll_sideways(chromium: &Chromium, path: &Path) {
    let page = with_pictures(chromium, path);
    page.resize(390, 800);
    page.wait("innerWidth === 390");
    let wide: Vec<String> = page.eval(
        "[...document.querySelectorAll('main *')].filter(e => e.getBoundingClientRect().right > innerWidth + 1 && !e.closest('.wide') && !e.closest('.off'))\
         .map(e => e.outerHTML.slice(0, 120))",
    );
    assert_eq!(wide, [] as [&str; 0]);
    // The claims can be read without scrolling sideways.
    let reach: [u64; 2] =
        page.eval("(e => [e.scrollWidth, e.clientWidth])(document.querySelector('#claims .wide'))");
    assert!(reach[0] <= reach[1], "{reach:?}");
}

/// No text of a chart overlaps another or extends beyond the chart.
fn texts_of_charts_do_not_overlap(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "");
    page.resize(1400, 900);
    page.wait("innerWidth === 1400");
    let clashes: Vec<String> = page.eval(
        "[...document.querySelectorAll('svg.chart')].flatMap(svg => { \
         const box = svg.getBoundingClientRect(); \
         const texts = [...svg.querySelectorAll('text')].filter(t => !t.closest('.off')); \
         const rects = texts.map(t => [t.textContent, t.getBoundingClientRect()]); \
         return rects.flatMap(([a, r], i) => [ \
           ...(r.left < box.left - 1 || r.right > box.right + 1 || r.bottom > box.bottom + 1 ? [a + ' is cut'] : []), \
           ...rects.slice(i + 1).filter(([, s]) => r.left + 1 < s.right && s.left + 1 < r.right && r.top + 3 < s.bottom && s.top + 3 < r.bottom).map(([b]) => a + ' over ' + b)]); })",
    );
    assert_eq!(clashes, [] as [&str; 0]);
}

fn without_scripts_the_page_says_so(chromium: &Chromium, path: &Path) {
    let page = chromium.open_without_scripts(path);
    assert!(page.eval::<bool>(&format!(
        "document.querySelector(\"{WINDOWS} .setting input\").disabled"
    )));
    assert!(
        page.eval::<String>("document.body.innerText")
            .contains("Scripts are off")
    );
    assert_eq!(shown(&page, ".pictures"), ["2"]);
}
