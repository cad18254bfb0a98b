//! A cache of legal sets. Most scenes depend on few permissions, and the specification and the yardstick
//! agree on most of these, so that one set often serves several rules.

use crate::rules::Rules;
use etalon_frame::LegalSet;
use std::sync::Arc;

/// The legal sets of one scene under equal limits, each with its rules, which know what its computation asked.
#[derive(Debug, Default)]
pub struct KnownSets(Vec<(Rules, Arc<LegalSet>)>);

impl KnownSets {
    /// Returns the set of some rules: a cached one if the rules have the same values for all permissions that
    /// computing the set asked for; otherwise the result of `compute`, which is then cached.
    pub fn get(
        &mut self,
        rules: &Rules,
        compute: impl FnOnce(&Rules) -> LegalSet,
    ) -> Arc<LegalSet> {
        let mut known = self.0.iter();
        if let Some((_, set)) = known.find(|(other, _)| rules.agree_on_asked(other)) {
            return Arc::clone(set);
        }
        // A clone starts without recorded permissions, so it records only those of this computation.
        let rules = rules.clone();
        let set = Arc::new(compute(&rules));
        self.0.push((rules, Arc::clone(&set)));
        set
    }
}
