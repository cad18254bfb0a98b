//! Headline claims of the literature, held against what was measured.

mod cost;
mod picture;

use super::data::{Methods, Point, Scene};
use maud::{Markup, html};

/// A claim and how it is checked.
pub(super) struct Claim {
    /// What is said.
    title: &'static str,
    /// Who says it.
    source: &'static str,
    /// What of the records is held against it, and when it counts as reproduced.
    formula: &'static str,
    /// What was measured; nothing where the records do not tell.
    check: fn(&Methods<'_>) -> Vec<Figure>,
}

/// One figure that speaks for or against a claim.
#[derive(Clone, Debug, PartialEq)]
struct Figure {
    /// The scene it was found in; empty for all together.
    scene: String,
    /// The adapter; empty where adapters have no part in it.
    adapter: String,
    /// The figure in words.
    text: String,
    /// Whether the claim holds there.
    holds: bool,
}

impl<'a> Pair<'_, 'a> {
    fn place(&self) -> Place<'a> {
        (self.scene.name, self.adapter)
    }
}

impl Figure {
    fn new(place: Place<'_>, text: impl Into<String>, holds: bool) -> Self {
        Self {
            scene: place.0.to_owned(),
            adapter: place.1.to_owned(),
            text: text.into(),
            holds,
        }
    }
}

/// A scene and an adapter.
type Place<'p> = (&'p str, &'p str);

/// What became of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    Reproduced,
    /// In so many of so many places.
    Partly(usize, usize),
    NotReproduced,
    NotMeasured,
}

impl Outcome {
    fn of(figures: &[Figure]) -> Self {
        let held = figures.iter().filter(|f| f.holds).count();
        match (held, figures.len()) {
            (_, 0) => Self::NotMeasured,
            (0, _) => Self::NotReproduced,
            (held, all) if held == all => Self::Reproduced,
            (held, all) => Self::Partly(held, all),
        }
    }

    fn text(self) -> String {
        match self {
            Self::Reproduced => "✓ reproduced".to_owned(),
            Self::Partly(held, all) => format!("≈ reproduced in {held} of {all} places"),
            Self::NotReproduced => "✗ not reproduced".to_owned(),
            Self::NotMeasured => "– not measured".to_owned(),
        }
    }

    fn class(self) -> &'static str {
        match self {
            Self::Reproduced => "p",
            Self::Partly(..) => "i",
            Self::NotReproduced => "o",
            Self::NotMeasured => "u",
        }
    }
}

fn all() -> impl Iterator<Item = &'static Claim> {
    cost::CLAIMS.iter().chain(picture::CLAIMS)
}

/// The table of claims.
pub(super) fn section(methods: &Methods<'_>) -> Markup {
    let checked: Vec<(&Claim, Vec<Figure>)> = all().map(|c| (c, (c.check)(methods))).collect();
    html! {
        p {
            "What is said of methods, and what this run measured of it. A claim holds in a place when the figure there "
            "meets the condition beside it; whether it was reproduced is decided by all places together."
        }
        div.wide { table.text {
            thead { tr { th { "Claim" } th { "How it is checked" } th { "Measured" } th { "Outcome" } } }
            tbody {
                @for (claim, figures) in &checked {
                    @let outcome = Outcome::of(figures);
                    tr {
                        th scope="row" { (claim.title) br; cite { (claim.source) } }
                        td { (claim.formula) }
                        td {
                            @if figures.is_empty() { "–" }
                            @for (text, places, holds) in together(figures) {
                                div { @if !holds { "✗ " } b { (text) } small { " " (places) } }
                            }
                        }
                        td.verdict class=(outcome.class()) { span class={ "chip " (outcome.class()) } { (outcome.text()) } }
                    }
                }
            }
        } }
    }
}

