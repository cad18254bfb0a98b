//! The matrix as CSV (RFC 4180): a line per cell and adapter.

use super::data::{CellOutcome, Matrix, unit};
use crate::csv::{field, line, number};
use etalon_record::CellRate;

const COLUMNS: [&str; 15] = [
    "adapter",
    "cell",
    "unit",
    "rate",
    "low",
    "high",
    "of_base",
    "of_clear",
    "of_memory",
    "of_arithmetic",
    "work",
    "time",
    "rounds",
    "state",
    "message",
];

/// Returns the lines, with the names of the columns first. Rates are in the row's unit; relative rates and shares
/// of limits are fractions of 1.
pub(crate) fn csv(matrix: &Matrix<'_>) -> String {
    let mut text = line(&COLUMNS);
    for adapter in &matrix.adapters {
        for cell in &matrix.cells {
            let Some(entry) = cell.results.get(*adapter) else {
                continue;
            };
            let [unit, rate, low, high, work, time, rounds] = figures(entry.outcome.times());
            let [base, clear] = [entry.of_base, entry.of_clear].map(number);
            let memory = number(entry.reached.map(|reached| reached.of_memory()));
            let arithmetic = number(entry.reached.map(|reached| reached.of_arithmetic()));
            let (state, message) = state(&entry.outcome);
            let (adapter, name, message) = (field(adapter), field(&cell.name), field(&message));
            let fields: [String; COLUMNS.len()] = [
                adapter, name, unit, rate, low, high, base, clear, memory, arithmetic, work, time,
                rounds, state, message,
            ];
            text.push_str(&line(&fields));
        }
    }
    text
}

/// Returns the unit, the rate, the ends of the interval, the work, the time and the rounds.
fn figures(times: Option<&CellRate>) -> [String; 7] {
    let Some(times) = times else {
        return Default::default();
    };
    let (unit, divisor) = unit(times.measure);
    let ends = times.slope.rate_interval();
    let scaled = |value: Option<f64>| number(value.map(|v| v / divisor));
    [
        unit.to_owned(),
        scaled(times.slope.rate()),
        scaled(ends.map(|e| e[0])),
        scaled(ends.map(|e| e[1])),
        times.work.to_string(),
        times.time.name().to_owned(),
        times.slope.rounds.len().to_string(),
    ]
}

/// Returns the name of a cell's state, and a message.
pub(super) fn state(outcome: &CellOutcome) -> (String, String) {
    match outcome {
        CellOutcome::Rate(_) => ("measured".to_owned(), String::new()),
        CellOutcome::Below(_) => ("below-resolution".to_owned(), String::new()),
        CellOutcome::Untimed(verdict, message) => (verdict.to_string(), message.clone()),
        CellOutcome::Incomplete => ("incomplete".to_owned(), String::new()),
    }
}
