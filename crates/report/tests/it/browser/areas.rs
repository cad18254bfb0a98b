//! The matrix of areas and adapters in a browser.

use super::driver::Chromium;
use crate::areas::write_twenty;

pub(super) fn twenty_adapters_fit_and_areas_open(chromium: &Chromium) {
    let folder = tempfile::tempdir().unwrap();
    write_twenty(folder.path());
    let path = etalon_report::write(folder.path()).unwrap().html;
    for page in [
        chromium.open(&path, ""),
        chromium.open_without_scripts(&path),
    ] {
        let number = |script: &str| -> f64 { page.eval(script) };
        page.resize(1366, 768);
        let table = "document.querySelector('.matrix').getBoundingClientRect()";
        assert!(
            number(&format!("{table}.width")) > 1200.0,
            "the whole width"
        );
        assert!(number("document.documentElement.scrollWidth") <= 1366.0);
        let cells = "[...document.querySelector('.matrix').querySelectorAll('td')].filter(td => td.checkVisibility())";
        let tallest = format!("Math.max(...{cells}.map(td => td.getBoundingClientRect().height))");
        assert!(number(&tallest) < 40.0, "one line and a bar");
        let cut = "[...document.querySelectorAll('.matrix th, .matrix td')].filter(e => e.scrollWidth > e.clientWidth + 1).length";
        assert_eq!(number(cut), 0.0, "nothing is cut off");

        page.resize(390, 800);
        assert!(number("document.documentElement.scrollWidth") <= 390.0);
        // Adapters are named in their cells.
        let named = "getComputedStyle(document.querySelector('.matrix td.new'), '::before').content.includes('vulkan:lavapipe')";
        assert!(page.eval::<bool>(named));
    }
    let page = chromium.open(&path, "");
    page.resize(1366, 768);
    let files = "document.querySelectorAll('.matrix .file').length";
    page.run("document.querySelector('.matrix .open').focus()");
    page.press("Enter");
    page.wait(&format!("{files} === 2"));
    // Number 0 of `compare` is new, 2 and 4 are known.
    let numbers = page.texts(".matrix .file td");
    assert!(numbers.iter().all(|number| number == "1"), "{numbers:?}");
    page.click(".matrix .open");
    page.wait(&format!("{files} === 0"));
    page.click(".matrix td a");
    page.wait_count("5 of 42 cases");
    page.wait_hash("#on=vulkan:lavapipe&area=blend&verdict=bad");
}
