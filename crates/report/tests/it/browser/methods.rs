//! The page of methods in a browser: legend, slider, enlarged pictures, break points.

use super::driver::{Chromium, Page};
use crate::synthetic;
use etalon_record::{Run, RunWriter};
use image::RgbImage;
use std::fs;
use std::path::{Path, PathBuf};

type Check = fn(&Chromium, &Path);

/// Every check, with its name.
pub(super) const CHECKS: [(&str, Check); 8] = [
    (
        "a legend highlights its method",
        a_legend_highlights_its_method,
    ),
    (
        "a slider swaps the pictures and moves the mark",
        a_slider_swaps_pictures_and_moves_the_mark,
    ),
    (
        "pictures are enlarged by click and by keys",
        pictures_are_enlarged_by_click_and_by_keys,
    ),
    (
        "a texel is told of in its method's terms",
        a_texel_is_told_of_in_its_methods_terms,
    ),
    (
        "the page's FLIP is that of its authors' code",
        the_pages_flip_is_that_of_its_authors_code,
    ),
    (
        "break points lead to the pictures beside them",
        break_points_lead_to_the_pictures_beside_them,
    ),
    ("breaks at other limits", breaks_at_other_limits),
    (
        "a narrow window and no scripts",
        a_narrow_window_and_no_scripts,
    ),
];

const SIZE: [u32; 2] = [16, 8];

/// The scene of transparency whose pictures there are, of `cpu`.
const WINDOWS: &str = "[data-name='transparency/windows']";

/// As in `crates/truth/tests/truth/distances.rs`.
fn truth(x: u32, y: u32) -> [u8; 3] {
    [(x * 16) as u8, (y * 32) as u8, (x * y * 2) as u8]
}

fn drawn(x: u32, y: u32) -> [u8; 3] {
    let [r, g, b] = truth(x, y);
    if x >= 8 {
        [255 - r, g, b]
    } else {
        [r, g / 2, b]
    }
}

/// Behind the intersecting panes.
const BACKGROUND: [u8; 3] = [230, 230, 217];

/// Their truth in the middle at alpha 0.5: a half of red, a quarter of yellow, an eighth of blue and of what is behind.
const PANES: [u8; 3] = [201, 112, 83];

/// Two samples of the red pane and two of what is behind all panes.
const HALF_COVERED: [u8; 3] = [223, 140, 128];

/// Writes a run with pictures and its page.
pub(super) fn write(folder: &Path) -> PathBuf {
    let plain = folder.join("plain-methods");
    synthetic::methods::write(&plain);
    let run = Run::read(&plain).unwrap();
    let out = folder.join("methods");
    let mut writer = RunWriter::create(&out, &run.header).unwrap();
    fs::create_dir_all(out.join("pictures")).unwrap();
    let save = |name: &str, of: &dyn Fn(u32, u32) -> [u8; 3]| {
        let picture = RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| image::Rgb(of(x, y)));
        picture.save(out.join("pictures").join(name)).unwrap();
    };
    save("truth.png", &truth);
    save("drawn.png", &drawn);
    for (name, middle) in [("panes-truth.png", PANES), ("panes.png", HALF_COVERED)] {
        let picture = RgbImage::from_fn(128, 128, |x, y| {
            image::Rgb(if [x, y] == [64, 64] {
                middle
            } else {
                BACKGROUND
            })
        });
        picture.save(out.join("pictures").join(name)).unwrap();
    }
    for record in run.records {
        let mut record = record;
        if record.adapter == "cpu" && record.case.contains("/intersecting-panes/") {
            let measured = record.measured.as_mut().unwrap();
            measured.picture = Some("pictures/panes.png".to_owned());
            measured.truth = Some("pictures/panes-truth.png".to_owned());
        }
        if record.adapter == "cpu" && record.case.contains("/windows/") {
            let measured = record.measured.as_mut().unwrap();
            let right = measured.method == "sorted";
            let picture = if right { "truth.png" } else { "drawn.png" };
            measured.picture = Some(format!("pictures/{picture}"));
            measured.truth = Some("pictures/truth.png".to_owned());
        }
        writer.append(&record).unwrap();
    }
    drop(writer);
    etalon_report::write(&out).unwrap().methods.unwrap()
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
    // By keys alone, and pinned.
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
    let place = "(e => e.getBoundingClientRect().x)(document.querySelector(\"[data-name='transparency/windows'] .cursor:not(.off)\"))";
    let before: f64 = page.eval(place);
    page.run(&format!(
        "document.querySelector(\"{WINDOWS} .setting input\").focus()"
    ));
    page.press("ArrowRight");
    assert_eq!(text(), "alpha 0.7");
    assert_eq!(shown(&page, ".pictures"), ["3"]);
    assert!(
        page.eval::<f64>(place) > before,
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

const UNSORTED: &str =
    "[data-name='transparency/windows'] .pictures:not(.off) [data-method=unsorted]";

/// Opens the page where its pictures are compared.
fn with_pictures<'c>(chromium: &'c Chromium, path: &Path) -> Page<'c> {
    let page = chromium.open(path, "");
    page.run(&format!(
        "document.querySelector(\"{UNSORTED}\").scrollIntoView({{block: 'center'}})"
    ));
    page.wait(&format!(
        "document.querySelectorAll(\"{UNSORTED} button\").length === 3"
    ));
    page
}

