//! A failing case is its picture, and real failures precede selftests.

use super::driver::Chromium;
use crate::synthetic::{self, adapter, header};
use etalon_frame::Api;
use etalon_record::{Expected, Record, RunWriter, Verdict};
use std::path::Path;

/// A new failure, a known one with its example, and a selftest, in the reverse order of their weight.
fn write(folder: &Path) {
    let header = header(4, vec![adapter("gl:a", Api::OpenGl)]);
    let mut writer = RunWriter::create(folder, &header).unwrap();
    let fail = |id: &str, seed| synthetic::record(&writer, id, "gl:a", Verdict::Fail, seed);
    let expected = || {
        Some(Expected {
            reason: "a known bug".to_owned(),
        })
    };
    let records = [
        Record {
            due_fail: true,
            ..fail("a-selftest/told/bug=1", 1)
        },
        Record {
            expected: expected(),
            ..fail("blend/example", 2)
        },
        Record {
            expected: expected(),
            example: Some("blend/example".to_owned()),
            ..Record::new("blend/other", "gl:a", Verdict::Fail)
        },
        fail("depth/new", 3),
    ];
    for record in records {
        writer.append(&record).unwrap();
    }
}

pub(super) fn a_failing_case_is_its_picture(chromium: &Chromium) {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path());
    let path = etalon_report::write(folder.path()).unwrap().html;

    let page = chromium.open(&path, "");
    let areas = page.texts(".matrix tbody th a");
    assert_eq!(areas, ["blend", "depth", "a-selftest"], "selftests last");
    assert!(page.text(".state.bad").contains("first depth/new on gl:a"));
    page.click("#known th a");
    page.wait_count("2 of 4 cases");
    assert!(page.text("#only").contains("a known bug"));
    page.run("location.hash = '#verdict=fail'");
    page.wait_count("4 of 4 cases");
    let order = [
        "depth/new",
        "blend/example",
        "blend/other",
        "a-selftest/told/bug=1",
    ];
    assert_eq!(page.rows(), order);

    // The link to an example shows it in place.
    page.run("location.hash = '#case=blend/other'");
    page.wait("document.querySelector('.alike img')?.naturalWidth > 0");
    assert!(page.text(".alike a").contains("blend/example"));

    page.run("location.hash = '#case=depth/new'");
    page.wait("document.querySelector('#case .shot img')?.naturalWidth > 0");
    let section = "document.querySelector('#case .record')";
    let order: Vec<String> = page.eval(&format!(
        "[...{section}.querySelectorAll('.violation, .shots figcaption, .story, .codes, .again')]\
         .filter(e => !e.closest('details:not(.again)')).map(e => e.matches('figcaption') ? e.textContent : e.classList[0])"
    ));
    let first = [
        "violation",
        "allowed",
        "drawn",
        "difference",
        "allowed | drawn",
    ];
    assert_eq!(order[..5], first, "{order:?}");
    assert_eq!(order.last().unwrap(), "again", "commands are last");
    let narrowest = format!(
        "Math.min(...[...{section}.querySelectorAll('.strip > .shots .shot')].map(e => e.getBoundingClientRect().width))"
    );
    assert!(page.eval::<f64>(&narrowest) >= 256.0);
    let ring = format!("{section}.querySelector('.ring').getBoundingClientRect().width");
    assert!(page.eval::<f64>(&ring) > 4.0, "the texel is marked");
    assert!(
        page.text(".said").contains("allowed ["),
        "{}",
        page.text(".said")
    );

    // The values under the pointer, and the slider.
    page.hover("#case .shot");
    page.wait("document.querySelector('.said').textContent.startsWith('texel 8,8: allowed [')");
    page.run("document.querySelector('#case input[type=range]').focus()");
    page.press("Home");
    page.wait("document.querySelector('.over .shot').style.getPropertyValue('--at') === '0%'");

    // No view is wider than a phone.
    page.resize(390, 844);
    for hash in ["#", "#cases", "#case=depth/new", "#case=blend/other"] {
        page.run(&format!("location.hash = {hash:?}"));
        page.wait("document.querySelector('#report, #cases, #case').isConnected");
        let wide: f64 = page.eval("document.documentElement.scrollWidth");
        assert!(wide <= 390.0, "{hash} {wide}");
    }
}
