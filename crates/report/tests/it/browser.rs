//! The pages in a browser: opened from the file system, used by clicks and keys. One Chromium serves all
//! checks, since its start costs more than most of them; each check has its own tab.

mod areas;
mod cdp;
mod driver;
mod failures;
mod history;
mod hostile;
mod index;
mod large;
pub(crate) mod made;
mod matrix;
mod methods;
mod site;
mod unscripted;

use driver::Chromium;

#[test]
fn pages_work_in_a_browser() {
    let folder = tempfile::tempdir().unwrap();
    let path = made::write(folder.path());
    let chromium = Chromium::start();
    let check = |name: &str, check: &dyn Fn()| {
        let start = std::time::Instant::now();
        println!("{name} …");
        check();
        println!("{name}: {:.1?}", start.elapsed());
    };
    for (name, run) in index::CHECKS {
        check(name, &|| run(&chromium, &path));
    }
    let methods_page = methods::write(folder.path());
    for (name, run) in methods::CHECKS {
        check(name, &|| run(&chromium, &methods_page));
    }
    check("hostile names", &|| {
        hostile::hostile_names_stay_text(&chromium)
    });
    check("site", &|| {
        site::a_site_leads_to_reports_and_cases(&chromium, &path);
    });
    check("performance matrix", &|| {
        matrix::two_adapters_are_compared_at_each_width_and_without_scripts(&chromium);
    });
    check("history", &|| {
        history::news_lead_to_cases_runs_and_back(&chromium)
    });
    check("areas of twenty adapters", &|| {
        areas::twenty_adapters_fit_and_areas_open(&chromium)
    });
    check("failures", &|| {
        failures::a_failing_case_is_its_picture(&chromium);
    });
    check("large run", &|| {
        large::eighty_thousand_records_open_and_are_searched(&chromium);
    });
    check("pages without scripts", &|| {
        unscripted::pages_have_no_script(&chromium)
    });
}
