//! deqp-runner's lists, read as deqp-runner 0.24.0 reads them (`RunnerResults::from_csv`). Its package is not
//! a dependency, since it brings a whole test runner. Instead `data/deqp` keeps a list as it is written here,
//! and the status that deqp-runner's own reader gave each line.

use std::collections::HashMap;

/// The list that deqp-runner read.
pub(crate) const LIST: &str = include_str!("../data/deqp/results.csv");
/// Its reading: case, status, true if deqp-runner calls it a regression.
const STATUSES: &str = include_str!("../data/deqp/statuses.csv");

/// One line of a list, as deqp-runner's own reader took it.
pub(crate) struct Line {
    pub(crate) status: &'static str,
    pub(crate) regression: bool,
}

/// The recorded reading of a case.
pub(crate) fn recorded(case: &str) -> Line {
    let lines = STATUSES.lines().map(|line| line.split(','));
    let mut found = lines
        .map(|mut parts| [(); 3].map(|()| parts.next().unwrap()))
        .filter(|[name, ..]| *name == case);
    let [_, status, regression] = found.next().unwrap();
    Line {
        status,
        regression: regression.parse().unwrap(),
    }
}

/// The status of each name of a list, or the line for which deqp-runner refuses the whole list.
pub(crate) fn read(list: &str) -> Result<HashMap<&str, &str>, String> {
    const TEST: [&str; 6] = ["Pass", "Fail", "Skip", "Crash", "Warn", "Timeout"];
    const PLAIN: [&str; 10] = [
        "Pass",
        "Fail",
        "Skip",
        "Crash",
        "Flake",
        "Warn",
        "Missing",
        "ExpectedFail",
        "Timeout",
        "KnownFlake",
    ];
    let improvement = |status: &str| {
        let inner = status.strip_prefix("UnexpectedImprovement(");
        let inner = inner.and_then(|s| s.strip_suffix(')'));
        inner.is_some_and(|s| TEST.contains(&s))
    };
    let mut results = HashMap::new();
    for line in list.lines() {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let mut parts = line.split(',');
        let (Some(name), Some(status)) = (parts.next(), parts.next()) else {
            return Err(line.to_owned());
        };
        let known = PLAIN.contains(&status) || improvement(status);
        if name.is_empty() || !known || results.insert(name, status).is_some() {
            return Err(line.to_owned());
        }
    }
    Ok(results)
}

#[test]
fn lists_that_deqp_runner_refuses_are_refused() {
    assert_eq!(read("# a, b\n\na,Fail\nb@c,Crash,0.5").unwrap().len(), 2);
    for refused in [
        "a",
        "a,",
        ",Pass",
        "a,Odd",
        "a,UnexpectedImprovement(Odd)",
        "a,Fail\na,Pass",
    ] {
        assert!(read(refused).is_err(), "{refused}");
    }
}
