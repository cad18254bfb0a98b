//! The wire format from outside: folders that are written, cut off, damaged, resumed and replaced.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

mod bench_folder;
mod damage;
mod run_folder;
#[path = "../spoil/mod.rs"]
mod spoil;
