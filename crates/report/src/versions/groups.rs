//! Cases grouped by their finding and by the releases in which they are bad.

use crate::words::plain;
use etalon_record::{CaseVersions, Standing, Versions};
use std::collections::BTreeMap;

/// The sequence of a case's results over the releases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ResultCourse {
    /// Bad in some releases.
    Bad,
    /// Never bad, but flaky in some release.
    Flaky,
    /// Never bad or flaky, and good in some release.
    Good,
    /// The result is unknown in all releases: nothing was drawn or asserted.
    Unknown,
}

/// Cases with the same finding that change in the same way.
pub(super) struct CaseGroup<'a> {
    pub(super) course: ResultCourse,
    /// The finding; `None` if no finding mentions the cases.
    pub(super) finding: Option<&'a str>,
    /// The releases in which they are bad, in words.
    bad: String,
    /// These releases as the `versions` of a finding.
    pub(super) range: Option<String>,
    pub(super) cases: Vec<&'a CaseVersions>,
}

impl CaseGroup<'_> {
    /// Returns the releases in which the cases are bad, in words.
    pub(super) fn bad(&self) -> &str {
        match self.course {
            ResultCourse::Flaky => "flaky",
            _ => &self.bad,
        }
    }
}

/// Returns the groups: bad ones first, the largest of each kind first.
pub(super) fn groups(versions: &Versions) -> Vec<CaseGroup<'_>> {
    let mut by_key: BTreeMap<_, Vec<&CaseVersions>> = BTreeMap::new();
    for case in &versions.cases {
        let key = (course(case), case.finding.as_deref(), spans(versions, case));
        by_key.entry(key).or_default().push(case);
    }
    let mut groups: Vec<CaseGroup<'_>> = by_key
        .into_iter()
        .map(|((course, finding, bad), cases)| CaseGroup {
            course,
            finding,
            bad,
            range: cases[0].range(&versions.header.releases),
            cases,
        })
        .collect();
    groups.sort_by_key(|group| (group.course, std::cmp::Reverse(group.cases.len())));
    groups
}

fn course(case: &CaseVersions) -> ResultCourse {
    let standings = case.standings();
    let any = |wanted| standings.contains(&Some(wanted));
    if any(Standing::Bad) {
        ResultCourse::Bad
    } else if any(Standing::Flaky) {
        ResultCourse::Flaky
    } else if any(Standing::Good) {
        ResultCourse::Good
    } else {
        ResultCourse::Unknown
    }
}

/// Returns the releases in which a case is bad: `103 to 110, 143`, `all`, or nothing.
fn spans(versions: &Versions, case: &CaseVersions) -> String {
    let releases = &versions.header.releases;
    let bad = case.bad();
    if bad == [[0, releases.len() - 1]] {
        return "all".to_owned();
    }
    let version = |i: usize| plain(&releases[i].version, 40);
    let each = bad.iter().map(|[first, last]| {
        if first == last {
            version(*first)
        } else {
            format!("{} to {}", version(*first), version(*last))
        }
    });
    each.collect::<Vec<_>>().join(", ")
}
