//! The first screen of the page of methods: a small chart and a sentence for each question, and the methods
//! that fit a budget.

use super::data::{Methods, Question, SeriesPoint, ShownScene};
use super::front::{front, undecided};
use super::scatter::steps;
use crate::chart::{
    BOTTOM, LEFT, Plot, RIGHT, Scale, TOP, color, key, marker, n, polyline, zero_band,
};
use crate::numbers::{count, duration, share};
use maud::{Markup, html};
use serde_json::json;

/// Width and height of a small chart, in pixels.
const SIZE: [f64; 2] = [232.0, 120.0];
/// The room for marks around it.
const MARGIN: f64 = 9.0;
/// A frame time in seconds that leaves most of a frame to other work.
const SHORT: f64 = 0.001;

/// A method's time and error on an adapter, at the setting that represents its scene.
struct TimedMethod<'a> {
    method: &'a str,
    adapter: usize,
    time: f64,
    /// The interval of the time.
    interval: Option<[f64; 2]>,
    error: f64,
}

/// Returns the charts of all questions, with the choice of an adapter and of a budget.
pub(super) fn section(methods: &Methods<'_>, shown: &[ShownScene<'_, '_>]) -> Markup {
    html! {
        section id="overview" {
            h2 { "Which method, at which price?" }
            p.lead {
                "A chart per question, of the scene that most methods draw: to the left what is faster, below what is more accurate. "
                "The line joins the methods that no other one beats, the dots mark an error of 1 %."
            }
            form.budget id="budget" hidden {
                label { "On " select id="on" {
                    @for (index, adapter) in methods.adapters.iter().enumerate() {
                        option value=(index) { (adapter.name) }
                    }
                } }
                (limit("most-time", "Frame time at most"))
                (limit("most-error", "RMSE at most"))
            }
            div.cards {
                @for (q, question) in methods.questions.iter().enumerate() { (card(methods, q, &AnsweredQuestion::of(question, shown))) }
            }
        }
    }
}

/// Returns a slider, whose stops the script knows.
fn limit(id: &str, name: &str) -> Markup {
    html! {
        label for=(id) { (name) " " output for=(id) { "any" } " " input id=(id) type="range" min="0" step="1"; }
    }
}

/// The maximum number of adapters that a terminal lists for a question.
const ADAPTERS: usize = 4;

/// A question's scenes, and the timed methods of each.
struct AnsweredQuestion<'s, 'a> {
    question: &'s Question<'a>,
    scenes: Vec<&'s ShownScene<'s, 'a>>,
    /// The timed methods, by scene.
    timed: Vec<Vec<TimedMethod<'a>>>,
}

impl<'s, 'a> AnsweredQuestion<'s, 'a> {
    fn of(question: &'s Question<'a>, shown: &'s [ShownScene<'s, 'a>]) -> Self {
        let scenes = shown
            .iter()
            .filter(|shown| std::ptr::eq(shown.question, question));
        let scenes: Vec<&ShownScene<'_, '_>> = scenes.collect();
        Self {
            question,
            timed: scenes.iter().map(|shown| timed(shown)).collect(),
            scenes,
        }
    }

    /// Returns the scene in which the most methods were timed, with these methods; `None` if no method was timed.
    fn fullest(&self) -> Option<(&'s ShownScene<'s, 'a>, &[TimedMethod<'a>])> {
        let timed = self.timed.iter().enumerate();
        let fullest = timed.max_by_key(|(place, points)| (points.len(), std::cmp::Reverse(*place)));
        let (place, points) = fullest.filter(|(_, points)| !points.is_empty())?;
        Some((self.scenes[place], points))
    }
}

