//! A site: the pages of recorded folders in one static folder, as a job publishes it.
//!
//! Every link is relative and leads to a file of the site, so that the folder works from any place: a web server, an
//! archive, the file system.

mod runs;
mod start;
mod write;

pub use write::{SITE_FILE, write_site};