fn pictures_are_enlarged_by_click_and_by_keys(chromium: &Chromium, path: &Path) {
    let page = with_pictures(chromium, path);
    page.click(&format!("{UNSORTED} button[data-mode=picture]"));
    page.wait("document.querySelector('dialog').open");
    assert_eq!(
        page.text("#viewer-title"),
        "transparency/windows: unsorted at alpha 0.5 on cpu"
    );
    let values = || page.text("dialog .values");
    let at = |x: u32, y: u32| {
        let codes = |of: [u8; 3]| of.map(|c| format!("{c:4}")).concat();
        format!(
            "texel {x},{y}\npicture    {}\ntruth      {}\n",
            codes(drawn(x, y)),
            codes(truth(x, y))
        )
    };
    assert!(values().starts_with(&at(8, 4)), "{}", values());
    page.press("ArrowRight");
    page.press("ArrowUp");
    assert!(values().starts_with(&at(9, 3)), "{}", values());
    assert!(values().contains("difference  -33"), "{}", values());
    assert!(values().contains("etalon explain methods/transparency/windows/method=unsorted/alpha=0.5 --texel 9,3 --adapter cpu"));
    // Below the pointer.
    page.run("{ const c = document.querySelector('dialog canvas'), r = c.getBoundingClientRect(); \
              c.dispatchEvent(new PointerEvent('pointermove', { clientX: r.x + r.width * 2.5 / 16, clientY: r.y + r.height * 6.5 / 8 })); }");
    assert!(values().starts_with(&at(2, 6)), "{}", values());
    page.press("3");
    assert_eq!(page.texts("dialog [aria-pressed=true]"), ["difference"]);
    assert!(page.text("dialog .scale").contains("codes per channel"));
    page.press("4");
    assert!(page.text("dialog .scale").contains("67 pixels per degree"));
    // Texels are seen: a grid between them, at eight times their size at least.
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

fn a_texel_is_told_of_in_its_methods_terms(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "");
    let panes = "[data-name='transparency/intersecting-panes']";
    let told = |method: &str| -> String {
        let shot = format!("{panes} .pictures:not(.off) [data-method={method}]");
        page.run(&format!(
            "document.querySelector(\"{shot}\").scrollIntoView({{block: 'center'}})"
        ));
        let button = format!("{shot} button[data-mode=picture]");
        page.wait(&format!("document.querySelector(\"{button}\")"));
        page.click(&button);
        page.wait("document.querySelector('dialog').open");
        let text = page.text("dialog .story");
        page.press("Escape");
        page.wait("!document.querySelector('dialog').open");
        text
    };
    let layers = |notes: [&str; 3], last: &str| {
        let known = [
            "layer 1: depth 0.402, alpha 0.50, 50.0 % of the truth",
            "layer 2: depth 0.500, alpha 0.50, 25.0 % of the truth",
            "layer 3: depth 0.598, alpha 0.50, 12.5 % of the truth",
        ];
        let lines = known.iter().zip(notes);
        let mut text: Vec<String> = lines.map(|(l, n)| format!("{l}{n}")).collect();
        text.extend((!last.is_empty()).then(|| last.to_owned()));
        text.join("\n")
    };
    assert_eq!(told("sorted"), layers(["", "", ""], ""));
    assert_eq!(
        told("weighted-blended"),
        layers(
            [
                "; weight 321: 46.4 % of the colour",
                "; weight 188: 27.1 % of the colour",
                "; weight 97.1: 14.0 % of the colour",
            ],
            "revealage: 12.5 % of the background",
        )
    );
    // Two panes turned by 45 degrees and one that is not, all wide enough for the middle.
    let listed = told("linked-lists");
    let start = layers(["; in the list"; 3], "");
    assert!(
        listed.starts_with(&start) && listed.ends_with(" fragments, 131072 nodes"),
        "{listed}"
    );
    // A pool without room: the drawn colour tells which layer is missing, where but one choice gives it.
    let full = |drawn: &str| -> String {
        page.eval(&format!(
            "(f => {{ const found = layersAt(f, compared(f), 64, 64), pool = () => ({{ nodes: 3, fragments: 9 }}); \
             const [notes, last] = TELL['linked-lists']({{ ...found, pool, drawn: {drawn} }}); \
             return [...notes, last].join('|'); }})(document.querySelector(\"{panes} .pictures:not(.off) [data-method=linked-lists]\"))"
        ))
    };
    // Red and blue without the yellow between them.
    assert_eq!(
        full("[178, 102, 128]"),
        "in the list|found no room|in the list|9 fragments, 3 nodes"
    );
    assert!(full("[0, 0, 0]").contains("doesn't tell which layers found no room"));
    // A quarter of a layer's own absorbance counts as in front of it.
    assert_eq!(
        told("moment-based"),
        layers(
            [
                "; transmittance 0.841 told, 1.000 exact: 50.0 % of the colour",
                "; transmittance 0.420 told, 0.500 exact: 25.0 % of the colour",
                "; transmittance 0.210 told, 0.250 exact: 12.5 % of the colour",
            ],
            "absorbance: 12.5 % of the background left",
        )
    );
    assert_eq!(
        told("depth-peeling"),
        layers(
            ["; peel 1 of 4", "; peel 2 of 4", "; peel 3 of 4"],
            "every layer taken",
        )
    );
    assert_eq!(
        told("dual-depth-peeling"),
        layers(
            [
                "; peel 1 of 2, front",
                "; peel 2 of 2, both",
                "; peel 1 of 2, back",
            ],
            "every layer taken",
        )
    );
    assert_eq!(
        told("unsorted"),
        layers(
            [
                "; drawn 2 of 3",
                "; drawn 1 of 3",
                "; drawn 3 of 3, rejected behind layer 1",
            ],
            "",
        )
    );
    let asked = "; alpha asks for 2.0 of 4 samples, seen in";
    assert_eq!(
        told("alpha-to-coverage"),
        layers(
            [2, 0, 0]
                .map(|n| format!("{asked} {n}"))
                .each_ref()
                .map(String::as_str),
            "the background: seen in 2 of 4 samples",
        )
    );
    // Fewer peels than layers lose the farthest, from both sides those in the middle.
    let few = |method: &str, passes: u32| -> String {
        page.eval(&format!(
            "(f => {{ f.dataset.passes = {passes}; return story(f, compared(f), 64, 64).join('|'); }})\
             (document.querySelector(\"{panes} .pictures:not(.off) [data-method={method}]\"))"
        ))
    };
    let lost = few("depth-peeling", 4);
    assert!(
        lost.contains("truth; not reached|1 layer lost after 2 peels"),
        "{lost}"
    );
    let lost = few("dual-depth-peeling", 3);
    let middle = "layer 2: depth 0.500, alpha 0.50, 25.0 % of the truth; not reached|";
    assert!(
        lost.contains(middle) && lost.ends_with("1 layer lost after 1 peel"),
        "{lost}"
    );
    // Where the truth is another one than the layers', nothing is told.
    let at = |x: u32, y: u32| -> String {
        page.eval(&format!(
            "(f => story(f, compared(f), {x}, {y}).join('|'))(document.querySelector(\"{panes} .pictures:not(.off) [data-method=sorted]\"))"
        ))
    };
    assert_eq!(at(60, 64), "");
    assert_eq!(at(2, 2), "no layer in front of the background");
}