/// Returns the sentences of all questions for a terminal, one per adapter.
pub(super) fn lines(methods: &Methods<'_>, shown: &[ShownScene<'_, '_>]) -> Vec<String> {
    let mut lines = Vec::new();
    for question in &methods.questions {
        let found = AnsweredQuestion::of(question, shown);
        let Some((scene, timed)) = found.fullest() else {
            lines.push(format!("{}: not timed", question.name));
            continue;
        };
        lines.push(format!(
            "{}, in {}{}",
            question.name,
            scene.scene.name,
            scene.settings[scene.main].at()
        ));
        let adapters = methods.adapters.iter().enumerate();
        lines.extend(
            adapters
                .take(ADAPTERS)
                .map(|(number, adapter)| format!("  {}: {}", adapter.name, answer(timed, number))),
        );
        if let Some(more @ 1..) = methods.adapters.len().checked_sub(ADAPTERS) {
            lines.push(format!("  and {}", count(more as u64, "more adapter")));
        }
    }
    lines
}

fn card(methods: &Methods<'_>, number: usize, found: &AnsweredQuestion<'_, '_>) -> Markup {
    let points: Vec<_> = found
        .timed
        .iter()
        .enumerate()
        .flat_map(|(scene, timed)| {
            timed
                .iter()
                .map(move |t| json!([t.method, scene, t.adapter, t.time, t.error]))
        })
        .collect();
    let fullest = found.fullest();
    html! {
        article.card data-points=(json!(points)) {
            h3 { a href={ "#q" (number) } { (super::name::title(found.question.name)) } }
            @match fullest {
                Some((scene, points)) => {
                    @for (adapter, _) in methods.adapters.iter().enumerate() {
                        div class=(if adapter == 0 { "on" } else { "on off" }) data-on=(adapter) {
                            (chart(found.question, scene, points, adapter))
                            p.answer { (answer(points, adapter)) }
                        }
                    }
                }
                None => p.u { "Not timed." }
            }
            p.left {}
            p.of {
                @if let Some((scene, _)) = fullest { "In " (scene.scene.name) ", one of " }
                (count(found.scenes.len() as u64, "scene"))
            }
        }
    }
}

/// Returns the methods of a scene at the setting that represents it.
fn timed<'a>(shown: &ShownScene<'_, 'a>) -> Vec<TimedMethod<'a>> {
    let Some(setting) = shown.settings.get(shown.main) else {
        return Vec::new();
    };
    let of_point = |method: &'a str, point: &SeriesPoint<'a>| {
        Some(TimedMethod {
            method,
            adapter: point.adapter,
            time: point.wall()?,
            interval: point.interval(),
            error: point.error()?,
        })
    };
    let points = shown.scene.at(setting);
    points
        .filter_map(|(series, point)| of_point(series.method, point))
        .collect()
}

