//! Claims of what methods cost.

use super::claim::{Claim, Figure, Place};
use super::pair::{Pair, fragments, medians, pairs, time};
use crate::methods::breaks::LIMIT;
use crate::methods::data::Methods;
use crate::numbers::digits;

/// The claims, in the order in which they are shown.
pub(super) const CLAIMS: &[Claim] = &[
    Claim {
        title: "Dual depth peeling halves the passes of depth peeling.",
        source: "Bavoil and Myers 2008, Order Independent Transparency with Dual Depth Peeling",
        formula: "Passes of k dual peels and the RMSE that they leave, over those of 2 k single peels; where a scene \
                  fixes the number of layers, the passes of both. A peel is a pass over the geometry and one to \
                  compose. Holds when RMSE is at most 1.5 times as large, and dual peeling takes half the passes and \
                  at most two more, its first being for the range of depths.",
        check: dual_peeling,
    },
    Claim {
        title: "Weighted blended transparency takes two passes, whatever the layers.",
        source: "McGuire and Bavoil 2013, Weighted Blended Order-Independent Transparency",
        formula: "Passes of every case: one to gather, one to compose.",
        check: weighted_passes,
    },
    Claim {
        title: "Culling a closed mesh halves its fragments.",
        source: "Foley and others, Computer Graphics: Principles and Practice: back-face culling",
        formula: "Fragments with back faces culled over those with all faces drawn, back to front, in the scene \
                  closed-mesh. Holds between 0.4 and 0.6.",
        check: culling,
    },
    Claim {
        title: "Supersampling by 2×2 costs four times.",
        source: "Akenine-Möller and others, Real-Time Rendering, 4th edition: screen-based antialiasing",
        formula: "Fragments with 2×2 samples over those with one, among them one more for each texel of the picture, which takes the \
                  mean. Holds between 3.5 and 6.",
        check: supersampling,
    },
    Claim {
        title: "Multisampling costs less than supersampling with as many samples.",
        source: "Akenine-Möller and others, Real-Time Rendering, 4th edition: screen-based antialiasing",
        formula: "Frame times of MSAA 4× and of 2×2 supersampling, over that without either; medians over scenes. \
                  Holds when the first is below the second.",
        check: multisampling,
    },
    Claim {
        title: "Drawing front to back saves shading as a depth prepass does.",
        source: "Akenine-Möller and others, Real-Time Rendering, 4th edition: pipeline optimization",
        formula: "Fragments shaded from front to back and after a prepass, over those in no order, with the most \
                  layers; where an adapter counts fragments before the depth test, so that a depth test saves none, frame times. \
                  Holds when the former is below 0.9 and at most 1.2 times the latter.",
        check: front_to_back,
    },
];

/// One peeling method at one value of its scene's parameter.
#[derive(Clone, Copy)]
struct Peeled {
    value: Option<f64>,
    error: f64,
    passes: u32,
}

fn dual_peeling(methods: &Methods<'_>) -> Vec<Figure> {
    let mut figures = Vec::new();
    for scene in methods.scenes().filter(|s| s.question == "transparency") {
        let by_peels = scene.series.iter().any(|s| s.parameter == Some("k"));
        for (index, adapter) in methods.adapters.iter().enumerate() {
            let of = |method: &str| -> Vec<Peeled> {
                let own = scene.series.iter().filter(|s| s.method == method);
                own.flat_map(|s| s.on(index))
                    .filter_map(|p| {
                        Some(Peeled {
                            value: p.value,
                            error: p.error()?,
                            passes: p.measured.passes,
                        })
                    })
                    .collect()
            };
            let (one, dual) = (of("depth-peeling"), of("dual-depth-peeling"));
            let found = if by_peels {
                twice_the_peels(&one, &dual)
            } else {
                richest(&one, &dual)
            };
            if let Some((text, holds)) = found {
                figures.push(Figure::new((scene.name, adapter.name), text, holds));
            }
        }
    }
    figures
}

/// The factor by which an error may be larger and still count as the same.
const ALIKE: f64 = 1.5;

fn halves(one: u32, dual: u32) -> bool {
    dual < one && dual <= one.div_ceil(2) + 2
}

/// Some peels from both sides against twice as many from one.
fn twice_the_peels(one: &[Peeled], dual: &[Peeled]) -> Option<(String, bool)> {
    let twice = |d: &Peeled| one.iter().find(|o| o.value == d.value.map(|k| 2.0 * k));
    let mut pairs: Vec<(u32, u32, f64)> = dual
        .iter()
        .filter_map(|d| {
            let o = twice(d)?;
            (o.error > 0.0).then(|| (o.passes, d.passes, d.error / o.error))
        })
        .collect();
    pairs.sort_by_key(|(passes, ..)| *passes);
    let (passes, dual_passes, _) = *pairs.last()?;
    let least = pairs.iter().map(|p| p.2).fold(f64::INFINITY, f64::min);
    let most = pairs.iter().map(|p| p.2).fold(0.0, f64::max);
    let holds = most <= ALIKE && pairs.iter().all(|(o, d, _)| halves(*o, *d));
    let (least, most) = (digits(least, 2), digits(most, 2));
    let text = format!("{passes} → {dual_passes} passes, RMSE ×{least} to ×{most}");
    Some((text, holds))
}

