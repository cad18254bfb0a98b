//! The pairs of facts that meet in draws of cases, and the pairs that cannot meet.

use crate::processors::processors;
use etalon_case::{CaseFile, Profile};
use etalon_explore::{FactKind, FactPairs};
use etalon_frame::threads::each;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Returns the pairs of a profile's cases. Random scenes do not count: another seed has other pairs.
pub(crate) fn count(files: &[CaseFile], profile: Profile) -> FactPairs {
    let files: Vec<&CaseFile> = files.iter().filter(|file| !file.is_random()).collect();
    let counted = each(processors(), &files, |file| {
        let mut pairs = FactPairs::default();
        for case in file.cases(profile).filter_map(|case| case.build().ok()) {
            let variants = case.variants.iter().map(|variant| &variant.scene);
            variants
                .chain([&case.scene])
                .for_each(|scene| pairs.add(scene));
        }
        pairs
    });
    let mut all = FactPairs::default();
    for pairs in &counted {
        all.add_all(pairs);
    }
    all
}

/// The pairs of two kinds of facts.
#[derive(Default)]
struct KindPairs {
    met: u64,
    excluded: u64,
    /// The pairs without a scene.
    missing: Vec<[String; 2]>,
}

/// The pairs of all facts, by their kinds.
pub(crate) struct ToldPairs(BTreeMap<[FactKind; 2], KindPairs>);

impl ToldPairs {
    pub(crate) fn new(pairs: &FactPairs) -> Self {
        let mut kinds: BTreeMap<[FactKind; 2], KindPairs> = BTreeMap::new();
        for pair in pairs.pairs() {
            let of_kinds = kinds.entry(pair.facts.map(|fact| fact.kind)).or_default();
            if pair.scenes > 0 {
                of_kinds.met += 1;
            } else if pair.is_excluded {
                of_kinds.excluded += 1;
            } else {
                of_kinds
                    .missing
                    .push(pair.facts.map(|fact| fact.name.clone()));
            }
        }
        Self(kinds)
    }

    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        let mut sums = [0; 3];
        for ([a, b], pairs) in &self.0 {
            let counts = [pairs.met, pairs.excluded, pairs.missing.len() as u64];
            let [met, excluded, missing] = counts;
            text += &format!(
                "{} with {}: {met} pairs have a scene, {excluded} cannot meet, {missing} have none\n",
                a.name(),
                b.name()
            );
            for (sum, count) in sums.iter_mut().zip(counts) {
                *sum += count;
            }
        }
        text += "\nstates without a scene in which they meet:\n";
        for (fact, others) in self.missing_states() {
            text += &format!("  {fact}: {}\n", others.join(", "));
        }
        let [met, excluded, missing] = sums;
        text += &format!(
            "\n{met} pairs have a scene, {excluded} cannot meet (cases/pairs.txt), {missing} have none\n"
        );
        text
    }

    /// Returns for each state the later ones that it does not meet.
    fn missing_states(&self) -> BTreeMap<&str, Vec<&str>> {
        let mut of_states: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        let states = self.0.get(&[FactKind::State; 2]);
        for [a, b] in states.into_iter().flat_map(|pairs| &pairs.missing) {
            of_states.entry(a).or_default().push(b);
        }
        of_states
    }

    pub(crate) fn json(&self) -> Value {
        let kinds = self.0.iter().map(|([a, b], pairs)| {
            json!({ "kinds": [a.name(), b.name()], "met": pairs.met, "excluded": pairs.excluded, "missing": pairs.missing })
        });
        json!({ "pairs": kinds.collect::<Vec<_>>() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_case::Library;

    #[test]
    fn no_case_has_a_pair_that_cannot_meet() {
        let files: Vec<CaseFile> = Library::built_in().files().cloned().collect();
        let pairs = count(&files, Profile::Full);
        let met = pairs
            .pairs()
            .filter(|pair| pair.is_excluded && pair.scenes > 0);
        let met: Vec<_> = met.map(|pair| pair.facts.map(|f| &f.name)).collect();
        assert!(met.is_empty(), "cases/pairs.txt excludes {met:?}");
    }
}
