//! A site: the pages of recorded folders and the documents of a checkout in one static folder, as a job publishes it.
//!
//! Every link is relative and leads to a file of the site, or away by a whole address, so that the folder works from
//! any place: a web server, an archive, the file system. What a document links to is part of the site; what cannot
//! be is left as text and named.

mod docs;
mod markdown;
mod runs;
mod start;
mod write;

pub use write::{SITE_FILE, WrittenSite, write_site};
