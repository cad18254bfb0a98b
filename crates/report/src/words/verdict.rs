//! Verdicts in words and signs.

use etalon_record::{Record, Verdict};

/// The tone in which a record's verdict is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Tone {
    /// The verdict as it is.
    Plain,
    /// Bad, but expected.
    Excused,
    /// A selftest that failed, as it is due to.
    Due,
    /// A selftest that was due to fail and did not.
    Missed,
}

impl Tone {
    pub(crate) fn of(record: &Record) -> Self {
        let due = record.due_fail && record.expected.is_none();
        Self::new(record.verdict, due, record.unexpected())
    }

    pub(crate) fn new(verdict: Verdict, due_fail: bool, unexpected: bool) -> Self {
        match (verdict.is_bad(), unexpected) {
            (true, false) if due_fail => Self::Due,
            (true, false) => Self::Excused,
            (false, true) if due_fail => Self::Missed,
            _ => Self::Plain,
        }
    }

    /// Returns true if the verdict says that the driver, or the selftest, does what it should.
    pub(crate) fn is_right(self, verdict: Verdict) -> bool {
        let good = matches!(
            verdict,
            Verdict::Pass | Verdict::Imprecise | Verdict::Measured
        );
        self == Self::Due || self == Self::Plain && good
    }

    /// Returns the suffix of the verdict in reports.
    pub(crate) fn suffix(self) -> &'static str {
        match self {
            Self::Plain => "",
            Self::Excused => " (expected)",
            Self::Due => " (due)",
            Self::Missed => " (due to fail)",
        }
    }
}

/// Returns a sign that distinguishes verdicts without colour, and the classes that colour it as a plain
/// verdict and as an expected one. The classes are fixed letters that never come from a record. The variation
/// selector keeps browsers from drawing a coloured picture.
pub(crate) fn signs(verdict: Verdict) -> (&'static str, [&'static str; 2]) {
    match verdict {
        Verdict::Pass => ("✓", ["p", "b x"]),
        Verdict::Imprecise => ("≈", ["i", "b x"]),
        Verdict::Fail => ("✗", ["f", "f x"]),
        Verdict::RequiredByCts => ("⊠", ["r", "r x"]),
        Verdict::Disputed => ("?", ["q", "q x"]),
        Verdict::Blocked => ("⊗", ["k", "k x"]),
        Verdict::Open => ("○", ["o", "o x"]),
        Verdict::Measured => ("◇", ["n", "b x"]),
        Verdict::NotSupported => ("–", ["u", "b x"]),
        Verdict::Skipped => ("↷", ["u", "b x"]),
        Verdict::Flaky => ("⇄", ["b", "b x"]),
        Verdict::Crash => ("⚡\u{fe0e}", ["b", "b x"]),
        Verdict::Timeout => ("◷", ["b", "b x"]),
        Verdict::DeviceLost => ("⊘", ["b", "b x"]),
        Verdict::ResourceError => ("□", ["b", "b x"]),
        Verdict::InternalError => ("!", ["b", "b x"]),
    }
}

/// Returns the sign of a verdict.
pub(crate) fn symbol(verdict: Verdict) -> &'static str {
    signs(verdict).0
}

/// Returns the verdict's name with spaces.
pub(crate) fn name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::RequiredByCts => "required by CTS",
        Verdict::NotSupported => "not supported",
        Verdict::DeviceLost => "device lost",
        Verdict::ResourceError => "resource error",
        Verdict::InternalError => "internal error",
        other => other.name(),
    }
}

/// Returns the meaning of a verdict in one sentence.
pub(crate) fn meaning(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "Every texel lies inside the yardstick, and something was asserted.",
        Verdict::Imprecise => "Every texel is legal; some lie outside the yardstick.",
        Verdict::Fail => "A texel lies outside what the API's text allows.",
        Verdict::RequiredByCts => "The text is open, but a Khronos mustpass case forbids a texel.",
        Verdict::Disputed => "Only a contested reading of the text forbids a texel.",
        Verdict::Blocked => "Not drawn: a case that it depends on failed.",
        Verdict::Open => "Nothing could be asserted.",
        Verdict::Measured => "Measured, not judged.",
        Verdict::NotSupported => "The adapter lacks something that the scene needs.",
        Verdict::Skipped => "The expectations or a time limit skip the case on this adapter.",
        Verdict::Flaky => "The same case gave different frames.",
        Verdict::Crash => "The process that drew the case died.",
        Verdict::Timeout => "The case exceeded its time limit.",
        Verdict::DeviceLost => "The API reported the device lost.",
        Verdict::ResourceError => "The driver refused an allocation or an object.",
        Verdict::InternalError => "The suite itself failed, not the driver.",
    }
}

/// Returns the verdicts of a record's repetitions: `pass, 2 × fail`.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_of_verdicts_differ() {
        let mut symbols: Vec<_> = Verdict::ALL.iter().map(|v| symbol(*v)).collect();
        symbols.sort_unstable();
        symbols.dedup();
        assert_eq!(symbols.len(), Verdict::ALL.len());
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
}
