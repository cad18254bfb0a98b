//! Records in one sentence.

use super::plain::plain;
use super::story::sentence;
use super::texel::{multisampled, texel_line};
use super::verdict::{Tone, meaning, name};
use crate::numbers::duration;
use etalon_record::{LossKind, ProcessEnd, Record};

/// Returns the loss of a process in one sentence.
pub(crate) fn process_end(end: &ProcessEnd) -> String {
    let what = match end.kind {
        LossKind::Died => "The process died",
        LossKind::Timeout => "The process did not answer in time",
        LossKind::Memory => "The process exceeded its memory limit",
        LossKind::Garbage => "The process wrote an invalid message",
        LossKind::NotStarted => "The process could not be started again",
    };
    let mut text = what.to_owned();
    if let Some(signal) = end.signal {
        text += &format!(", ended by signal {signal}");
        if let Some(name) = signal_name(signal) {
            text += &format!(" ({name})");
        }
    }
    if let Some(exit) = end.exit {
        text += &format!(", exit status {}", exit_status(exit));
    }
    text += &format!(", after {}.", duration(end.seconds));
    text
}

/// Returns an exit status as its system writes it: Windows exceptions are negative, and known by their
/// hexadecimal codes.
fn exit_status(exit: i32) -> String {
    if exit < 0 {
        format!("0x{exit:08X}")
    } else {
        exit.to_string()
    }
}

/// Returns the name of a signal that ends processes, by its number on most Linux machines.
fn signal_name(signal: i32) -> Option<&'static str> {
    Some(match signal {
        1 => "SIGHUP",
        2 => "SIGINT",
        3 => "SIGQUIT",
        4 => "SIGILL",
        5 => "SIGTRAP",
        6 => "SIGABRT",
        7 => "SIGBUS",
        8 => "SIGFPE",
        9 => "SIGKILL",
        11 => "SIGSEGV",
        13 => "SIGPIPE",
        14 => "SIGALRM",
        15 => "SIGTERM",
        24 => "SIGXCPU",
        25 => "SIGXFSZ",
        31 => "SIGSYS",
        _ => return None,
    })
}

/// Returns the most informative line about a record: the ruling of its story, its first wrong texel, or the
/// last line of its message, which usually names the cause of a crash.
pub(crate) fn headline(record: &Record) -> String {
    let last = record.message.lines().rev().find(|l| !l.trim().is_empty());
    let text = match (record.wrong.first(), last) {
        _ if Tone::of(record) == Tone::Missed => {
            format!("{}, but the selftest is due to fail", name(record.verdict))
        }
        (Some(texel), _) if record.verdict.is_judged() => {
            let sentence = record.story.as_ref().and_then(sentence);
            sentence.unwrap_or_else(|| texel_line(texel, multisampled(record)))
        }
        (_, Some(line)) => line.trim().to_owned(),
        (Some(texel), None) => texel_line(texel, multisampled(record)),
        (None, None) => meaning(record.verdict).to_owned(),
    };
    plain(&text, 300)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lost_process_is_told_in_one_sentence() {
        let mut end = ProcessEnd {
            kind: LossKind::Died,
            signal: Some(6),
            exit: None,
            stderr: String::new(),
            seconds: 0.25,
        };
        let text = "The process died, ended by signal 6 (SIGABRT), after 250.0 ms.";
        assert_eq!(process_end(&end), text);
        (end.kind, end.signal) = (LossKind::Garbage, Some(-7));
        (end.exit, end.seconds) = (Some(3), 20.0);
        let text = "The process wrote an invalid message, ended by signal -7, exit status 3, after 20.00 s.";
        assert_eq!(process_end(&end), text);
        (end.signal, end.exit) = (None, Some(0xC000_0005_u32 as i32));
        let text = "The process wrote an invalid message, exit status 0xC0000005, after 20.00 s.";
        assert_eq!(process_end(&end), text);
        end.seconds = 1e300;
        assert!(process_end(&end).len() < 120);
    }
}
