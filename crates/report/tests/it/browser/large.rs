//! A run as large as a nightly one.

use super::driver::Chromium;
use crate::synthetic::large;
use std::time::Instant;

/// The maximum number of bytes of the first page.
const BYTES: u64 = 500_000;
/// The maximum number of elements of the first page.
const ELEMENTS: u64 = 5000;

pub(super) fn eighty_thousand_records_open_and_are_searched(chromium: &Chromium) {
    let folder = tempfile::tempdir().unwrap();
    let start = Instant::now();
    assert_eq!(large::write(folder.path()), 80_000);
    let written = start.elapsed();
    let path = etalon_report::write(folder.path()).unwrap().html;
    let size = std::fs::metadata(&path).unwrap().len();
    println!(
        "run written in {written:.1?}, reports in {:.1?}, page of {:.1} MB",
        start.elapsed() - written,
        size as f64 / 1e6
    );
    assert!(size < BYTES, "{size}");

    for _ in 0..2 {
        let page = chromium.open(&path, "#q=compare");
        page.wait("document.querySelector('#case-table tbody th a')");
        let ready: f64 = page.eval("performance.getEntriesByName('etalon-ready')[0].startTime");
        let painted: Vec<f64> =
            page.eval("performance.getEntriesByType('paint').map(e => e.startTime)");
        let loaded: f64 = page.eval("performance.getEntriesByType('navigation')[0].loadEventEnd");
        let nodes: u64 = page.eval("document.querySelectorAll('*').length");
        println!(
            "rows ready {ready:.0} ms, painted {painted:.0?} ms, loaded {loaded:.0} ms, {nodes} elements"
        );
    }
    let page = chromium.open(&path, "");
    let elements: u64 = page.eval("document.querySelectorAll('*').length");
    assert!(elements < ELEMENTS, "{elements}");
    let page = chromium.open(&path, "#cases");
    page.wait_count("8,000 of 8,000 cases");
    assert!(page.rows().is_empty(), "groups are closed");
    page.click("#f-q");
    page.type_in("less*value-7");
    page.wait_count("0 of 8,000 cases");
    page.press("Escape");
    page.type_in("stencil read=value-3");
    page.wait_count("36 of 8,000 cases");
    assert_eq!(page.rows().len(), 36);
    page.click("#f-clear");
    page.click("#f-unexpected");
    page.wait("document.querySelectorAll('#case-table tbody th a').length > 30");
    assert!(page.text("#page-at").starts_with("Page 1 of "));
    page.click("#page-on");
    page.wait_hash("#unexpected=1&page=2");
    page.wait("document.querySelector('#page-at').textContent.startsWith('Page 2 of ')");
    assert!(page.rows().len() > 30);
    let searched: f64 = page.eval(
        "(() => { const q = document.querySelector('#f-q'); const start = performance.now(); \
         q.value = 'blend'; q.dispatchEvent(new Event('input')); document.body.offsetHeight; \
         return performance.now() - start; })()",
    );
    println!("a search takes {searched:.0} ms with its layout");
}
