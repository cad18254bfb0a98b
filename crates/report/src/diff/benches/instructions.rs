//! Counted instructions of two benches, compared apart from the times.

use crate::numbers::{change, instructions};
use crate::page::adapter::adapter;
use crate::table::{Cell, Table};
use etalon_record::{Bench, BenchRecord};
use serde::Serialize;
use tabled::settings::Color;

/// The smallest change of a number of instructions that is reported, if its counts scatter less.
pub(super) const SMALLEST: f64 = 0.01;

/// The change in the instructions of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum InstructionOutcome {
    /// More than the visible change more.
    More,
    /// More than the visible change fewer.
    Fewer,
    /// No more than the visible change apart.
    AsMany,
}

/// A case on an adapter whose instructions were counted in both benches.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InstructionChange {
    /// The case's id.
    pub case: String,
    /// The adapter's name.
    pub adapter: String,
    /// More, fewer or as many, by `ratio` and `visible`.
    pub outcome: InstructionOutcome,
    /// The instructions of one frame in the first bench.
    pub before: f64,
    /// The instructions of one frame in the second bench.
    pub after: f64,
    /// After over before.
    pub ratio: f64,
    /// The ratio above which the number has changed: 1 % more, or the scatter of both counts if it is larger.
    pub visible: f64,
}

/// Compares the counts of two benches. Returns the changes, and a note if different programs counted.
pub(super) fn compare(before: &Bench, after: &Bench) -> (Vec<InstructionChange>, Option<String>) {
    let mut note = None;
    let both = before.records.iter().filter_map(|old| {
        let picture = &old.picture;
        let new = after.record(&picture.case, &picture.adapter)?;
        let counters = [old, new].map(|r| r.counted.as_ref().map(|c| c.counter));
        if let [Some(old), Some(new)] = counters
            && old != new
        {
            note = Some(format!(
                "Instructions are not compared: {old} counted them before, {new} after."
            ));
            return None;
        }
        changed(old, new)
    });
    let changes = both.collect();
    (changes, note)
}

fn changed(old: &BenchRecord, new: &BenchRecord) -> Option<InstructionChange> {
    let (old_count, new_count) = (old.counted.as_ref()?, new.counted.as_ref()?);
    let (before, after) = (old_count.per_frame()?, new_count.per_frame()?);
    let scatter = old_count.scatter()? + new_count.scatter()?;
    let visible = 1.0 + scatter.max(SMALLEST);
    let ratio = after / before;
    Some(InstructionChange {
        case: old.picture.case.clone(),
        adapter: old.picture.adapter.clone(),
        outcome: if ratio > visible {
            InstructionOutcome::More
        } else if ratio < 1.0 / visible {
            InstructionOutcome::Fewer
        } else {
            InstructionOutcome::AsMany
        },
        before,
        after,
        ratio,
        visible,
    })
}

/// Returns a table with a row per change.
pub(super) fn instructions_table<'a>() -> Table<'a, &'a InstructionChange> {
    Table::new("diff stacked")
        .row_class(|c: &&InstructionChange| match c.outcome {
            InstructionOutcome::More => "slower",
            InstructionOutcome::Fewer => "faster",
            InstructionOutcome::AsMany => "",
        })
        .head("case", |c| &*c.case)
        .text("adapter", |c| adapter(&c.adapter))
        .text("outcome", |c| {
            let (text, color) = match c.outcome {
                InstructionOutcome::More => ("more", Some(Color::FG_RED | Color::BOLD)),
                InstructionOutcome::Fewer => ("fewer", Some(Color::FG_GREEN)),
                InstructionOutcome::AsMany => ("as many", None),
            };
            Cell::from(text).color(color)
        })
        .number("before", |c| instructions(c.before))
        .number("after", |c| instructions(c.after))
        .number("change", |c| change(c.ratio))
        .number("visible", |c| change(c.visible))
}
