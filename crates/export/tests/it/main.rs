//! A history from outside as files for other programs: what was added is in them.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

mod dashboard;
mod folder;
mod latest;
mod made;
mod openmetrics;
mod otava;
mod random;
mod selection;
mod tables;
