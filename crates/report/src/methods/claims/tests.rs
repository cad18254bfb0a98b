use super::*;
use crate::methods::tests::made::{Made, run};
use etalon_methods::{Claim, ClaimedValues, FigureCondition, Quantity, Test};

/// Checks the claim whose title begins like this against a run.
fn outcome(title: &str, made: &[Made]) -> (Reproduction, Vec<CaseFigure>, Vec<String>) {
    let claim = claims().find(|c| c.title.starts_with(title)).unwrap();
    of(claim, made)
}

fn of(claim: &'static Claim, made: &[Made]) -> (Reproduction, Vec<CaseFigure>, Vec<String>) {
    let run = run(made);
    let methods = Methods::of(&run).unwrap();
    let checked = check(claim, &methods);
    let blind = checked
        .counting_before_depth_test
        .iter()
        .map(|b| (*b).to_owned())
        .collect();
    (Reproduction::of(&checked.figures), checked.figures, blind)
}

fn told(figures: &[CaseFigure]) -> Vec<String> {
    let texts = together(figures);
    texts
        .into_iter()
        .map(|t| format!("{}{} {}", t.holds.sign().unwrap_or(""), t.text, t.places))
        .collect()
}

/// Returns a figure that meets a condition, and a figure that does not.
fn figures(condition: FigureCondition) -> [f64; 2] {
    match condition {
        FigureCondition::Below(limit) | FigureCondition::AtMost(limit) => {
            [limit * 0.8, limit * 1.5]
        }
        FigureCondition::Above(limit) => [limit * 1.5, limit * 0.8],
        FigureCondition::Between(low, high) => [f64::midpoint(low, high), high * 2.0],
    }
}

/// Returns the first family of a claim, and two values of its parameter that count.
fn place(claim: &Claim) -> (String, [f64; 2]) {
    let family = claim.families.first().copied().unwrap_or("scene");
    let values = match claim.values {
        ClaimedValues::All => [1.0, 2.0],
        ClaimedValues::Between(low, high) => [low, (low + 1.0).min(high)],
    };
    (format!("{}/{family}", claim.question), values)
}

fn with(made: Made, quantity: Quantity, figure: f64) -> Made {
    match quantity {
        Quantity::Rmse => Made {
            rmse: figure,
            ..made
        },
        Quantity::Largest => Made {
            max: figure,
            ..made
        },
        Quantity::Passes => Made {
            passes: figure as u32,
            ..made
        },
        Quantity::Draws => Made {
            draws: (figure * 100.0) as u32,
            ..made
        },
        Quantity::Fragments => Made {
            fragments: Some((figure * 1000.0) as u64),
            ..made
        },
        Quantity::Time => Made {
            wall: Some(figure),
            interval: Some([figure * 0.999, figure * 1.001]),
            ..made
        },
    }
}

/// Returns records that meet a claim, or that refute it.
fn made(claim: &Claim, good: bool) -> Vec<Made> {
    let (_, values) = place(claim);
    made_at(claim, good, values)
}

