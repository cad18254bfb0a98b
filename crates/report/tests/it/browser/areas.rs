//! The matrix of areas and adapters in a browser.

use super::driver::Chromium;
use crate::areas::write_twenty;

pub(super) fn twenty_adapters_fit_and_rows_open(chromium: &Chromium) {
    let folder = tempfile::tempdir().unwrap();
    write_twenty(folder.path());
    let path = etalon_report::write(folder.path()).unwrap().html;
    for page in [
        chromium.open(&path, ""),
        chromium.open_without_scripts(&path),
    ] {
        let number = |script: &str| -> f64 { page.eval(script) };
        let pane = "document.querySelector('.pane')";
        page.resize(1366, 768);
        assert!(number(&format!("{pane}.scrollWidth - {pane}.clientWidth")) <= 0.0);
        assert!(number("document.documentElement.scrollWidth") <= 1366.0);
        let cells = "[...document.querySelector('.matrix').querySelectorAll('td')].filter(td => td.checkVisibility())";
        let tallest = format!("Math.max(...{cells}.map(td => td.getBoundingClientRect().height))");
        assert!(number(&tallest) < 40.0, "one line and a bar");

        let files = "[...document.querySelectorAll('.matrix .file')].filter(row => row.checkVisibility()).length";
        assert_eq!(number(files), 0.0);
        page.run("document.querySelector('.matrix summary').focus()");
        page.press("Enter");
        page.wait(&format!("{files} === 2"));
        page.click(".matrix summary");
        page.wait(&format!("{files} === 0"));

        page.resize(390, 800);
        assert!(number("document.documentElement.scrollWidth") <= 390.0);
        let first = "document.querySelector('.matrix tbody th').getBoundingClientRect().left";
        let before = number(first);
        page.run(&format!("{pane}.scrollLeft = 400"));
        assert!(number(&format!("{pane}.scrollLeft")) > 300.0);
        assert_eq!(number(first), before, "the names of areas stay in sight");
    }
}
