//! The list of mutants while the classes add theirs.

use crate::mutant::Mutant;
use crate::plant::Plant;

/// The source of a bug that no driver is known to have shipped.
pub(super) const CONFUSION: &str = "a likely mistake, known from no driver";
/// The source of a bug too small for suites with thresholds.
pub(super) const SMALL: &str = "a small error, below the thresholds of other suites";

/// A mutant in a table: its name, its effect, and the bug.
pub(super) type Row<B> = (&'static str, &'static str, B);

/// The mutants so far, and the class and area of those that follow.
#[derive(Debug, Default)]
pub(super) struct List {
    class: &'static str,
    area: &'static str,
    pub(super) mutants: Vec<Mutant>,
}

impl List {
    /// Sets the class of the mutants that follow, and the area that must catch them.
    pub(super) fn class(&mut self, class: &'static str, area: &'static str) {
        self.class = class;
        self.area = area;
    }

    /// Adds a mutant to the class.
    pub(super) fn add(
        &mut self,
        name: &str,
        source: &'static str,
        about: impl Into<String>,
        plant: Plant,
    ) -> &mut Mutant {
        let at = self.mutants.len();
        self.mutants.push(Mutant {
            name: format!("{}/{name}", self.class),
            about: about.into(),
            source,
            area: self.area,
            legal: None,
            plant,
        });
        &mut self.mutants[at]
    }

    /// Adds the mutants of a table, of one source and planted in the same way.
    pub(super) fn rows<B: Copy>(
        &mut self,
        source: &'static str,
        plant: fn(B) -> Plant,
        rows: &[Row<B>],
    ) {
        for (name, about, bug) in rows {
            self.add(name, source, *about, plant(*bug));
        }
    }
}
