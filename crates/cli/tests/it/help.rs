//! Help texts, completion scripts and manual pages. `INSTA_UPDATE=always` accepts new help texts.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use assert_cmd::Command;
use std::collections::BTreeSet;
use std::fs;

const BINARY: &str = env!("CARGO_BIN_EXE_etalon");

fn stdout(arguments: &[&str]) -> String {
    let mut command = Command::new(BINARY);
    // Without a terminal, help is wrapped at this width.
    command.args(arguments).env("COLUMNS", "100");
    let assert = command.assert().success().stderr("");
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

/// Returns the commands that a command's help lists.
fn listed(help: &str) -> Vec<&str> {
    help.lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.strip_prefix("  ")?.split(' ').next())
        .filter(|word| !word.is_empty() && *word != "help")
        .collect()
}

#[test]
fn help_texts_are_as_recorded() {
    let overview = stdout(&["--help"]);
    insta::assert_snapshot!("help", overview);
    assert_eq!(stdout(&["help"]), overview);
    let commands = listed(&overview);
    assert!(commands.len() >= 13, "{commands:?}");
    assert!(!commands.contains(&"worker"), "{commands:?}");
    for command in commands {
        let help = stdout(&[command, "--help"]);
        insta::assert_snapshot!(format!("help-{command}"), help);
        for inner in listed(&help) {
            let help = stdout(&[command, inner, "--help"]);
            insta::assert_snapshot!(format!("help-{command}-{inner}"), help);
        }
    }
}

#[test]
fn completion_scripts_name_every_command() {
    let help = stdout(&["--help"]);
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = stdout(&["completions", shell]);
        for command in listed(&help) {
            assert!(script.contains(command), "{shell}: {command}");
        }
        assert!(script.contains("shader-cache"), "{shell}");
        assert!(!script.contains("enumerate"), "{shell}: the hidden command");
        if shell == "bash" {
            let mut bash = Command::new("bash");
            bash.arg("-n").write_stdin(script).assert().success();
        }
    }
}

#[test]
fn manual_pages_are_printed_and_written() {
    let page = stdout(&["man"]);
    assert!(page.contains(".TH etalon 1"), "{page}");
    assert!(page.contains("Exit codes"), "{page}");
    let work = tempfile::tempdir().unwrap();
    let folder = work.path().join("new/man1");
    let path = folder.to_str().unwrap();
    assert!(stdout(&["man", "--out", path]).contains(path));
    let found: BTreeSet<String> = fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let help = stdout(&["--help"]);
    let mut expected: BTreeSet<String> = [
        "etalon",
        "etalon-expectations-import",
        "etalon-expectations-export",
        "etalon-history-add",
        "etalon-history-export",
        "etalon-history-report",
        "etalon-history-show",
        "etalon-history-triage",
    ]
    .iter()
    .map(|name| format!("{name}.1"))
    .collect();
    expected.extend(listed(&help).iter().map(|name| format!("etalon-{name}.1")));
    assert_eq!(found, expected);
    let run = fs::read_to_string(folder.join("etalon-run.1")).unwrap();
    assert!(run.contains("shader\\-cache"), "{run}");
    let file = work.path().join("file");
    fs::write(&file, "").unwrap();
    let mut refused = Command::new(BINARY);
    refused.args(["man", "--out"]).arg(file.join("below"));
    refused.assert().code(64);
}
