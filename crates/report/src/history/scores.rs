//! Scores of families over the runs of a timeline: over the cases that all complete runs have, and over all
//! cases of each run.

use super::courses::Courses;
use super::families::Families;
use super::looks::Looks;
use super::places::Line;
use etalon_stats::{Score, Standing};

/// The scores of a timeline, by family, then by run.
pub(super) struct Scores {
    /// Scores over the cases with a verdict in all complete runs.
    common: Vec<Vec<Score>>,
    /// Scores over all cases of each run.
    own: Vec<Vec<Score>>,
}

impl Scores {
    pub(super) fn new(families: usize, runs: usize) -> Self {
        let none = vec![vec![Score::default(); runs]; families];
        Self {
            common: none.clone(),
            own: none,
        }
    }

    /// Counts a record.
    pub(super) fn take(&mut self, family: u32, run: usize, standing: Standing) {
        count(&mut self.own[family as usize][run], standing);
    }

    /// Counts the cases that all complete runs have.
    pub(super) fn compare(
        &mut self,
        courses: &Courses,
        line: &Line<'_>,
        families: &Families,
        looks: &Looks,
    ) {
        let is_complete = |run: u32| line.runs[run as usize].whole;
        for (course, family) in courses.of.iter().zip(&families.of) {
            let Some(course) = course.as_ref().filter(|course| course.is_common) else {
                continue;
            };
            let decided = |(from, end, look): (u32, u32, u32)| {
                looks.standing(look) != Standing::Unknown || !(from..end).any(is_complete)
            };
            if course.ended().all(decided) {
                for (from, end, look) in course.ended() {
                    let runs = from as usize..end as usize;
                    for score in &mut self.common[*family as usize][runs] {
                        count(score, looks.standing(look));
                    }
                }
            }
        }
    }

    /// Returns the score of a family in a run over the cases that all complete runs have.
    pub(super) fn common(&self, family: usize, run: usize) -> Score {
        self.common[family][run]
    }

    /// Returns the sums over families.
    pub(super) fn sum(
        &self,
        families: impl Iterator<Item = usize>,
        run: usize,
    ) -> etalon_stats::RunScore {
        let mut sums = [Score::default(); 2];
        for family in families {
            let scores = [self.common[family][run], self.own[family][run]];
            for (sum, score) in sums.iter_mut().zip(scores) {
                sum.good += score.good;
                sum.of += score.of;
            }
        }
        let [common, own] = sums;
        etalon_stats::RunScore { common, own }
    }
}

fn count(score: &mut Score, standing: Standing) {
    score.of += usize::from(standing != Standing::Unknown);
    score.good += usize::from(standing == Standing::Good);
}
