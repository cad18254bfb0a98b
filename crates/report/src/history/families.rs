//! Families of cases, which share a case file as their ids suggest, and the areas of the families.

use etalon_record::before_axes;
use std::collections::BTreeMap;
use std::rc::Rc;

/// The families and areas of all cases.
pub(super) struct Families {
    /// The names of the families, sorted.
    pub(super) names: Vec<String>,
    /// The names of the areas, sorted.
    pub(super) areas: Vec<String>,
    /// The area of each family.
    pub(super) area_of: Vec<usize>,
    /// The family of each case, by the case's number minus one.
    pub(super) of: Vec<u32>,
}

impl Families {
    pub(super) fn new(cases: &[Rc<str>]) -> Self {
        let mut names: BTreeMap<&str, u32> = cases.iter().map(|case| (family(case), 0)).collect();
        let mut areas: BTreeMap<&str, usize> = names.keys().map(|name| (area(name), 0)).collect();
        for (number, area) in areas.values_mut().enumerate() {
            *area = number;
        }
        for (number, name) in names.values_mut().enumerate() {
            *name = number as u32;
        }
        Self {
            area_of: names.keys().map(|name| areas[area(name)]).collect(),
            of: cases.iter().map(|case| names[family(case)]).collect(),
            names: names.keys().map(|name| (*name).to_owned()).collect(),
            areas: areas.keys().map(|area| (*area).to_owned()).collect(),
        }
    }
}

/// Returns the first part of an id.
fn area(id: &str) -> &str {
    id.split('/').next().unwrap_or(id)
}

/// Returns the parts of an id before the first axis; without axes, all parts except the last.
fn family(id: &str) -> &str {
    match before_axes(id) {
        None | Some("") => area(id),
        Some(before) if before == id => id.rsplit_once('/').map_or(id, |(family, _)| family),
        Some(some) => some,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_family_is_what_stands_before_the_axes() {
        for (id, expected) in [
            ("depth/compare/compare=less/write=true", "depth/compare"),
            ("perf/matrix/fill/blend=off", "perf/matrix/fill"),
            ("found/softpipe", "found"),
            ("a=1/b", "a=1"),
            ("alone", "alone"),
            ("", ""),
            ("/", ""),
            ("ä/ö=1", "ä"),
        ] {
            assert_eq!(family(id), expected, "{id}");
        }
        let cases: Vec<Rc<str>> = ["b/x/a=1", "a/y/a=1", "b/x/a=2"].map(Rc::from).to_vec();
        let families = Families::new(&cases);
        assert_eq!(families.names, ["a/y", "b/x"]);
        assert_eq!(families.of, [1, 0, 1]);
        assert_eq!(families.area_of, [0, 1]);
    }
}
