//! Blessing: changing the expectations so that they agree with a run.
//!
//! New expectations have the grade [`Grade::Unread`]: a run shows what happened, but only people can say
//! which clause it breaks.

use crate::condition::Condition;
use crate::symptom::Symptom;
use etalon_frame::AdapterName;
use etalon_record::{
    AdapterRecord, Entry, Evidence, Expectation, Expectations, Finding, Grade, Known, Record, Run,
    Verdict, version_of,
};
use std::collections::{BTreeMap, BTreeSet};

/// The expectations after a run was blessed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Blessing {
    /// All entries of a list, with the new ones at the end.
    pub entries: Vec<Entry>,
    /// The new entries as findings, each with a file name made from the last part of the adapter's name, the case file,
    /// the verdict and the kind of violation. Two findings can have the same name.
    pub findings: Vec<(String, Finding)>,
    /// The number of new entries.
    pub added: usize,
    /// Expectations that were removed, because all cases that they name were drawn and are better.
    pub removed: Vec<Known>,
    /// Expectations for which only some cases are better; they must be narrowed by hand.
    pub to_narrow: Vec<Known>,
    /// The number of records that blessing cannot excuse: selftests that do not fail, and nothing else.
    pub unblessed: u64,
}

/// Adds an entry for every unexpected verdict of a run, case by case, and removes the entries whose cases
/// are all better. `ids` are all existing cases, although the run may have drawn only some. `all_adapters`
/// is true if the run used every adapter found. The reason of a new entry says that it is not explained
/// yet: people must write the explanation. `message` gives the reasons of a record in words.
pub fn bless(
    expectations: &Expectations,
    run: &Run,
    ids: &[String],
    all_adapters: bool,
    today: &str,
    message: &dyn Fn(&Record) -> String,
) -> Blessing {
    let mut blessing = Blessing::default();
    let mut drawn = vec![DrawnCases::default(); expectations.all().len()];
    let mut new = Vec::new();
    for record in run.all_records() {
        // Expectations are about adapters of the header.
        let Some(adapter) = run.header.adapter(&record.adapter) else {
            continue;
        };
        for number in expectations.numbers(adapter, &record.case) {
            drawn[number].cases.insert(&record.case);
            let good = !record.verdict.is_bad()
                && !matches!(record.verdict, Verdict::NotSupported | Verdict::Skipped);
            drawn[number].any_better |= good;
            drawn[number].any_worse |= !good;
        }
        if !record.unexpected() {
            continue;
        }
        // If its round trip is recorded, the case is expected as soon as the round trip is.
        let follows = record.blocked_by.iter().any(|id| {
            let mut records = run.all_records();
            records.any(|r| r.adapter == record.adapter && r.case == *id)
        });
        if !record.verdict.is_bad() {
            blessing.unblessed += 1;
        } else if !follows
            && !matches!(
                expectations.look_up_record(adapter, &record.case, record.shown()),
                Expectation::Agrees(_)
            )
        {
            new.push((record, entry(record, adapter, run, today, message(record))));
        }
    }
    keep_or_remove(&mut blessing, expectations, &drawn, ids, all_adapters);
    blessing.added = new.len();
    blessing.findings = findings(&new, run, today);
    blessing
        .entries
        .extend(new.into_iter().map(|(_, entry)| entry));
    blessing
}

/// The drawn cases that an expectation names.
#[derive(Clone, Default)]
struct DrawnCases<'r> {
    cases: BTreeSet<&'r str>,
    /// True if a case is better than expected.
    any_better: bool,
    any_worse: bool,
}