/// The picture that takes most passes of those that both get right.
fn richest(one: &[Peeled], dual: &[Peeled]) -> Option<(String, bool)> {
    let right = |o: &Peeled, d: &Peeled| {
        let (better, worse) = (o.error.min(d.error), o.error.max(d.error));
        o.value == d.value && worse <= LIMIT && worse <= ALIKE * better
    };
    let pairs = one.iter().flat_map(|o| {
        let same = dual.iter().filter(move |d| right(o, d));
        same.map(|d| (o.passes, d.passes))
    });
    let (one, dual) = pairs.max()?;
    Some((format!("{one} → {dual} passes"), halves(one, dual)))
}

fn weighted_passes(methods: &Methods<'_>) -> Vec<Figure> {
    let mut figures = Vec::new();
    for scene in methods.scenes() {
        let own = scene
            .series
            .iter()
            .filter(|s| s.method == "weighted-blended");
        let mut passes: Vec<u32> = own
            .flat_map(|s| &s.points)
            .map(|p| p.measured.passes)
            .collect();
        passes.sort_unstable();
        passes.dedup();
        if let (Some(least), Some(most)) = (passes.first(), passes.last()) {
            let text = match least == most {
                true => format!("{least} passes"),
                false => format!("{least} to {most} passes"),
            };
            figures.push(Figure::new((scene.name, ""), text, passes == [2]));
        }
    }
    figures
}

fn culling(methods: &Methods<'_>) -> Vec<Figure> {
    let mut all = pairs(methods, "culling", "none", "back");
    all.retain(|pair| pair.scene.name == "closed-mesh");
    medians(&all, Pair::place, fragments)
        .into_iter()
        .map(|(place, r)| {
            Figure::new(
                place,
                format!("×{}", digits(r, 2)),
                (0.4..=0.6).contains(&r),
            )
        })
        .collect()
}

fn supersampling(methods: &Methods<'_>) -> Vec<Figure> {
    let all = pairs(methods, "anti-aliasing", "none", "supersampling-2x2");
    medians(&all, Pair::place, fragments)
        .into_iter()
        .map(|(place, r)| {
            Figure::new(
                place,
                format!("×{}", digits(r, 2)),
                (3.5..=6.0).contains(&r),
            )
        })
        .collect()
}

fn multisampling(methods: &Methods<'_>) -> Vec<Figure> {
    let of = |method| {
        let all = pairs(methods, "anti-aliasing", "none", method);
        medians(&all, |pair| ("", pair.adapter), time)
    };
    let supersampled = of("supersampling-2x2");
    let mut figures = Vec::new();
    for (place, msaa) in of("msaa-4") {
        if let Some((_, full)) = supersampled.iter().find(|(p, _)| *p == place) {
            let text = format!("×{} against ×{}", digits(msaa, 2), digits(*full, 2));
            figures.push(Figure::new(place, text, msaa < *full));
        }
    }
    figures
}

fn front_to_back(methods: &Methods<'_>) -> Vec<Figure> {
    let question = "visibility-cost";
    // A test that rejects nothing that is counted: the count is taken before it.
    let tested = medians(
        &pairs(methods, question, "no-test", "unsorted"),
        Pair::place,
        fragments,
    );
    let blind = |place: &Place<'_>| tested.iter().any(|(p, r)| p == place && *r >= 1.0);
    let of = |method| {
        let mut all = pairs(methods, question, "unsorted", method);
        let most = all.iter().filter_map(|p| p.one.value).reduce(f64::max);
        all.retain(|p| p.one.value == most);
        medians(&all, Pair::place, |pair| match blind(&pair.place()) {
            true => time(pair),
            false => fragments(pair).or_else(|| time(pair)),
        })
    };
    let prepass = of("depth-prepass");
    let mut figures = Vec::new();
    for (place, sorted) in of("front-to-back") {
        if let Some((_, pre)) = prepass.iter().find(|(p, _)| *p == place) {
            let what = if blind(&place) { "time " } else { "" };
            let text = format!("{what}×{} against ×{}", digits(sorted, 2), digits(*pre, 2));
            let holds = sorted <= pre * 1.2 && sorted < 0.9;
            figures.push(Figure::new(place, text, holds));
        }
    }
    figures
}
