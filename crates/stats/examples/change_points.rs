//! Precision and recall of change points on simulated series with planted steps, as a table:
//!
//! ```sh
//! cargo run --release -p etalon-stats --example change_points
//! ```
//!
//! `--series` prints the series instead, one a line with commas between times, for other tools;
//! `--found FILE` reads their answers and prints the table: a line per series, with the first run of each change,
//! separated by commas.

#[path = "../tests/it/nightly.rs"]
mod nightly;

use nightly::{MACHINES, Machine, RUNS, STEPS, Score, Series, alarms, series};
use oorandom::Rand64;
use std::{env, fs, process::ExitCode};

/// Series of each machine and size.
const SERIES: usize = 100;
/// Sizes of steps in per cent; no steps at 0.
const SIZES: [u32; 6] = [0, 1, 2, 5, 10, 20];

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments.as_slice() {
        [] => print(|series| alarms(&series.points)),
        ["--series"] => {
            for series in MACHINES
                .iter()
                .flat_map(|m| SIZES.iter().flat_map(|size| all_series(*m, *size)))
            {
                let times: Vec<String> = series
                    .points
                    .iter()
                    .map(|p| format!("{:.9}", p.median))
                    .collect();
                println!("{}", times.join(","));
            }
        }
        ["--found", file] => {
            let text = match fs::read_to_string(file) {
                Ok(text) => text,
                Err(error) => {
                    eprintln!("{file}: {error}");
                    return ExitCode::FAILURE;
                }
            };
            match answers(&text) {
                Ok(answers) => {
                    let mut answers = answers.into_iter();
                    print(|_| answers.next().unwrap_or_default());
                }
                Err(error) => {
                    eprintln!("{file}: {error}");
                    return ExitCode::FAILURE;
                }
            }
        }
        _ => {
            eprintln!("usage: change_points [--series | --found FILE]");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

/// Returns the first runs of the changes in each series.
fn answers(text: &str) -> Result<Vec<Vec<usize>>, String> {
    let run = |number: usize, word: &str| match word.trim().parse() {
        Ok(run) if run < RUNS => Ok(run),
        _ => Err(format!("line {number}: `{word}` is not a run below {RUNS}")),
    };
    let lines = text.lines().zip(1..).map(|(line, number)| {
        // A series without changes has an empty line.
        let words = line.split(',').filter(|_| !line.trim().is_empty());
        words.map(|word| run(number, word)).collect()
    });
    let answers: Vec<Vec<usize>> = lines.collect::<Result<_, String>>()?;
    let expected = MACHINES.len() * SIZES.len() * SERIES;
    if answers.len() != expected {
        return Err(format!("{} lines instead of {expected}", answers.len()));
    }
    Ok(answers)
}

/// The series of a machine and a size, the same each time.
fn all_series(machine: Machine, size: u32) -> Vec<Series> {
    let mut random = Rand64::new(u128::from(size) + 1);
    let make = |_| series(&mut random, machine, f64::from(size) / 100.0);
    (0..SERIES).map(make).collect()
}

fn print(mut found: impl FnMut(&Series) -> Vec<usize>) {
    println!(
        "{SERIES} series of {RUNS} runs per cell, with {STEPS} steps each: recall / precision in per cent.\n\
         none: false changes in 1,000 runs without a step.\n"
    );
    print!("{:<46}{:>6}", "", "none");
    for size in &SIZES[1..] {
        print!("{:>12}", format!("{size} %"));
    }
    println!();
    for machine in MACHINES {
        print!("{:<46}", machine.name);
        for size in SIZES {
            let mut score = Score::default();
            for series in all_series(machine, size) {
                score.add(&series.steps, &found(&series), RUNS);
            }
            match size {
                0 => print!("{:>6.2}", 1000.0 * score.wrong as f64 / score.runs as f64),
                _ => print!(
                    "{:>12}",
                    format!(
                        "{:.0} / {:.0}",
                        100.0 * score.recall(),
                        100.0 * score.precision()
                    )
                ),
            }
        }
        println!();
    }
}
