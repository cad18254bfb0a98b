//! Stability: the error along a parameter, one curve per method, with break points.

use super::breaks::{self, Break, LIMIT};
use super::data::{Methods, Question, SceneSeries, Series};
use super::name::value_text;
use super::scatter::{ROUNDING, line_at};
use crate::chart::{HEIGHT, Labels, Plot, Scale, chart, color, marker, n, zero_band};
use crate::numbers::share;
use maud::{Markup, html};

/// The break of one method's curve, and the adapters that share it.
pub(super) struct CurveBreak<'a> {
    pub(super) method: &'a str,
    pub(super) series: String,
    pub(super) adapters: Vec<&'a str>,
    pub(super) found: Break,
    pub(super) sentence: String,
    /// The parameter with its ends: `alpha 0.1 to 0.9`.
    range: String,
}

impl CurveBreak<'_> {
    /// True if the error crosses the limit within the parameter's range.
    pub(super) fn crosses(&self) -> bool {
        matches!(self.found, Break::Crossings(_))
    }
}

/// The parameters along which some method of the scene has a curve.
fn parameters<'a>(scene: &SceneSeries<'a>) -> Vec<&'a str> {
    let curves = scene.series.iter().filter(|s| s.values().len() > 1);
    let mut names: Vec<&str> = curves.filter_map(|s| s.parameter).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// The curves along a parameter.
fn curves<'s, 'a>(scene: &'s SceneSeries<'a>, parameter: &str) -> Vec<&'s Series<'a>> {
    let along = |s: &&Series<'a>| s.parameter == Some(parameter) && s.values().len() > 1;
    scene.series.iter().filter(along).collect()
}

/// The scale of a parameter in a scene.
fn scale(series: &[&Series<'_>]) -> Scale {
    let values: Vec<f64> = series.iter().flat_map(|s| s.values()).collect();
    Scale::fitting(&values)
}

/// Every method's break in a scene, in order; adapters that break alike together.
pub(super) fn found<'a>(methods: &Methods<'a>, scene: &SceneSeries<'a>) -> Vec<CurveBreak<'a>> {
    let mut result: Vec<CurveBreak<'a>> = Vec::new();
    for parameter in parameters(scene) {
        let all = curves(scene, parameter);
        let log = matches!(scale(&all), Scale::Log { .. });
        for series in all {
            let first = result.len();
            for (index, adapter) in methods.adapters.iter().enumerate() {
                let curve = series.curve(index);
                let (Some(start), Some(end)) = (curve.first(), curve.last()) else {
                    continue;
                };
                let Some(found) = breaks::find(&curve, log) else {
                    continue;
                };
                let range = format!(
                    "{parameter} {} to {}",
                    value_text(start.0),
                    value_text(end.0)
                );
                let sentence = found.sentence(&series.name(), parameter, &range);
                match result[first..].iter_mut().find(|f| f.sentence == sentence) {
                    Some(same) => same.adapters.push(adapter.name),
                    None => result.push(CurveBreak {
                        method: series.method,
                        series: series.name(),
                        adapters: vec![adapter.name],
                        sentence,
                        found,
                        range,
                    }),
                }
            }
        }
    }
    result
}

/// All charts of a scene, with the list of breaks; nothing where no method has a parameter.
pub(super) fn charts<'a>(
    methods: &Methods<'a>,
    question: &Question<'a>,
    scene: &SceneSeries<'a>,
) -> Markup {
    let parameters = parameters(scene);
    html! {
        @if !parameters.is_empty() {
            div.charts {
                @for parameter in &parameters {
                    @let series = curves(scene, parameter);
                    @for adapters in alike(methods, &series) {
                        (panel(methods, question, scene, parameter, &series, &adapters))
                    }
                }
            }
            (list(methods, scene))
        }
    }
}

/// The breaks of a scene: each crossing in a sentence, all that never crosses together.
fn list(methods: &Methods<'_>, scene: &SceneSeries<'_>) -> Markup {
    let (broken, steady): (Vec<_>, Vec<_>) =
        found(methods, scene).into_iter().partition(|f| f.crosses());
    let mut groups: Vec<(String, Vec<String>)> = Vec::new();
    for f in steady {
        let head = match f.found {
            Break::Always => format!("Always beyond 1\u{a0}% RMSE, {}", f.range),
            _ => format!("Never beyond 1\u{a0}% RMSE, {}", f.range),
        };
        let name = match f.adapters.len() {
            n if n == methods.adapters.len() => f.series,
            _ => format!("{} ({})", f.series, f.adapters.join(", ")),
        };
        match groups.iter_mut().find(|(h, _)| *h == head) {
            Some((_, names)) => names.push(name),
            None => groups.push((head, vec![name])),
        }
    }
    html! {
        ul.breaks {
            @for found in &broken {
                li {
                    (found.sentence)
                    @if methods.adapters.len() > 1 { " " small { "(" (who(methods, found)) ")" } }
                }
            }
            @for (head, names) in &groups { li { (head) ": " (names.join(", ")) } }
        }
    }
}