/// Figures that read the same, with the places they were found in.
fn together(figures: &[Figure]) -> Vec<(&str, String, bool)> {
    let mut texts: Vec<(&str, bool)> = Vec::new();
    for f in figures {
        if !texts.contains(&(&f.text, f.holds)) {
            texts.push((&f.text, f.holds));
        }
    }
    let with = |text, holds| {
        let alike: Vec<&Figure> = figures
            .iter()
            .filter(|f| f.text == text && f.holds == holds)
            .collect();
        (text, places(&alike, figures), holds)
    };
    texts.into_iter().map(|(t, h)| with(t, h)).collect()
}

/// Scenes, each with its adapters unless those are all that have some figure of the scene.
fn places(some: &[&Figure], all: &[Figure]) -> String {
    let mut scenes: Vec<&str> = some.iter().map(|f| f.scene.as_str()).collect();
    scenes.dedup();
    let in_scene = |scene: &str| {
        let here: Vec<&Figure> = some.iter().copied().filter(|f| f.scene == scene).collect();
        let adapters: Vec<&str> = here.iter().map(|f| f.adapter.as_str()).collect();
        let every = all.iter().filter(|f| f.scene == scene).count() == here.len();
        match (scene, adapters.as_slice()) {
            (scene, [""]) => scene.to_owned(),
            ("", adapters) if every && adapters.len() > 1 => "all adapters".to_owned(),
            ("", adapters) => adapters.join(", "),
            (scene, adapters) if every && adapters.len() > 1 => scene.to_owned(),
            (scene, adapters) => format!("{scene} on {}", adapters.join(", ")),
        }
    };
    let parts: Vec<String> = scenes.into_iter().map(in_scene).collect();
    parts.join("; ")
}

/// Two methods on the same scene, adapter, settings and parameter value.
struct Pair<'s, 'a> {
    scene: &'s Scene<'a>,
    adapter: &'a str,
    one: &'s Point<'a>,
    other: &'s Point<'a>,
}

/// Every place where two methods of a question can be compared.
fn pairs<'s, 'a>(
    methods: &'s Methods<'a>,
    question: &str,
    one: &str,
    other: &str,
) -> Vec<Pair<'s, 'a>> {
    let mut result = Vec::new();
    for scene in methods.scenes().filter(|s| s.question == question) {
        for a in scene.series.iter().filter(|s| s.method == one) {
            for b in scene
                .series
                .iter()
                .filter(|s| s.method == other && s.variant == a.variant)
            {
                for p in &a.points {
                    let same = |o: &&Point<'_>| o.adapter == p.adapter && o.value == p.value;
                    if let Some(o) = b.points.iter().find(same) {
                        result.push(Pair {
                            scene,
                            adapter: methods.adapters[p.adapter].name,
                            one: p,
                            other: o,
                        });
                    }
                }
            }
        }
    }
    result
}

/// The median of a ratio over all pairs of a place, where it is known.
fn medians<'s, 'a>(
    pairs: &[Pair<'s, 'a>],
    place: impl Fn(&Pair<'s, 'a>) -> Place<'a>,
    ratio: impl Fn(&Pair<'s, 'a>) -> Option<f64>,
) -> Vec<(Place<'a>, f64)> {
    let mut groups: Vec<(Place<'a>, Vec<f64>)> = Vec::new();
    for pair in pairs {
        let Some(value) = ratio(pair).filter(|v| v.is_finite()) else {
            continue;
        };
        let place = place(pair);
        match groups.iter_mut().find(|g| g.0 == place) {
            Some(group) => group.1.push(value),
            None => groups.push((place, vec![value])),
        }
    }
    let middle = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        let last = values.len() - 1;
        f64::midpoint(values[last / 2], values[last.div_ceil(2)])
    };
    groups.into_iter().map(|(p, v)| (p, middle(v))).collect()
}

/// How many fragments the other method shaded for each of the one's.
fn fragments(pair: &Pair<'_, '_>) -> Option<f64> {
    let (one, other) = (pair.one.measured.fragments?, pair.other.measured.fragments?);
    (one > 0).then(|| other as f64 / one as f64)
}

/// How many times as long the other method took.
fn time(pair: &Pair<'_, '_>) -> Option<f64> {
    Some(pair.other.wall()? / pair.one.wall()?)
}

#[cfg(test)]
mod tests;
