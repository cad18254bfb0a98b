//! Break points in one picture: a row for each method with a parameter, and a cell for each value.

use super::breaks::LIMIT;
use super::data::{MethodSeries, ShownScene};
use super::name::value_text;
use crate::chart::key;
use crate::numbers::share;
use crate::table::{Cell, Table};
use maud::{Markup, html};

/// The smallest error of each colour of cells.
const STEPS: [f64; 5] = [0.0, 1e-9, 0.001, LIMIT, 0.1];

/// A row: a method's errors along its parameter, in one scene.
struct Row<'s, 'a> {
    shown: &'s ShownScene<'s, 'a>,
    series: &'s MethodSeries<'a>,
    /// The parameter's values, each with the largest error of all adapters.
    errors: Vec<(f64, f64)>,
}

/// Returns the picture of all scenes; empty if no method was drawn at several values.
pub(super) fn picture(shown: &[ShownScene<'_, '_>]) -> Markup {
    let rows: Vec<Row<'_, '_>> = shown.iter().flat_map(rows).collect();
    if rows.is_empty() {
        return html! {};
    }
    let table = Table::<Row<'_, '_>>::new("strips")
        .text("Scene", |row| {
            html! { a href={ "#" (row.shown.anchor) } { (row.shown.scene.question) "/" (row.shown.scene.name) } }
        })
        .text("Method", |row| {
            html! { (key(row.shown.style(row.series.method))) " " (row.series.name()) }
        })
        .text("From", |row| row.errors.first().map(|(value, _)| value_text(*value)))
        .text("Error along the parameter", |row| Cell::from(strip(row)))
        .text("To", |row| {
            let last = row.errors.last().map(|(value, _)| value_text(*value));
            html! { (last.unwrap_or_default()) " " (row.series.parameter.unwrap_or_default()) }
        });
    html! {
        p.legend {
            @for step in 0..STEPS.len() {
                i class={ "e" (step) } {} " " (step_text(step)) " "
            }
            i.e3.turn {} " the error crosses " (LIMIT * 100.0) " %"
        }
        div.wide { (table.page(rows)) }
    }
}

fn rows<'s, 'a>(shown: &'s ShownScene<'s, 'a>) -> Vec<Row<'s, 'a>> {
    let series = shown.scene.series.iter();
    let several = series.filter(|series| series.values().len() > 1);
    several
        .map(|series| Row {
            shown,
            series,
            errors: errors(series),
        })
        .filter(|row| row.errors.len() > 1)
        .collect()
}

/// Returns the values of a series, each with the largest error of all adapters. Its points are in the order of
/// their values.
fn errors(series: &MethodSeries<'_>) -> Vec<(f64, f64)> {
    let mut errors: Vec<(f64, f64)> = Vec::new();
    for point in &series.points {
        if let (Some(value), Some(error)) = (point.value, point.error()) {
            match errors.last_mut().filter(|(last, _)| *last == value) {
                Some((_, largest)) => *largest = error.max(*largest),
                None => errors.push((value, error)),
            }
        }
    }
    errors
}

/// Returns the cells of a row. A line separates neighbouring cells on different sides of the limit.
fn strip(row: &Row<'_, '_>) -> Markup {
    let parameter = row.series.parameter.unwrap_or_default();
    let before = [None]
        .into_iter()
        .chain(row.errors.iter().map(|(_, error)| Some(*error)));
    html! {
        span.strip {
            @for ((value, error), before) in row.errors.iter().zip(before) {
                @let turns = before.is_some_and(|before| (before > LIMIT) != (*error > LIMIT));
                i class={ "e" (step(*error)) @if turns { " turn" } } title={ (parameter) " " (value_text(*value)) ": " (share(*error)) } {}
            }
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
    use crate::methods::data::Methods;
    use crate::methods::tests::made::{Made, run};

    #[test]
    fn a_row_holds_the_largest_errors_and_marks_where_they_cross() {
        let made = |alpha, error| {
            Made::new("t/windows/method=a")
                .at("alpha", alpha)
                .off(error)
        };
        let run = run(&[
            made(0.1, 0.0),
            made(0.2, 0.002),
            made(0.2, 0.005).on("hw:a"),
            made(0.4, 0.02),
            made(0.8, 0.3),
        ]);
        let methods = Methods::of(&run).expect("it has methods");
        let shown = methods.shown();
        let html = picture(&shown).into_string();
        for expected in [
            "class=\"e0\" title=\"alpha 0.1",
            "class=\"e2\" title=\"alpha 0.2: 0.5",
            "class=\"e3 turn\" title=\"alpha 0.4",
            "class=\"e4\" title=\"alpha 0.8",
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
