//! How verdicts, codes and texels are put in words; shared by all reports.

use etalon_frame::{Aspect, Band, ChannelEncoding, ChannelMismatch, WrongTexel};
use etalon_record::{LossKind, ProcessEnd, Record, Settings, Verdict};

/// How a record's verdict is to be taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Tone {
    /// As the verdict says.
    Plain,
    /// Bad, but expected or due.
    Excused,
    /// A selftest that was due to fail and did not.
    Missed,
}

impl Tone {
    pub(crate) fn of(record: &Record) -> Self {
        if record.verdict.is_bad() && !record.unexpected() {
            Self::Excused
        } else if record.due_fail && record.unexpected() && !record.verdict.is_bad() {
            Self::Missed
        } else {
            Self::Plain
        }
    }

    /// What is said behind the verdict.
    pub(crate) fn suffix(self) -> &'static str {
        match self {
            Self::Plain => "",
            Self::Excused => " (expected)",
            Self::Missed => " (due to fail)",
        }
    }
}

/// A sign that tells verdicts apart without colour. The variation selector keeps browsers from
/// drawing a coloured picture.
pub(crate) fn symbol(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "✓",
        Verdict::Imprecise => "≈",
        Verdict::Fail => "✗",
        Verdict::Open => "○",
        Verdict::Measured => "◇",
        Verdict::NotSupported => "–",
        Verdict::Skipped => "↷",
        Verdict::Flaky => "⇄",
        Verdict::Crash => "⚡\u{fe0e}",
        Verdict::Timeout => "◷",
        Verdict::DeviceLost => "⊘",
        Verdict::ResourceError => "□",
        Verdict::InternalError => "!",
    }
}

/// The verdict's name with spaces.
pub(crate) fn name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NotSupported => "not supported",
        Verdict::DeviceLost => "device lost",
        Verdict::ResourceError => "resource error",
        Verdict::InternalError => "internal error",
        other => other.name(),
    }
}

/// What the verdict means, in one sentence.
pub(crate) fn meaning(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "Every texel lies inside the yardstick, and something was asserted.",
        Verdict::Imprecise => "Every texel is legal; some lie outside the yardstick.",
        Verdict::Fail => "A texel lies outside what the API's text allows.",
        Verdict::Open => "Nothing could be asserted.",
        Verdict::Measured => "Numbers without judgement.",
        Verdict::NotSupported => "The adapter lacks something that the scene needs.",
        Verdict::Skipped => "The expectations forbid drawing the case here.",
        Verdict::Flaky => "The same case gave different frames.",
        Verdict::Crash => "The process that drew the case died.",
        Verdict::Timeout => "The case took longer than it may.",
        Verdict::DeviceLost => "The API reported the device lost.",
        Verdict::ResourceError => "The driver refused an allocation or an object.",
        Verdict::InternalError => "The suite's own logic failed; the driver is not to blame.",
    }
}