/// Returns the chart of a scene on an adapter. Its axes fit all adapters.
fn chart(
    question: &Question<'_>,
    shown: &ShownScene<'_, '_>,
    points: &[TimedMethod<'_>],
    adapter: usize,
) -> Markup {
    let positive = points.iter().map(|t| t.error).filter(|error| *error > 0.0);
    let plot = Plot {
        x: Scale::log(points.iter().map(|t| t.time)),
        y: Scale::log(positive.chain([super::breaks::LIMIT])),
        zero: zero_band(points.iter().map(|t| t.error)),
    };
    let small = |(x, y): (f64, f64)| {
        let [width, height] = SIZE;
        (
            (x - LEFT) / (RIGHT - LEFT) * width,
            (y - TOP) / (BOTTOM - TOP) * height,
        )
    };
    let here: Vec<&TimedMethod<'_>> = points.iter().filter(|t| t.adapter == adapter).collect();
    let costs: Vec<(f64, f64)> = here.iter().map(|t| (t.time, t.error)).collect();
    let line: Vec<(f64, f64)> = steps(&plot, &costs).into_iter().map(small).collect();
    let (_, level) = small((LEFT, plot.y(super::breaks::LIMIT)));
    let [width, height] = SIZE;
    let view = format!(
        "{} {} {} {}",
        n(-MARGIN),
        n(-MARGIN),
        n(width + 2.0 * MARGIN),
        n(height + 2.0 * MARGIN)
    );
    html! {
        svg.chart.small viewBox=(view) role="img" {
            title { (shown.scene.name) ": " (answer(points, adapter)) }
            rect.box x="0" y="0" width=(n(width)) height=(n(height)) {}
            path.level.one d={ "M0 " (n(level)) "H" (n(width)) } {}
            @if costs.len() > 1 { path.front d=(polyline(&line)) {} }
            @for timed in &here {
                @let style = question.style(timed.method);
                @let place = small((plot.x(timed.time), plot.y(timed.error)));
                g class={ "of " (color(style)) } data-time=(timed.time) data-error=(timed.error) {
                    (marker(style, place, false, &format!("{}: {}, {}", timed.method, share(timed.error), duration(timed.time))))
                }
            }
        }
        p.legend aria-hidden="true" {
            @for timed in &here { span.key { (key(question.style(timed.method))) " " (timed.method) } " " }
        }
    }
}

/// Returns the recommended methods: the most accurate one within a short time, and the most accurate one
/// overall. Names the methods that are on the front or not, depending on where times are in their intervals.
fn answer(points: &[TimedMethod<'_>], adapter: usize) -> String {
    let here: Vec<&TimedMethod<'_>> = points.iter().filter(|t| t.adapter == adapter).collect();
    let intervals = here
        .iter()
        .map(|t| (t.interval.unwrap_or([t.time; 2]), t.error));
    let open = undecided(&intervals.collect::<Vec<_>>());
    let open: Vec<&str> = open.into_iter().map(|i| here[i].method).collect();
    let best = recommended(&here);
    if open.is_empty() {
        best
    } else {
        format!("{best}; too close in time to rank: {}", open.join(", "))
    }
}

fn recommended(here: &[&TimedMethod<'_>]) -> String {
    let costs: Vec<(f64, f64)> = here.iter().map(|t| (t.time, t.error)).collect();
    let leaders: Vec<&TimedMethod<'_>> = front(&costs).into_iter().map(|i| here[i]).collect();
    let (Some(fastest), Some(best)) = (leaders.first(), leaders.last()) else {
        return "Not timed on this adapter.".to_owned();
    };
    let exact = if best.error == 0.0 {
        format!("exact: {}, {}", best.method, duration(best.time))
    } else {
        let (error, time) = (share(best.error), duration(best.time));
        format!("most accurate: {}, {error}, {time}", best.method)
    };
    let short = leaders.iter().rfind(|t| t.time <= SHORT);
    let first = short.unwrap_or(fastest);
    if std::ptr::eq(*first, *best) {
        return exact;
    }
    let error = share(first.error);
    if short.is_some() {
        format!("under 1 ms: {}, {error}; {exact}", first.method)
    } else {
        let time = duration(first.time);
        format!("fastest: {}, {error}, {time}; {exact}", first.method)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timed(method: &'static str, time: f64, error: f64) -> TimedMethod<'static> {
        TimedMethod {
            method,
            adapter: 0,
            time,
            interval: None,
            error,
        }
    }

    #[test]
    fn the_answer_names_methods_that_no_other_beats() {
        let points = [
            timed("rough", 0.0002, 0.2),
            timed("sorted", 0.0009, 0.0018),
            timed("slow", 0.02, 0.1),
            timed("lists", 0.01, 0.0),
        ];
        let text = answer(&points, 0);
        assert_eq!(
            text,
            format!(
                "under 1 ms: sorted, {}; exact: lists, {}",
                share(0.0018),
                duration(0.01)
            )
        );
        assert_eq!(answer(&points, 1), "Not timed on this adapter.");
        assert!(answer(&points[3..], 0).starts_with("exact: lists"));
        assert!(answer(&points[2..], 0).starts_with("exact: lists"));
        let slow = [timed("a", 0.002, 0.5), timed("b", 0.004, 0.1)];
        assert!(answer(&slow, 0).starts_with("fastest: a, "));
        // The clock does not tell which one is faster.
        let coarse = slow.map(|timed| TimedMethod {
            interval: Some([0.001, 0.005]),
            ..timed
        });
        assert!(answer(&coarse, 0).ends_with("; too close in time to rank: a"));
    }
}
