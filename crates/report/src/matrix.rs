//! The performance matrix: rates of cells as a page of heat maps, as CSV, and as a table for a terminal.

mod csv;
mod data;
mod heat;
mod page;
mod reached;
mod roofline;
mod table;

pub(crate) use csv::csv;
pub(crate) use data::Matrix;
pub(crate) use page::page;
pub use table::matrix_table;
