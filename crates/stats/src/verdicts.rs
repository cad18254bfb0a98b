//! Verdicts over runs: what broke, what was fixed, and scores that do not move when the suite grows.

use std::collections::{BTreeMap, BTreeSet};

/// The meaning of a verdict for its case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Standing {
    /// The case is drawn correctly.
    Good,
    /// The case is drawn wrong, or the driver fails to draw it.
    Bad,
    /// The case is drawn correctly only some of the time.
    Flaky,
    /// The case is not drawn, or nothing is asserted.
    Unknown,
}

/// An event of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum VerdictEvent {
    /// The case is bad, and was good or flaky.
    Broken,
    /// The case is good, and was bad or flaky.
    Fixed,
    /// The case is flaky, or alternates between good and bad, and did not before.
    Flaky,
    /// The case is present, and was not in the previous runs.
    Appeared,
    /// The case is absent, and was in the previous run.
    Gone,
}

impl VerdictEvent {
    /// Returns the phrase that reports put before the run, such as `broken at`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Broken => "broken at",
            Self::Fixed => "fixed at",
            Self::Flaky => "flaky since",
            Self::Appeared => "appeared at",
            Self::Gone => "gone since",
        }
    }
}

/// An event, the run that shows it, and the previous run: the cause came between the two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Happening<K> {
    /// The kind of change that the verdicts show.
    pub event: VerdictEvent,
    /// The last run without the event.
    pub after: K,
    /// The first run that shows the event.
    pub at: K,
}

/// The number of changes between good and bad, at most [`NEAR`] runs apart, that make a case flaky.
const TURNS: usize = 4;
/// The maximum number of runs between such changes.
const NEAR: usize = 3;

/// Returns what happened to a case over runs, oldest first.
///
/// The first run is the beginning of a history and gives no event. A run that did not select the case, or did
/// not end, must be left out; `Unknown` says that a run of the whole suite has no verdict for it. When a case
/// appears again, its standing from before it was gone still counts.
///
/// A case that alternates four times between good and bad, with at most three runs in between, is flaky for
/// that time, although each run had a definite verdict.
pub fn happenings<K: Copy>(runs: &[(K, Standing)]) -> Vec<Happening<K>> {
    let standings = with_turns(runs);
    let mut found = Vec::new();
    let mut known = None;
    for (index, standing) in standings.iter().enumerate() {
        let before = index
            .checked_sub(1)
            .map(|before| (runs[before].0, standings[before]));
        if let Some((after, last)) = before {
            let mut tell = |event| {
                let run = runs[index].0;
                found.push(Happening {
                    event,
                    after,
                    at: run,
                });
            };
            match (last, standing) {
                (Standing::Unknown, Standing::Unknown) => {}
                (_, Standing::Unknown) => tell(VerdictEvent::Gone),
                (Standing::Unknown, _) => tell(VerdictEvent::Appeared),
                _ => {}
            }
            match standing {
                _ if known.is_none_or(|known| known == *standing) => {}
                Standing::Good => tell(VerdictEvent::Fixed),
                Standing::Bad => tell(VerdictEvent::Broken),
                Standing::Flaky => tell(VerdictEvent::Flaky),
                Standing::Unknown => {}
            }
        }
        if *standing != Standing::Unknown {
            known = Some(*standing);
        }
    }
    found
}

/// Returns the standings, with `Flaky` in place of stretches that alternate between good and bad.
fn with_turns<K: Copy>(runs: &[(K, Standing)]) -> Vec<Standing> {
    let mut standings: Vec<Standing> = runs.iter().map(|(_, standing)| *standing).collect();
    let sure: Vec<usize> = (0..standings.len())
        .filter(|i| matches!(standings[*i], Standing::Good | Standing::Bad))
        .collect();
    let turns: Vec<usize> = sure
        .windows(2)
        .filter(|w| standings[w[0]] != standings[w[1]])
        .map(|w| w[1])
        .collect();
    for group in turns.chunk_by(|a, b| b - a <= NEAR) {
        if let ([first, .., last], true) = (group, group.len() >= TURNS) {
            // The last change begins the following state.
            for standing in standings[*first..*last]
                .iter_mut()
                .filter(|c| **c != Standing::Unknown)
            {
                *standing = Standing::Flaky;
            }
        }
    }
    standings
}

/// The number of good cases in a set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Score {
    /// The number of cases whose standing is good; at most `of`.
    pub good: usize,
    /// Cases about which something is known.
    pub of: usize,
}

impl Score {
    fn over<'a>(standings: impl Iterator<Item = &'a Standing>) -> Self {
        let mut score = Self::default();
        for standing in standings.filter(|standing| **standing != Standing::Unknown) {
            score.of += 1;
            score.good += usize::from(*standing == Standing::Good);
        }
        score
    }

    /// Returns the share of good cases, 0 to 1; `None` if there are no cases.
    pub fn share(self) -> Option<f64> {
        (self.of > 0).then(|| self.good as f64 / self.of as f64)
    }
}

