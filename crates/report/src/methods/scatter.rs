//! Accuracy against speed: a chart per scene and adapter, with fronts.

use super::data::{Kind, Methods, Point, Question, SceneSeries};
use super::front::front;
use super::name::value_text;
use crate::chart::{
    BOTTOM, HEIGHT, LEFT, Labels, Plot, RIGHT, Scale, TOP, chart, marker, n, zero_band,
};
use crate::numbers::{duration, round_duration, share};
use maud::{Markup, html};

/// The error of rounding to 8 bits alone where values lie anywhere between two codes: the standard
/// deviation of a uniform distribution one code wide.
pub(super) const ROUNDING: f64 = 1.0 / (255.0 * 3.464_101_615_137_754_4);

/// One point of a chart.
struct Dot<'s, 'a> {
    point: &'s Point<'a>,
    /// Position of the method in its question.
    style: usize,
    name: String,
    /// True if it stands for its series: the only point, or that of the middle value.
    main: bool,
    time: f64,
    error: f64,
}

/// All charts of a scene: software and hardware adapters apart.
pub(super) fn charts(
    methods: &Methods<'_>,
    question: &Question<'_>,
    scene: &SceneSeries<'_>,
) -> Markup {
    let dots = dots(question, scene);
    let positive: Vec<f64> = dots.iter().map(|d| d.error).filter(|e| *e > 0.0).collect();
    let y = Scale::log(positive.iter().copied().chain([0.01]));
    let zero = zero_band(dots.iter().map(|d| d.error));
    let kinds = methods.kinds();
    html! {
        @for kind in &kinds {
            @let of_kind: Vec<&Dot<'_, '_>> = dots
                .iter()
                .filter(|d| methods.adapters[d.point.adapter].kind == *kind)
                .collect();
            @if !of_kind.is_empty() {
                @if kinds.len() > 1 { p.cap { (heading(*kind)) } }
                @let x = Scale::log(of_kind.iter().map(|d| d.time));
                @let plot = Plot { x, y, zero };
                div.charts.speed {
                    @for (index, adapter) in methods.adapters.iter().enumerate() {
                        @let own: Vec<&Dot<'_, '_>> = of_kind.iter().copied().filter(|d| d.point.adapter == index).collect();
                        @if !own.is_empty() {
                            (panel(scene, adapter.name, &plot, &of_kind, &own))
                        }
                    }
                }
            }
        }
    }
}

fn heading(kind: Kind) -> &'static str {
    match kind {
        Kind::Software => "Software adapters, which draw with the processor",
        Kind::Hardware => "Hardware adapters",
        Kind::Unknown => "Adapters of unknown kind",
    }
}

fn dots<'s, 'a>(question: &Question<'a>, scene: &'s SceneSeries<'a>) -> Vec<Dot<'s, 'a>> {
    let mut dots = Vec::new();
    for series in &scene.series {
        let style = question.style(series.method);
        let middle = series.middle();
        for point in &series.points {
            if let (Some(time), Some(error)) = (point.wall(), point.error()) {
                dots.push(Dot {
                    point,
                    style,
                    name: match (point.value, series.parameter) {
                        (Some(v), Some(p)) => {
                            format!("{}, {p} {}", series.name(), value_text(v))
                        }
                        _ => series.name(),
                    },
                    main: point.value == middle,
                    time,
                    error,
                });
            }
        }
    }
    dots
}

