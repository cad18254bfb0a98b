//! Rendering methods: accuracy against speed, stability, and claims of the literature; and how
//! accurate the drivers are.

mod breaks;
mod claims;
mod data;
mod driver;
mod front;
#[cfg(test)]
mod made;
mod page;
mod scatter;
mod stability;
mod summary;

pub(crate) use data::Methods;
pub(crate) use driver::section as driver_section;
pub(crate) use page::page;
pub(crate) use summary::{lines, section};

/// The name of the page of methods in a run folder.
pub(crate) const PAGE: &str = "methods.html";
/// How charts look; for pages that have some.
pub(crate) const CHART_STYLE: &str = include_str!("chart/chart.css");

/// A parameter's value.
fn value_text(value: f64) -> String {
    crate::chart::kit::digits(value, 3)
}

/// The name of the element that a scene's charts are in: letters, digits and dashes, so that no name
/// of a record can break a link.
fn anchor(question: usize, scene: usize) -> String {
    format!("s{question}-{scene}")
}
