//! Break points: a row for each method with a parameter, with its errors along the parameter and where they cross the
//! limit, on each adapter. The page shows one adapter at a time.

use super::breaks::{Break, LIMIT};
use super::data::{MethodSeries, Methods, SceneSetting, ShownScene};
use super::name::value_text;
use super::stability;
use crate::chart::key;
use crate::numbers::{count, share};
use crate::table::{Cell, Table};
use maud::{Markup, html};

/// The smallest error of each colour of cells.
const STEPS: [f64; 5] = [0.0, 1e-9, 0.001, LIMIT, 0.1];

/// A row: a method in a scene, along its parameter.
#[derive(Clone, Copy)]
struct Row<'s, 'a> {
    shown: &'s ShownScene<'s, 'a>,
    series: &'s MethodSeries<'a>,
}

/// Returns the section of break points.
pub(super) fn section(methods: &Methods<'_>, shown: &[ShownScene<'_, '_>]) -> Markup {
    let rows: Vec<Row<'_, '_>> = shown.iter().flat_map(rows).collect();
    let series = methods.scenes().flat_map(|s| &s.series);
    let single = series.filter(|s| s.values().len() == 1).count();
    let adapters = || methods.adapters.iter().enumerate();
    let table = Table::<Row<'_, '_>>::new("strips")
        .text("Scene", |row| {
            html! { a href={ "#" (row.shown.anchor) } { (row.shown.scene.question) "/" (row.shown.scene.name) } }
        })
        .text("Method", |row| {
            html! { (key(row.shown.style(row.series.method))) " " (row.series.name()) }
        })
        .text("From", |row| row.series.values().first().map(|value| value_text(*value)))
        .text("Error along the parameter", |row| {
            Cell::from(html! { @for (on, _) in adapters() { (strip(row.series, on)) } })
        })
        .text("To", |row| {
            let last = row.series.values().last().map(|value| value_text(*value));
            html! { (last.unwrap_or_default()) " " (row.series.parameter.unwrap_or_default()) }
        })
        .text("Break point", |row| {
            html! { @for (on, _) in adapters() { span class=[(on > 0).then_some("off")] data-on=(on) { (broken(row, on)) } } }
        });
    html! {
        section id="breaks" {
            h2 { "Break points" }
            p {
                "The parameter at which a method's RMSE crosses 1 % of full brightness, interpolated between the two values "
                "beside it that were drawn."
            }
            @if rows.is_empty() {
                p.u { "Not measured: no method was drawn at two values of its parameter." }
            } @else {
                p.legend {
                    @for step in 0..STEPS.len() {
                        i class={ "e" (step) } {} " " (step_text(step)) " "
                    }
                    i.e3.turn {} " the error crosses " (LIMIT * 100.0) " %"
                }
                @for (on, adapter) in adapters() { p.cap.off[on > 0] data-on=(on) { "On " (adapter.name) "." } }
                div #break-rows { (table.page(rows)) }
                @if single > 0 {
                    p.note { "Not measured: " (count(single as u64, "method")) " drawn at one value of a parameter only." }
                }
            }
        }
    }
}

/// Returns the methods of a scene that some adapter drew at several values.
fn rows<'s, 'a>(shown: &'s ShownScene<'s, 'a>) -> impl Iterator<Item = Row<'s, 'a>> {
    let is_curve =
        |s: &&MethodSeries<'a>| (0..shown.methods.adapters.len()).any(|on| s.curve(on).len() > 1);
    let series = shown.scene.series.iter().filter(is_curve);
    series.map(|series| Row { shown, series })
}

