//! Whatever is added, in any order, is read back unchanged.

use crate::made::{Content, adapter, content, run, times};
use etalon_frame::{Aspect, TexelCounts};
use etalon_history::{
    Added, Asserted, History, HistoryError, Measures, MethodMeasures, NewAdapter, NewRun, Outcome,
    Writer,
};
use etalon_record::{Labels, Machine, Verdict};
use proptest::collection::{btree_map, vec};
use proptest::prelude::*;
use proptest::sample::select;
use std::collections::BTreeMap;

fn measures() -> impl Strategy<Value = Measures> {
    let counts = (0u64..3, 0u64..3).prop_map(|(wrong, imprecise)| TexelCounts {
        total: 256,
        wrong,
        imprecise,
        open: 0,
    });
    let asserted = vec((0u64..5, any::<u64>()), 0..2).prop_map(|pairs| {
        let make = |(asserted, codes)| Asserted {
            aspect: Aspect::Color,
            channels: 5,
            asserted,
            codes,
        };
        pairs.into_iter().map(make).collect::<Vec<_>>()
    });
    let method = prop::option::of((any::<f32>(), 0u32..4)).prop_map(|method| {
        method
            .filter(|(rmse, _)| rmse.is_finite())
            .map(|(rmse, passes)| MethodMeasures {
                rmse,
                max: 0.1,
                flip: rmse / 3.0,
                wrong: 1.0,
                passes,
                draws: 1,
                fragments: None,
                bytes: 4096,
            })
    });
    (asserted, counts, method).prop_map(|(asserted, texels, method)| Measures {
        asserted,
        texels,
        method,
    })
}

fn outcome() -> impl Strategy<Value = Outcome> {
    let verdict = || select(&Verdict::ALL[..]);
    let reason = prop::option::of("[a-z\"'\u{0}\n]{0,6}");
    let flags = (any::<bool>(), prop::bool::weighted(0.1));
    (
        verdict(),
        reason,
        prop::option::weighted(0.1, verdict()),
        flags,
        measures(),
    )
        .prop_map(
            |(verdict, expected, improves, (due_fail, inferred), measures)| Outcome {
                verdict,
                expected,
                improves,
                due_fail,
                inferred,
                measures,
            },
        )
}

/// Few outcomes and few cases, so that most runs repeat those of others.
fn part(outcomes: Vec<Outcome>) -> impl Strategy<Value = BTreeMap<String, Outcome>> {
    let case = (0u8..30).prop_map(|n| format!("{}/made/n={n}", ["depth", "perf"][n as usize % 2]));
    btree_map(case, select(outcomes), 0..25)
}

/// Outcomes and version of each adapter, by its number.
type Parts = BTreeMap<u8, (BTreeMap<String, Outcome>, u8)>;

fn runs() -> impl Strategy<Value = Vec<NewRun>> {
    vec(outcome(), 1..6)
        .prop_flat_map(|outcomes| {
            let adapters = btree_map(0u8..3, (part(outcomes), 0u8..3), 0..3);
            vec((adapters, 1u8..28, 0u32..2, any::<bool>()), 1..10)
        })
        .prop_map(|runs| {
            let make = |(index, (adapters, day, cores, label)): (usize, (Parts, u8, u32, bool))| {
                let parts = adapters.into_iter().map(|(name, (outcomes, version))| {
                    let made: NewAdapter = adapter(&format!("gl:{name}"), &version.to_string());
                    let timed = |case: &&String| case.starts_with("perf/");
                    let cases: &BTreeMap<String, Outcome> = &outcomes;
                    let times = cases.keys().filter(timed).map(|case| {
                        let wall = [f32::from(day), 0.1 + index as f32];
                        (case.clone(), times(&wall, 0.3))
                    });
                    NewAdapter {
                        times: times.collect(),
                        outcomes,
                        ..made
                    }
                });
                let mut made = run(index as u8, &format!("2026-01-{day:02}"), parts.collect());
                made.machine = Machine {
                    cores,
                    ..made.machine
                };
                if label {
                    made.labels = Labels::from([("branch".to_owned(), format!("{day}"))]);
                }
                made
            };
            runs.into_iter().enumerate().map(make).collect()
        })
}

/// The content as exports see it.
fn by_record(history: &History) -> Result<Content, HistoryError> {
    let mut content = Content::new();
    history.each_record::<HistoryError>(|run, part, case, outcome| {
        let case = history.case_name(case)?.to_string();
        let outcome = history.outcome(outcome)?.as_ref().clone();
        content.insert((run.digest, part.timeline.to_string(), case), outcome);
        Ok(())
    })?;
    Ok(content)
}

/// The content as the histories of cases see it.
fn by_case(history: &History) -> Result<Content, HistoryError> {
    let mut content = Content::new();
    for case in history.cases()? {
        for found in history.case_history(case, None)? {
            let mut time = i64::MIN;
            for point in &found.points {
                let run = history.run(point.run).unwrap();
                assert!(time <= run.time(), "points follow time");
                time = run.time();
                let outcome = history.outcome(point.outcome)?.as_ref().clone();
                let key = (run.digest, found.timeline.to_string(), case.to_string());
                assert!(content.insert(key, outcome).is_none());
            }
        }
    }
    Ok(content)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn runs_come_back_as_they_were_added(runs in runs(), seed in any::<u64>()) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("etalon.db");
        let mut order: Vec<&NewRun> = runs.iter().collect();
        let mut random = oorandom::Rand64::new(seed.into());
        for at in (1..order.len()).rev() {
            order.swap(at, random.rand_range(0..at as u64 + 1) as usize);
        }
        let mut writer = Writer::open(&path).unwrap();
        for made in &order {
            prop_assert!(matches!(writer.add(made).unwrap(), Added::New(_)));
            // Any run that is there can be added again at any time.
            prop_assert!(matches!(writer.add(order[0]).unwrap(), Added::Already(_)));
        }
        let history = History::open_read(&path).unwrap();
        let expected = content(&runs);
        prop_assert_eq!(&by_record(&history).unwrap(), &expected);
        prop_assert_eq!(&by_case(&history).unwrap(), &expected);

        let mut times = 0;
        for key in history.series_keys().unwrap() {
            for point in history.series(&key).unwrap() {
                let digest = history.run(point.run).unwrap().digest;
                let made = runs.iter().find(|r| r.digest == digest).unwrap();
                let part = made.adapters.iter().find(|a| *a.timeline == *key.timeline).unwrap();
                let case = history.case_name(key.case).unwrap();
                prop_assert_eq!(&point.times, &part.times[&*case]);
                times += 1;
            }
        }
        let expected: usize = runs.iter().flat_map(|r| &r.adapters).map(|a| a.times.len()).sum();
        prop_assert_eq!(times, expected);

        for part in history.adapter_runs() {
            let counted: u32 = history.tallies(part).unwrap().iter().map(|t| t.records).sum();
            prop_assert_eq!(counted, part.records);
            let run = history.run(part.run).unwrap();
            let made = runs.iter().find(|r| r.digest == run.digest).unwrap();
            prop_assert_eq!(&run.labels, &made.labels);
        }
    }
}
