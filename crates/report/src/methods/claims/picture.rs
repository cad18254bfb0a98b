//! Claims of what methods show.

use super::claim::{Claim, Figure, Place};
use super::pair::pairs;
use crate::methods::breaks::{self, Break, LIMIT};
use crate::methods::data::{Methods, Point, SceneSeries, Series, usable};
use crate::numbers::{digits, share};

/// Half a step between two codes of 8 bits.
const HALF_CODE: f64 = 0.5 / 255.0;

/// The claims, in the order in which they are shown.
pub(super) const CLAIMS: &[Claim] = &[
    Claim {
        title: "Early tests never change the picture.",
        source: "Vulkan: Early Fragment Test; OpenGL 4.6: 14.9",
        formula: "RMSE and largest error with tests forced to be early, against a shader that could discard and so is \
                  tested late. Holds when both are the same.",
        check: early_tests,
    },
    Claim {
        title: "Reversed float depth resolves smaller gaps than 24 bits.",
        source: "Reed 2015, Depth Precision Visualized",
        formula: "The smallest gap between two planes at which the picture is within 1 % RMSE. Holds when reversed \
                  depth has the smaller one.",
        check: reversed_depth,
    },
    Claim {
        title: "Alpha to coverage knows one more level than it has samples.",
        source: "Vulkan: Multisample Coverage",
        formula: "RMSE over one layer, along alpha, with four samples. Holds when each fourth of alpha is within 0.5 % \
                  and everything halfway between two of them is at least four times as far off as the farthest of those.",
        check: alpha_to_coverage,
    },
    Claim {
        title: "Shadow volumes by depth-fail are right with the eye inside, where depth-pass is not.",
        source: "Everitt and Kilgard 2002, Practical and Robust Stenciled Shadow Volumes",
        formula: "At how many of the eye's places each is within 1 % RMSE. Holds when depth-fail is at all of them, and depth-pass is not.",
        check: shadow_volumes,
    },
    Claim {
        title: "The error of blending into 8 bits grows with the layers, up to half a code over alpha.",
        source: "Closed form: half a code per layer, of which 1 - alpha is left by every later one",
        formula: "Largest error over half a code divided by alpha, along alpha; and the largest error along the layers. Holds \
                  when the first is at most 1.2, for a conversion within 0.6 codes, and the second never falls by more than half a code.",
        check: accumulation,
    },
];

fn early_tests(methods: &Methods<'_>) -> Vec<Figure> {
    let mut figures: Vec<Figure> = Vec::new();
    for pair in pairs(methods, "visibility-cost", "discard", "forced-early-test") {
        let of = |p: &Point<'_>| (p.measured.distance.rmse, p.measured.distance.max);
        let (late, early) = (of(pair.one), of(pair.other));
        let text = match late == early {
            true => "the same".to_owned(),
            false => format!("RMSE {} and {}", share(late.0), share(early.0)),
        };
        let figure = Figure::new(pair.place(), text, late == early);
        if !figures.contains(&figure) {
            figures.push(figure);
        }
    }
    figures
}

/// The value from which on a curve stays within the limit; its start if it always does.
fn resolved(series: &Series<'_>, adapter: usize) -> Option<Option<f64>> {
    let curve = series.curve(adapter);
    let ratio = curve.last()?.0 / curve.first()?.0;
    match breaks::find(&curve, ratio >= 20.0)? {
        Break::Never => Some(Some(curve.first()?.0)),
        Break::Always => Some(None),
        Break::Crossings(all) => Some(all.last().filter(|c| !c.leaves).map(|c| c.value)),
    }
}

fn reversed_depth(methods: &Methods<'_>) -> Vec<Figure> {
    let mut figures = Vec::new();
    for scene in methods.scenes().filter(|s| s.question == "depth-precision") {
        let of = |method: &'static str| {
            let own = move |s: &&Series<'_>| s.method == method && s.parameter == Some("gap");
            scene.series.iter().filter(own)
        };
        for fixed in of("depth24") {
            for reversed in of("reversed-depth").filter(|s| s.variant == fixed.variant) {
                for (index, adapter) in methods.adapters.iter().enumerate() {
                    let (Some(a), Some(b)) = (resolved(fixed, index), resolved(reversed, index))
                    else {
                        continue;
                    };
                    let text =
                        |v: Option<f64>| v.map_or_else(|| "none".to_owned(), |v| digits(v, 2));
                    let holds = match (a, b) {
                        (Some(a), Some(b)) => b < a,
                        (None, Some(_)) => true,
                        (_, None) => false,
                    };
                    let scene = scene_name(scene, fixed);
                    let place = (scene.as_str(), adapter.name);
                    let figure = format!("gap {} against {}", text(b), text(a));
                    figures.push(Figure::new(place, figure, holds));
                }
            }
        }
    }
    figures
}

