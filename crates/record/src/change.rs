//! The meaning of the step from one verdict to another.

use crate::verdict::Verdict;
use etalon_stats::Standing;

/// The parts of a record that decide what a change means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CaseResult {
    /// The verdict before expectations are applied.
    pub verdict: Verdict,
    /// True if the case is a selftest that must fail.
    pub due_fail: bool,
    /// True if an expectation names the verdict.
    pub expected: bool,
}

impl CaseResult {
    /// Returns true if the outcome counts against its run: a bad verdict that no expectation names, or a
    /// selftest that had to fail and did not.
    pub fn unexpected(self) -> bool {
        let undrawn = matches!(self.verdict, Verdict::NotSupported | Verdict::Skipped);
        let counts = if self.due_fail {
            !undrawn && !self.verdict.is_violation()
        } else {
            self.verdict.is_bad()
        };
        counts && !self.expected
    }
}

/// The meaning of a step from one outcome of a case to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Change {
    /// The second outcome is worse.
    Worse,
    /// The second outcome is better.
    Better,
    /// The outcomes differ, and neither is worse.
    Other,
    /// The outcomes are the same.
    Same,
}

impl Change {
    /// Returns the meaning of the step between two outcomes of a case.
    ///
    /// | from | to | change |
    /// |---|---|---|
    /// | not unexpected | unexpected | worse |
    /// | right | wrong, or nothing known | worse |
    /// | wrong | right | better |
    /// | wrong | more or less wrong | worse or better |
    /// | flaky | wrong | worse |
    /// | drawn, not right | blocked | worse |
    /// | open | wrong | worse |
    /// | not drawn | right | better |
    ///
    /// All else is other: in particular, a step into *nothing known* is never better. Nothing is known about
    /// an open, unsupported, blocked or skipped case, or after an error of the suite. Skipping is intended,
    /// so a step from or to it is other. A selftest that is due to fail is right if it fails. The verdicts
    /// by how wrong they are: disputed, required by the CTS, fail, resource error, and last timeout, crash
    /// and lost device, which no picture came back from.
    pub fn between(before: impl Into<CaseResult>, after: impl Into<CaseResult>) -> Self {
        use Standing::{Bad, Flaky, Good, Unknown};
        let (before, after): (CaseResult, CaseResult) = (before.into(), after.into());
        if before == after {
            return Self::Same;
        }
        if after.unexpected() && !before.unexpected() {
            return Self::Worse;
        }
        if before.verdict == Verdict::Skipped || after.verdict == Verdict::Skipped {
            return Self::Other;
        }
        let drawn = !matches!(
            before.verdict,
            Verdict::NotSupported | Verdict::Blocked | Verdict::InternalError
        );
        let standings = [before, after].map(|o| o.verdict.standing(o.due_fail));
        match standings {
            [Good, Good] => Self::Other,
            [Good, _] => Self::Worse,
            [_, Good] => Self::Better,
            [_, Unknown] if drawn && after.verdict == Verdict::Blocked => Self::Worse,
            [_, Unknown] => Self::Other,
            [Unknown, Bad | Flaky] if drawn => Self::Worse,
            [Unknown, Bad | Flaky] => Self::Other,
            [Flaky, Bad] => Self::Worse,
            // A flaky record can hide a crash.
            [Bad | Flaky, Flaky] => Self::Other,
            [Bad, Bad] => match wrongness(before).cmp(&wrongness(after)) {
                std::cmp::Ordering::Less => Self::Worse,
                std::cmp::Ordering::Greater => Self::Better,
                std::cmp::Ordering::Equal => Self::Other,
            },
        }
    }
}

