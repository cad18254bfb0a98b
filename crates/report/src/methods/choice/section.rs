//! The first screen of the page of methods, and the same sentences for a terminal.

use super::answer::{MethodBudget, sentence};
use super::{
    Candidate, FrameSize, QuestionPoints, ScenePoint, default_budget, default_size, error, sizes,
    time,
};
use crate::chart::{
    BOTTOM, HEIGHT, LEFT, LabelPlaces, Plot, RIGHT, Scale, TOP, chart, color, key, marker, n,
    zero_band,
};
use crate::methods::breaks::LIMIT;
use crate::methods::data::{Methods, ShownScene};
use crate::methods::name::{row_anchor, title};
use crate::numbers::{between, count, round_duration, share};
use etalon_methods::Order;
use etalon_record::{Clock, Estimate};
use maud::{Markup, html};
use serde_json::{Value, json};

/// The maximum number of adapters that a terminal lists for a question.
const ADAPTERS: usize = 4;

/// Where the page begins: the first adapter, a size, and a frame time.
struct Beginning {
    adapter: usize,
    size: usize,
    time: f64,
}

/// Returns the charts and sentences of all questions, with the choice of adapter, size and budget.
pub(in crate::methods) fn section(methods: &Methods<'_>, shown: &[ShownScene<'_, '_>]) -> Markup {
    let sizes = sizes(methods);
    let Some(first) = methods.adapters.first() else {
        return html! {};
    };
    let beginning = Beginning {
        adapter: 0,
        size: default_size(&sizes),
        time: default_budget(first.kind),
    };
    html! {
        section id="overview" data-sizes=(json!(sizes.iter().map(|s| sides(*s)).collect::<Vec<_>>())) {
            h2.vh { "Which method, at which price?" }
            (form(methods, &sizes, &beginning))
            p.note { (caveat(methods, &sizes)) }
            div.cards {
                @for (q, question) in methods.questions.iter().enumerate() {
                    (card(methods, q, &QuestionPoints::new(question, shown), &sizes, &beginning))
                }
            }
            p.note {
                "Each mark is a method: its median over the scenes of the question. The thin upright line is the range of its error over "
                "scenes, the bar the interval of its time. After the name: "
                b { "⇅" } " the method sorts what it draws, " b { "!" } " its picture depends on the order of draws. Faint marks are beyond the budget. "
                "Dotted: an error of 1 %. A click on a mark leads to its scene or, if it stands for several, to its row in the table."
            }
        }
    }
}

/// Returns the sides of a size; `None` for that of pictures.
fn sides(size: FrameSize) -> Option<[u32; 2]> {
    match size {
        FrameSize::Picture => None,
        FrameSize::Sides(sides) => Some(sides),
    }
}

fn form(methods: &Methods<'_>, sizes: &[FrameSize], beginning: &Beginning) -> Markup {
    html! {
        form.budget id="budget" hidden data-time=(beginning.time) {
            label { "Device " select id="on" {
                @for (index, adapter) in methods.adapters.iter().enumerate() {
                    option value=(index) { (adapter.name) }
                }
            } }
            label { "Frame " select id="frame" {
                @for (index, size) in sizes.iter().enumerate() {
                    option value=(index) selected[index == beginning.size] { (size.text()) }
                }
                @if sizes.len() > 1 { option value="computed" { "another size" } }
            } }
            label.computed for="texels" hidden { output for="texels" {} " " input id="texels" type="range" min="0" max="100" value="50"; }
            (limit("most-time", "Frame time at most"))
            (limit("most-error", "Error at most"))
        }
    }
}

/// Returns a slider, whose stops the script knows.
fn limit(id: &str, name: &str) -> Markup {
    html! {
        label for=(id) { (name) " " output for=(id) { "any" } " " input id=(id) type="range" min="0" step="1"; }
    }
}

/// Returns what a reader must know before choosing by these times.
fn caveat(methods: &Methods<'_>, sizes: &[FrameSize]) -> String {
    let costs = methods
        .scenes()
        .flat_map(|s| &s.series)
        .flat_map(|s| &s.points);
    let costs: Vec<_> = costs.filter_map(|p| p.measured.cost).collect();
    if costs.is_empty() {
        return "Times are those of small pictures, about 128 by 128 texels: below a millisecond they are mostly what a \
                submission takes, and say little about large frames. etalon run 'methods/*' --sizes 720p,1080p,4k times those."
            .to_owned();
    }
    let clocks = match (
        costs.iter().any(|c| c.clock == Clock::Device),
        costs.iter().any(|c| c.clock == Clock::Wall),
    ) {
        (true, true) => {
            "between timestamps of the device where hardware has them, else until the device was done"
        }
        (true, false) => "between timestamps of the device",
        _ => "until the device was done",
    };
    let crooked = costs.iter().filter(|c| c.is_crooked()).count();
    let crooked = match crooked {
        0 => String::new(),
        some => format!(
            " {} of {} fit no straight line, and are shown at measured sizes only.",
            some,
            count(costs.len() as u64, "cost")
        ),
    };
    let measured: Vec<String> = sizes.iter().skip(1).map(|size| size.text()).collect();
    format!(
        "A frame's time is measured at {}, {clocks}. At another size it is computed, as a fixed cost plus a cost per megapixel.{crooked}",
        measured.join(", ")
    )
}

