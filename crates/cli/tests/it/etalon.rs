//! Starts the binary under test.

use assert_cmd::Command;
use std::time::Duration;

/// The path of the binary.
pub(crate) const BINARY: &str = env!("CARGO_BIN_EXE_etalon");

/// Variables of CI and of systems that shard; the tests themselves can run in such a system.
pub(crate) const REMOVED: [&str; 5] = [
    "CI",
    "CI_NODE_INDEX",
    "TEST_SHARD_INDEX",
    "SLURM_ARRAY_TASK_ID",
    "JOB_COMPLETION_INDEX",
];

/// Returns the binary with these arguments and a time limit.
pub(crate) fn etalon(arguments: &[&str]) -> Command {
    let mut command = Command::new(BINARY);
    command.args(arguments).timeout(Duration::from_secs(100));
    for name in REMOVED {
        command.env_remove(name);
    }
    command
}
