//! The best methods of every scene, for the first page and the terminal.

use super::breaks::LIMIT;
use super::data::{Kind, Methods, Point, SceneSeries, Series};
use super::name::{PAGE, anchor};
use crate::numbers::{count, duration, share};
use crate::words::plain;
use maud::{Markup, html};

/// The most scenes that the terminal lists.
const LISTED: usize = 40;

/// A method on an adapter.
struct Best<'s, 'a> {
    series: &'s Series<'a>,
    point: &'s Point<'a>,
    error: f64,
}

/// A scene's candidates on adapters of a kind: every series by its middle value.
fn candidates<'s, 'a>(
    methods: &'s Methods<'a>,
    scene: &'s SceneSeries<'a>,
    kind: Kind,
) -> Vec<Best<'s, 'a>> {
    let mut result = Vec::new();
    for series in &scene.series {
        let middle = series.middle();
        for point in series.points.iter().filter(|p| p.value == middle) {
            if methods.adapters[point.adapter].kind == kind
                && let Some(error) = point.error()
            {
                result.push(Best {
                    series,
                    point,
                    error,
                });
            }
        }
    }
    result
}

/// The most accurate method; of equal ones the faster.
fn accurate<'s, 'a>(all: &'s [Best<'s, 'a>]) -> Option<&'s Best<'s, 'a>> {
    let time = |b: &Best<'_, '_>| b.point.wall().unwrap_or(f64::INFINITY);
    all.iter().min_by(|a, b| {
        a.error
            .total_cmp(&b.error)
            .then(time(a).total_cmp(&time(b)))
    })
}

/// The fastest method within one percent.
fn fast<'s, 'a>(all: &'s [Best<'s, 'a>]) -> Option<(&'s Best<'s, 'a>, f64)> {
    let good = all.iter().filter(|b| b.error <= LIMIT);
    good.filter_map(|b| Some((b, b.point.wall()?)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The section of `index.html` that leads to the page of methods.
pub(crate) fn section(methods: &Methods<'_>) -> Markup {
    let kinds = methods.kinds();
    html! {
        section id="methods" {
            h2 { "Methods: accuracy against speed" }
            p {
                "The best methods of every scene, each at the middle value of its parameter. Charts, break points and "
                "claims are on " a href=(PAGE) { "the page of methods" } "."
            }
            div.wide { table.text {
                thead { tr {
                    th { "Scene" }
                    @if kinds.len() > 1 { th { "Adapters" } }
                    th { "Most accurate" } th { "RMSE" } th { "Fastest within 1 % RMSE" } th { "Frame time" } th { "On" }
                } }
                tbody {
                    @for (q, question) in methods.questions.iter().enumerate() {
                        @for (s, scene) in question.scenes.iter().enumerate() {
                            @for kind in &kinds {
                                @let all = candidates(methods, scene, *kind);
                                @if let Some(best) = accurate(&all) {
                                    tr {
                                        th scope="row" { a href={ (PAGE) "#" (anchor(q, s)) } { (question.name) "/" (scene.name) } }
                                        @if kinds.len() > 1 { td { (kind.name()) } }
                                        td { (best.series.name()) }
                                        td.num { (share(best.error)) }
                                        @if let Some((fast, time)) = fast(&all) {
                                            td { (fast.series.name()) }
                                            td.num { (duration(time)) }
                                            td { (methods.adapters[fast.point.adapter].name) }
                                        } @else {
                                            td colspan="3" { "none" }
                                        }
                                    }
                                }
                            }
                        }
                    }
                }
            } }
        }
    }
}

/// A line per scene for the terminal; empty where there are no methods.
pub(crate) fn lines(methods: &Methods<'_>, width: usize) -> String {
    let mut text = String::from("\nMethods: the most accurate, and the fastest within 1 % RMSE\n");
    let scenes = methods.scenes().count();
    let kinds = methods.kinds();
    let listed = methods.scenes().take(LISTED);
    for (scene, kind) in listed.flat_map(|s| kinds.iter().map(move |k| (s, *k))) {
        let all = candidates(methods, scene, kind);
        let Some(best) = accurate(&all) else { continue };
        let mut line = format!("  {}/{}", scene.question, scene.name);
        if kinds.len() > 1 {
            line.push_str(&format!(" ({})", kind.name()));
        }
        line.push_str(&format!(": {} {}", best.series.name(), share(best.error)));
        match fast(&all) {
            Some((fast, time)) => line.push_str(&format!(
                "; {} {} on {}",
                fast.series.name(),
                duration(time),
                methods.adapters[fast.point.adapter].name
            )),
            None => line.push_str("; none within"),
        }
        text.push_str(&plain(&line, width.max(20)));
        text.push('\n');
    }
    if scenes > LISTED {
        let more = count((scenes - LISTED) as u64, "more scene");
        text.push_str(&format!("  and {more}\n"));
    }
    text
}
