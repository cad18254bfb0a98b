//! Scores of families over the runs of a timeline: over what all whole runs have, and over what each has.

use super::courses::Courses;
use super::families::Families;
use super::looks::Looks;
use super::places::Line;
use etalon_stats::{Class, Score};

/// The scores of a timeline.
pub(super) struct Scores {
    /// Good cases of what all whole runs have a verdict of: by family, then by run.
    common_good: Vec<Vec<i64>>,
    /// The number of these cases, by family.
    common_of: Vec<usize>,
    /// All of each run: by family, then by run.
    own: Vec<Vec<Score>>,
}

impl Scores {
    pub(super) fn new(families: usize, runs: usize) -> Self {
        Self {
            common_good: vec![vec![0; runs + 1]; families],
            common_of: vec![0; families],
            own: vec![vec![Score::default(); runs]; families],
        }
    }

    /// Counts a record.
    pub(super) fn take(&mut self, family: u32, run: usize, class: Class) {
        if class != Class::Missing {
            let score = &mut self.own[family as usize][run];
            score.of += 1;
            score.good += usize::from(class == Class::Good);
        }
    }

    /// Finds what all whole runs have, and counts it.
    pub(super) fn compare(
        &mut self,
        courses: &Courses,
        line: &Line<'_>,
        families: &Families,
        looks: &Looks,
    ) {
        let whole = |run: &u32| line.runs[*run as usize].whole;
        let runs = line.runs.len() as u32;
        let first = (0..runs).find(whole).unwrap_or(0);
        let last = (0..runs).rfind(whole).unwrap_or(0);
        for (course, family) in courses.of.iter().zip(&families.of) {
            let Some(course) = course else { continue };
            let holed = courses.holed.get(&course.gaps).copied().unwrap_or(false);
            let decided = |(from, end, look): (u32, u32, u32)| {
                looks.class(look) != Class::Missing || !(from..end).any(|run| whole(&run))
            };
            let is_common = !holed && course.first <= first && course.last >= last;
            if !is_common || !course.ended().all(decided) {
                continue;
            }
            let family = *family as usize;
            self.common_of[family] += 1;
            for (from, end, look) in course.ended() {
                if looks.class(look) == Class::Good {
                    self.common_good[family][from as usize] += 1;
                    self.common_good[family][end as usize] -= 1;
                }
            }
        }
        for good in &mut self.common_good {
            let mut sum = 0;
            for change in good {
                sum += *change;
                *change = sum;
            }
        }
    }

    /// The score of a family in a whole run over what all of them have.
    pub(super) fn common(&self, family: usize, run: usize) -> Score {
        Score {
            good: usize::try_from(self.common_good[family][run]).unwrap_or(0),
            of: self.common_of[family],
        }
    }

    /// The score of a family over all cases of a run.
    pub(super) fn own(&self, family: usize, run: usize) -> Score {
        self.own[family][run]
    }

    /// The sums over families.
    pub(super) fn sum(
        &self,
        families: impl Iterator<Item = usize>,
        run: usize,
    ) -> etalon_stats::Scores {
        let add = |to: &mut Score, score: Score| {
            to.good += score.good;
            to.of += score.of;
        };
        let mut sums = etalon_stats::Scores {
            common: Score::default(),
            own: Score::default(),
        };
        for family in families {
            add(&mut sums.common, self.common(family, run));
            add(&mut sums.own, self.own(family, run));
        }
        sums
    }
}
