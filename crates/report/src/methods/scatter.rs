//! Accuracy against speed: a chart per scene and adapter, with a Pareto front for each setting.

use super::data::{DeviceKind, SceneSetting, SeriesPoint, ShownScene};
use super::front::front;
use crate::chart::{
    BOTTOM, HEIGHT, LEFT, LabelPlaces, Plot, RIGHT, Scale, TOP, chart, color, marker, n, polyline,
    zero_band,
};
use crate::numbers::{between, duration, round_duration, share};
use maud::{Markup, html};

/// The RMSE that rounding to 8 bits causes if values are spread evenly between codes: the standard deviation
/// of a uniform distribution one code wide.
pub(super) const ROUNDING: f64 = 1.0 / (255.0 * 3.464_101_615_137_754_4);

/// One point of a chart.
struct Dot<'s, 'a> {
    point: &'s SeriesPoint<'a>,
    /// The index of the method in its question.
    style: usize,
    /// The index of its setting.
    setting: usize,
    time: f64,
    error: f64,
}

/// The charts of one kind of adapter.
pub(super) struct OfKind {
    /// The heading above the charts, if there are several kinds.
    pub(super) heading: Option<&'static str>,
    /// One chart per adapter.
    pub(super) panels: Vec<Markup>,
}

/// Returns all charts of a scene, with software and hardware adapters apart. All settings share the axes, so
/// a method's mark moves on them from setting to setting.
pub(super) fn charts(shown: &ShownScene<'_, '_>) -> Vec<OfKind> {
    let methods = shown.methods;
    let dots = dots(shown);
    let positive: Vec<f64> = dots.iter().map(|d| d.error).filter(|e| *e > 0.0).collect();
    let y = Scale::log(positive.iter().copied().chain([0.01]));
    let zero = zero_band(dots.iter().map(|d| d.error));
    let kinds = methods.kinds();
    let mut result = Vec::new();
    for kind in &kinds {
        let of_kind: Vec<&Dot<'_, '_>> = dots
            .iter()
            .filter(|d| methods.adapters[d.point.adapter].kind == *kind)
            .collect();
        if of_kind.is_empty() {
            continue;
        }
        let ends = |d: &&Dot<'_, '_>| {
            let interval = d.point.interval();
            [d.time].into_iter().chain(interval.into_iter().flatten())
        };
        let x = Scale::log(of_kind.iter().flat_map(ends));
        let plot = Plot { x, y, zero };
        let adapters = methods.adapters.iter().enumerate();
        let panels = adapters.filter_map(|(index, adapter)| {
            let drew = of_kind.iter().any(|d| d.point.adapter == index);
            let title = format!(
                "{} on {}, as a small picture",
                shown.scene.name, adapter.name
            );
            drew.then(|| panel(shown, &title, &plot, &of_kind, index))
        });
        result.push(OfKind {
            heading: (kinds.len() > 1).then(|| heading(*kind)),
            panels: panels.collect(),
        });
    }
    result
}

fn heading(kind: DeviceKind) -> &'static str {
    match kind {
        DeviceKind::Software => "Software adapters, which draw with the processor",
        DeviceKind::Hardware => "Hardware adapters",
        DeviceKind::Unknown => "Adapters of unknown kind",
    }
}

fn dots<'s, 'a>(shown: &'s ShownScene<'s, 'a>) -> Vec<Dot<'s, 'a>> {
    let mut dots = Vec::new();
    for (index, setting) in shown.settings.iter().enumerate() {
        for (series, point) in shown.scene.at(setting) {
            if let (Some(time), Some(error)) = (point.wall(), point.error()) {
                dots.push(Dot {
                    point,
                    style: shown.style(series.method),
                    setting: index,
                    time,
                    error,
                });
            }
        }
    }
    dots
}

fn panel(
    shown: &ShownScene<'_, '_>,
    title: &str,
    plot: &Plot,
    dots: &[&Dot<'_, '_>],
    adapter: usize,
) -> Markup {
    let mut about = String::new();
    let settings = shown.settings.iter().enumerate();
    let groups: Vec<Markup> = settings
        .map(|(index, setting)| {
            let dots = dots.iter().copied();
            let same: Vec<_> = dots.filter(|d| d.setting == index).collect();
            let line = same.iter().copied();
            let line: Vec<_> = line.filter(|d| d.point.adapter == adapter).collect();
            let (text, body) = at_setting(plot, &same, &line, setting);
            if index == shown.main {
                about = text;
            }
            html! { g class=(shown.class("dots", index)) data-at=(index) { (body) } }
        })
        .collect();
    let body = html! {
        (plot.frame(round_duration, share, "← faster: frame time", "← more accurate: RMSE"))
        (line_at(plot, 0.01, "one"))
        (line_at(plot, ROUNDING, "rounding"))
        @for group in &groups { (group) }
    };
    chart(HEIGHT, title, &about, &body)
}