/// Returns records at two values of the parameter that meet a claim, or that refute it.
fn made_at(claim: &Claim, good: bool, values: [f64; 2]) -> Vec<Made> {
    let (scene, _) = place(claim);
    let setting =
        |method: &str, value: f64| Made::new(&format!("{scene}/method={method}")).at("p", value);
    let pick = |condition| figures(condition)[usize::from(!good)];
    let mut records = Vec::new();
    match claim.test {
        Test::Value {
            quantity,
            of,
            holds,
        } => {
            records.extend(values.map(|v| with(setting(of, v), quantity, pick(holds))));
        }
        Test::Ratio {
            quantity,
            of,
            over,
            holds,
        } => {
            for value in values {
                // Every negative term has figure 2; the positive term compensates for it.
                let mut add = |terms: &[(&str, f64)], sum: f64| {
                    let less = terms.iter().filter(|t| t.1 < 0.0).count() as f64 * 2.0;
                    for (method, sign) in terms {
                        let figure = if *sign < 0.0 { 2.0 } else { sum + less };
                        records.push(with(setting(method, value), quantity, figure));
                    }
                };
                add(over, 1.0);
                add(of, pick(holds));
                if let Some([less, more]) = claim.fewer {
                    for (method, n) in [(less, 2000), (more, 9000)] {
                        let known = |m: &Made| {
                            m.id.ends_with(&format!("={method}"))
                                && m.parameter == Some(("p", value))
                        };
                        if !records.iter().any(known) {
                            records.push(Made {
                                fragments: Some(n),
                                ..setting(method, value)
                            });
                        }
                    }
                }
            }
        }
        Test::Same { methods: [a, b] } => {
            records.push(setting(a, values[0]).off(0.02));
            records.push(setting(b, values[0]).off(if good { 0.02 } else { 0.0201 }));
        }
        Test::Trend {
            quantity,
            of,
            holds,
        } => {
            records.push(with(setting(of, values[0]), quantity, 0.01));
            records.push(with(setting(of, values[1]), quantity, 0.01 * pick(holds)));
        }
        Test::Unlike { right, wrong } => {
            for (i, value) in values.into_iter().enumerate() {
                records.push(setting(right, value).off(0.001));
                records.push(setting(wrong, value).off(if good && i == 1 { 0.2 } else { 0.001 }));
            }
        }
        Test::Halves { of, over } => {
            let passes = |made: Made, passes| Made {
                passes,
                ..made.off(0.01)
            };
            records.push(passes(setting(over, 8.0), 16));
            records.push(passes(setting(of, 4.0), if good { 9 } else { 15 }));
        }
        Test::Narrowest { of, over, holds } => {
            let gaps = [0.001, 0.01, 0.1, 1.0];
            // The other resolves from the third gap on.
            let narrowest = [(1, 0.1), (3, 10.0), (2, 1.0)];
            let (from, _) = narrowest
                .into_iter()
                .find(|(_, ratio)| holds.met(*ratio) == good)
                .unwrap();
            for (i, gap) in gaps.into_iter().enumerate() {
                records.push(setting(over, gap).off(if i < 2 { 0.3 } else { 0.001 }));
                records.push(setting(of, gap).off(if i < from { 0.3 } else { 0.001 }));
            }
        }
        Test::Levels { of, samples } => {
            for i in 1..2 * samples {
                let alpha = f64::from(i) / f64::from(2 * samples);
                let off = if i % 2 == 1 && good { 0.07 } else { 0.001 };
                records.push(setting(of, alpha).off(off));
            }
        }
        Test::HalfCodes { of, holds } => {
            let alpha = 0.1;
            let off = pick(holds) * 0.5 / 255.0 / alpha;
            records.push(setting(of, alpha).off(off));
        }
    }
    records
}

#[test]
fn every_claim_has_figures_that_reproduce_and_figures_that_refute_it() {
    assert!(claims().count() >= 21, "{}", claims().count());
    for claim in claims() {
        for (good, expected) in [
            (true, Reproduction::Reproduced),
            (false, Reproduction::NotReproduced),
        ] {
            let (found, figures, _) = of(claim, &made(claim, good));
            assert_eq!(found, expected, "{}: {figures:?}", claim.title);
        }
        let text = words::compared(claim);
        assert!(
            text.contains("Holds") && text.contains(claim.question),
            "{text}"
        );
        assert!(!claim.source.is_empty());
    }
}

#[test]
fn values_that_a_claim_excludes_neither_confirm_nor_refute_it() {
    let mut restricted = 0;
    for claim in claims() {
        let ClaimedValues::Between(low, high) = claim.values else {
            continue;
        };
        restricted += 1;
        let title = claim.title;
        // These tests read whole curves.
        assert!(
            !matches!(
                claim.test,
                Test::Halves { .. } | Test::Narrowest { .. } | Test::Levels { .. }
            ),
            "{title}"
        );
        let inside = made(claim, true);
        let (reproduction, figures, _) = of(claim, &inside);
        assert_eq!(reproduction, Reproduction::Reproduced, "{title}");
        let mut excluded = vec![[low / 4.0, low / 2.0]];
        if high.is_finite() {
            excluded.push([high * 2.0, high * 4.0]);
        }
        for values in excluded {
            let outside = made_at(claim, false, values);
            let (alone, ..) = of(claim, &outside);
            assert_eq!(alone, Reproduction::NotMeasured, "{title}");
            let (together, all, _) = of(claim, &[inside.clone(), outside].concat());
            assert_eq!(together, Reproduction::Reproduced, "{title}");
            assert_eq!(told(&all), told(&figures), "{title}");
        }
    }
    assert!(restricted >= 8, "{restricted}");
}

