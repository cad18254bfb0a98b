use super::*;
use crate::methods::made::{Made, run};

/// The claim whose title begins like this, checked against a run.
fn check(title: &str, made: &[Made]) -> (Reproduction, Vec<Figure>) {
    let run = run(made);
    let claim = all().find(|c| c.title.starts_with(title)).unwrap();
    let figures = Methods::of(&run).map_or_else(Vec::new, |m| (claim.check)(&m));
    (Reproduction::of(&figures), figures)
}

fn outcome(title: &str, made: &[Made]) -> Reproduction {
    check(title, made).0
}

fn passes(id: &str, passes: u32) -> Made {
    Made {
        passes,
        ..Made::new(id)
    }
}

fn fragments(id: &str, fragments: u64) -> Made {
    Made {
        fragments: Some(fragments),
        ..Made::new(id)
    }
}

fn wall(id: &str, wall: f64) -> Made {
    Made {
        wall: Some(wall),
        ..Made::new(id)
    }
}

#[test]
fn nothing_is_measured_where_methods_are_missing() {
    let lonely = [Made::new("elsewhere/scene/method=other").at("k", 1.0)];
    for claim in all() {
        let (outcome, figures) = check(claim.title, &lonely);
        assert_eq!(
            outcome,
            Reproduction::NotMeasured,
            "{} {figures:?}",
            claim.title
        );
        assert_eq!(check(claim.title, &[]).0, Reproduction::NotMeasured);
    }
}

#[test]
fn one_method_alone_says_nothing() {
    for id in [
        "transparency/peeling/method=depth-peeling",
        "culling/closed-mesh/method=back",
        "anti-aliasing/edges/method=none",
        "anti-aliasing/edges/method=msaa-4",
        "visibility-cost/rooms/method=front-to-back",
        "depth-precision/planes/method=depth24",
        "stencil-effects/shadow-volume/method=shadow-volume-depth-pass",
    ] {
        for claim in all() {
            assert_eq!(
                outcome(claim.title, &[fragments(id, 7)]),
                Reproduction::NotMeasured
            );
        }
    }
}

#[test]
fn dual_peeling_is_counted_at_equal_pictures() {
    let one = |k: f64, rmse: f64| {
        passes("transparency/peeling/method=depth-peeling", 2 * k as u32)
            .at("k", k)
            .off(rmse)
    };
    let dual = |k: f64, rmse: f64| {
        passes(
            "transparency/peeling/method=dual-depth-peeling",
            2 * k as u32 + 1,
        )
        .at("k", k)
        .off(rmse)
    };
    let halves = [
        one(8.0, 0.05),
        one(16.0, 0.004),
        dual(4.0, 0.06),
        dual(8.0, 0.002),
        dual(16.0, 0.002),
    ];
    let (outcome, figures) = check("Dual depth", &halves);
    assert_eq!(outcome, Reproduction::Reproduced);
    assert_eq!(figures[0].text, "32 → 17 passes, RMSE ×0.5 to ×1.2");
    let worse = [one(8.0, 0.05), dual(4.0, 0.08)];
    assert_eq!(
        super::tests::outcome("Dual depth", &worse),
        Reproduction::NotReproduced
    );
    let unpaired = [one(8.0, 0.001), dual(8.0, 0.001)];
    assert_eq!(
        super::tests::outcome("Dual depth", &unpaired),
        Reproduction::NotMeasured
    );
    // Without a number of peels, the richest scene that both get right.
    let layers = |method: &str, n: f64, p: u32, rmse| {
        passes(&format!("transparency/thin/method={method}"), p)
            .at("layers", n)
            .off(rmse)
    };
    let richest = [
        layers("depth-peeling", 2.0, 4, 0.001),
        layers("dual-depth-peeling", 2.0, 3, 0.001),
        layers("depth-peeling", 8.0, 16, 0.001),
        layers("dual-depth-peeling", 8.0, 9, 0.001),
        layers("depth-peeling", 16.0, 18, 0.1),
        layers("dual-depth-peeling", 16.0, 10, 0.1),
    ];
    assert_eq!(check("Dual depth", &richest).1[0].text, "16 → 9 passes");
}

#[test]
fn weighted_blending_takes_two_passes_everywhere() {
    let of = |scene: &str, n| passes(&format!("transparency/{scene}/method=weighted-blended"), n);
    assert_eq!(
        outcome("Weighted", &[of("a", 2), of("b", 2)]),
        Reproduction::Reproduced
    );
    assert_eq!(
        outcome("Weighted", &[of("a", 2), of("b", 3)]),
        Reproduction::Partly(1, 2)
    );
    assert_eq!(
        outcome("Weighted", &[of("a", 4)]),
        Reproduction::NotReproduced
    );
}

