//! The summary of a hunt for a terminal.

use super::summary::{areas, elsewhere, totals};
use crate::terminal::{self, TableOptions, wrapped};
use crate::words::plain;
use etalon_record::{Catch, Hunt, MutantRecord};
use tabled::builder::Builder;

/// Totals, a table with a row per area, and the bugs that were only noticed, survived, or were
/// seen by another area alone. Always ends in a newline.
pub fn hunt_table(hunt: &Hunt, options: TableOptions) -> String {
    let mut builder = Builder::default();
    builder.push_record(["area", "caught", "noticed", "passed", "of its own"]);
    for row in areas(hunt) {
        let [caught, noticed, passed] = row.counts;
        builder.push_record([
            plain(row.area, 40),
            caught.to_string(),
            noticed.to_string(),
            passed.to_string(),
            format!("{} of {}", row.own_reached, row.own),
        ]);
    }
    let table = wrapped(terminal::table(builder, options, 1), options);
    let mut text = format!("{table}\n\n{}\n", totals(hunt));
    let of = |outcome| hunt.mutants.iter().filter(move |m| m.outcome == outcome);
    let proven = |m: &MutantRecord| m.mutant.legal.clone().unwrap_or_default();
    list(&mut text, options, "Noticed", of(Catch::Noticed), proven);
    list(&mut text, options, "Survived", of(Catch::Survived), proven);
    let others = elsewhere(hunt);
    list(
        &mut text,
        options,
        "Caught by other areas only",
        others.into_iter(),
        |m| m.first.as_ref().map(|s| s.case.clone()).unwrap_or_default(),
    );
    let complaints: Vec<_> = hunt.complaints().collect();
    if !complaints.is_empty() {
        text.push_str(&format!("\n{}\n", options.paint("Wrong", "31")));
        for (mutant, why) in complaints {
            let name = plain(&mutant.mutant.name, 100);
            text.push_str(&format!("  {name}: {why}\n"));
        }
    }
    text
}

fn list<'a>(
    text: &mut String,
    options: TableOptions,
    title: &str,
    mutants: impl Iterator<Item = &'a MutantRecord>,
    why: impl Fn(&MutantRecord) -> String,
) {
    let mut empty = true;
    for mutant in mutants {
        if empty {
            text.push_str(&format!("\n{title}\n"));
            empty = false;
        }
        text.push_str(&format!("  {}\n", plain(&mutant.mutant.name, 100)));
        let reason = why(mutant);
        if !reason.is_empty() {
            text.push_str(&format!("      {}\n", plain(&reason, options.room(5))));
        }
    }
}