fn the_pages_flip_is_that_of_its_authors_code(chromium: &Chromium, path: &Path) {
    let page = with_pictures(chromium, path);
    let mean: f64 = page.eval(&format!(
        "Number(document.querySelector(\"{UNSORTED}\").dataset.mapMean)"
    ));
    assert!((mean - 0.7392).abs() < 2e-3, "{mean}");
    let same = "[data-name='transparency/windows'] .pictures:not(.off) [data-method=sorted]";
    page.wait(&format!(
        "document.querySelectorAll(\"{same} button\").length === 3"
    ));
    assert_eq!(
        page.eval::<f64>(&format!(
            "Number(document.querySelector(\"{same}\").dataset.mapMean)"
        )),
        0.0
    );
    assert_eq!(
        page.text(&format!("{same} button[data-mode=difference]")),
        "no difference"
    );
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
    let seen = format!(
        "(r => r.top >= 0 && r.top < innerHeight)(document.querySelector(\"{WINDOWS} .pictures:not(.off)\").getBoundingClientRect())"
    );
    page.wait(&seen);
    page.click("#side0");
    assert_eq!(shown(&page, ".pictures"), ["2"]);
}

fn breaks_at_other_limits(chromium: &Chromium, path: &Path) {
    let page = chromium.open(path, "");
    let rows = || page.texts("#break-rows td:nth-child(3)");
    let written = rows();
    assert!(
        written
            .iter()
            .any(|r| r == "weighted-blended leaves 1\u{a0}% RMSE at alpha 0.53"),
        "{written:?}"
    );
    // The script finds what the page was written with.
    page.run("showBreaks(1)");
    assert_eq!(rows(), written);
    page.run("document.querySelector('#limit').select()");
    page.type_in("5");
    page.wait("document.querySelector('#limit-text').textContent.startsWith('5')");
    let other = rows();
    assert_ne!(other, written);
    assert!(
        other.iter().all(|r| r.contains("5\u{a0}% RMSE")),
        "{other:?}"
    );
    // Between 0.7, where it is 0.035, and 0.9, where it is 0.106.
    assert!(
        other
            .iter()
            .any(|r| r.starts_with("weighted-blended leaves 5\u{a0}% RMSE at alpha 0.7")),
        "{other:?}"
    );
    assert!(
        page.eval::<bool>("getComputedStyle(document.querySelector('.rings')).display === 'none'"),
        "the rings are those of 1 %"
    );
}

