//! The names of a run's pages, and what they show.

use crate::methods::Methods;
use crate::news::RunNews;
use etalon_record::{Bench, Dead};

/// The first page.
pub(crate) const INDEX: &str = "index.html";
/// The page about the run as a whole.
pub(crate) const DETAILS: &str = "details.html";
/// The name of [`INDEX`] in its own links.
pub(super) const SAME_PAGE: &str = "";

/// What the pages show beside the records.
#[derive(Clone, Copy)]
pub(crate) struct PageParts<'a> {
    /// The scripts of the case files, by file.
    pub(crate) scripts: &'a [(String, String)],
    pub(crate) dead: &'a [Dead],
    pub(crate) methods: Option<&'a Methods<'a>>,
    pub(crate) news: Option<&'a RunNews>,
    /// The frame times.
    pub(crate) timed: Option<&'a Bench>,
}