#[test]
fn culling_is_judged_by_its_closed_mesh() {
    let of =
        |scene: &str, method: &str, n| fragments(&format!("culling/{scene}/method={method}"), n);
    let halved = [
        of("closed-mesh", "none", 1000),
        of("closed-mesh", "back", 510),
    ];
    assert_eq!(outcome("Culling", &halved), Reproduction::Reproduced);
    let kept = [
        of("closed-mesh", "none", 1000),
        of("closed-mesh", "back", 900),
    ];
    assert_eq!(outcome("Culling", &kept), Reproduction::NotReproduced);
    let other = [of("open-mesh", "none", 1000), of("open-mesh", "back", 900)];
    assert_eq!(outcome("Culling", &other), Reproduction::NotMeasured);
    let zero = [of("closed-mesh", "none", 0), of("closed-mesh", "back", 0)];
    assert_eq!(outcome("Culling", &zero), Reproduction::NotMeasured);
}

#[test]
fn sampling_costs_are_ratios_per_adapter() {
    let of = |method: &str| format!("anti-aliasing/edges/method={method}");
    let four = [
        fragments(&of("none"), 1000),
        fragments(&of("supersampling-2x2"), 5100),
    ];
    assert_eq!(outcome("Supersampling", &four), Reproduction::Reproduced);
    let two = [
        fragments(&of("none"), 1000),
        fragments(&of("supersampling-2x2"), 2000),
    ];
    assert_eq!(outcome("Supersampling", &two), Reproduction::NotReproduced);
    let times = |msaa, full| {
        vec![
            wall(&of("none"), 1.0),
            wall(&of("msaa-4"), msaa),
            wall(&of("supersampling-2x2"), full),
        ]
    };
    assert_eq!(
        outcome("Multisampling", &times(1.5, 4.0)),
        Reproduction::Reproduced
    );
    assert_eq!(
        outcome("Multisampling", &times(4.5, 4.0)),
        Reproduction::NotReproduced
    );
    let mut both = times(1.5, 4.0);
    both.extend(times(5.0, 4.0).into_iter().map(|m| m.on("gl:a")));
    let (found, figures) = check("Multisampling", &both);
    assert_eq!(found, Reproduction::Partly(1, 2));
    assert_eq!(figures[1].adapter, "gl:a");
    let mut untimed = times(1.5, 4.0);
    untimed[1].wall = None;
    assert_eq!(
        outcome("Multisampling", &untimed),
        Reproduction::NotMeasured
    );
}

#[test]
fn front_to_back_is_held_against_the_prepass() {
    let of = |sorted, prepass| {
        [
            ("unsorted", 1000),
            ("front-to-back", sorted),
            ("depth-prepass", prepass),
        ]
        .map(|(m, n)| fragments(&format!("visibility-cost/rooms/method={m}"), n).at("layers", 8.0))
    };
    assert_eq!(
        outcome("Drawing front", &of(400, 400)),
        Reproduction::Reproduced
    );
    assert_eq!(
        outcome("Drawing front", &of(800, 400)),
        Reproduction::NotReproduced
    );
    assert_eq!(
        outcome("Drawing front", &of(1000, 1000)),
        Reproduction::NotReproduced
    );
    // An adapter that counts what the depth test rejects is judged by its times.
    let mut blind = of(1000, 2000).to_vec();
    blind.push(fragments("visibility-cost/rooms/method=no-test", 1000).at("layers", 8.0));
    assert_eq!(
        outcome("Drawing front", &blind),
        Reproduction::NotReproduced
    );
    blind[1].wall = Some(0.0005);
    assert_eq!(outcome("Drawing front", &blind), Reproduction::Reproduced);
}

#[test]
fn early_tests_must_give_the_same_error() {
    let of = |early| {
        [("discard", 0.001), ("forced-early-test", early)]
            .map(|(m, e)| Made::new(&format!("visibility-cost/rooms/method={m}")).off(e))
    };
    assert_eq!(outcome("Early tests", &of(0.001)), Reproduction::Reproduced);
    assert_eq!(
        outcome("Early tests", &of(0.0011)),
        Reproduction::NotReproduced
    );
}

