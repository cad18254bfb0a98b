//! Counting the instructions of a frame, by a program around the worker.
//!
//! Workers each draw a case a different number of times. The difference of their instructions, per frame, is
//! free of what a worker does only once, and is the same on a busy machine.

use super::round::SLOT;
use crate::launch::Launch;
use crate::loss::RequestError;
use crate::protocol::Request;
use crate::worker::Worker;
use etalon_record::{CountedInstructions, InstructionCounter};
use etalon_scene::Scene;
use std::borrow::Cow;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// The frames that each process draws. Drivers compile at the first frame, and some again at the second. The
/// first process is not counted: it fills the driver's shader cache for the processor that the counter shows
/// it.
const FRAMES: [u32; 4] = [2, 2, 6, 10];
/// The factor by which a process is allowed to take longer than without a counter.
const SLOWER: u32 = 20;

/// Returns a program that can count here: perf if the system lets it read the processor's counter, otherwise Valgrind.
///
/// # Errors
/// If there is neither, with a remedy.
pub fn instruction_counter() -> Result<InstructionCounter, String> {
    let counts = |counter: &InstructionCounter| {
        let log = log_file();
        let (program, arguments) = around(*counter, &log);
        let mut command = Command::new(program);
        command.args(arguments).arg("true").stdin(Stdio::null());
        let ran = command.stdout(Stdio::null()).stderr(Stdio::null()).status();
        let total = read_total(*counter, &log);
        ran.is_ok_and(|status| status.success()) && total.is_some_and(|total| total > 0)
    };
    let mut counters = InstructionCounter::ALL.into_iter();
    counters.find(counts).ok_or_else(|| {
        "no program here can count instructions: perf lacks the processor's counter or the permission to read \
         it, and Valgrind is not installed; apt-get install valgrind"
            .to_owned()
    })
}

/// Counts the instructions of a scene's frame on an adapter, for the case and the adapter of these names.
///
/// # Errors
/// Why they were not counted.
pub(crate) fn count(
    counter: InstructionCounter,
    launch: &Launch,
    [case, adapter]: [&str; 2],
    scene: &Scene,
    timeout: Duration,
) -> Result<CountedInstructions, String> {
    if launch.launcher.is_some() {
        return Err(
            "a launcher starts its workers, whose instructions cannot be counted".to_owned(),
        );
    }
    let log = log_file();
    let (program, mut arguments) = around(counter, &log);
    arguments.push(launch.program.display().to_string());
    arguments.extend(launch.arguments.iter().cloned());
    let launch = Launch {
        program: program.into(),
        arguments,
        patience: launch.patience * SLOWER,
        ..launch.clone()
    };
    let timeout = timeout * SLOWER;
    let mut processes = Vec::new();
    for frames in FRAMES {
        let mut worker = Worker::start(&launch).map_err(|e| e.to_string())?.process;
        let mut draw = || -> Result<(), RequestError> {
            let scene = Cow::Borrowed(scene);
            worker.ask(Request::Prepare { slot: SLOT, scene }, timeout)?;
            worker.submit(SLOT, frames, timeout)?;
            worker.ask(Request::Drop { slot: SLOT }, timeout)?;
            Ok(())
        };
        if let Err(failure) = draw() {
            let why = match failure {
                RequestError::Backend(error) => error.to_string(),
                RequestError::Lost(loss) => worker.end_of(loss).to_string(),
            };
            return Err(format!("a worker failed under {counter}: {why}"));
        }
        if !worker.close(timeout) {
            return Err(format!("a worker did not end under {counter}"));
        }
        let total = read_total(counter, &log);
        let total = total.ok_or_else(|| format!("{counter} printed no count"))?;
        processes.push([u64::from(frames), total]);
    }
    processes.remove(0);
    Ok(CountedInstructions {
        case: case.to_owned(),
        adapter: adapter.to_owned(),
        counter,
        processes,
    })
}

/// Returns the file that a counter writes to.
fn log_file() -> PathBuf {
    std::env::temp_dir().join(format!("etalon-instructions-{}.log", std::process::id()))
}

/// Returns the program and its arguments that write the instructions of another program to a file.
fn around(counter: InstructionCounter, log: &Path) -> (&'static str, Vec<String>) {
    let log = log.display();
    let words = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
    match counter {
        InstructionCounter::Perf => {
            let mut arguments: Vec<String> =
                words(&["stat", "-x", ",", "-e", "instructions:u", "-o"]);
            arguments.push(log.to_string());
            arguments.push("--".to_owned());
            ("perf", arguments)
        }
        InstructionCounter::Valgrind => {
            let mut arguments: Vec<String> = words(&[
                "--tool=cachegrind",
                "--cache-sim=no",
                "--cachegrind-out-file=/dev/null",
            ]);
            arguments.push(format!("--log-file={log}"));
            ("valgrind", arguments)
        }
    }
}

/// Reads the count that a program wrote, and removes the file.
fn read_total(counter: InstructionCounter, log: &Path) -> Option<u64> {
    let text = fs::read_to_string(log).ok();
    // If the file cannot be removed, the next process replaces it.
    let _ = fs::remove_file(log);
    total(counter, &text?)
}

fn total(counter: InstructionCounter, text: &str) -> Option<u64> {
    let number = |words: &str| words.trim().replace(',', "").parse().ok();
    match counter {
        InstructionCounter::Perf => text.lines().find_map(|line| {
            let (count, rest) = line.split_once(',')?;
            rest.contains("instructions").then(|| number(count))?
        }),
        InstructionCounter::Valgrind => text.lines().rev().find_map(|line| {
            let (before, count) = line.split_once("refs:")?;
            before.trim_end().ends_with('I').then(|| number(count))?
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_of_perf_and_valgrind_are_parsed() {
        let perf = "# started on Fri Nov 27\n\n1234567,,instructions:u,1000,100.00,,\n";
        assert_eq!(total(InstructionCounter::Perf, perf), Some(1_234_567));
        let missing = "<not supported>,,instructions:u,0,100.00,,\n";
        assert_eq!(total(InstructionCounter::Perf, missing), None);
        let valgrind = "==7== Cachegrind, a high-precision tracing profiler\n==7== \n==7== I   refs:      6,864,674\n";
        assert_eq!(
            total(InstructionCounter::Valgrind, valgrind),
            Some(6_864_674)
        );
        assert_eq!(
            total(InstructionCounter::Valgrind, "==7== D refs: 5\n"),
            None
        );
    }
}
