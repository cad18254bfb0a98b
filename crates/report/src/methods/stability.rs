//! Stability: the error along a parameter, one curve per method, with break points.

use super::breaks::{self, Break, LIMIT};
use super::data::{MethodSeries, Methods, SceneSeries, ShownScene};
use super::name::value_text;
use super::scatter::{ROUNDING, line_at};
use crate::chart::{
    BOTTOM, HEIGHT, LEFT, LabelPlaces, Plot, RIGHT, Scale, TOP, chart, color, dash, marker, n,
    polyline, zero_band,
};
use crate::lists::grouped;
use crate::numbers::share;
use maud::{Markup, html};
use std::collections::BTreeSet;

/// Returns the parameters along which some method of the scene has a curve.
fn parameters<'a>(scene: &SceneSeries<'a>) -> BTreeSet<&'a str> {
    let curves = scene.series.iter().filter(|s| s.values().len() > 1);
    curves.filter_map(|s| s.parameter).collect()
}

/// Returns the curves along a parameter.
fn curves<'s, 'a>(scene: &'s SceneSeries<'a>, parameter: &str) -> Vec<&'s MethodSeries<'a>> {
    let along = |s: &&MethodSeries<'a>| s.parameter == Some(parameter) && s.values().len() > 1;
    scene.series.iter().filter(along).collect()
}

/// Returns the scale of a parameter in a scene.
fn scale(series: &[&MethodSeries<'_>]) -> Scale {
    let values: Vec<f64> = series.iter().flat_map(|s| s.values()).collect();
    Scale::fitting(&values)
}

/// Returns the break of a curve on an adapter; `None` for fewer than two values.
pub(super) fn break_of(
    scene: &SceneSeries<'_>,
    series: &MethodSeries<'_>,
    adapter: usize,
) -> Option<Break> {
    let log = matches!(scale(&curves(scene, series.parameter?)), Scale::Log(..));
    breaks::find(&series.curve(adapter), log)
}

/// Returns all charts of a scene; empty if no method has several values of a parameter.
pub(super) fn charts(shown: &ShownScene<'_, '_>) -> Vec<Markup> {
    let mut panels = Vec::new();
    for parameter in parameters(shown.scene) {
        let found = curves(shown.scene, parameter);
        let variants: BTreeSet<&str> = found.iter().map(|s| s.variant.as_str()).collect();
        for variant in variants {
            let in_variant = found.iter().copied().filter(|s| s.variant == variant);
            let series: Vec<&MethodSeries<'_>> = in_variant.collect();
            let adapters = alike(shown.methods, &series).into_iter();
            panels.extend(adapters.map(|on| panel(shown, parameter, variant, &series, &on)));
        }
    }
    panels
}

/// Returns the crossings of all scenes for a terminal. Adapters with equal ones share a line.
pub(super) fn lines(methods: &Methods<'_>) -> Vec<String> {
    let mut found = Vec::new();
    for scene in methods.scenes() {
        for series in &scene.series {
            for (index, adapter) in methods.adapters.iter().enumerate() {
                if let Some(Break::Crossings(crossings)) = break_of(scene, series, index) {
                    let parameter = series.parameter.unwrap_or_default();
                    let sentence = breaks::sentence(&series.name(), parameter, &crossings);
                    let line = format!("{}/{}: {sentence}", scene.question, scene.name);
                    found.push((line, adapter.name));
                }
            }
        }
    }
    let line = |(line, on): (String, Vec<&str>)| {
        if on.len() == methods.adapters.len() {
            format!("{line} (all adapters)")
        } else {
            format!("{line} ({})", on.join(", "))
        }
    };
    grouped(found).into_iter().map(line).collect()
}

/// Groups adapters whose curves look the same in a chart.
fn alike(methods: &Methods<'_>, series: &[&MethodSeries<'_>]) -> Vec<Vec<usize>> {
    let lines = |adapter: usize| -> Vec<Vec<(f64, f64)>> {
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
        let curves_of = lines(adapter);
        if curves_of.iter().all(Vec::is_empty) {
            continue;
        }
        match groups.iter_mut().find(|g| same(&lines(g[0]), &curves_of)) {
            Some(group) => group.push(adapter),
            None => groups.push(vec![adapter]),
        }
    }
    groups
}

