//! The list of mutants while the classes add theirs.

use crate::fields::Places;
use crate::mutant::Mutant;
use crate::plant::{Plant, draws, passes, scene};
use etalon_scene::{Draw, Pass, Scene};
use std::fmt::Display;

/// The source of a bug that no driver is known to have shipped.
pub(super) const CONFUSION: &str = "a likely mistake, known from no driver";
/// The source of a bug too small for suites with thresholds.
pub(super) const SMALL: &str = "a small error, below the thresholds of other suites";

/// Offsets of small errors in codes.
pub(super) const STEPS: [(&str, i64); 4] = [
    ("plus-1", 1),
    ("minus-1", -1),
    ("plus-3", 3),
    ("minus-3", -3),
];

/// The clause that lets conversions round either way.
pub(super) const ROUNDED: &str = "Vulkan: Fundamentals, Conversion from Floating-Point to Normalized \
                                  Fixed-Point: one of the two closest values, the nearest only recommended";
/// The clause that lets blending be as coarse as the destination.
pub(super) const PRECISION: &str = "Vulkan: Blending: precision no lower than that used to represent \
                                    destination components, read as codes of the destination";

/// The mutants so far, and the class, area and source of those that follow.
#[derive(Debug, Default)]
pub(super) struct List {
    class: &'static str,
    area: &'static str,
    source: &'static str,
    pub(super) mutants: Vec<Mutant>,
}

impl List {
    /// Sets the class of the mutants that follow, and the area that must catch them.
    pub(super) fn class(&mut self, class: &'static str, area: &'static str) {
        (self.class, self.area, self.source) = (class, area, CONFUSION);
    }

    /// Sets the source of the mutants that follow in the class.
    pub(super) fn source(&mut self, source: &'static str) {
        self.source = source;
    }

    /// Begins a mutant of the class: `name: The effect, in one sentence.`
    pub(super) fn bug(&mut self, text: impl AsRef<str>) -> Named<'_> {
        let (name, about) = text.as_ref().split_once(": ").unwrap_or_default();
        Named {
            name: format!("{}/{name}", self.class),
            about: about.to_owned(),
            source: self.source,
            area: self.area,
            legal: None,
            strikes: |_| true,
            list: self,
        }
    }

    /// Adds a mutant for each pair of values: a field that is the first acts as the second. `name` and
    /// `about` say which field it is.
    pub(super) fn swaps<T: Copy + PartialEq + Display + Send + Sync + 'static>(
        &mut self,
        name: &str,
        about: &str,
        field: Places<T>,
        pairs: impl IntoIterator<Item = (T, T)>,
    ) {
        for (right, wrong) in pairs {
            self.bug(format!(
                "{name}{right}-as-{wrong}: {about}{right} acts as {wrong}."
            ))
            .each(field, move |value| {
                if *value == right {
                    *value = wrong;
                }
            });
        }
    }
}

/// A mutant that lacks its bug yet. The functions that plant one end it.
#[must_use]
pub(super) struct Named<'a> {
    list: &'a mut List,
    name: String,
    about: String,
    source: &'static str,
    area: &'static str,
    legal: Option<&'static str>,
    strikes: fn(&Draw) -> bool,
}

impl Named<'_> {
    /// Gives it a source of its own.
    pub(super) fn source(self, source: &'static str) -> Self {
        Self { source, ..self }
    }

    /// Gives it an area of its own.
    pub(super) fn area(self, area: &'static str) -> Self {
        Self { area, ..self }
    }

    /// States the clause that allows it.
    pub(super) fn legal(self, clause: &'static str) -> Self {
        let legal = Some(clause);
        Self { legal, ..self }
    }

    /// Restricts it to some draws.
    pub(super) fn when(self, strikes: fn(&Draw) -> bool) -> Self {
        Self { strikes, ..self }
    }

    /// Plants it.
    pub(super) fn plant(self, plant: Plant) {
        self.list.mutants.push(Mutant {
            name: self.name,
            about: self.about,
            source: self.source,
            area: self.area,
            legal: self.legal,
            plant,
        });
    }

    /// Changes the draws that it strikes.
    pub(super) fn draws(self, bug: impl Fn(&mut Draw) + Send + Sync + 'static) {
        let strikes = self.strikes;
        self.plant(draws(move |draw| {
            if strikes(draw) {
                bug(draw);
            }
        }));
    }

    /// Changes a field of the draws that it strikes, wherever they have it.
    pub(super) fn each<T: 'static>(
        self,
        field: Places<T>,
        bug: impl Fn(&mut T) + Send + Sync + 'static,
    ) {
        self.draws(move |draw| field(draw).into_iter().for_each(&bug));
    }

    /// Gives a field of the draws that it strikes a value.
    pub(super) fn set<T: Copy + Send + Sync + 'static>(self, field: Places<T>, value: T) {
        self.each(field, move |place| *place = value);
    }

    /// Changes every pass, given the scene that is asked for and the number of the pass.
    pub(super) fn passes(self, bug: impl Fn(&Scene, usize, &mut Pass) + Send + Sync + 'static) {
        self.plant(passes(bug));
    }

    /// Changes the scene.
    pub(super) fn scene(self, bug: impl Fn(&mut Scene) + Send + Sync + 'static) {
        self.plant(scene(bug));
    }
}