fn a_narrow_window_and_no_scripts(chromium: &Chromium, path: &Path) {
    let page = with_pictures(chromium, path);
    page.resize(390, 800);
    page.wait("innerWidth === 390");
    let wide: Vec<String> = page.eval(
        "[...document.querySelectorAll('main *')].filter(e => e.getBoundingClientRect().right > innerWidth + 1 && !e.closest('.wide') && !e.closest('.off'))\
         .map(e => e.outerHTML.slice(0, 120))",
    );
    assert_eq!(wide, [] as [&str; 0]);
    // The claims are read without scrolling sideways.
    let reach: [u64; 2] =
        page.eval("(e => [e.scrollWidth, e.clientWidth])(document.querySelector('#claims .wide'))");
    assert!(reach[0] <= reach[1], "{reach:?}");
    // No text of a chart overlaps another one, and none reaches out of it.
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

    let page = chromium.open_without_scripts(path);
    assert!(page.eval::<bool>(&format!(
        "document.querySelector(\"{WINDOWS} .setting input\").disabled"
    )));
    assert!(!page.eval::<bool>("document.querySelector('#limit-field').checkVisibility()"));
    assert!(
        page.eval::<String>("document.body.innerText")
            .contains("Scripts are off")
    );
    assert_eq!(shown(&page, ".pictures"), ["2"]);
}
