//! A site: the pages of recorded folders in one static folder, which a CI job can publish.
//!
//! All links are relative and lead to files of the site, so the folder works anywhere: on a web server, in an
//! archive, on the file system.

mod runs;
mod start;
mod write;

pub use runs::CasesOf;
pub use write::{SITE_FILE, write_site};