/// Returns the tables of a question's methods and scenes, one per adapter, at the size with which the page begins.
pub(in crate::methods) fn tables(
    methods: &Methods<'_>,
    question: usize,
    shown: &[ShownScene<'_, '_>],
) -> Markup {
    let sizes = sizes(methods);
    let size = sizes[default_size(&sizes)];
    let points = QuestionPoints::new(&methods.questions[question], shown);
    if points.points.is_empty() {
        return html! {};
    }
    html! {
        @for (number, adapter) in methods.adapters.iter().enumerate() {
            div.off[number > 0] data-on=(number) {
                p.cap { "Error, frame time and break point in each scene, at " (size.text()) " on " (adapter.name) ". A click on a heading sorts." }
                (super::table::table(question, &points, number, size))
            }
        }
    }
}

/// Returns the sentences of all questions for a terminal, one per adapter.
pub(in crate::methods) fn lines(
    methods: &Methods<'_>,
    shown: &[ShownScene<'_, '_>],
) -> Vec<String> {
    let sizes = sizes(methods);
    let size = sizes[default_size(&sizes)];
    let mut lines = Vec::new();
    for question in &methods.questions {
        let points = QuestionPoints::new(question, shown);
        lines.push(format!("{}:", question.name));
        let adapters = methods.adapters.iter().enumerate();
        lines.extend(adapters.take(ADAPTERS).map(|(number, adapter)| {
            let budget = MethodBudget {
                time: Some(default_budget(adapter.kind)),
                error: None,
            };
            let place = format!("{} on {}", size.text(), adapter.name);
            let candidates = points.candidates(number, size);
            format!("  {}", sentence(&candidates, budget, &place))
        }));
        if let Some(more @ 1..) = methods.adapters.len().checked_sub(ADAPTERS) {
            lines.push(format!("  and {}", count(more as u64, "more adapter")));
        }
    }
    lines
}

fn card(
    methods: &Methods<'_>,
    number: usize,
    points: &QuestionPoints<'_, '_>,
    sizes: &[FrameSize],
    beginning: &Beginning,
) -> Markup {
    let size = sizes[beginning.size];
    let candidates = points.candidates(beginning.adapter, size);
    let budget = MethodBudget {
        time: Some(beginning.time),
        error: None,
    };
    let place = format!(
        "{} on {}",
        size.text(),
        methods.adapters[beginning.adapter].name
    );
    let plot = plot(points, methods, sizes);
    let names = points.question.methods.iter();
    let names = names.map(|m| json!([m, etalon_methods::order(points.question.name, m).map(sign)]));
    html! {
        article.card data-methods=(Value::from_iter(names)) data-scenes=(Value::from_iter(points.scenes.iter().map(|s| &*s.anchor)))
            data-points=(Value::from_iter(points.points.iter().map(|p| data(p, sizes)))) {
            h3 { a href={ "#q" (number) } { (title(points.question.name)) } }
            p.answer { (sentence(&candidates, budget, &place)) }
            @if let Some(plot) = &plot {
                div.plotted data-x=(json!([logs(plot.x), LEFT, RIGHT])) data-y=(json!([logs(plot.y), TOP, BOTTOM, plot.zero])) {
                    (chart(HEIGHT, &format!("{}: error against frame time", title(points.question.name)), "A mark per method.", &html! {
                        (plot.frame(round_duration, share, "frame time →", "RMSE, share of full brightness →"))
                        (level(plot))
                        g.limits {}
                        g.marks { (marks(points, plot, &candidates, [number, beginning.adapter])) }
                    }))
                }
            }
            p.legend aria-hidden="true" {
                @for method in &points.question.methods { span.key { (key(points.question.style(method))) " " (method) } " " }
            }
            p.of {
                (count(points.scenes.len() as u64, "scene")) ". "
                span.untimed { (untimed(points, &candidates)) }
            }
        }
    }
}