/// A comparison needs all of its methods at the same setting.
#[test]
fn a_claim_is_not_measured_if_a_method_is_missing_or_has_another_setting() {
    let lonely = [Made::new("elsewhere/scene/method=other").at("k", 1.0)];
    for claim in claims() {
        assert_eq!(
            of(claim, &lonely).0,
            Reproduction::NotMeasured,
            "{}",
            claim.title
        );
        if matches!(
            claim.test,
            Test::Value { .. } | Test::Trend { .. } | Test::Levels { .. } | Test::HalfCodes { .. }
        ) {
            continue;
        }
        let records = made(claim, true);
        let mut methods: Vec<&str> = records
            .iter()
            .map(|m| m.id.rsplit('/').next().unwrap())
            .collect();
        methods.sort_unstable();
        methods.dedup();
        for missing in methods {
            let others: Vec<Made> = records
                .iter()
                .filter(|m| !m.id.ends_with(missing))
                .cloned()
                .collect();
            let (found, figures, _) = of(claim, &others);
            assert_eq!(
                found,
                Reproduction::NotMeasured,
                "{} without {missing}: {figures:?}",
                claim.title
            );
        }
        // Each method at its own values, as in a covering array.
        let mut apart = records.clone();
        for (i, made) in apart.iter_mut().enumerate() {
            made.parameter = Some(("p", 100.0 + i as f64));
        }
        let (found, figures, _) = of(claim, &apart);
        let expected = [Reproduction::NotMeasured];
        assert!(expected.contains(&found), "{}: {figures:?}", claim.title);
    }
}

/// The prepass draws in the order of `unsorted`, and its own fragments do not count as shaded.
#[test]
fn the_fragments_of_a_prepass_do_not_count_as_shaded() {
    let records = |sorted, prepass| {
        let fragments = [
            ("no-test", 4000),
            ("unsorted", 1500),
            ("front-to-back", sorted),
            ("depth-prepass", prepass),
        ];
        fragments.map(|(method, n)| Made {
            fragments: Some(n),
            ..Made::new(&format!("visibility-cost/rooms/method={method}")).at("layers", 8.0)
        })
    };
    let title = "Drawing front to back";
    // The prepass draws 1500 fragments, and 1000 are shaded.
    let (found, figures, _) = outcome(title, &records(1000, 2500));
    assert_eq!(found, Reproduction::Reproduced);
    assert_eq!(told(&figures), ["×1 rooms at layers 8 on cpu"]);
    // A fifth of all fragments of the prepass, but far fewer than it shades.
    let (found, figures, _) = outcome(title, &records(300, 2500));
    assert_eq!(found, Reproduction::NotReproduced, "{figures:?}");
    // Half again as many fragments as the prepass shades.
    assert_eq!(
        outcome(title, &records(1500, 2500)).0,
        Reproduction::NotReproduced
    );
    // An adapter that counts before the depth test decides nothing.
    let mut blind = records(4000, 8000);
    blind[1].fragments = Some(4000);
    let (found, _, names) = outcome(title, &blind);
    assert_eq!(
        (found, names),
        (Reproduction::NotMeasured, vec!["cpu".to_owned()])
    );
}

