//! A site in a browser: from the start page to a case, a document and back, by clicks.

use super::driver::Chromium;
use std::path::Path;

pub(super) fn a_site_leads_to_reports_cases_and_documents(chromium: &Chromium, run: &Path) {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("site");
    let run = run.parent().unwrap().to_owned();
    let checkout = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let site = etalon_report::write_site(&to, &[run], Some(&checkout), false).unwrap();
    let page = chromium.open(&site.html, "");
    page.click("#cases li a");
    page.wait("document.querySelector('.gallery img')?.naturalWidth > 0");
    assert_eq!(page.text("h1#case-title"), "Gallery: depth");
    page.click(".gallery a");
    page.wait("document.querySelector('#meant img')?.naturalWidth === 4");

    let page = chromium.open(&site.html, "");
    page.click("#documents ul a");
    page.wait("document.querySelector('article.text img')?.naturalWidth > 100");
    assert_eq!(page.text("article.text h1"), "etalon");
    page.click("article.text a[href='crates/mutants.html']");
    page.wait("location.pathname.endsWith('/docs/crates/mutants.html')");
    page.click("main > nav a");
    page.wait("location.pathname.endsWith('/site/index.html')");
    page.resize(390, 800);
    let wide: i64 = page.eval("document.documentElement.scrollWidth");
    assert!(wide <= 390, "{wide}");
}