/// Returns the methods of a question that have no mark.
fn untimed(points: &QuestionPoints<'_, '_>, candidates: &[Candidate<'_>]) -> String {
    let has_mark = |method: &&&str| candidates.iter().any(|c| c.method == **method);
    let methods = points.question.methods.iter();
    let missing: Vec<&str> = methods.filter(|m| !has_mark(m)).copied().collect();
    if missing.is_empty() {
        String::new()
    } else {
        format!("Not timed here: {}.", missing.join(", "))
    }
}

/// Returns the mark beside the name of a method whose picture needs an order.
fn sign(order: Order) -> &'static str {
    match order {
        Order::Independent => "",
        Order::Sorted => "⇅",
        Order::Submitted => "!",
    }
}

/// Returns the ends of a logarithmic scale, as decimal logarithms.
fn logs(scale: Scale) -> [f64; 2] {
    let (low, high) = scale.ends();
    [low.log10(), high.log10()]
}

/// Returns a method in a scene on an adapter for the script: method, adapter, scene; for each size its time and error;
/// and its cost.
fn data(point: &ScenePoint<'_>, sizes: &[FrameSize]) -> Value {
    let m = point.measured;
    let at = |size: &FrameSize| match (time(m, *size), error(m, *size)) {
        (Some([low, time, high]), Some([rmse, most])) => json!([low, time, high, rmse, most]),
        _ => Value::Null,
    };
    let ends = |e: &Estimate| {
        let [low, high] = e.interval.unwrap_or([e.median; 2]);
        [low, e.median, high]
    };
    let cost = m.cost.filter(|c| !c.is_crooked());
    let cost = cost.map(|c| [ends(&c.fixed), ends(&c.per_megapixel)]);
    json!([
        point.method,
        point.adapter,
        point.scene,
        sizes.iter().map(at).collect::<Vec<_>>(),
        cost
    ])
}

/// Returns the scales of a chart, which hold all adapters and sizes; `None` if nothing was timed.
fn plot(
    points: &QuestionPoints<'_, '_>,
    methods: &Methods<'_>,
    sizes: &[FrameSize],
) -> Option<Plot> {
    let adapters = 0..methods.adapters.len();
    let places = adapters.flat_map(|a| sizes.iter().map(move |s| (a, *s)));
    let all: Vec<Candidate<'_>> = places.flat_map(|(a, s)| points.candidates(a, s)).collect();
    if all.is_empty() {
        return None;
    }
    let errors = || all.iter().flat_map(|c| c.error);
    Some(Plot {
        x: Scale::log(all.iter().flat_map(|c| c.time)),
        y: Scale::log(errors().filter(|e| *e > 0.0).chain([LIMIT])),
        zero: zero_band(errors()),
    })
}

fn level(plot: &Plot) -> Markup {
    let y = plot.y(LIMIT);
    html! { path.level.one d={ "M" (n(LEFT)) " " (n(y)) "H" (n(RIGHT)) } {} }
}

/// Returns the marks of the methods with their names; each leads to its scene or, over several scenes, to its row in the
/// table.
fn marks(
    points: &QuestionPoints<'_, '_>,
    plot: &Plot,
    candidates: &[Candidate<'_>],
    [question, adapter]: [usize; 2],
) -> Markup {
    let place = |c: &Candidate<'_>| (plot.x(c.time[1]), plot.y(c.error[1]));
    let mut labels = LabelPlaces::new(candidates.iter().map(place));
    html! {
        @for c in candidates {
            @let style = points.question.style(c.method);
            @let (x, y) = place(c);
            @let about = format!("{}: {} ({}), {} ({})", c.method, share(c.error[1]), between([c.error[0], c.error[2]], share),
                round_duration(c.time[1]), between([c.time[0], c.time[2]], round_duration));
            @let row = points.question.methods.iter().position(|m| *m == c.method);
            @let target = match c.scenes[..] {
                [only] => points.scenes[only].anchor.clone(),
                _ => row_anchor(question, adapter, row.unwrap_or(0)),
            };
            a class={ "of " (color(style)) } href={ "#" (target) } {
                path.spread d={ "M" (n(x)) " " (n(plot.y(c.error[0]))) "V" (n(plot.y(c.error[2]))) } {}
                path.spread.wide d={ "M" (n(plot.x(c.time[0]))) " " (n(y)) "H" (n(plot.x(c.time[2]))) } {}
                (marker(style, (x, y), false, &about))
                @let name = format!("{}{}", c.method, c.order.map_or("", sign));
                @if let Some((x, y)) = labels.place(&name, (x, y)) { text.label x=(n(x)) y=(n(y)) { (name) } }
            }
        }
    }
}
