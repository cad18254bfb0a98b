//! The best methods of every scene, for the first page and the terminal.

use super::breaks::LIMIT;
use super::data::{Kind, Methods, Point, SceneSeries, Series, Setting};
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

/// A scene's candidates on adapters of a kind, all at one setting.
fn candidates<'s, 'a>(
    methods: &'s Methods<'a>,
    scene: &'s SceneSeries<'a>,
    setting: &'s Setting<'a>,
    kind: Kind,
) -> Vec<Best<'s, 'a>> {
    let of_kind = scene
        .at(setting)
        .filter(|(_, p)| methods.adapters[p.adapter].kind == kind);
    let best = of_kind.filter_map(|(series, point)| {
        let error = point.error()?;
        Some(Best {
            series,
            point,
            error,
        })
    });
    best.collect()
}

/// True if there are two methods among them: one alone is neither the most accurate nor the fastest.
fn compared(all: &[Best<'_, '_>]) -> bool {
    let first = all.first().map(|b| b.series.method);
    all.iter().any(|b| Some(b.series.method) != first)
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
                "The best methods of every scene, all at the same parameters. Charts, break points and "
                "claims are on " a href=(PAGE) { "the page of methods" } "."
            }
            div.wide { table.text {
                thead { tr {
                    th { "Scene" } th { "At" }
                    @if kinds.len() > 1 { th { "Adapters" } }
                    th { "Most accurate" } th { "RMSE" } th { "Fastest within 1 % RMSE" } th { "Frame time" } th { "On" }
                } }
                tbody {
                    @for (q, question) in methods.questions.iter().enumerate() {
                        @for (s, scene) in question.scenes.iter().enumerate() {
                            @if let Some(setting) = scene.main() {
                                @for kind in &kinds {
                                    (row(methods, scene, &setting, *kind, &anchor(q, s)))
                                }
                            }
                        }
                    }
                }
            } }
        }
    }
}

fn row(
    methods: &Methods<'_>,
    scene: &SceneSeries<'_>,
    setting: &Setting<'_>,
    kind: Kind,
    anchor: &str,
) -> Markup {
    let all = candidates(methods, scene, setting, kind);
    html! {
        @if let Some(best) = accurate(&all) {
            tr {
                th scope="row" { a href={ (PAGE) "#" (anchor) } { (scene.question) "/" (scene.name) } }
                td { (setting.text()) }
                @if methods.kinds().len() > 1 { td { (kind.name()) } }
                @if compared(&all) {
                    td { (best.series.method) }
                    td.num { (share(best.error)) }
                    @if let Some((fast, time)) = fast(&all) {
                        td { (fast.series.method) }
                        td.num { (duration(time)) }
                        td { (methods.adapters[fast.point.adapter].name) }
                    } @else {
                        td colspan="3" { "none" }
                    }
                } @else {
                    td { "only " (best.series.method) " measured" }
                    td.num { (share(best.error)) }
                    td.u colspan="3" { "nothing to compare" }
                }
            }
        }
    }
}

/// A line per scene for the terminal; empty where there are no methods.
pub(crate) fn lines(methods: &Methods<'_>, width: usize) -> String {
    let mut text = String::from(
        "\nMethods at the same parameters: the most accurate, and the fastest within 1 % RMSE\n",
    );
    let scenes = methods.scenes().count();
    let kinds = methods.kinds();
    let listed = methods.scenes().take(LISTED);
    for (scene, kind) in listed.flat_map(|s| kinds.iter().map(move |k| (s, *k))) {
        let Some(setting) = scene.main() else {
            continue;
        };
        let all = candidates(methods, scene, &setting, kind);
        let Some(best) = accurate(&all) else { continue };
        let mut line = format!("  {}/{}{}", scene.question, scene.name, setting.at());
        if kinds.len() > 1 {
            line.push_str(&format!(" ({})", kind.name()));
        }
        if !compared(&all) {
            let only = (best.series.method, share(best.error));
            line.push_str(&format!(": only {} measured, {}", only.0, only.1));
            text.push_str(&plain(&line, width.max(20)));
            text.push('\n');
            continue;
        }
        line.push_str(&format!(": {} {}", best.series.method, share(best.error)));
        match fast(&all) {
            Some((fast, time)) => line.push_str(&format!(
                "; {} {} on {}",
                fast.series.method,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::made::{Made, run};

    #[test]
    fn only_equals_are_ranked_and_one_alone_is_not() {
        let of = |method: &str, opening, error: f64| {
            Made::new(&format!("aa/wedge/method={method}"))
                .at("opening", opening)
                .off(error)
        };
        // `none` looks best in a scene of its own.
        let mixed = run(&[
            of("none", 24.0, 0.001),
            of("msaa-4", 4.0, 0.02),
            of("ssaa", 4.0, 0.015),
        ]);
        let methods = Methods::of(&mixed).unwrap();
        let text = lines(&methods, 100);
        assert!(
            text.contains("aa/wedge at opening 4: ssaa 1.5\u{a0}%; none within"),
            "{text}"
        );
        let html = section(&methods).into_string();
        assert!(
            html.contains("opening 4") && !html.contains("<td>none</td><td class=\"num\">0.1"),
            "{html}"
        );

        let alone = run(&[of("none", 24.0, 0.001), of("msaa-4", 4.0, 0.02)]);
        let methods = Methods::of(&alone).unwrap();
        let text = lines(&methods, 100);
        assert!(
            text.contains("aa/wedge at opening 24: only none measured, 0.1\u{a0}%"),
            "{text}"
        );
        assert!(
            section(&methods)
                .into_string()
                .contains("nothing to compare")
        );
    }
}