/// `1 case`, `2 cases`.
pub(crate) fn count(n: u64, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

/// How a process was lost, in one sentence.
pub(crate) fn process_end(end: &ProcessEnd) -> String {
    let what = match end.kind {
        LossKind::Died => "The process died",
        LossKind::Timeout => "The process did not answer in time",
        LossKind::Memory => "The process held more memory than it may",
        LossKind::Garbage => "The process wrote what is no message",
        LossKind::NotStarted => "The process could not be started again",
    };
    let mut text = what.to_owned();
    if let Some(signal) = end.signal {
        text.push_str(&format!(", ended by signal {signal}"));
        if let Some(name) = signal_name(signal) {
            text.push_str(&format!(" ({name})"));
        }
    }
    if let Some(exit) = end.exit {
        text.push_str(&format!(", exit status {exit}"));
    }
    text.push_str(&format!(", after {}.", seconds(end.seconds)));
    text
}

/// The name of a signal that ends processes, as Linux numbers them on most machines.
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

/// `12.3 s`, `4.5 ms`.
pub(crate) fn seconds(value: f64) -> String {
    match value.abs() {
        v if v >= 1e6 => format!("{value:.1e} s"),
        v if v >= 1.0 => format!("{value:.1} s"),
        _ => format!("{:.1} ms", value * 1e3),
    }
}

/// The verdicts of a record's repetitions: `pass, 2 × fail`.
pub(crate) fn repetitions(verdicts: &[Verdict]) -> String {
    let runs = verdicts.chunk_by(|a, b| a == b).map(|same| {
        let word = same.first().map_or("", |v| name(*v));
        match same.len() {
            1 => word.to_owned(),
            n => format!("{n} × {word}"),
        }
    });
    runs.collect::<Vec<_>>().join(", ")
}

/// How a run was drawn, one text per setting that is not as it is by itself.
pub(crate) fn settings(settings: &Settings) -> Vec<String> {
    let mut texts = Vec::new();
    let mut add = |text: Option<String>| texts.extend(text);
    add(settings.shard.map(|s| format!("shard {s}")));
    add(settings.shuffle.map(|s| format!("shuffled with seed {s}")));
    add(settings
        .repeat
        .map(|n| count(u64::from(n), "drawing") + " of each case"));
    add(settings
        .shader_cache
        .map(|c| format!("shader cache {}", c.name())));
    add(settings
        .validate
        .then(|| "validation layers listened".to_owned()));
    add(settings
        .timeout
        .map(|s| format!("at most {} per case", seconds(s))));
    add(settings
        .memory
        .map(|m| format!("at most {m} MiB per worker")));
    texts
}

/// The channel's name in its aspect.
fn channel_name(aspect: Aspect, channel: u8) -> String {
    match (aspect, channel) {
        (Aspect::Color, 0) => "red".to_owned(),
        (Aspect::Color, 1) => "green".to_owned(),
        (Aspect::Color, 2) => "blue".to_owned(),
        (Aspect::Color, 3) => "alpha".to_owned(),
        (Aspect::Color, n) => format!("channel {n}"),
        (other, _) => other.name().to_owned(),
    }
}

/// The attachment and the channel, or one word where they have the same name.
pub(crate) fn channel_of(m: &ChannelMismatch) -> String {
    let name = channel_name(m.aspect, m.channel);
    if m.attachment == name {
        name
    } else {
        format!("{} {name}", m.attachment)
    }
}

/// A code as it is stored.
pub(crate) fn code_text(encoding: ChannelEncoding, code: u32) -> String {
    match encoding {
        ChannelEncoding::Unorm(bits) | ChannelEncoding::Snorm(bits) => {
            format!("0x{code:0width$x}", width = usize::from(bits).div_ceil(4))
        }
        ChannelEncoding::Srgb8 => format!("0x{code:02x}"),
        ChannelEncoding::Float16 => format!("0x{code:04x}"),
        ChannelEncoding::Ufloat(_) => format!("0x{code:03x}"),
        ChannelEncoding::Uint(_) => code.to_string(),
        ChannelEncoding::Float32 => format!("0x{code:08x}"),
    }
}

/// The value that a code stands for.
pub(crate) fn value_text(encoding: ChannelEncoding, code: u32) -> String {
    if encoding == ChannelEncoding::Float32 {
        // Debug keeps every digit and the sign of zero, and knows infinities and NaNs.
        return format!("{:?}", f32::from_bits(code));
    }
    let value = encoding.value_of_order(encoding.order_of_code(code));
    match encoding {
        ChannelEncoding::Uint(_) => format!("{value}"),
        _ => {
            let text = format!("{value:.7}");
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
    }
}

/// A code with its value: `0x80 = 0.5019608`.
pub(crate) fn code_and_value(encoding: ChannelEncoding, code: u32) -> String {
    let text = code_text(encoding, code);
    match encoding {
        ChannelEncoding::Uint(_) => text,
        _ => format!("{text} = {}", value_text(encoding, code)),
    }
}

/// `low to high`, or the one code where they agree, in the notation of `text`.
pub(crate) fn allowed(m: &ChannelMismatch, text: fn(ChannelEncoding, u32) -> String) -> String {
    let low = text(m.encoding, m.low);
    if m.low == m.high {
        low
    } else {
        format!("{low} to {}", text(m.encoding, m.high))
    }
}

/// Where a texel lies: `texel (3, 4)`, with its sample where there are several.
pub(crate) fn place(texel: &WrongTexel, multisampled: bool) -> String {
    let at = format!("texel ({}, {})", texel.x, texel.y);
    if multisampled {
        format!("{at} sample {}", texel.sample)
    } else {
        at
    }
}

/// Whether the wrong texels tell that there are several samples.
pub(crate) fn multisampled(record: &Record) -> bool {
    record.wrong.iter().any(|t| t.sample > 0)
}

/// A wrong texel in one line.
fn texel_line(texel: &WrongTexel, multisampled: bool) -> String {
    const SHOWN: usize = 2;
    // An imprecise texel is told against the yardstick, which it left, not against what is legal.
    let (bound, legal) = match texel.band {
        Band::Imprecise => ("yardstick", " (legal)"),
        Band::Fail => ("allowed", ""),
    };
    let channel = |m: &ChannelMismatch| {
        format!(
            "{} {bound} {}, got {}",
            channel_of(m),
            allowed(m, code_text),
            code_text(m.encoding, m.actual)
        )
    };
    let mut parts: Vec<String> = texel.channels.iter().take(SHOWN).map(channel).collect();
    match texel.channels.len().saturating_sub(SHOWN) {
        0 => {}
        n => parts.push(count(n as u64, "more channel")),
    }
    format!(
        "{}{legal}: {}",
        place(texel, multisampled),
        parts.join("; ")
    )
}

/// The one line that says most about a record: its first wrong texel, or the last line of its
/// message, where the reason of a death usually stands.
pub(crate) fn headline(record: &Record) -> String {
    let last = record.message.lines().rev().find(|l| !l.trim().is_empty());
    let text = match (record.wrong.first(), last) {
        _ if Tone::of(record) == Tone::Missed => {
            format!("{}, but the selftest is due to fail", name(record.verdict))
        }
        (Some(texel), _) if record.verdict.is_judged() => texel_line(texel, multisampled(record)),
        (_, Some(line)) => line.trim().to_owned(),
        (Some(texel), None) => texel_line(texel, multisampled(record)),
        (None, None) => meaning(record.verdict).to_owned(),
    };
    plain(&text, 300)
}

/// Text without control characters, which a terminal would obey, and no longer than so many
/// characters.
pub(crate) fn plain(text: &str, longest: usize) -> String {
    let clean = |c: char| {
        // Invisible characters that turn the reading direction could make one id look like another.
        let turns = matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        if c.is_control() || turns {
            '\u{fffd}'
        } else {
            c
        }
    };
    let mut result: String = text.chars().take(longest).map(clean).collect();
    if text.chars().nth(longest).is_some() {
        result.push('…');
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mismatch(encoding: ChannelEncoding, low: u32, high: u32, actual: u32) -> ChannelMismatch {
        ChannelMismatch {
            attachment: "depth".to_owned(),
            aspect: Aspect::Depth,
            channel: 0,
            encoding,
            low,
            high,
            actual,
        }
    }

    #[test]
    fn a_texel_is_told_in_one_line() {
        let mut texel = WrongTexel {
            x: 3,
            y: 4,
            sample: 0,
            band: Band::Fail,
            channels: vec![mismatch(ChannelEncoding::Unorm(16), 0x7ff, 0x800, 1)],
        };
        assert_eq!(
            texel_line(&texel, false),
            "texel (3, 4): depth allowed 0x07ff to 0x0800, got 0x0001"
        );
        texel.sample = 2;
        texel.channels = vec![mismatch(ChannelEncoding::Uint(8), 7, 7, 9); 3];
        texel.channels[0].attachment = "ds".to_owned();
        texel.channels[0].aspect = Aspect::Stencil;
        let line = texel_line(&texel, true);
        assert!(
            line.starts_with("texel (3, 4) sample 2: ds stencil allowed 7, got 9"),
            "{line}"
        );
        assert!(line.ends_with("1 more channel"), "{line}");
    }

    #[test]
    fn values_keep_what_matters() {
        let float = |v: f32| value_text(ChannelEncoding::Float32, v.to_bits());
        assert_eq!(float(-0.0), "-0.0");
        assert_eq!(float(f32::NAN), "NaN");
        assert_eq!(float(f32::INFINITY), "inf");
        assert_eq!(value_text(ChannelEncoding::Unorm(8), 255), "1");
        assert_eq!(
            code_and_value(ChannelEncoding::Unorm(8), 1),
            "0x01 = 0.0039216"
        );
    }

    #[test]
    fn symbols_differ() {
        let mut all: Vec<_> = Verdict::ALL.iter().map(|v| symbol(*v)).collect();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), Verdict::ALL.len());
    }

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
        let text = "The process wrote what is no message, ended by signal -7, exit status 3, after 20.0 s.";
        assert_eq!(process_end(&end), text);
        end.seconds = 1e300;
        assert!(process_end(&end).len() < 120);
    }

    #[test]
    fn repetitions_are_counted_in_their_order() {
        use Verdict::{Fail, Pass};
        assert_eq!(
            repetitions(&[Pass, Fail, Fail, Pass]),
            "pass, 2 × fail, pass"
        );
        assert_eq!(repetitions(&[]), "");
    }

    #[test]
    fn settings_are_told_where_they_are_set() {
        assert!(settings(&Settings::default()).is_empty());
        let some = Settings {
            repeat: Some(3),
            validate: true,
            timeout: Some(20.0),
            ..Settings::default()
        };
        let texts = [
            "3 drawings of each case",
            "validation layers listened",
            "at most 20.0 s per case",
        ];
        assert_eq!(settings(&some), texts);
    }

    #[test]
    fn control_characters_do_not_pass() {
        assert_eq!(plain("a\u{1b}[2Jb\u{202e}", 9), "a\u{fffd}[2Jb\u{fffd}");
        assert_eq!(plain("aüb", 2), "aü…");
    }
}