/// The score of one run of a history.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunScore {
    /// The score over the cases that all runs have, which only the driver can change.
    pub common: Score,
    /// The score over all cases of the run, which also changes when cases appear or disappear.
    pub own: Score,
}

/// Returns the scores of runs, over the cases that they share and over the cases of each.
pub fn scores<K: Ord + Copy>(runs: &[BTreeMap<K, Standing>]) -> Vec<RunScore> {
    let there = |run: &BTreeMap<K, Standing>| -> BTreeSet<K> {
        let cases = run
            .iter()
            .filter(|(_, standing)| **standing != Standing::Unknown);
        cases.map(|(case, _)| *case).collect()
    };
    let common = runs.iter().map(there).reduce(|common, run| &common & &run);
    let common = common.unwrap_or_default();
    let score = |run: &BTreeMap<K, Standing>| RunScore {
        common: Score::over(
            run.iter()
                .filter(|(case, _)| common.contains(case))
                .map(|(_, c)| c),
        ),
        own: Score::over(run.values()),
    };
    runs.iter().map(score).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use VerdictEvent::{Appeared, Broken, Fixed, Flaky, Gone};

    /// Returns the events of a history written in letters: good, bad, flaky, missing.
    fn events(text: &str) -> Vec<(VerdictEvent, usize)> {
        let standing = |letter| match letter {
            'g' => Standing::Good,
            'b' => Standing::Bad,
            'f' => Standing::Flaky,
            _ => Standing::Unknown,
        };
        let runs: Vec<(usize, Standing)> = text.chars().map(standing).enumerate().collect();
        let found = happenings(&runs);
        assert!(
            found.iter().all(|h| h.after + 1 == h.at),
            "{text}: {found:?}"
        );
        found.into_iter().map(|h| (h.event, h.at)).collect()
    }

    #[test]
    fn each_event_is_reported_once_at_the_run_that_shows_it() {
        assert_eq!(events(""), []);
        assert_eq!(events("ggggg"), []);
        assert_eq!(events("bbb"), []);
        assert_eq!(events("ggbbb"), [(Broken, 2)]);
        assert_eq!(events("bbg"), [(Fixed, 2)]);
        assert_eq!(events("gbbbbbg"), [(Broken, 1), (Fixed, 6)]);
        assert_eq!(events("gffg"), [(Flaky, 1), (Fixed, 3)]);
        assert_eq!(events("gfb"), [(Flaky, 1), (Broken, 2)]);
        assert_eq!(events("..gg.."), [(Appeared, 2), (Gone, 4)]);
    }

    #[test]
    fn a_case_that_returns_is_compared_with_its_last_verdict() {
        assert_eq!(events("g.g"), [(Gone, 1), (Appeared, 2)]);
        assert_eq!(events("g..b"), [(Gone, 1), (Appeared, 3), (Broken, 3)]);
        assert_eq!(events(".b"), [(Appeared, 1)]);
    }

    #[test]
    fn alternating_good_and_bad_is_flaky() {
        assert_eq!(events("gggbgbgbbbbb"), [(Flaky, 3), (Broken, 7)]);
        assert_eq!(events("ggbbggbbgggggg"), [(Flaky, 2), (Fixed, 8)]);
        assert_eq!(
            events("gb.gb.g"),
            [
                (Flaky, 1),
                (Gone, 2),
                (Appeared, 3),
                (Gone, 5),
                (Appeared, 6),
                (Fixed, 6)
            ]
        );
        // Three changes, or changes far apart, are separate breaks and fixes.
        assert_eq!(events("gbgb"), [(Broken, 1), (Fixed, 2), (Broken, 3)]);
        assert_eq!(events("gbbbbggggbbbbgggg").len(), 4);
    }

    #[test]
    fn scores_of_common_cases_do_not_change_with_the_suite() {
        let run =
            |cases: &[(u8, Standing)]| cases.iter().copied().collect::<BTreeMap<u8, Standing>>();
        let before = run(&[(1, Standing::Good), (2, Standing::Good), (3, Standing::Bad)]);
        let after = run(&[
            (1, Standing::Good),
            (2, Standing::Good),
            (4, Standing::Bad),
            (5, Standing::Bad),
            (6, Standing::Unknown),
        ]);
        let [b, a] = scores(&[before, after])[..] else {
            panic!("two runs")
        };
        assert_eq!(b.common, Score { good: 2, of: 2 });
        assert_eq!(a.common, b.common);
        assert_eq!(
            (b.own, a.own),
            (Score { good: 2, of: 3 }, Score { good: 2, of: 4 })
        );
        assert_eq!(a.own.share(), Some(0.5));
        assert_eq!(Score::default().share(), None);
        assert!(scores::<u8>(&[]).is_empty());
    }
}
