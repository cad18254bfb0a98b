//! Writes the pages of a history, and says how large they are and how long it took:
//! `cargo run --release -p etalon-report --example history_page -- DATABASE FOLDER`.
#![expect(clippy::unwrap_used, reason = "an example may stop at the first error")]

use etalon_history::History;
use etalon_record::Labels;
use etalon_report::write_history;
use std::path::PathBuf;
use std::time::Instant;

fn main() {
    let paths: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [database, folder] = &paths[..] else {
        eprintln!("usage: history_page DATABASE FOLDER");
        std::process::exit(64)
    };
    let start = Instant::now();
    let history = History::open_read(database).unwrap();
    let written = write_history(&history, &Labels::new(), folder, true).unwrap();
    println!(
        "{}: {:.2} MB; {} files, {:.1} MB in all, in {:.1?}",
        written.html.display(),
        written.start as f64 / 1e6,
        written.files,
        written.bytes as f64 / 1e6,
        start.elapsed()
    );
}