fn scene_name(scene: &SceneSeries<'_>, series: &Series<'_>) -> String {
    match series.variant.as_str() {
        "" => scene.name.to_owned(),
        variant => format!("{} ({variant})", scene.name),
    }
}

fn alpha_to_coverage(methods: &Methods<'_>) -> Vec<Figure> {
    let mut figures = Vec::new();
    let scenes = methods
        .scenes()
        .filter(|s| s.question == "transparency" && s.name == "levels");
    for scene in scenes {
        let own = |s: &&Series<'_>| s.method == "alpha-to-coverage" && s.parameter == Some("alpha");
        for series in scene.series.iter().filter(own) {
            for (index, adapter) in methods.adapters.iter().enumerate() {
                let curve = series.curve(index);
                let at = |halves: bool| {
                    let eighth = move |v: f64| {
                        let eighths = v * 8.0;
                        (eighths - eighths.round()).abs() < 1e-6
                            && (eighths.round() % 2.0 == 1.0) == halves
                    };
                    curve
                        .iter()
                        .filter(move |(v, _)| eighth(*v))
                        .map(|(_, e)| *e)
                };
                let on_level = at(false).reduce(f64::max);
                let between = at(true).reduce(f64::min);
                if let (Some(on), Some(between)) = (on_level, between) {
                    let text = format!(
                        "at most {} on levels, at least {} between",
                        share(on),
                        share(between)
                    );
                    let holds = on <= 0.005 && between >= 4.0 * on;
                    figures.push(Figure::new((scene.name, adapter.name), text, holds));
                }
            }
        }
    }
    figures
}

fn shadow_volumes(methods: &Methods<'_>) -> Vec<Figure> {
    let all = pairs(
        methods,
        "stencil-effects",
        "shadow-volume-depth-pass",
        "shadow-volume-depth-fail",
    );
    let mut places: Vec<(Place<'_>, [usize; 3])> = Vec::new();
    for pair in &all {
        let right = |p: &Point<'_>| usize::from(p.error().is_some_and(|e| e <= LIMIT));
        let counts = [right(pair.one), right(pair.other), 1];
        match places.iter_mut().find(|(place, _)| *place == pair.place()) {
            Some((_, sum)) => sum.iter_mut().zip(counts).for_each(|(s, c)| *s += c),
            None => places.push((pair.place(), counts)),
        }
    }
    let figure = |(place, [pass, fail, all]): (Place<'_>, [usize; 3])| {
        let text = format!("depth-fail right at {fail} of {all}, depth-pass at {pass}");
        Figure::new(place, text, fail == all && pass < all)
    };
    places.into_iter().map(figure).collect()
}

fn accumulation(methods: &Methods<'_>) -> Vec<Figure> {
    let mut figures = Vec::new();
    let own = |s: &&Series<'_>| s.method == "ordered-8-bit";
    for scene in methods.scenes().filter(|s| s.question == "accumulation") {
        for (series, (index, adapter)) in scene
            .series
            .iter()
            .filter(own)
            .flat_map(|s| methods.adapters.iter().enumerate().map(move |a| (s, a)))
        {
            let place = (scene.name, adapter.name);
            let largest: Vec<(f64, f64)> = series
                .on(index)
                .filter_map(|p| Some((p.value?, p.measured.distance.max)))
                .filter(|(v, e)| *v > 0.0 && usable(*e))
                .collect();
            match series.parameter {
                Some("alpha") => {
                    let part = largest.iter().map(|(alpha, e)| e / (HALF_CODE / alpha));
                    if let Some(most) = part.reduce(f64::max) {
                        let text =
                            format!("at most ×{} of half a code over alpha", digits(most, 2));
                        figures.push(Figure::new(place, text, most <= 1.2));
                    }
                }
                Some("layers") if largest.len() > 1 => {
                    // Saturated, it may waver by a part of a code.
                    let grows = largest.windows(2).all(|w| w[1].1 >= w[0].1 - HALF_CODE);
                    let ends = [largest[0], largest[largest.len() - 1]];
                    let [first, last] = ends.map(|(n, e)| format!("{} after {n}", share(e)));
                    let holds = grows && ends[1].1 > ends[0].1;
                    figures.push(Figure::new(place, format!("{first}, {last}"), holds));
                }
                _ => {}
            }
        }
    }
    figures
}
