//! The list of mutants while classes add to it.

use crate::fields::FieldPlaces;
use crate::mutant::Mutant;
use crate::permission::{UsedPermission, under};
use crate::plant::{Plant, swapped};
use etalon_frame::Limits;
use etalon_reference::rules::{BlendPrecision, Rounding};
use etalon_scene::Draw;
use std::fmt::Display;

/// The source of a bug that no driver is known to have had.
pub(super) const CONFUSION: &str = "a likely mistake, known from no driver";
/// The source of a bug too small for suites with thresholds.
pub(super) const SMALL: &str = "a small error, below the thresholds of other suites";

/// The sizes of small errors, in codes.
pub(super) const STEPS: [(&str, i64); 4] = [
    ("plus-1", 1),
    ("minus-1", -1),
    ("plus-3", 3),
    ("minus-3", -3),
];

/// Stores that round in either direction.
pub(super) fn rounded() -> Vec<UsedPermission> {
    vec![under!(store: Rounding::EitherNeighbour)]
}

/// Blends that are as coarse as the destination.
pub(super) fn coarse() -> Vec<UsedPermission> {
    vec![under!(blend: BlendPrecision::DestinationCodes | BlendPrecision::AnySteps)]
}

/// The mutants so far, and the class, area and source of the next ones.
#[derive(Debug, Default)]
pub(super) struct MutantList {
    /// True if the next changes are innocents alone, and no bugs.
    pub(super) innocents_alone: bool,
    class: &'static str,
    area: &'static str,
    source: &'static str,
    pub(super) mutants: Vec<Mutant>,
}

impl MutantList {
    /// Sets the class of the following mutants, and the area that must catch them.
    pub(super) fn class(&mut self, class: &'static str, area: &'static str) {
        (self.class, self.area, self.source) = (class, area, CONFUSION);
    }

    /// Sets the source of the following mutants in the class.
    pub(super) fn source(&mut self, source: &'static str) {
        self.source = source;
    }

    /// Adds a mutant of the class: `name: The effect, in one sentence.`
    pub(super) fn add(&mut self, text: &str, facts: Facts, plant: Plant) {
        let (name, about) = text.split_once(": ").unwrap_or_default();
        self.mutants.push(Mutant {
            name: format!("{}/{name}", self.class),
            about: about.to_owned(),
            source: facts.source.unwrap_or(self.source),
            area: facts.area.unwrap_or(self.area),
            permissions: facts.permitted.unwrap_or_default(),
            reports: facts.reports,
            is_innocent_alone: self.innocents_alone,
            plant: match facts.when {
                Some(strikes) => plant.when(strikes),
                None => plant,
            },
        });
    }

    /// Adds a mutant for each pair of values, which uses the second value in place of the first. `name` and
    /// `about` identify the field.
    pub(super) fn swaps<T: Copy + PartialEq + Display + Send + Sync + 'static>(
        &mut self,
        name: &str,
        about: &str,
        field: FieldPlaces<T>,
        pairs: impl IntoIterator<Item = (T, T)>,
    ) {
        for (right, wrong) in pairs {
            let text = format!("{name}{right}-as-{wrong}: {about}{right} acts as {wrong}.");
            self.add(&text, Facts::default(), swapped(field, right, wrong));
        }
    }
}

/// Facts that differ from those of the class.
#[derive(Default)]
pub(super) struct Facts {
    pub(super) source: Option<&'static str>,
    pub(super) area: Option<&'static str>,
    /// The permissions that it uses.
    pub(super) permitted: Option<Vec<UsedPermission>>,
    /// Sets the limits that a driver that behaves so reports.
    pub(super) reports: Option<fn(&mut Limits)>,
    /// Returns true for the draws that it affects.
    pub(super) when: Option<fn(&Draw) -> bool>,
}

/// Declares `add`, which adds the mutants of a file to the list. See [`rows`].
macro_rules! bugs {
    ($($row:tt)+) => {
        /// Adds the mutants of this file.
        pub(crate) fn add(list: &mut $crate::list::MutantList) {
            $crate::list::rows! { list; $($row)+ }
        }
    };
}

/// Adds rows of mutants to a list: `"name: The effect." => plant, fact value;`, in which `{…}` in the text
/// is replaced by a variable, and facts are those of [`Facts`]. Other entries set the class or the source
/// of the following rows, loop over rows (with a type if an entry has a function: `for (name, bug as
/// type)`), test conditions, define variables, call functions that add more rows (`also`), or swap values
/// of fields (`swaps`).
macro_rules! rows {
    ($list:ident;) => {};
    ($list:ident; class $class:literal, $area:expr; $($rest:tt)*) => {
        $list.class($class, $area);
        $crate::list::rows! { $list; $($rest)* }
    };
    ($list:ident; source $source:expr; $($rest:tt)*) => {
        $list.source($source);
        $crate::list::rows! { $list; $($rest)* }
    };
    ($list:ident; also $add:expr; $($rest:tt)*) => {
        $add($list);
        $crate::list::rows! { $list; $($rest)* }
    };
    ($list:ident; swaps $($argument:expr),+; $($rest:tt)*) => {
        $list.swaps($($argument),+);
        $crate::list::rows! { $list; $($rest)* }
    };
    ($list:ident; let $variable:ident: $type:ty = $value:expr; $($rest:tt)*) => {
        let $variable: $type = $value;
        $crate::list::rows! { $list; $($rest)* }
    };
    ($list:ident; let $variable:pat = $value:expr; $($rest:tt)*) => {
        let $variable = $value;
        $crate::list::rows! { $list; $($rest)* }
    };
    ($list:ident; if ($condition:expr) { $($row:tt)+ } $($rest:tt)*) => {
        if $condition {
            $crate::list::rows! { $list; $($row)+ }
        }
        $crate::list::rows! { $list; $($rest)* }
    };
    ($list:ident; for ($name:ident, $bug:ident as $type:ty) in [$(($text:expr, $value:expr)),+ $(,)?]
        { $($row:tt)+ } $($rest:tt)*) => {
        for ($name, $bug) in [$(($text, $value as $type)),+] {
            $crate::list::rows! { $list; $($row)+ }
        }
        $crate::list::rows! { $list; $($rest)* }
    };
    ($list:ident; for ($name:ident, $about:ident, $bug:ident as $type:ty)
        in [$(($text:expr, $effect:expr, $value:expr)),+ $(,)?] { $($row:tt)+ } $($rest:tt)*) => {
        for ($name, $about, $bug) in [$(($text, $effect, $value as $type)),+] {
            $crate::list::rows! { $list; $($row)+ }
        }
        $crate::list::rows! { $list; $($rest)* }
    };
    ($list:ident; for $item:pat in $values:tt { $($row:tt)+ } $($rest:tt)*) => {
        for $item in $values {
            $crate::list::rows! { $list; $($row)+ }
        }
        $crate::list::rows! { $list; $($rest)* }
    };
    ($list:ident; $text:literal => $plant:expr $(, $fact:ident $value:expr)*; $($rest:tt)*) => {
        let facts = $crate::list::Facts {
            $($fact: Some($value),)*
            ..$crate::list::Facts::default()
        };
        $list.add(&format!($text), facts, $plant);
        $crate::list::rows! { $list; $($rest)* }
    };
}

pub(super) use {bugs, rows};
