//! A history from outside: added runs are read back, whatever happens to the file.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

mod adding;
mod counting;
mod files;
mod folders;
mod made;
mod migrations;
mod random;
