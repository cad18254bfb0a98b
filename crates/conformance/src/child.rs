//! Tests in their own process, whose environment selects the driver before it is loaded.

use std::env;
use std::process::Command;

/// The variable that names a child's test.
const CHILD: &str = "ETALON_TEST_CHILD";

/// Runs `body` in a process with this environment, by running the test of this name again. Without any
/// variable, runs it in this process.
///
/// # Panics
/// If the child fails, with all its output.
pub fn in_child(test: &str, environment: &[(&str, String)], body: impl FnOnce()) {
    if environment.is_empty() || env::var_os(CHILD).is_some_and(|child| child == test) {
        body();
        return;
    }
    let output = Command::new(env::current_exe().expect("the path of the test"))
        .args([test, "--exact", "--include-ignored", "--nocapture"])
        .env(CHILD, test)
        // Mesa prints a warning if this is not set.
        .env("XDG_RUNTIME_DIR", env::temp_dir())
        .envs(environment.iter().map(|(name, value)| (name, value)))
        .output()
        .expect("the test starts itself");
    let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && text.contains("1 passed"),
        "{test} with {environment:?}: {}\n{text}",
        output.status
    );
    print!("{text}");
}