/// Returns the marks and fronts of one setting, and the front in words.
fn at_setting(
    plot: &Plot,
    same: &[&Dot<'_, '_>],
    line: &[&Dot<'_, '_>],
    setting: &SceneSetting<'_>,
) -> (String, Markup) {
    let costs = |dots: &[&Dot<'_, '_>]| -> Vec<(f64, f64)> {
        dots.iter().map(|d| (d.time, d.error)).collect()
    };
    let (every, mine) = (costs(same), costs(line));
    let leaders: Vec<&Dot<'_, '_>> = front(&mine).iter().map(|i| line[*i]).collect();
    let names: Vec<&str> = leaders
        .iter()
        .map(|d| d.point.measured.method.as_str())
        .collect();
    let setting_text = setting.at();
    let about = match names.as_slice() {
        [] => format!("No method was timed{setting_text}."),
        [one] if line.len() == 1 => {
            format!("Only {one} was timed{setting_text}: there is nothing to compare.")
        }
        [name] => format!("No method is faster or more accurate than {name}{setting_text}."),
        several => format!(
            "The front{setting_text}, from fast to accurate: {}.",
            several.join(", ")
        ),
    };
    let place = |d: &Dot<'_, '_>| (plot.x(d.time), plot.y(d.error));
    let mut labels = LabelPlaces::new(line.iter().map(|d| place(d)));
    for level in [0.01, ROUNDING] {
        labels.avoid(&[(LEFT, plot.y(level)), (RIGHT, plot.y(level))]);
    }
    let lines = [(every.clone(), "group"), (mine.clone(), "front")];
    // A single point is not a front, because nothing was compared with it.
    let lines: Vec<(Vec<(f64, f64)>, &str)> = lines
        .into_iter()
        .filter(|(points, class)| points.len() > 1 && (*class == "front" || every != mine))
        .map(|(points, class)| (steps(plot, &points), class))
        .collect();
    for (corners, _) in &lines {
        labels.avoid(corners);
    }
    for dot in line {
        if let Some([low, high]) = dot.point.interval() {
            let y = plot.y(dot.error);
            labels.avoid(&[(plot.x(low), y), (plot.x(high), y)]);
        }
    }
    // Leaders first: if there is no room for all names, the names of the front are kept.
    let others = line.iter().copied();
    let others = others.filter(|d| !leaders.iter().any(|l| std::ptr::eq(*l, *d)));
    let named: Vec<(&Dot<'_, '_>, Option<(f64, f64)>)> = leaders
        .iter()
        .copied()
        .chain(others)
        .map(|d| (d, labels.place(&d.point.measured.method, place(d))))
        .collect();
    let body = html! {
        @for (corners, class) in &lines { path class=(class) d=(polyline(corners)) {} }
        @for (dot, label) in named.iter().rev() {
            @let m = dot.point.measured;
            @let interval = dot.point.interval();
            g class={ "of " (color(dot.style)) } {
                @if let Some([low, high]) = interval {
                    @let (y, from, to) = (plot.y(dot.error), plot.x(low), plot.x(high));
                    @if to - from > 1.0 {
                        path.spread d={ "M" (n(from)) " " (n(y - 3.0)) "v6M" (n(from)) " " (n(y)) "H" (n(to)) "M" (n(to)) " " (n(y - 3.0)) "v6" } {}
                    }
                }
                (marker(dot.style, place(dot), false, &format!("{}{setting_text}: RMSE {}, {}", m.method, share(dot.error), with_interval(dot.time, interval))))
                @if let Some((x, y)) = label {
                    text.label x=(n(*x)) y=(n(*y)) { (m.method) }
                }
            }
        }
    };
    (about, body)
}

/// Returns a time with its interval: `1.2 ms (1.1 ms to 1.4 ms)`.
pub(super) fn with_interval(time: f64, interval: Option<[f64; 2]>) -> String {
    match interval {
        Some(ends) => format!("{} ({})", duration(time), between(ends, duration)),
        None => duration(time),
    }
}

/// Returns the corners of the front as steps: between two of its points, the best known method is the faster
/// one.
pub(super) fn steps(plot: &Plot, points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut corners: Vec<(f64, f64)> = Vec::new();
    for index in front(points) {
        let (x, y) = (plot.x(points[index].0), plot.y(points[index].1));
        match corners.last() {
            None => corners.push((x, TOP)),
            Some((_, above)) => corners.push((x, *above)),
        }
        corners.push((x, y));
    }
    if let Some((_, y)) = corners.last().copied() {
        corners.push((RIGHT, y));
    }
    corners
}

/// Returns the explanation of the charts of accuracy against speed.
pub(super) fn caption() -> Markup {
    html! {
        p {
            "Each chart is one adapter at one setting of the scene: a point is a method, the farther left the faster, the farther "
            "down the nearer to the truth. Methods are compared at the same parameters only; the slider moves all of them to "
            "other ones. The " b { "solid line" } " is the Pareto front of this "
            "adapter: a method above or right of it is beaten by another. The "
            b { "dashed line" } " is the front of all adapters of the same kind; software and hardware never "
            "share one. Where there are pictures without any error, a band at the bottom holds them. Dotted lines: an RMSE of 1 %, and what "
            "rounding to 8 bits alone costs (" (share(ROUNDING)) "). Frame time is the median wall time of a "
            "frame until the device was done; a picture that the rules forbid gets no time. The bar is the interval that holds the median "
            "with 95 % confidence or, of fewer than six frames, the fastest and the slowest."
        }
        p {
            b { "Short times are overhead." } " A picture has about 128 by 128 texels: submission, waiting and the start of each pass are a large "
            "part of a frame below a millisecond, and most of it on a fast device. Such times order methods by their number of passes and draws "
            "rather than by their fragments, which are counted in the table."
        }
    }
}

/// Returns a dotted line at an error, if the error is within the plot.
pub(super) fn line_at(plot: &Plot, error: f64, class: &str) -> Markup {
    let y = plot.y(error);
    let shown = y > TOP + 1.0 && y < BOTTOM - plot.zero - 1.0;
    html! {
        @if shown { path class={ "level " (class) } d={ "M" (n(LEFT)) " " (n(y)) "H" (n(RIGHT)) } {} }
    }
}