/// The adapters that a break was found on.
pub(super) fn who(methods: &Methods<'_>, found: &CurveBreak<'_>) -> String {
    if found.adapters.len() == methods.adapters.len() {
        "all adapters".to_owned()
    } else {
        found.adapters.join(", ")
    }
}

/// Adapters whose curves cannot be told apart in a chart, together.
fn alike(methods: &Methods<'_>, series: &[&Series<'_>]) -> Vec<Vec<usize>> {
    let of = |adapter: usize| -> Vec<Vec<(f64, f64)>> {
        series.iter().map(|s| s.curve(adapter)).collect()
    };
    let near = |a: f64, b: f64| (a - b).abs() <= 0.1 * a.max(b) || a.max(b) < 3.0 * ROUNDING;
    let same = |a: &[Vec<(f64, f64)>], b: &[Vec<(f64, f64)>]| {
        a.iter().zip(b).all(|(a, b)| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.0 == b.0 && near(a.1, b.1))
        })
    };
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for adapter in 0..methods.adapters.len() {
        let own = of(adapter);
        if own.iter().all(Vec::is_empty) {
            continue;
        }
        match groups.iter_mut().find(|g| same(&of(g[0]), &own)) {
            Some(group) => group.push(adapter),
            None => groups.push(vec![adapter]),
        }
    }
    groups
}

fn panel<'a>(
    methods: &Methods<'a>,
    question: &Question<'a>,
    scene: &SceneSeries<'a>,
    parameter: &str,
    series: &[&Series<'a>],
    adapters: &[usize],
) -> Markup {
    let on = adapters[0];
    let errors = series
        .iter()
        .flat_map(|s| s.points.iter().filter_map(|p| p.error()));
    let x = scale(series);
    let log = matches!(x, Scale::Log { .. });
    let plot = Plot {
        x,
        y: Scale::log(errors.clone().filter(|e| *e > 0.0).chain([LIMIT])),
        zero: zero_band(errors),
    };
    let names: Vec<&str> = adapters.iter().map(|a| methods.adapters[*a].name).collect();
    let title = match names.len() {
        n if n == methods.adapters.len() && n > 1 => format!("{}, all adapters", scene.name),
        1 | 2 => format!("{} on {}", scene.name, names.join(", ")),
        n => format!("{} on {} and {} like it", scene.name, names[0], n - 1),
    };
    let places = |s: &Series<'_>| -> Vec<(f64, f64)> {
        s.curve(on)
            .iter()
            .map(|(v, e)| (plot.x(*v), plot.y(*e)))
            .collect()
    };
    let mut labels = Labels::new(series.iter().flat_map(|s| places(s)));
    let body = html! {
        (plot.frame(value_text, share, parameter, "RMSE, share of full brightness"))
        (line_at(&plot, LIMIT, "one"))
        @for s in series {
            @let places = places(s);
            path class={ "curve " (color(question.style(s.method))) } d=(line(&places)) {}
        }
        @for s in series {
            @let (style, places) = (question.style(s.method), places(s));
            @for ((value, error), place) in s.curve(on).into_iter().zip(places) {
                @let text = format!("{}: RMSE {} at {parameter} {}", s.name(), share(error), value_text(value));
                (marker(style, place, true, &text))
            }
        }
        @for s in series {
            @if let Some(Break::Crossings(crossings)) = breaks::find(&s.curve(on), log) {
                @for c in crossings {
                    @let text = c.text();
                    @let at = (plot.x(c.value), plot.y(LIMIT));
                    circle class={ "break " (color(question.style(s.method))) } cx=(n(at.0)) cy=(n(at.1)) r="6" {
                        title { (s.name()) @if c.leaves { " leaves" } @else { " comes within" } " 1 % RMSE at " (parameter) " " (text) }
                    }
                    @if let Some((x, y)) = labels.place(&text, at) {
                        text.label x=(n(x)) y=(n(y)) { (text) }
                    }
                }
            }
        }
    };
    let body = html! {
        (body)
        @for s in series {
            @if let Some(end) = places(s).last().copied() {
                @let name = s.name();
                @if let Some((x, y)) = labels.place(&name, end) {
                    text.label x=(n(x)) y=(n(y)) { (name) }
                }
            }
        }
    };
    let about = format!(
        "The error along {parameter}, one curve per method; rings mark where a curve crosses 1 %. On {}.",
        names.join(", ")
    );
    chart(HEIGHT, &title, &about, &body)
}

fn line(places: &[(f64, f64)]) -> String {
    let mut path = String::new();
    for (i, (x, y)) in places.iter().enumerate() {
        let letter = if i == 0 { 'M' } else { 'L' };
        path.push_str(&format!("{letter}{} {}", n(*x), n(*y)));
    }
    path
}

/// The explanation of the charts of stability.
pub(super) fn caption() -> Markup {
    html! {
        p {
            "The error along the parameter of a scene, one curve per method. Where a curve crosses an RMSE of "
            "1 % of full brightness, the dotted line, the method breaks: the ring marks the place, "
            "interpolated between the logarithms of the errors beside it. Adapters whose "
            "errors differ by less than a tenth, or by no more than a few roundings to 8 bits make, share a chart, which shows the first of them."
        }
    }
}
