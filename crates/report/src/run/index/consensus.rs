//! The verdict that the adapters which drew a case agree on, and the adapters that differ.
//!
//! Every adapter that drew the case has a vote: *right* for Pass, Imprecise and Measured, *wrong* for every bad
//! verdict, whether it was expected or not, since an expectation changes nothing in what the driver does.
//! NotSupported, Skipped and a missing record do not vote: nothing was drawn. A selftest that is due to fail
//! has none either, since its judge sees another scene than its drivers.
//!
//! More than half of the votes are the consensus, and the adapters of the other side are odd. If both sides
//! have the same number of votes, no adapter is odd. A single vote makes no consensus.

use crate::run::grid::{CaseRow, RunGrid};
use crate::words;
use etalon_record::Verdict;
use std::cmp::Reverse;

/// The distribution of the votes on one case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Votes {
    /// No adapter voted.
    Nobody,
    /// There is one vote.
    Alone,
    /// All votes agree; there are at least two.
    Agree,
    /// One adapter disagrees with at least two others.
    Odd,
    /// At least two adapters are in the minority, or both sides have equally many votes.
    Split,
}

impl Votes {
    /// Returns the word in the page's data.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Nobody => "nobody",
            Self::Alone => "alone",
            Self::Agree => "agree",
            Self::Odd => "odd",
            Self::Split => "split",
        }
    }
}

/// The verdict that the adapters agree on.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Consensus {
    /// The distribution of the votes.
    pub(crate) votes: Votes,
    /// The columns of the smaller side; empty if both sides are equal.
    pub(crate) odd: Vec<usize>,
    /// The consensus in words.
    pub(crate) text: String,
}

impl Consensus {
    /// Returns the consensus on one case of a grid.
    pub(crate) fn of(grid: &RunGrid<'_>, case: &CaseRow<'_>) -> Self {
        let mut is_due = false;
        let mut votes = Vec::new();
        for (column, index) in case.records.iter().enumerate() {
            let Some(record) = index.map(|i| grid.record(i)) else {
                continue;
            };
            is_due |= record.due_fail;
            if !record.due_fail {
                votes.push((column, record.verdict));
            }
        }
        let mut result = Self::of_verdicts(&votes, &grid.adapters);
        if is_due && result.votes == Votes::Nobody {
            result.text = "due to fail".to_owned();
        }
        result
    }

    /// Returns the consensus of the verdicts by column. `names` are the names of all columns.
    fn of_verdicts(verdicts: &[(usize, Verdict)], names: &[&str]) -> Self {
        let voted = |v: Verdict| !matches!(v, Verdict::NotSupported | Verdict::Skipped);
        let votes = verdicts.iter().copied().filter(|(_, v)| voted(*v));
        let (wrong, right): (Vec<_>, Vec<_>) = votes.partition(|(_, v)| v.is_bad());
        let sizes = (right.len(), wrong.len());
        let (most, least) = if sizes.0 >= sizes.1 {
            (right, wrong)
        } else {
            (wrong, right)
        };
        let name = |column: usize| names.get(column).copied().unwrap_or_default();
        let (votes, text) = match (most.as_slice(), least.as_slice()) {
            ([], _) => (Votes::Nobody, "not drawn".to_owned()),
            ([(column, verdict)], []) => {
                let text = format!("only {} drew it: {}", name(*column), words::name(*verdict));
                (Votes::Alone, text)
            }
            (_, []) => (
                Votes::Agree,
                format!("all agree: {}", in_detail(&most, names)),
            ),
            ([_, _, ..], [(column, verdict)]) => {
                let (odd, verdict) = (name(*column), words::name(*verdict));
                let others = in_detail(&most, names);
                let mut text = format!("only {odd} differs: {verdict}");
                // Others that pass need no mention.
                if others != words::name(Verdict::Pass) {
                    text += &format!("; others {others}");
                }
                (Votes::Odd, text)
            }
            _ => {
                let side = match sizes.0.cmp(&sizes.1) {
                    std::cmp::Ordering::Equal => "",
                    std::cmp::Ordering::Greater => ", most are right",
                    std::cmp::Ordering::Less => ", most are wrong",
                };
                let text = format!("split {}:{}{side}", most.len(), least.len());
                (Votes::Split, text)
            }
        };
        let decided = most.len() > least.len();
        let odd = least.iter().filter(|_| decided).map(|(column, _)| *column);
        Self {
            votes,
            odd: odd.collect(),
            text,
        }
    }