/// Returns the cells of a row on an adapter. A line separates neighbouring cells on different sides of the limit.
fn strip(series: &MethodSeries<'_>, adapter: usize) -> Markup {
    let parameter = series.parameter.unwrap_or_default();
    let curve = series.curve(adapter);
    let mut before = None;
    let mut cells = Vec::new();
    for value in series.values() {
        let error = curve.iter().find(|(v, _)| *v == value).map(|(_, e)| *e);
        let turns = error
            .zip(before)
            .is_some_and(|(e, b): (f64, f64)| (b > LIMIT) != (e > LIMIT));
        before = error.or(before);
        cells.push((value, error, turns));
    }
    html! {
        span.strip.off[adapter > 0] data-on=(adapter) {
            @for (value, error, turns) in cells {
                @let place = format!("{parameter} {}", value_text(value));
                @match error {
                    Some(error) => i class={ "e" (step(error)) @if turns { " turn" } } title={ (place) ": " (share(error)) } {},
                    None => i title={ (place) ": not drawn" } {},
                }
            }
        }
    }
}

/// Returns where a row crosses the limit on an adapter, with links to the pictures on both sides.
fn broken(row: &Row<'_, '_>, adapter: usize) -> Markup {
    let Row { shown, series } = row;
    let link = |value: f64| {
        let setting = SceneSetting {
            variant: series.variant.clone(),
            parameter: series.parameter.map(|name| (name, value)),
        };
        let number = shown.settings.iter().position(|s| *s == setting);
        html! { a href={ "#" (shown.anchor) } data-go=[number] { (value_text(value)) } }
    };
    html! {
        @match stability::break_of(shown.scene, series, adapter) {
            None => "not measured",
            Some(Break::Never) => "never above 1 %",
            Some(Break::Always) => "always above 1 %",
            Some(Break::Crossings(crossings)) => @for (i, c) in crossings.iter().enumerate() {
                @if i > 0 { "; " }
                @if c.leaves { "above from " } @else { "below from " }
                b { (c.text()) } " (" (link(c.between[0])) " → " (link(c.between[1])) ")"
            },
        }
    }
}

/// Returns the errors of a colour, in words.
fn step_text(step: usize) -> String {
    match STEPS.get(step + 1) {
        Some(_) if step == 0 => "exact".to_owned(),
        Some(end) => format!("below {} %", end * 100.0),
        None => "above".to_owned(),
    }
}

/// Returns the colour of an error, as an index into [`STEPS`].
fn step(error: f64) -> usize {
    STEPS.iter().rposition(|least| error >= *least).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::tests::made::{Made, run};

    #[test]
    fn each_adapter_has_its_own_strip_and_break_point() {
        let made = |alpha, error| {
            Made::new("t/windows/method=a")
                .at("alpha", alpha)
                .off(error)
        };
        let run = run(&[
            made(0.1, 0.0),
            made(0.2, 0.002),
            made(0.4, 0.02),
            made(0.8, 0.3),
            made(0.1, 0.002).on("hw:a"),
            made(0.8, 0.005).on("hw:a"),
        ]);
        let methods = Methods::of(&run).expect("it has methods");
        let html = section(&methods, &methods.shown()).into_string();
        for expected in [
            "<span class=\"strip\" data-on=\"0\"><i class=\"e0\" title=\"alpha 0.1: 0\"></i><i class=\"e2\" title=\"alpha 0.2",
            "class=\"e3 turn\" title=\"alpha 0.4",
            "class=\"e4\" title=\"alpha 0.8",
            "<span class=\"strip off\" data-on=\"1\"><i class=\"e2\" title=\"alpha 0.1: 0.2\u{a0}%\"></i><i title=\"alpha 0.2: not drawn\"></i>",
            "<span data-on=\"0\">above from <b>",
            "data-go=\"1\">0.2</a> → ",
            "<span class=\"off\" data-on=\"1\">never above 1 %</span>",
        ] {
            assert!(html.contains(expected), "{expected}: {html}");
        }
        assert_eq!(html.matches(" turn\" title").count(), 1);
        assert_eq!(
            [0.0, 1e-4, 0.001, 0.01, 0.0101, 1.0].map(step),
            [0, 1, 2, 3, 3, 4]
        );
    }
}