/// Returns how wrong a bad outcome is; larger is worse.
fn wrongness(outcome: CaseResult) -> u8 {
    match outcome.verdict {
        Verdict::Disputed => 1,
        Verdict::RequiredByCts => 2,
        Verdict::ResourceError => 4,
        Verdict::Timeout | Verdict::Crash | Verdict::DeviceLost => 5,
        // A selftest whose fault was missed is as grave as a failure.
        _ => 3,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows are the verdict before, columns the verdict after, both in this order.
    const ORDER: [(&str, Verdict); 16] = [
        ("pass", Verdict::Pass),
        ("imprecise", Verdict::Imprecise),
        ("measured", Verdict::Measured),
        ("skipped", Verdict::Skipped),
        ("not-supported", Verdict::NotSupported),
        ("blocked", Verdict::Blocked),
        ("open", Verdict::Open),
        ("internal-error", Verdict::InternalError),
        ("flaky", Verdict::Flaky),
        ("disputed", Verdict::Disputed),
        ("required-by-cts", Verdict::RequiredByCts),
        ("fail", Verdict::Fail),
        ("resource-error", Verdict::ResourceError),
        ("timeout", Verdict::Timeout),
        ("crash", Verdict::Crash),
        ("device-lost", Verdict::DeviceLost),
    ];

    /// Every bad verdict is expected, before and after, so only verdicts decide. `w` is worse, `b` better,
    /// `.` other, `=` the same.
    const EXPECTED: &str = "
        pass            = . . . w w w w w w w w w w w w
        imprecise       . = . . w w w w w w w w w w w w
        measured        . . = . w w w w w w w w w w w w
        skipped         . . . = . . . . . . . . . . . .
        not-supported   b b b . = . . . . . . . . . . .
        blocked         b b b . . = . . . . . . . . . .
        open            b b b . . w = . w w w w w w w w
        internal-error  b b b . . . . = . . . . . . . .
        flaky           b b b . . w . . = w w w w w w w
        disputed        b b b . . w . . . = w w w w w w
        required-by-cts b b b . . w . . . b = w w w w w
        fail            b b b . . w . . . b b = w w w w
        resource-error  b b b . . w . . . b b b = w w w
        timeout         b b b . . w . . . b b b b = . .
        crash           b b b . . w . . . b b b b . = .
        device-lost     b b b . . w . . . b b b b . . =
    ";

    /// Nothing is expected, so a step from a verdict that does not count to one that does is worse.
    const UNEXPECTED: &str = "
        pass            = . . . w w w w w w w w w w w w
        imprecise       . = . . w w w w w w w w w w w w
        measured        . . = . w w w w w w w w w w w w
        skipped         . . . = . w w w w w w w w w w w
        not-supported   b b b . = w w w w w w w w w w w
        blocked         b b b . . = . . . . . . . . . .
        open            b b b . . w = . w w w w w w w w
        internal-error  b b b . . . . = . . . . . . . .
        flaky           b b b . . w . . = w w w w w w w
        disputed        b b b . . w . . . = w w w w w w
        required-by-cts b b b . . w . . . b = w w w w w
        fail            b b b . . w . . . b b = w w w w
        resource-error  b b b . . w . . . b b b = w w w
        timeout         b b b . . w . . . b b b b = . .
        crash           b b b . . w . . . b b b b . = .
        device-lost     b b b . . w . . . b b b b . . =
    ";

    /// A selftest that is due to fail: a violation is right, and a right picture is wrong.
    const SELFTEST: &str = "
        pass            = . . . . w . . . b b b w w w w
        imprecise       . = . . . w . . . b b b w w w w
        measured        . . = . . w . . . b b b w w w w
        skipped         w w w = . w w w w . . . w w w w
        not-supported   w w w . = w w w w b b b w w w w
        blocked         . . . . . = . . . b b b . . . .
        open            w w w . . w = . w b b b w w w w
        internal-error  . . . . . . . = . b b b . . . .
        flaky           w w w . . w . . = b b b w w w w
        disputed        w w w . w w w w w = . . w w w w
        required-by-cts w w w . w w w w w . = . w w w w
        fail            w w w . w w w w w . . = w w w w
        resource-error  b b b . . w . . . b b b = w w w
        timeout         b b b . . w . . . b b b b = . .
        crash           b b b . . w . . . b b b b . = .
        device-lost     b b b . . w . . . b b b b . . =
    ";

    fn result(verdict: Verdict, due_fail: bool, expected: bool) -> CaseResult {
        CaseResult {
            verdict,
            due_fail,
            expected,
        }
    }

    fn every() -> impl Iterator<Item = CaseResult> {
        let flags = [(false, false), (false, true), (true, false), (true, true)];
        Verdict::ALL
            .into_iter()
            .flat_map(move |v| flags.map(|(due_fail, expected)| result(v, due_fail, expected)))
    }

    fn check(table: &str, result: impl Fn(Verdict) -> CaseResult) {
        let rows: Vec<Vec<&str>> = table
            .trim()
            .lines()
            .map(|line| line.split_whitespace().collect())
            .collect();
        assert_eq!(rows.len(), ORDER.len());
        for (row, (name, before)) in rows.iter().zip(ORDER) {
            assert_eq!(row[0], name);
            assert_eq!(row.len(), ORDER.len() + 1, "{name}");
            for (cell, (_, after)) in row[1..].iter().zip(ORDER) {
                let change = match Change::between(result(before), result(after)) {
                    Change::Worse => "w",
                    Change::Better => "b",
                    Change::Other => ".",
                    Change::Same => "=",
                };
                assert_eq!(change, *cell, "{before} to {after}");
            }
        }
    }

    #[test]
    fn every_pair_of_verdicts_has_a_meaning() {
        assert!(
            Verdict::ALL
                .iter()
                .all(|v| ORDER.iter().any(|(_, o)| o == v))
        );
        check(EXPECTED, |v| result(v, false, v.is_bad()));
        check(UNEXPECTED, |v| result(v, false, false));
        check(SELFTEST, |v| result(v, true, false));
    }

    #[test]
    fn a_crash_is_worse_than_a_failure() {
        let plain = |v| result(v, false, false);
        let expected = |v| result(v, false, true);
        for lost in [Verdict::Crash, Verdict::Timeout, Verdict::DeviceLost] {
            for of in [plain, expected] {
                assert_eq!(Change::between(of(Verdict::Fail), of(lost)), Change::Worse);
                assert_eq!(Change::between(of(lost), of(Verdict::Fail)), Change::Better);
            }
            // The failure that replaces an expected crash is news.
            let change = Change::between(expected(lost), plain(Verdict::Fail));
            assert_eq!(change, Change::Worse);
        }
    }

    #[test]
    fn a_step_into_nothing_known_is_never_better() {
        let unknown = |o: &CaseResult| o.verdict.standing(o.due_fail) == Standing::Unknown;
        for before in every() {
            for after in every().filter(unknown) {
                let change = Change::between(before, after);
                assert_ne!(change, Change::Better, "{before:?} {after:?}");
            }
        }
    }

    #[test]
    fn a_result_that_becomes_unexpected_is_worse_and_never_better() {
        for before in every() {
            assert_eq!(Change::between(before, before), Change::Same);
            for after in every() {
                let ways = [
                    Change::between(before, after),
                    Change::between(after, before),
                ];
                assert_ne!(ways, [Change::Better; 2], "{before:?} {after:?}");
                if after.unexpected() && !before.unexpected() {
                    assert_eq!(ways[0], Change::Worse, "{before:?} {after:?}");
                }
            }
        }
    }
}
