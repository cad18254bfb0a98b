//! Choosing the method cases whose pictures are kept.

use etalon_case::Case;
use std::collections::{BTreeMap, HashSet};

/// Returns the indices of the cases whose pictures are kept: for each method in each scene, the case in the
/// middle of its parameter's range.
pub(super) fn pictured(cases: &[Case]) -> HashSet<usize> {
    type Family<'a> = (&'a str, &'a str, &'a str);
    let mut families: BTreeMap<Family<'_>, Vec<(f64, &str, usize)>> = BTreeMap::new();
    for (number, case) in cases.iter().enumerate() {
        if let Some(method) = &case.method {
            let family = (&*method.question, &*method.scene, &*method.name);
            let value = method.parameter.as_ref().map_or(0.0, |p| p.value);
            families
                .entry(family)
                .or_default()
                .push((value, &case.id, number));
        }
    }
    // The id decides between equal values, so that the drawing order does not matter.
    let middle = |mut pictures: Vec<(f64, &str, usize)>| {
        pictures.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(b.1)));
        pictures
            .get(pictures.len() / 2)
            .map(|(_, _, number)| *number)
    };
    families.into_values().filter_map(middle).collect()
}
