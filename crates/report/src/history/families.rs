//! Families of cases, which share a case file as their ids suggest, and the areas of the families.

use etalon_frame::CaseId;
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
        let mut names: BTreeMap<&str, u32> = cases
            .iter()
            .map(|case| (CaseId::new(case).family(), 0))
            .collect();
        let mut areas: BTreeMap<&str, usize> = names
            .keys()
            .map(|name| (CaseId::new(name).area(), 0))
            .collect();
        for (number, area) in areas.values_mut().enumerate() {
            *area = number;
        }
        for (number, name) in names.values_mut().enumerate() {
            *name = number as u32;
        }
        Self {
            area_of: names
                .keys()
                .map(|name| areas[CaseId::new(name).area()])
                .collect(),
            of: cases
                .iter()
                .map(|case| names[CaseId::new(case).family()])
                .collect(),
            names: names.keys().map(|name| (*name).to_owned()).collect(),
            areas: areas.keys().map(|area| (*area).to_owned()).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_family_is_an_id_without_its_axes() {
        let cases: Vec<Rc<str>> = ["b/x/a=1", "a/y/a=1", "b/x/a=2"].map(Rc::from).to_vec();
        let families = Families::new(&cases);
        assert_eq!(families.names, ["a/y", "b/x"]);
        assert_eq!(families.of, [1, 0, 1]);
        assert_eq!(families.area_of, [0, 1]);
    }
}