/// Returns the panel of a scene. One part of the panel after the other.
fn panel(
    shown: &ShownScene<'_, '_>,
    parameter: &str,
    variant: &str,
    series: &[&MethodSeries<'_>],
    adapters: &[usize],
) -> Markup {
    let (methods, scene) = (shown.methods, shown.scene);
    let on = adapters[0];
    let errors = series
        .iter()
        .flat_map(|s| s.points.iter().filter_map(|p| p.error()));
    let x = scale(series);
    let log = matches!(x, Scale::Log(..));
    let plot = Plot {
        x,
        y: Scale::log(errors.clone().filter(|e| *e > 0.0).chain([LIMIT])),
        zero: zero_band(errors),
    };
    let names: Vec<&str> = adapters.iter().map(|a| methods.adapters[*a].name).collect();
    let what = match variant {
        "" => format!("{} along {parameter}", scene.name),
        variant => format!("{} along {parameter}, {variant}", scene.name),
    };
    let title = match names.len() {
        n if n == methods.adapters.len() && n > 1 => format!("{what}, all adapters"),
        1 | 2 => format!("{what} on {}", names.join(", ")),
        n => format!("{what} on {} and {} like it", names[0], n - 1),
    };
    let places = |s: &MethodSeries<'_>| -> Vec<(f64, f64)> {
        s.curve(on)
            .iter()
            .map(|(v, e)| (plot.x(*v), plot.y(*e)))
            .collect()
    };
    let mut labels = LabelPlaces::new(series.iter().flat_map(|s| places(s)));
    for s in series {
        labels.avoid(&places(s));
    }
    labels.avoid(&[(LEFT, plot.y(LIMIT)), (RIGHT, plot.y(LIMIT))]);
    let cursors = shown
        .settings
        .iter()
        .enumerate()
        .filter_map(|(index, setting)| {
            let (name, value) = setting.parameter?;
            (name == parameter && setting.variant == variant).then(|| (index, plot.x(value)))
        });
    let crossings = |s: &MethodSeries<'_>| match breaks::find(&s.curve(on), log) {
        Some(Break::Crossings(crossings)) => crossings,
        _ => Vec::new(),
    };
    // Breaks get labels before methods do, because the legend has the methods' names too.
    let rings: Vec<Vec<_>> = series
        .iter()
        .map(|s| {
            let rings = crossings(s).into_iter().map(|c| {
                let center = (plot.x(c.value), plot.y(LIMIT));
                (c, center, labels.place(&c.text(), center))
            });
            rings.collect()
        })
        .collect();
    let ends: Vec<Option<(f64, f64)>> = series
        .iter()
        .map(|s| labels.place(s.method, places(s).last().copied()?))
        .collect();
    let body = html! {
        (plot.frame(value_text, share, parameter, "← more accurate: RMSE"))
        (line_at(&plot, LIMIT, "one"))
        @for (index, x) in cursors {
            path class=(shown.class("cursor", index)) data-at=(index) d={ "M" (n(x)) " " (n(TOP)) "V" (n(BOTTOM)) } {}
        }
        @for s in series {
            @let (style, places) = (shown.style(s.method), places(s));
            g class={ "of " (color(style)) } {
                path class={ "curve " (color(style)) } d=(polyline(&places)) stroke-dasharray=(dash(style)) {}
                @for ((value, error), place) in s.curve(on).into_iter().zip(places) {
                    @let text = format!("{}: RMSE {} at {parameter} {}", s.name(), share(error), value_text(value));
                    (marker(style, place, true, &text))
                }
            }
        }
        g.rings {
            @for (s, rings) in series.iter().zip(&rings) {
                @let style = color(shown.style(s.method));
                @for (c, center, label) in rings {
                    g class={ "of " (style) } {
                        circle class={ "break " (style) } cx=(n(center.0)) cy=(n(center.1)) r="6" {
                            title { (s.name()) @if c.leaves { " leaves" } @else { " comes within" } " 1 % RMSE at " (parameter) " " (c.text()) }
                        }
                        @if let Some((x, y)) = label {
                            text.label x=(n(*x)) y=(n(*y)) { (c.text()) }
                        }
                    }
                }
            }
        }
        @for (s, end) in series.iter().zip(&ends) {
            @if let Some((x, y)) = end {
                g class={ "of " (color(shown.style(s.method))) } {
                    text.label x=(n(*x)) y=(n(*y)) { (s.method) }
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

/// Returns the caption that explains the charts of stability.
pub(super) fn caption() -> Markup {
    html! {
        p {
            "The error along the parameter of a scene, one curve per method; the broad line marks the value that the other "
            "charts and the pictures show. Where a curve crosses an RMSE of "
            "1 % of full brightness, the dotted line, the method breaks: the ring marks the place, "
            "interpolated between the logarithms of the errors beside it. Adapters whose "
            "errors differ by less than a tenth, or by no more than a few roundings to 8 bits make, share a chart, which shows the first of them."
        }
    }
}
