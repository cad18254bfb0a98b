//! The queries of `ci/history` name what an export has: metrics and labels of the dashboard, good verdicts everywhere.

use crate::made::{adapter, exported, run, wall};
use etalon_export::{ExportFormat, RunChoice};
use etalon_history::Outcome;
use etalon_record::Verdict;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The labels of each metric.
type Metrics = BTreeMap<String, BTreeSet<String>>;

fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../ci/history");
    fs::read_to_string(path.join(name)).unwrap()
}

/// The samples of a history of one run with a record and a time beside a ruler.
fn samples() -> String {
    let mut adapter = adapter("an adapter", "1.0");
    let pass = Outcome::new(Verdict::Pass);
    adapter.outcomes.insert("perf/a".to_owned(), pass);
    let mut times = wall(&[0.5]);
    times.ruler = vec![0.25];
    adapter.times.insert("perf/a".to_owned(), times);
    let mut run = run(1, "2026-01-01", vec![adapter]);
    // [`words`] reads no escapes.
    run.machine.os = "an os".to_owned();
    run.ruler = Some("a ruler".to_owned());
    let (out, _dir) = exported(&[run], ExportFormat::OpenMetrics, &RunChoice::default());
    fs::read_to_string(out.join("history.om")).unwrap()
}

/// Returns the words of a query: names, and every other character as a word. A quoted string is one word with
/// its quotes.
fn words(query: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = query.trim_start();
    while let Some(first) = rest.chars().next() {
        let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '$';
        let len = match first {
            '"' => rest[1..].find('"').unwrap() + 2,
            c if is_name(c) => rest.find(|c| !is_name(c)).unwrap_or(rest.len()),
            c => c.len_utf8(),
        };
        let (word, more) = rest.split_at(len);
        words.push(word);
        rest = more.trim_start();
    }
    words
}

/// The metrics of a query or a sample with the labels that their selectors name, and the labels of its groups.
fn named(query: &str) -> (Metrics, BTreeSet<String>) {
    let words = words(query);
    let (mut metrics, mut groups) = (Metrics::new(), BTreeSet::new());
    for (index, word) in words.iter().enumerate() {
        if word.starts_with("etalon_") {
            let labels = metrics.entry((*word).to_owned()).or_default();
            if words.get(index + 1) == Some(&"{") {
                let inner = words[index + 1..].split(|w| *w == "}").next().unwrap();
                let parts = inner.split(|w| *w == "{" || *w == ",");
                labels.extend(parts.filter_map(|l| l.first()).map(|l| (*l).to_owned()));
            }
        }
        if ["by", "without", "on", "ignoring"].contains(word) && words[index + 1] == "(" {
            let inner = words[index + 2..].split(|w| *w == ")").next().unwrap();
            let labels = inner.iter().filter(|w| **w != ",");
            groups.extend(labels.map(|l| (*l).to_owned()));
        }
    }
    (metrics, groups)
}

/// Returns all queries of the dashboard, including those of its variables.
fn queries(value: &Value) -> Vec<&str> {
    match value {
        Value::Object(object) => {
            let direct = ["expr", "definition"].map(|key| object.get(key).and_then(Value::as_str));
            let inner = object.values().flat_map(queries);
            direct.into_iter().flatten().chain(inner).collect()
        }
        Value::Array(items) => items.iter().flat_map(queries).collect(),
        _ => Vec::new(),
    }
}

fn good() -> BTreeSet<String> {
    let good = Verdict::ALL.into_iter().filter(|v| !v.is_bad());
    good.map(|v| v.to_string()).collect()
}

#[test]
fn the_dashboard_asks_for_metrics_and_labels_that_are_written() {
    let mut written = Metrics::new();
    for line in samples().lines().filter(|l| !l.starts_with('#')) {
        for (metric, labels) in named(line).0 {
            written.entry(metric).or_default().extend(labels);
        }
    }
    let board: Value = serde_json::from_str(&text("grafana.json")).unwrap();
    let queries = queries(&board);
    let mut asked = BTreeSet::new();
    for query in &queries {
        let (metrics, mut groups) = named(query);
        assert!(!metrics.is_empty(), "{query}");
        if let Some(arguments) = query.strip_prefix("label_values(") {
            let label = arguments.trim_end_matches(')').rsplit(", ").next();
            groups.extend(label.map(str::to_owned));
        }
        for (metric, labels) in metrics {
            let known = written.get(&metric);
            let known = known.unwrap_or_else(|| panic!("no metric {metric}: {query}"));
            for label in labels.union(&groups) {
                assert!(known.contains(label), "{metric} has no {label}: {query}");
            }
            asked.insert(metric);
        }
    }
    let metrics: BTreeSet<String> = written.into_keys().collect();
    assert_eq!(asked, metrics, "the dashboard shows every metric");
}

#[test]
fn the_queries_agree_with_the_suite_on_what_is_good() {
    let board: Value = serde_json::from_str(&text("grafana.json")).unwrap();
    let mut lists = 0;
    for query in queries(&board) {
        for quoted in words(query).iter().filter(|w| w.contains('|')) {
            let named = quoted.trim_matches('"').split('|').map(str::to_owned);
            assert_eq!(named.collect::<BTreeSet<_>>(), good(), "{query}");
            lists += 1;
        }
    }
    assert!(lists > 0);
    for name in ["duckdb.sql", "clickhouse.sql"] {
        let sql = text(name);
        let mut lists: Vec<BTreeSet<String>> = Vec::new();
        for list in sql.split("verdict in (").skip(1) {
            let list = list.split(')').next().unwrap();
            let named = list
                .split(',')
                .map(|v| v.trim().trim_matches('\'').to_owned());
            lists.push(named.collect());
        }
        // The question about disagreement parts what was not drawn from what is good.
        let drawn: BTreeSet<String> = ["pass", "imprecise", "measured"].map(str::to_owned).into();
        let rest: BTreeSet<String> = good().difference(&drawn).cloned().collect();
        assert!(lists.len() > 3, "{name}");
        for list in lists {
            assert!(
                [&good(), &drawn, &rest].contains(&&list),
                "{name}: {list:?}"
            );
        }
    }
}
