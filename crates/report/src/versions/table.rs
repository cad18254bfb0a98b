//! The summary of a search over releases for a terminal.

use super::groups::{Course, groups};
use crate::numbers::count;
use crate::terminal::{self, TableOptions, wrapped};
use crate::words::plain;
use etalon_record::Versions;
use tabled::builder::Builder;

/// A table with a row per finding and span of releases, and the totals. Always ends in a newline.
pub fn versions_table(versions: &Versions, options: TableOptions) -> String {
    let mut builder = Builder::default();
    builder.push_record(["finding", "bad in", "versions of a finding", "cases"]);
    let mut totals = [0_usize; 4];
    let mut rows = 0;
    for group in groups(versions) {
        totals[group.course.clone() as usize] += group.cases.len();
        let bad = match group.course {
            Course::Bad => group.bad,
            Course::Flaky => "flaky".to_owned(),
            Course::Good | Course::Unknown => continue,
        };
        let first = || format!("none: {}", plain(&group.cases[0].case, 120));
        builder.push_record([
            group
                .finding
                .map_or_else(first, |finding| plain(finding, 160)),
            bad,
            group.range.unwrap_or_default(),
            group.cases.len().to_string(),
        ]);
        rows += 1;
    }
    let mut text = String::new();
    if rows > 0 {
        let table = wrapped(terminal::table(builder, options, 3), options);
        text.push_str(&format!("{table}\n\n"));
    }
    let [bad, flaky, good, unknown] = totals.map(|n| n as u64);
    text.push_str(&format!(
        "{} of {}, oldest {}, newest {}: {} bad in some, {flaky} flaky, {good} good in all that were drawn, \
         {unknown} not drawn or not asserted\n",
        count(versions.cases.len() as u64, "case"),
        plain(&versions.header.line, 64),
        end(versions.header.releases.first()),
        end(versions.header.releases.last()),
        bad,
    ));
    text
}

fn end(release: Option<&etalon_record::ReleaseRecord>) -> String {
    release.map_or_else(String::new, |r| plain(&r.version, 40))
}
