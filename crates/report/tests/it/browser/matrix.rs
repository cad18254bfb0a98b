//! The performance matrix in a browser.

use super::driver::Chromium;
use crate::matrix;

pub(super) fn two_adapters_are_compared_at_each_width_and_without_scripts(chromium: &Chromium) {
    let folder = tempfile::tempdir().unwrap();
    matrix::write(folder.path());
    let written = etalon_report::write_bench(folder.path()).unwrap();
    let [path, _] = written.matrix.unwrap();
    let page = chromium.open(&path, "");
    // The second adapter takes half the time.
    let fill = |row: u32| page.text(&format!("#ratios .heat tbody tr:nth-child({row}) td"));
    assert_eq!([fill(1), fill(2), fill(3)], ["×0.500", "×0.500", "–"]);
    page.choose("#other", "cpu");
    page.wait("document.querySelector('#ratios .heat td').textContent === '×1.00'");
    assert_eq!(page.text("#ratios .list td"), "×1.00");
    // A cell opens its samples.
    page.click("#adapter-0 .heat tbody a");
    page.wait("document.querySelector('details.samples[open] dd') !== null");
    assert!(page.text("details.samples[open]").contains("samples=1"));
    assert_eq!(
        page.eval::<u64>("document.querySelectorAll('details.samples[open]').length"),
        1
    );
    for (width, height) in [(400, 900), (1400, 900)] {
        page.resize(width, height);
        let wide: u32 = page.eval("document.documentElement.scrollWidth");
        assert!(wide <= width, "{wide}");
    }
    // Without scripts there are all rates but no ratios.
    let page = chromium.open_without_scripts(&path);
    assert!(page.eval::<bool>("document.getElementById('compare').hidden"));
    assert_eq!(
        page.eval::<u64>("document.querySelectorAll('td[data-rate]').length"),
        6
    );
}
