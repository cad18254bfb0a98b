//! Writes a made-up run and its reports, to look at the pages and at their size:
//! `cargo run -p etalon-report --example sample -- FOLDER [REPEATS|large|methods]`. A large run has 8,000 cases on ten
//! adapters.
#![expect(clippy::unwrap_used, reason = "an example may stop at the first error")]

#[path = "../tests/it/synthetic/mod.rs"]
mod synthetic;

use etalon_record::Run;
use etalon_report::{TableOptions, table, write};
use std::path::PathBuf;
use std::time::Instant;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| {
        eprintln!("usage: sample FOLDER [REPEATS|large|methods]");
        std::process::exit(64)
    }));
    let kind = arguments.next().unwrap_or_else(|| "1".to_owned());
    let records = match kind.as_str() {
        "large" => synthetic::large::write(&folder),
        "methods" => synthetic::methods::write(&folder),
        repeats => synthetic::write(&folder, repeats.parse().unwrap()),
    };
    let start = Instant::now();
    let written = write(&folder).unwrap();
    let seconds = start.elapsed().as_secs_f64();
    let pages = [
        Some(&written.html),
        Some(&written.junit),
        written.methods.as_ref(),
    ];
    for path in pages.into_iter().flatten() {
        let bytes = std::fs::metadata(path).unwrap().len();
        println!("{}: {:.2} MB", path.display(), bytes as f64 / 1e6);
    }
    println!("{records} records, {seconds:.2} s");
    let run = Run::read(&folder).unwrap();
    let options = TableOptions {
        width: 120,
        color: true,
    };
    print!("{}", table(&run, options));
}