#[test]
fn an_equal_time_is_not_less_and_a_wide_interval_decides_nothing() {
    let title = "Multisampling takes less time";
    let times = |msaa: f64, full: f64, spread: f64| {
        [("msaa-4", msaa), ("supersampling-2x2", full)].map(|(method, wall)| Made {
            wall: Some(wall),
            interval: Some([wall * (1.0 - spread), wall * (1.0 + spread)]),
            ..Made::new(&format!("anti-aliasing/fan/method={method}"))
        })
    };
    assert_eq!(
        outcome(title, &times(2.0, 4.0, 0.1)).0,
        Reproduction::Reproduced
    );
    assert_eq!(
        outcome(title, &times(4.0, 4.0, 0.0)).0,
        Reproduction::NotReproduced
    );
    assert_eq!(
        outcome(title, &times(5.0, 4.0, 0.02)).0,
        Reproduction::NotReproduced
    );
    let (found, figures, _) = outcome(title, &times(3.8, 4.0, 0.2));
    assert_eq!(found, Reproduction::Undecided);
    assert_eq!(
        told(&figures),
        ["?×0.95 (interval ×0.633 to ×1.42) fan on cpu"]
    );
    // A time without an interval gives no figure.
    let mut bare = times(2.0, 4.0, 0.1);
    bare[0].interval = None;
    assert_eq!(outcome(title, &bare).0, Reproduction::NotMeasured);
    // Two adapters: one confirms the claim and one refutes it.
    let mut both = times(2.0, 4.0, 0.1).to_vec();
    both.extend(times(9.0, 4.0, 0.1).map(|m| m.on("gl:a")));
    let (found, figures, _) = outcome(title, &both);
    assert_eq!(found, Reproduction::Partly(1, 2));
    assert_eq!(
        told(&figures)[1],
        "✗×2.25 (interval ×1.84 to ×2.75) fan on gl:a"
    );
}

/// Missing data is no verdict: curves that never resolve, whether over different gaps or one gap, decide
/// nothing.
#[test]
fn gaps_that_nothing_resolves_are_not_measured() {
    let curve = |method: &str, gaps: &[(f64, f64)]| -> Vec<Made> {
        let records = |(gap, off): &(f64, f64)| {
            Made::new(&format!("depth-precision/planes/method={method}"))
                .at("gap", *gap)
                .off(*off)
        };
        gaps.iter().map(records).collect()
    };
    let title = "Reversed float depth";
    let never = [(0.001, 0.3), (0.01, 0.3)];
    let records = |a: &[(f64, f64)], b: &[(f64, f64)]| {
        let records = [curve("depth24", a), curve("reversed-depth", b)].concat();
        outcome(title, &records).0
    };
    assert_eq!(records(&never, &never), Reproduction::NotMeasured);
    assert_eq!(
        records(&[(0.01, 0.3)], &[(0.01, 0.001)]),
        Reproduction::NotMeasured
    );
    assert_eq!(
        records(&[(0.1, 0.3), (1.0, 0.001)], &[(0.001, 0.3), (0.01, 0.001)]),
        Reproduction::NotMeasured,
        "curves over different gaps"
    );
    let late = [(0.001, 0.3), (0.01, 0.001)];
    assert_eq!(records(&never, &late), Reproduction::Reproduced);
    assert_eq!(records(&late, &never), Reproduction::NotReproduced);
}

#[test]
fn figures_of_grouped_cases_keep_their_range_and_settings() {
    let record = |value: f64, alpha: f64, off: f64| {
        Made::new(&format!(
            "transparency/windows/method={}",
            if value > 0.0 {
                "weighted-blended"
            } else {
                "unsorted"
            }
        ))
        .at("alpha", alpha)
        .off(off)
    };
    let made = [
        record(1.0, 0.1, 0.01),
        record(0.0, 0.1, 0.02),
        record(1.0, 0.5, 0.03),
        record(0.0, 0.5, 0.04),
        record(1.0, 0.9, 0.3),
        record(0.0, 0.9, 0.1),
    ];
    let (found, figures, _) = outcome("Weighted blended transparency is nearer", &made);
    assert_eq!(found, Reproduction::Partly(2, 3));
    assert_eq!(
        told(&figures),
        [
            "×0.5 to ×0.75 windows in 2 cases, alpha 0.1 to alpha 0.5 on cpu",
            "✗×3 windows at alpha 0.9 on cpu"
        ]
    );
    let html = section(&Methods::of(&run(&made)).unwrap()).into_string();
    assert!(html.contains("reproduced in 2 of 3 cases"), "{html}");
}
