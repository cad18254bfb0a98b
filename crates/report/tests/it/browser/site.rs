//! A site in a browser: from the start page to a case, by clicks.

use super::driver::Chromium;
use super::made;
use std::path::Path;

pub(super) fn a_site_leads_to_reports_and_cases(chromium: &Chromium, run: &Path) {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("site");
    let run = run.parent().unwrap().to_owned();
    let site = etalon_report::write_site(&to, &[run], None, &|_, _| Some(made::catalogue()), false)
        .unwrap();
    let page = chromium.open(&site.html, "");
    page.click("#cases li a");
    page.wait("document.querySelector('.gallery img')?.naturalWidth > 0");
    assert_eq!(page.text("h1#case-title"), "Gallery: depth");
    page.click(".gallery a");
    page.wait("document.querySelector('#meant img')?.naturalWidth === 4");

    let page = chromium.open(&site.html, "");
    page.resize(390, 800);
    let wide: i64 = page.eval("document.documentElement.scrollWidth");
    assert!(wide <= 390, "{wide}");
}
