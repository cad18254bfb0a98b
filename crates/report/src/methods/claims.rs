//! Claims of the literature, compared with the measurements of a run.

mod claim;
mod cost;
mod pair;
mod picture;

use super::data::Methods;
use claim::{Claim, Figure, Reproduction};
use maud::{Markup, html};

fn all() -> impl Iterator<Item = &'static Claim> {
    cost::CLAIMS.iter().chain(picture::CLAIMS)
}

/// The table of claims.
pub(super) fn section(methods: &Methods<'_>) -> Markup {
    let checked: Vec<(&Claim, Vec<Figure>)> = all().map(|c| (c, (c.check)(methods))).collect();
    html! {
        p {
            "Claims of publications, and this run's measurements of them. A claim holds in a scene on an adapter if the figure "
            "there meets the condition beside it; it is reproduced if it holds everywhere."
        }
        div.wide { table.text {
            thead { tr { th { "Claim" } th { "Condition" } th { "Measured" } th { "Outcome" } } }
            tbody {
                @for (claim, figures) in &checked {
                    @let found = Reproduction::of(figures);
                    tr {
                        th scope="row" { (claim.title) br; cite { (claim.source) } }
                        td { (claim.formula) }
                        td {
                            @if figures.is_empty() { "–" }
                            @for (text, places, holds) in together(figures) {
                                div { @if !holds { "✗ " } b { (text) } small { " " (places) } }
                            }
                        }
                        td.verdict class=(found.class()) { span class={ "chip " (found.class()) } { (found.text()) } }
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

#[cfg(test)]
mod tests;
