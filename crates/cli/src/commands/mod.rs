//! One file per command.

pub(crate) mod adapters;
pub(crate) mod bench;
pub(crate) mod bisect;
pub(crate) mod bundle;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod conformance;
pub(crate) mod diff;
pub(crate) mod expectations;
pub(crate) mod explain;
pub(crate) mod export;
pub(crate) mod fuzz;
#[cfg(feature = "history")]
pub(crate) mod history;
pub(crate) mod judge;
pub(crate) mod list;
pub(crate) mod man;
pub(crate) mod merge;
#[cfg(feature = "mutants")]
pub(crate) mod mutants;
pub(crate) mod reduce;
pub(crate) mod report;
pub(crate) mod run;
pub(crate) mod schema;
pub(crate) mod show;
pub(crate) mod site;
