//! The pages of a history: what changed since the last run, scores over time, and the full history of each
//! case.
//!
//! The start page needs no script. Everything else is in neighbouring files, each a script that hands its
//! data to the page's script: a browser does not let a page from the file system read its neighbours
//! otherwise. A file is loaded when something in it is to be shown.

mod courses;
mod data;
mod families;
mod looks;
mod matrix;
mod model;
mod news;
mod page;
mod places;
mod scores;
mod sparkline;
mod times;
mod write;

pub use write::{HISTORY_PAGE_FILE, write_history};