#[test]
fn reversed_depth_needs_the_smaller_gap() {
    let curve = |method: &str, errors: [f64; 3]| {
        [0.001, 0.01, 0.1]
            .into_iter()
            .zip(errors)
            .map(move |(gap, e)| {
                Made::new(&format!("depth-precision/planes/method={method}"))
                    .at("gap", gap)
                    .off(e)
            })
            .collect::<Vec<_>>()
    };
    let of =
        |fixed, reversed| [curve("depth24", fixed), curve("reversed-depth", reversed)].concat();
    assert_eq!(
        outcome("Reversed", &of([0.3, 0.3, 0.001], [0.3, 0.001, 0.001])),
        Reproduction::Reproduced
    );
    assert_eq!(
        outcome("Reversed", &of([0.3, 0.3, 0.3], [0.3, 0.3, 0.001])),
        Reproduction::Reproduced
    );
    assert_eq!(
        outcome("Reversed", &of([0.3, 0.001, 0.001], [0.3, 0.3, 0.001])),
        Reproduction::NotReproduced
    );
    assert_eq!(
        outcome("Reversed", &of([0.3, 0.3, 0.3], [0.3, 0.3, 0.3])),
        Reproduction::NotReproduced
    );
}

#[test]
fn coverage_has_a_level_for_each_sample() {
    let of = |error: fn(f64) -> f64| -> Vec<Made> {
        (1..8)
            .map(|i| f64::from(i) / 8.0)
            .map(|a| {
                Made::new("transparency/levels/method=alpha-to-coverage")
                    .at("alpha", a)
                    .off(error(a))
            })
            .collect()
    };
    let levels = |a: f64| 0.4 * (a - (a * 4.0).round() / 4.0).abs() + 0.001;
    assert_eq!(
        outcome("Alpha to coverage", &of(levels)),
        Reproduction::Reproduced
    );
    assert_eq!(
        outcome("Alpha to coverage", &of(|_| 0.001)),
        Reproduction::NotReproduced,
        "no levels"
    );
    assert_eq!(
        outcome("Alpha to coverage", &of(|a| 0.1 * a)),
        Reproduction::NotReproduced
    );
}

#[test]
fn depth_fail_is_right_everywhere() {
    let of = |pass: [f64; 2], fail: [f64; 2]| {
        let mut all = Vec::new();
        for (i, eye) in [0.0, 0.5].into_iter().enumerate() {
            for (method, error) in [("pass", pass[i]), ("fail", fail[i])] {
                let id =
                    format!("stencil-effects/shadow-volume/method=shadow-volume-depth-{method}");
                all.push(Made::new(&id).at("eye", eye).off(error));
            }
        }
        all
    };
    let title = "Shadow volumes";
    assert_eq!(
        outcome(title, &of([0.001, 0.3], [0.001, 0.001])),
        Reproduction::Reproduced
    );
    assert_eq!(
        outcome(title, &of([0.001, 0.3], [0.001, 0.3])),
        Reproduction::NotReproduced
    );
    assert_eq!(
        outcome(title, &of([0.001, 0.001], [0.001, 0.001])),
        Reproduction::NotReproduced
    );
}

#[test]
fn accumulated_errors_stay_below_half_a_code_over_alpha() {
    let at = |parameter, value, e| {
        Made::new("accumulation/columns/method=ordered-8-bit")
            .at(parameter, value)
            .off(e)
    };
    let code = 1.0 / 255.0;
    let title = "The error of blending";
    let fine = [at("alpha", 0.1, 5.0 * code), at("alpha", 0.5, 0.9 * code)];
    assert_eq!(outcome(title, &fine), Reproduction::Reproduced);
    assert_eq!(
        outcome(title, &[at("alpha", 0.1, 7.0 * code)]),
        Reproduction::NotReproduced
    );
    let grows = [
        at("layers", 1.0, code),
        at("layers", 16.0, 4.0 * code),
        at("layers", 64.0, 3.8 * code),
    ];
    assert_eq!(outcome(title, &grows), Reproduction::Reproduced);
    let falls = [at("layers", 1.0, 4.0 * code), at("layers", 16.0, code)];
    assert_eq!(outcome(title, &falls), Reproduction::NotReproduced);
}

#[test]
fn places_with_one_figure_are_told_together() {
    let of = |scene: &str, adapter: &str, text: &str| Figure::new((scene, adapter), text, true);
    let figures = [
        of("a", "x", "2"),
        of("a", "y", "2"),
        of("b", "x", "2"),
        of("b", "y", "3"),
    ];
    let told: Vec<(&str, String)> = together(&figures)
        .into_iter()
        .map(|(t, p, _)| (t, p))
        .collect();
    assert_eq!(
        told,
        [("2", "a; b on x".to_owned()), ("3", "b on y".to_owned())]
    );
    let adapters = [of("", "x", "1"), of("", "y", "1")];
    assert_eq!(together(&adapters)[0].1, "all adapters");
}
