//! The pairs of facts that no specification lets meet, or whose meeting nothing could show.

use etalon_glob::Glob;

/// Lines `FACT + FACT: reason`; a fact can be a glob.
const EXCLUDED: &str = include_str!("../data/pairs.txt");

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

    /// Returns true if it names two facts.
    pub(crate) fn names(&self, [a, b]: [&str; 2]) -> bool {
        let matched = |a: &str, b: &str| self.0[0].is_match(a) && self.0[1].is_match(b);
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
            let mut facts = pairs
                .pairs()
                .map(|pair| pair.facts.map(|f| f.name.as_str()));
            let is_named = facts.any(|facts| excluded.names(facts));
            assert!(is_named, "no pair is named by `{line}`");
        }
    }
}
