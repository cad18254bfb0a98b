//! The pairs of facts that no specification lets meet, or whose meeting nothing could show.

use crate::facts::DrawFact;
use etalon_glob::Glob;

/// Lines `FACT + FACT: reason`; a fact can be a glob.
const EXCLUDED: &str = include_str!("../../../cases/pairs.txt");

/// Globs of two facts that cannot meet.
pub(crate) struct ExcludedPair([Glob; 2]);

impl ExcludedPair {
    /// Returns all pairs that cannot meet.
    pub(crate) fn all() -> Vec<Self> {
        lines().filter_map(Self::parse).collect()
    }

    fn parse(line: &str) -> Option<Self> {
        let (pair, _) = line.split_once(": ")?;
        let (a, b) = pair.split_once(" + ")?;
        Some(Self([Glob::new(a).ok()?, Glob::new(b).ok()?]))
    }

    pub(crate) fn names(&self, [a, b]: [&DrawFact; 2]) -> bool {
        let matched =
            |a: &DrawFact, b: &DrawFact| self.0[0].is_match(&a.name) && self.0[1].is_match(&b.name);
        matched(a, b) || matched(b, a)
    }
}

fn lines() -> impl Iterator<Item = &'static str> {
    EXCLUDED.lines().filter(|line| !line.starts_with('#'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FactPairs;

    #[test]
    fn every_line_names_a_pair() {
        let pairs = FactPairs::default();
        for line in lines() {
            let excluded = ExcludedPair::parse(line).expect("a line is FACT + FACT: reason");
            let is_named = pairs.pairs().any(|pair| excluded.names(pair.facts));
            assert!(is_named, "no pair is named by `{line}`");
        }
    }
}
