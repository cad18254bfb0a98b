//! Legal sets that are known already. Most scenes touch few permissions, and the texts and the yardstick agree on
//! most of these, so that one set often serves several rules.

use crate::rules::{AskedValues, Rules};
use etalon_frame::LegalSet;
use std::sync::Arc;

/// The legal sets of one scene under equal limits, each with the permissions that it was computed by.
#[derive(Debug, Default)]
pub struct KnownSets(Vec<(AskedValues, Arc<LegalSet>)>);

impl KnownSets {
    /// Returns a set that rules gave with the same values, as far as they were asked for.
    pub fn find(&self, rules: &Rules) -> Option<Arc<LegalSet>> {
        let mut all = self.0.iter();
        let known = all.find(|(asked, _)| rules.agree_on(asked))?;
        Some(Arc::clone(&known.1))
    }

    /// Returns the set of some rules that `judge` computes, and keeps it.
    pub fn add(&mut self, rules: &Rules, judge: impl FnOnce(&Rules) -> LegalSet) -> Arc<LegalSet> {
        // A clone has not been asked for anything yet.
        let rules = rules.clone();
        let set = Arc::new(judge(&rules));
        self.0.push((rules.asked(), Arc::clone(&set)));
        set
    }
}
