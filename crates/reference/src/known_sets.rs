//! Legal sets that are known already. Most scenes touch few permissions, and the texts and the yardstick agree on
//! most of these, so that one set often serves several rules.

use crate::rules::{AskedValues, Rules};
use etalon_frame::LegalSet;
use std::sync::Arc;

/// The legal sets of one scene under equal limits, each with the permissions that it was computed by.
#[derive(Debug, Default)]
pub struct KnownSets(Vec<(AskedValues, Arc<LegalSet>)>);

impl KnownSets {
    /// Returns the set of some rules: one that is known by the values that were asked for, or the one that
    /// `compute` gives, which is known from then on.
    pub fn get(
        &mut self,
        rules: &Rules,
        compute: impl FnOnce(&Rules) -> LegalSet,
    ) -> Arc<LegalSet> {
        let mut all = self.0.iter();
        if let Some((_, set)) = all.find(|(asked, _)| rules.agree_on(asked)) {
            return Arc::clone(set);
        }
        // A clone has not been asked for anything yet.
        let rules = rules.clone();
        let set = Arc::new(compute(&rules));
        self.0.push((rules.asked(), Arc::clone(&set)));
        set
    }
}
