//! Blessing: expectations are made to agree with a run.

use crate::adapter::AdapterRecord;
use crate::driver_version::driver_version;
use crate::expectations::{Entry, Expectation, Expectations};
use crate::run::Run;
use crate::verdict::Verdict;
use std::collections::BTreeSet;

/// The expectations after a run was blessed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Blessing {
    /// All entries, the new ones at the end.
    pub entries: Vec<Entry>,
    /// The number of new ones.
    pub added: usize,
    /// Entries that were removed: all cases that they name were drawn, and all are better.
    pub removed: Vec<Entry>,
    /// Entries of which some cases are better: to be narrowed by hand.
    pub to_narrow: Vec<Entry>,
    /// Records that no expectation excuses: selftests that do not fail.
    pub unblessed: u64,
}

impl Expectations {
    /// Adds an entry for every unexpected verdict of a run, case by case, and removes the entries of cases
    /// that are better. `ids` are all existing cases, of which the run may have drawn a part; `all_adapters`
    /// is true if it used every adapter found. The reason of a new entry says that it is not explained yet:
    /// explanations are for people to write.
    pub fn bless(&self, run: &Run, ids: &[String], all_adapters: bool, today: &str) -> Blessing {
        let mut blessing = Blessing::default();
        let mut drawn: Vec<BTreeSet<&str>> = vec![BTreeSet::new(); self.entries().len()];
        let mut better = vec![0_u64; self.entries().len()];
        let mut worse = vec![0_u64; self.entries().len()];
        let mut new = Vec::new();
        for record in &run.records {
            let Some(adapter) = run.header.adapter(&record.adapter) else {
                continue;
            };
            for number in self.numbers(adapter, &record.case) {
                drawn[number].insert(&record.case);
                let good = !record.verdict.is_bad()
                    && !matches!(record.verdict, Verdict::NotSupported | Verdict::Skipped);
                better[number] += u64::from(good);
                worse[number] += u64::from(!good);
            }
            if !record.unexpected() {
                continue;
            }
            // It is expected as soon as its round trip is.
            let follows = record.blocked_by.iter().any(|id| {
                let mut all = run.records.iter();
                all.any(|r| r.adapter == record.adapter && r.case == *id)
            });
            if !record.verdict.is_bad() {
                blessing.unblessed += 1;
            } else if !follows
                && !matches!(
                    self.look_up(adapter, &record.case, record.verdict),
                    Expectation::Agrees(_)
                )
            {
                new.push(entry(record, adapter, run, today));
            }
        }
        for (number, entry) in self.entries().iter().enumerate() {
            // What is flaky passes now and then, and what is skipped was not drawn.
            let tried = !matches!(entry.verdict, Verdict::Flaky | Verdict::Skipped);
            if !tried || better[number] == 0 {
                blessing.entries.push(entry.clone());
                continue;
            }
            let one_adapter = !entry.adapter.contains(['*', '?', '[', '{']);
            let whole = ids
                .iter()
                .filter(|id| self.names(number, id))
                .all(|id| drawn[number].contains(id.as_str()));
            if worse[number] == 0 && whole && (one_adapter || all_adapters) {
                blessing.removed.push(entry.clone());
            } else {
                blessing.to_narrow.push(entry.clone());
                blessing.entries.push(entry.clone());
            }
        }
        blessing.added = new.len();
        blessing.entries.extend(new);
        blessing
    }
}

fn entry(record: &crate::record::Record, adapter: &AdapterRecord, run: &Run, today: &str) -> Entry {
    let seen = match record.message.as_str() {
        "" => format!(
            "{} of {} samples wrong",
            record.texels.wrong, record.texels.total
        ),
        message => message.chars().take(200).collect(),
    };
    Entry {
        adapter: globset::escape(&record.adapter),
        driver: globset::escape(&adapter.driver_text()),
        version: driver_version(&adapter.driver_version).map(|v| format!("={v}")),
        case: globset::escape(&record.case),
        verdict: record.verdict,
        reason: format!("Not explained yet; blessed on {today}."),
        evidence: format!(
            "The run of {}: {}: {seen}",
            run.header.started, record.verdict
        ),
        link: None,
        expires: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::header::{FORMAT, Header, Settings};
    use crate::machine::Machine;
    use crate::record::Record;
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
            truncated: false,
            header: Header {
                format: FORMAT,
                etalon: String::new(),
                commit: None,
                machine: Machine::default(),
                started: "2026-01-01T00:00:00Z".to_owned(),
                command: Vec::new(),
                cases: verdicts.len() as u64,
                settings: Settings::default(),
                adapters: vec![adapter],
                absent: Vec::new(),
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

    fn ids(all: &[&str]) -> Vec<String> {
        all.iter().map(|id| (*id).to_owned()).collect()
    }

    #[test]
    fn what_is_blessed_is_expected_and_nothing_else() {
        let before = Expectations::default();
        let seen = run(
            &[
                ("a/x=*", Verdict::Fail),
                ("a/y", Verdict::Pass),
                ("a/z", Verdict::Flaky),
            ],
            &before,
        );
        let blessing = before.bless(&seen, &ids(&["a/x=*", "a/y", "a/z"]), true, "2026-11-22");
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
            driver_version: "Mesa 25.1".to_owned(),
            ..adapter.clone()
        };
        let found = after.look_up(&other, "a/x=*", Verdict::Fail);
        assert_eq!(found, Expectation::None, "another version is news");
        // Blessed once, there is nothing more to bless.
        let again = run(&[("a/x=*", Verdict::Fail), ("a/z", Verdict::Flaky)], &after);
        assert_eq!(after.bless(&again, &[], true, "d").added, 0);
    }

    #[test]
    fn what_is_blocked_follows_its_round_trip() {
        let none = Expectations::default();
        let mut seen = run(
            &[("a/trip", Verdict::Fail), ("b/x", Verdict::Blocked)],
            &none,
        );
        seen.records[1].blocked_by = vec!["a/trip".to_owned()];
        let blessing = none.bless(&seen, &[], true, "d");
        let cases: Vec<&str> = blessing.entries.iter().map(|e| e.case.as_str()).collect();
        assert_eq!(cases, ["a/trip"]);
        // Without it in the run, the case has to speak for itself.
        seen.records.remove(0);
        let blessing = none.bless(&seen, &[], true, "d");
        assert_eq!(blessing.entries[0].verdict, Verdict::Blocked);
    }

    #[test]
    fn an_entry_goes_when_all_that_it_names_is_better() {
        let entry = read("a/*");
        let all = ids(&["a/1", "a/2", "b/1"]);
        let bless = |verdicts: &[(&str, Verdict)], whole: bool| {
            let blessing = entry.bless(&run(verdicts, &entry), &all, whole, "d");
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