/// Sorts the expectations into entries to keep, to remove and to narrow.
fn keep_or_remove(
    blessing: &mut Blessing,
    expectations: &Expectations,
    drawn: &[DrawnCases<'_>],
    ids: &[String],
    all_adapters: bool,
) {
    for (number, known) in expectations.all().iter().enumerate() {
        // A flaky case passes sometimes, and a skipped case was not drawn.
        let tried = !matches!(known.verdict, Verdict::Flaky | Verdict::Skipped);
        if !tried || !drawn[number].any_better {
            blessing.entries.extend(known.entry());
            continue;
        }
        let pattern = |glob: &String| glob.contains(['*', '?', '[', '{']);
        let one_adapter = known.adapters.len() == 1 && !known.adapters.iter().any(pattern);
        let all_drawn = ids
            .iter()
            .filter(|id| expectations.names(number, id))
            .all(|id| drawn[number].cases.contains(id.as_str()));
        if !drawn[number].any_worse && all_drawn && (one_adapter || all_adapters) {
            blessing.removed.push(Known::clone(known));
        } else {
            blessing.to_narrow.push(Known::clone(known));
            blessing.entries.extend(known.entry());
        }
    }
}

fn entry(
    record: &Record,
    adapter: &AdapterRecord,
    run: &Run,
    today: &str,
    message: String,
) -> Entry {
    let seen = match message.as_str() {
        "" => format!(
            "{} of {} samples wrong",
            record.texels.wrong, record.texels.total
        ),
        message => message.chars().take(200).collect(),
    };
    Entry {
        adapter: etalon_glob::escape(&record.adapter),
        driver: etalon_glob::escape(&adapter.driver_text()),
        // A browser is the driver by name, and the device below it is another's.
        device: (adapter.info.backend == "webgpu")
            .then(|| etalon_glob::escape(&adapter.info.device)),
        version: version_of(adapter).map(|v| format!("={v}")),
        case: etalon_glob::escape(&record.case),
        verdict: record.verdict,
        reason: format!("Not explained yet; blessed on {today}."),
        evidence: format!(
            "The run of {}: {}: {seen}",
            run.header.provenance.started, record.verdict
        ),
        grade: Some(Grade::Unread),
        link: None,
        expires: None,
        symptom: None,
        processor: None,
        labels: Vec::new(),
    }
}

/// Groups new entries into findings: one per driver, kind of violation and case file. The cases are named
/// by globs if a condition on axes separates them from all other drawn cases, and one by one otherwise.
/// Adapters share a finding if they fail in the same cases, so that a finding excuses nothing that was not
/// seen.
fn findings(new: &[(&Record, Entry)], run: &Run, today: &str) -> Vec<(String, Finding)> {
    let mut groups: BTreeMap<_, Vec<&(&Record, Entry)>> = BTreeMap::new();
    for pair in new {
        let (record, entry) = pair;
        let file = record.parts().file();
        let key = (
            &entry.driver,
            &entry.device,
            &entry.version,
            entry.verdict,
            file,
            &entry.adapter,
            Symptom::of(record).broad(),
        );
        groups.entry(key).or_default().push(pair);
    }
    let mut found: Vec<(String, Finding)> = Vec::new();
    for ((driver, device, version, verdict, file, adapter, kind), group) in groups {
        let failing: Vec<&str> = group
            .iter()
            .map(|(record, _)| record.case.as_str())
            .collect();
        let name = group
            .first()
            .map_or("", |(record, _)| record.adapter.as_str());
        let on_adapter = run
            .all_records()
            .filter(|r| r.adapter == name && r.parts().file() == file);
        let drawn =
            on_adapter.filter(|r| !matches!(r.verdict, Verdict::NotSupported | Verdict::Skipped));
        let drawn: Vec<&str> = drawn.map(|r| r.case.as_str()).collect();
        // A single case says nothing about its axes.
        let globs = (failing.len() > 1)
            .then(|| Condition::of(&failing, &drawn).globs(file, &failing))
            .flatten();
        let each = || group.iter().map(|(_, e)| e.case.clone()).collect();
        let cases: Vec<String> = globs
            .filter(|globs| globs.len() < failing.len())
            .unwrap_or_else(each);
        let same = found.iter_mut().find(|(_, f)| {
            f.driver == *driver
                && f.device == *device
                && f.versions == *version
                && f.verdict == Some(verdict)
                && f.cases == cases
        });
        if let Some((_, finding)) = same {
            finding.adapters.push(adapter.clone());
            continue;
        }
        let Some((record, first)) = group.first() else {
            continue;
        };
        let name = AdapterName::new(&record.adapter).parts().next_back();
        let name = name.unwrap_or_default();
        found.push((
            slug(&format!("{name} {file} {verdict} {}", kind.text())),
            Finding {
                title: format!(
                    "{name}: {file}: {}, not explained yet; blessed on {today}",
                    format!("{verdict} {}", kind.text()).trim_end()
                ),
                adapters: vec![adapter.clone()],
                driver: driver.clone(),
                device: device.clone(),
                versions: version.clone(),
                cases,
                beside: BTreeMap::new(),
                needs: Vec::new(),
                verdict: Some(verdict),
                grade: Grade::Unread,
                clause: String::new(),
                evidence: Evidence::Text(format!("{}: {}", record.case, first.evidence)),
                read: None,
                link: None,
                expires: None,
                symptom: None,
                processor: None,
                labels: Vec::new(),
            },
        ));
    }
    found
}

/// Converts a text to lower case, with a `-` for each run of characters that are neither letters nor
/// digits.
fn slug(text: &str) -> String {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric());
    let words: Vec<String> = words
        .filter(|w| !w.is_empty())
        .map(str::to_lowercase)
        .collect();
    words.join("-")
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::AdapterInfo;
    use etalon_record::{Header, Provenance};
    use std::path::Path;

    fn run(verdicts: &[(&str, Verdict)], expectations: &Expectations) -> Run {
        let adapter: AdapterRecord = serde_json::from_value(serde_json::json!({
            "name": "gl:soft", "backend": "gl", "device": "d", "driver": "Mesa",
            "driver_version": "Mesa 25.0.7", "api_version": "1", "software": true,
            "limits": { "api": "open-gl", "sub_pixel_bits": 8, "max_size": 1,
                "max_color_attachments": 8, "formats": {}, "features": [], "sample_positions": {} },
        }))
        .unwrap();
        let records = verdicts.iter().map(|(case, verdict)| {
            let mut record = Record::new(*case, "gl:soft", *verdict);
            record.expect(expectations, &adapter);
            record
        });
        Run {
            records: records.collect(),
            beside: Vec::new(),
            truncated: false,
            header: Header {
                provenance: Provenance {
                    started: "2026-01-01T00:00:00Z".to_owned(),
                    ..Provenance::default()
                },
                ..Header::new(vec![adapter], verdicts.len() as u64)
            },
        }
    }

    fn read(case: &str) -> Expectations {
        let text = format!(
            r#"{{ "entries": [ {{ "adapter": "gl:soft", "driver": "*", "case": "{case}",
                "verdict": "fail", "reason": "r", "evidence": "e" }} ] }}"#
        );
        Expectations::parse(&text, Path::new("e.json")).unwrap()
    }

    fn adapter_of(run: &Run) -> &AdapterRecord {
        &run.header.adapters[0]
    }

    fn ids(names: &[&str]) -> Vec<String> {
        names.iter().map(|id| (*id).to_owned()).collect()
    }

    #[test]
    fn only_what_is_blessed_is_expected() {
        let before = Expectations::default();
        let seen = run(
            &[
                ("a/x=*", Verdict::Fail),
                ("a/y", Verdict::Pass),
                ("a/z", Verdict::Flaky),
            ],
            &before,
        );
        let blessing = bless(
            &before,
            &seen,
            &ids(&["a/x=*", "a/y", "a/z"]),
            true,
            "2026-11-22",
            &|_| String::new(),
        );
        assert_eq!((blessing.added, blessing.entries.len()), (2, 2));
        let text = Expectations::to_text(&blessing.entries).unwrap();
        let after = Expectations::parse(&text, Path::new("e.json")).unwrap();
        let adapter = &seen.header.adapters[0];
        let agrees = |case: &str| {
            matches!(
                after.look_up(adapter, case, Verdict::Fail),
                Expectation::Agrees(_)
            )
        };
        assert!(agrees("a/x=*") && agrees("a/z"));
        assert!(!agrees("a/x=1"), "a star in an id is no glob");
        let other = AdapterRecord {
            info: AdapterInfo {
                driver_version: "Mesa 25.1".to_owned(),
                ..adapter.info.clone()
            },
            ..adapter.clone()
        };
        let found = after.look_up(&other, "a/x=*", Verdict::Fail);
        assert_eq!(found, Expectation::None, "another version is news");
        assert!(
            blessing
                .entries
                .iter()
                .all(|e| e.grade == Some(Grade::Unread))
        );
        let named = |(name, f): &(String, Finding)| (name.clone(), f.cases.clone(), f.expected());
        assert_eq!(
            blessing.findings.iter().map(named).collect::<Vec<_>>(),
            [
                (
                    "soft-a-fail".to_owned(),
                    vec!["a/x=[*]".to_owned()],
                    Verdict::Fail
                ),
                (
                    "soft-a-z-flaky".to_owned(),
                    vec!["a/z".to_owned()],
                    Verdict::Flaky
                ),
            ]
        );
        let texts = blessing
            .findings
            .iter()
            .map(|(name, f)| (name.as_str(), f.to_text().unwrap()));
        let texts: Vec<(&str, String)> = texts.collect();
        let files: Vec<_> = texts.iter().map(|(n, t)| (*n, t.as_str())).collect();
        let found = Expectations::of_findings(&files).unwrap();
        assert!(matches!(
            found.look_up(adapter_of(&seen), "a/x=*", Verdict::Fail),
            Expectation::Agrees(_)
        ));
        // After blessing, there is nothing left to bless.
        let again = run(&[("a/x=*", Verdict::Fail), ("a/z", Verdict::Flaky)], &after);
        assert_eq!(
            bless(&after, &again, &[], true, "d", &|_| String::new()).added,
            0
        );
    }

    #[test]
    fn a_blocked_case_is_blessed_through_its_round_trip() {
        let none = Expectations::default();
        let mut seen = run(
            &[("a/trip", Verdict::Fail), ("b/x", Verdict::Blocked)],
            &none,
        );
        seen.records[1].blocked_by = vec!["a/trip".to_owned()];
        let blessing = bless(&none, &seen, &[], true, "d", &|_| String::new());
        let cases: Vec<&str> = blessing.entries.iter().map(|e| e.case.as_str()).collect();
        assert_eq!(cases, ["a/trip"]);
        // If the round trip is not in the run, the case gets its own entry.
        seen.records.remove(0);
        let blessing = bless(&none, &seen, &[], true, "d", &|_| String::new());
        assert_eq!(blessing.entries[0].verdict, Verdict::Blocked);
    }

    #[test]
    fn an_entry_is_removed_when_all_its_cases_are_better() {
        let entry = read("a/*");
        let drawn = ids(&["a/1", "a/2", "b/1"]);
        let bless = |verdicts: &[(&str, Verdict)], whole: bool| {
            let blessing = bless(&entry, &run(verdicts, &entry), &drawn, whole, "d", &|_| {
                String::new()
            });
            (
                blessing.removed.len(),
                blessing.to_narrow.len(),
                blessing.entries.len(),
            )
        };
        let (pass, fail) = (Verdict::Pass, Verdict::Fail);
        assert_eq!(bless(&[("a/1", pass), ("a/2", pass)], false), (1, 0, 0));
        assert_eq!(bless(&[("a/1", pass), ("a/2", fail)], true), (0, 1, 1));
        assert_eq!(
            bless(&[("a/1", pass)], true),
            (0, 1, 1),
            "a/2 was not drawn"
        );
        let gone = Verdict::NotSupported;
        assert_eq!(bless(&[("a/1", pass), ("a/2", gone)], true), (0, 1, 1));
        assert_eq!(bless(&[("a/1", fail), ("a/2", fail)], true), (0, 0, 1));
        assert_eq!(bless(&[("b/1", pass)], true), (0, 0, 1));
    }
}
