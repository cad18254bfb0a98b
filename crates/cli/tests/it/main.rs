//! The binary as a user meets it, and the rules of the workspace. One test binary: each one links the
//! whole suite.

mod adapters;
mod bench;
mod bisect;
mod bundle_c;
mod bundle_wgpu;
mod bundling;
mod call_faults;
mod check;
mod ci_files;
mod circles;
mod commands;
mod diff;
mod driver_releases;
mod etalon;
mod expectations;
mod findings;
mod fuzz;
mod help;
mod history;
mod history_export;
mod house;
mod launchers;
mod methods;
mod mutants;
mod news;
mod parts;
mod pipes;
mod read_faults;
mod reduce;
mod round_trips;
mod runs;
mod sample;
mod stories;
mod survive;
mod version;