    /// Returns the only adapter's column that differs from all others that drew the case.
    pub(crate) fn only(&self) -> Option<usize> {
        match (self.votes, self.odd.as_slice()) {
            (Votes::Odd, [column]) => Some(*column),
            _ => None,
        }
    }
}

/// Returns the verdict that most of one side have, then the others of that side: `pass; imprecise only on cpu`.
/// Of two verdicts that are as frequent the milder one goes first.
fn in_detail(side: &[(usize, Verdict)], names: &[&str]) -> String {
    let with = |v: Verdict| side.iter().filter(move |(_, other)| *other == v);
    let mut kinds: Vec<(usize, Verdict)> = Verdict::ALL
        .into_iter()
        .map(|v| (with(v).count(), v))
        .filter(|(n, _)| *n > 0)
        .collect();
    kinds.sort_by_key(|(n, v)| (Reverse(*n), v.severity()));
    let mut text = String::new();
    for (i, (n, verdict)) in kinds.into_iter().enumerate() {
        let word = words::name(verdict);
        match (i, n, with(verdict).next()) {
            (0, _, _) => text.push_str(word),
            (_, 1, Some((column, _))) => {
                let name = names.get(*column).copied().unwrap_or_default();
                text += &format!("; {word} only on {name}");
            }
            _ => text.push_str(&format!("; {n} {word}")),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use Verdict::{Crash, Fail, Imprecise, Measured, NotSupported, Open, Pass, Skipped};

    const NAMES: [&str; 9] = ["a", "b", "c", "d", "e", "f", "g", "h", "i"];

    fn of(verdicts: &[Verdict]) -> Consensus {
        let columns: Vec<_> = verdicts.iter().copied().enumerate().collect();
        Consensus::of_verdicts(&columns, &NAMES)
    }

    fn lies(verdicts: &[Verdict], votes: Votes, odd: &[usize], text: &str) {
        let found = of(verdicts);
        assert_eq!(
            (found.votes, found.odd.as_slice(), found.text.as_str()),
            (votes, odd, text),
            "{verdicts:?}"
        );
    }

    #[test]
    fn fewer_than_two_voters_make_no_consensus() {
        lies(&[], Votes::Nobody, &[], "not drawn");
        lies(&[NotSupported, Skipped], Votes::Nobody, &[], "not drawn");
        lies(
            &[NotSupported, Fail, Skipped],
            Votes::Alone,
            &[],
            "only b drew it: fail",
        );
    }

    #[test]
    fn right_verdicts_agree_and_exceptions_are_named() {
        lies(&[Pass, Pass], Votes::Agree, &[], "all agree: pass");
        let text = "all agree: pass; imprecise only on c";
        lies(&[Pass, Pass, Imprecise], Votes::Agree, &[], text);
        let text = "all agree: pass; 2 imprecise; measured only on a";
        let verdicts = [Measured, Imprecise, Pass, Pass, Imprecise, Pass];
        lies(&verdicts, Votes::Agree, &[], text);
    }

    #[test]
    fn wrong_verdicts_can_agree_too() {
        let text = "all agree: fail; crash only on b";
        lies(&[Fail, Crash, Fail], Votes::Agree, &[], text);
    }

    #[test]
    fn one_adapter_against_two_is_odd_and_one_against_one_is_not() {
        let text = "only c differs: fail";
        lies(&[Pass, Pass, Fail], Votes::Odd, &[2], text);
        let text = "only a differs: pass; others fail; open only on d";
        lies(&[Pass, Fail, Fail, Open], Votes::Odd, &[0], text);
        lies(&[Pass, Fail], Votes::Split, &[], "split 1:1");
        lies(&[Pass, NotSupported, Fail], Votes::Split, &[], "split 1:1");
    }

    #[test]
    fn several_adapters_against_more_are_a_split() {
        let mut verdicts = [Pass; 9];
        verdicts[6..].fill(Fail);
        let text = "split 6:3, most are right";
        lies(&verdicts, Votes::Split, &[6, 7, 8], text);
        let text = "split 3:2, most are wrong";
        lies(
            &[Fail, Crash, Open, Pass, Imprecise],
            Votes::Split,
            &[3, 4],
            text,
        );
        lies(&[Fail, Pass, Fail, Pass], Votes::Split, &[], "split 2:2");
    }

    #[test]
    fn only_one_adapter_can_be_alone() {
        assert_eq!(of(&[Pass, Pass, Fail]).only(), Some(2));
        assert_eq!(of(&[Pass, Fail]).only(), None);
        assert_eq!(of(&[Fail]).only(), None);
        assert_eq!(of(&[Pass, Pass, Pass, Fail, Fail]).only(), None);
    }
}
