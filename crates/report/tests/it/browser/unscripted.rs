//! The pages that have no script, in a browser that would run one.

use super::driver::Chromium;
use crate::bench;
use crate::printed::hunt;
use crate::runs_made::Two;
use crate::synthetic;
use std::path::{Path, PathBuf};

/// Every page except those of a run.
fn pages(folder: &Path) -> Vec<PathBuf> {
    let two = Two::new();
    synthetic::methods::write(&two.before());
    synthetic::methods::write(&two.after());
    let diff = folder.join("diff.html");
    std::fs::write(&diff, two.page(&two.diff())).unwrap();
    let benches = bench::pages(&folder.join("bench"));
    let hunt = etalon_report::write_hunt(&folder.join("hunt"), &hunt()).unwrap();
    let mut pages = vec![diff, hunt.html];
    pages.extend(benches);
    pages
}

/// Their policy forbids every script, also one injected through a name.
pub(super) fn pages_have_no_script(chromium: &Chromium) {
    let folder = tempfile::tempdir().unwrap();
    let pages = pages(folder.path());
    assert_eq!(pages.len(), 4);
    for path in pages {
        let page = chromium.open(&path, "");
        assert_eq!(page.eval::<u64>("document.scripts.length"), 0, "{path:?}");
        page.run(
            "{ const s = document.createElement('script'); s.textContent = 'window.hacked = 1'; \
             document.body.append(s); \
             const i = document.createElement('img'); i.setAttribute('onerror', 'window.hacked = 2'); \
             i.src = 'data:,'; document.body.append(i); window.failed = false; \
             i.addEventListener('error', () => { window.failed = true; }); }",
        );
        page.wait("window.failed");
        assert!(page.eval::<bool>("window.hacked === undefined"), "{path:?}");
        // The style sheet is allowed, and no name is wider than the page.
        assert!(page.eval::<bool>(
            "getComputedStyle(document.querySelector('main')).maxWidth !== '' && \
             document.title.startsWith('etalon')"
        ));
    }
}