fn panel(
    scene: &SceneSeries<'_>,
    adapter: &str,
    plot: &Plot,
    all: &[&Dot<'_, '_>],
    own: &[&Dot<'_, '_>],
) -> Markup {
    let costs = |dots: &[&Dot<'_, '_>]| -> Vec<(f64, f64)> {
        dots.iter().map(|d| (d.time, d.error)).collect()
    };
    let main = |dots: &[&Dot<'_, '_>]| -> Vec<(f64, f64)> {
        let main: Vec<&Dot<'_, '_>> = dots.iter().copied().filter(|d| d.main).collect();
        costs(&main)
    };
    let (every, mine) = (main(all), main(own));
    let best = front(&mine);
    let leaders: Vec<&Dot<'_, '_>> = {
        let own: Vec<&Dot<'_, '_>> = own.iter().copied().filter(|d| d.main).collect();
        best.iter().map(|i| own[*i]).collect()
    };
    let names: Vec<&str> = leaders
        .iter()
        .map(|d| d.point.measured.method.as_str())
        .collect();
    let about = match names.as_slice() {
        [] => "No method was timed.".to_owned(),
        [one] => format!("No method is faster or more accurate than {one}."),
        several => format!("The front, from fast to accurate: {}.", several.join(", ")),
    };
    let at = |d: &Dot<'_, '_>| (plot.x(d.time), plot.y(d.error));
    let mut labels = Labels::new(own.iter().map(|d| at(d)));
    let title = format!("{} on {adapter}", scene.name);
    let body = html! {
        (plot.frame(round_duration, share, "frame time", "RMSE, share of full brightness"))
        (line_at(plot, 0.01, "one"))
        (line_at(plot, ROUNDING, "rounding"))
        @if every != mine { (steps(plot, &every, "group")) }
        (steps(plot, &mine, "front"))
        @for dot in own.iter().filter(|d| !d.main).chain(own.iter().filter(|d| d.main)) {
            @let text = format!("{}: RMSE {}, {} on {adapter}", dot.name, share(dot.error), duration(dot.time));
            (marker(dot.style, at(dot), !dot.main, &text))
        }
        @for dot in &leaders {
            @let name = &dot.point.measured.method;
            @if let Some((x, y)) = labels.place(name, at(dot)) {
                text.label x=(n(x)) y=(n(y)) { (name) }
            }
        }
    };
    chart(HEIGHT, &title, &about, &body)
}

/// The front as steps: between two of its points nothing better than the faster one is known.
fn steps(plot: &Plot, points: &[(f64, f64)], class: &str) -> Markup {
    let mut path = String::new();
    for (i, at) in front(points).into_iter().enumerate() {
        let (x, y) = (plot.x(points[at].0), plot.y(points[at].1));
        if i == 0 {
            path.push_str(&format!("M{} {}V{}", n(x), n(TOP), n(y)));
        } else {
            path.push_str(&format!("H{}V{}", n(x), n(y)));
        }
    }
    if !path.is_empty() {
        path.push_str(&format!("H{}", n(RIGHT)));
    }
    html! { @if !path.is_empty() { path class=(class) d=(path) {} } }
}

/// The explanation of the charts of accuracy against speed.
pub(super) fn caption() -> Markup {
    html! {
        p {
            "Each chart is one adapter: a point is a method, the farther left the faster, the farther "
            "down the nearer to the truth. Of a method with a parameter the middle value is the full "
            "point and all others are the faint ones. The " b { "solid line" } " is the Pareto front of this "
            "adapter's full points: a method above or right of it is beaten by another. The "
            b { "dashed line" } " is the front of all adapters of the same kind; software and hardware never "
            "share one. Where there are pictures without any error, a band at the bottom holds them. Dotted lines: an RMSE of 1 %, and what "
            "rounding to 8 bits alone costs (" (share(ROUNDING)) "). Frame time is the median wall time of a "
            "frame until the device was done; a picture that the rules forbid gets no time."
        }
    }
}

/// A dotted line at an error, where the plot shows it.
pub(super) fn line_at(plot: &Plot, error: f64, class: &str) -> Markup {
    let y = plot.y(error);
    let shown = y > TOP + 1.0 && y < BOTTOM - plot.zero - 1.0;
    html! {
        @if shown { path class={ "level " (class) } d={ "M" (n(LEFT)) " " (n(y)) "H" (n(RIGHT)) } {} }
    }
}
