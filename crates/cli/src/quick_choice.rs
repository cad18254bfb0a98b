//! The choice of the quick profile: few of its candidates, with the power of all.

use crate::named_files::REDUNDANT_HEAD;
use etalon_backend::CallFault;
use etalon_case::{Case, CaseFile, Library, Profile};
use etalon_explore::FactPairs;
use etalon_frame::CaseId;
use etalon_glob::Glob;
use etalon_record::Expectations;
use etalon_runner::Hunted;
use std::cmp::Reverse;
use std::collections::{BTreeSet, HashMap};
use std::fmt::Write as _;

/// The number of cases that must catch each bug, or all that do: the further ones guard against bugs that are nearly the
/// planted one. With more, and with fewer, quick catches fewer bugs that it was not told.
const CATCHES: u32 = 4;
/// The number of parts of the bugs. In turn, the choice is not told one of them.
const PARTS: usize = 3;
/// The number of cases of the quick profile, unless it must keep more.
const QUICK: usize = 1800;

/// What candidates have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Power<'a> {
    /// A planted bug that the case catches.
    Bug(usize),
    /// Two facts that meet in a draw.
    Pair(usize, usize),
    /// A finding. The case is its shortest one.
    Finding(usize),
    /// What a faulty call breaks, shown by this very case: not every driver draws each case.
    Call(usize),
    /// A file.
    File(&'a str),
    /// The values of two axes of a file whose candidates are a covering array.
    Values(&'a str, [(&'a str, &'a str); 2]),
    /// The value of an axis of an area, which quick keeps while it has room.
    AreaValue(&'a str, (&'a str, &'a str)),
    /// The value of an axis of a file, which it keeps while it still has room.
    FileValue(&'a str, (&'a str, &'a str)),
}

impl Power<'_> {
    /// Returns the round of the choice in which the power counts. Only those of the first must be kept.
    fn round(&self) -> usize {
        match self {
            Self::AreaValue(..) => 1,
            Self::FileValue(..) => 2,
            _ => 0,
        }
    }
}

/// The candidates that quick keeps.
pub(crate) struct QuickChoice {
    /// For each candidate, true if quick has it.
    pub(crate) is_kept: Vec<bool>,
    /// Of the bugs that the choice was not told: how many a candidate catches, and how many a kept one does. Each third
    /// of the bugs is left out once.
    held_out: [usize; 2],
}

impl QuickChoice {
    /// Chooses by a hunt that drew every candidate with every bug.
    pub(crate) fn new(
        library: &Library,
        cases: &[Case],
        hunted: &Hunted,
        findings: &Expectations,
    ) -> Self {
        let powers = powers(library, cases, hunted, findings);
        let others = library.files().filter(|file| !file.is_measured());
        let candidates = others.flat_map(|file| file.cases(Profile::Candidates));
        let most = (QUICK + cases.len()).saturating_sub(candidates.count());
        let mut held_out = [0, 0];
        for part in 0..PARTS {
            let is_held = |power: &Power<'_>| matches!(power, Power::Bug(n) if n % PARTS == part);
            let told: Vec<Vec<Power<'_>>> = powers
                .iter()
                .map(|powers| powers.iter().copied().filter(|p| !is_held(p)).collect())
                .collect();
            let kept = choose(&told, most);
            for bug in (part..hunted.records.len()).step_by(PARTS) {
                let catches = |n: &usize| hunted.catches[*n].bugs.contains(&bug);
                let catching: Vec<usize> = (0..cases.len()).filter(catches).collect();
                held_out[0] += usize::from(!catching.is_empty());
                held_out[1] += usize::from(catching.iter().any(|n| kept[*n]));
            }
        }
        Self {
            is_kept: choose(&powers, most),
            held_out,
        }
    }

    /// Returns the file with the candidates that quick leaves out.
    pub(crate) fn redundant(&self, cases: &[Case]) -> String {
        let [caught, kept] = self.held_out;
        let left_out = cases.iter().zip(&self.is_kept).filter(|(_, kept)| !**kept);
        let ids: Vec<&str> = left_out.map(|(case, _)| case.id.as_str()).collect();
        let mut text = format!(
            "{REDUNDANT_HEAD}# Written by: etalon mutants --full --redundant cases/redundant.txt --order cases/order.txt\n\
             # Of {} candidates {} are left out. Chosen without a third of the planted bugs, each third in turn, quick\n\
             # catches {kept} of the {caught} held-out bugs that the candidates catch.\n",
            cases.len(),
            ids.len(),
        );
        for id in ids {
            let _ = writeln!(text, "{id}");
        }
        text
    }
}

/// Returns what each case has.
fn powers<'a>(
    library: &Library,
    cases: &'a [Case],
    hunted: &Hunted,
    findings: &Expectations,
) -> Vec<Vec<Power<'a>>> {
    let pairs = FactPairs::default();
    let files = |which: fn(&CaseFile) -> bool| -> BTreeSet<&str> {
        let files = library.files().filter(|file| which(file));
        files.map(CaseFile::stem).collect()
    };
    // Another seed has other pairs.
    let (random, covering) = (files(CaseFile::is_random), files(CaseFile::is_covering));
    let mut powers: Vec<Vec<Power<'a>>> = Vec::with_capacity(cases.len());
    let calls: Vec<Glob> = CallFault::ALL
        .iter()
        .filter_map(|fault| Glob::new(fault.cases()).ok())
        .collect();
    for (n, (case, catches)) in cases.iter().zip(&hunted.catches).enumerate() {
        let mut own: Vec<Power<'a>> = catches.bugs.iter().copied().map(Power::Bug).collect();
        if calls.iter().any(|glob| glob.is_match(&case.id)) {
            own.push(Power::Call(n));
        }
        let id: CaseId<'a> = case.parts();
        let axes: Vec<(&str, &str)> = id.axes().collect();
        own.push(Power::File(id.file()));
        own.extend(axes.iter().flat_map(|value| {
            [
                Power::AreaValue(id.area(), *value),
                Power::FileValue(id.file(), *value),
            ]
        }));
        if covering.contains(id.file()) {
            let pairs = axes.iter().enumerate().flat_map(|(place, value)| {
                axes[..place]
                    .iter()
                    .map(|other| Power::Values(id.file(), [*other, *value]))
            });
            own.extend(pairs);
        }
        if !random.contains(id.file()) {
            let variants = case.variants.iter().map(|variant| &variant.scene);
            let met = variants
                .chain([&case.scene])
                .flat_map(|scene| pairs.met_in(scene));
            own.extend(met.map(|(greater, lesser)| Power::Pair(greater, lesser)));
        }
        powers.push(own);
    }
    for finding in 0..findings.all().len() {
        let shows = |n: &usize| findings.names(finding, &cases[*n].id);
        let length = |n: &usize| {
            let draws = cases[*n].scene.passes.iter().map(|pass| pass.draws.len());
            (draws.sum::<usize>(), &cases[*n].id)
        };
        let shortest = (0..cases.len()).filter(shows).min_by_key(length);
        if let Some(shortest) = shortest {
            powers[shortest].push(Power::Finding(finding));
        }
    }
    powers
}

/// Chooses cases that together have everything but values of axes: first the case with the most that is still missing,
/// then the next. Cases go that later ones have made superfluous, and up to `most` come by the values that they add.
fn choose(powers: &[Vec<Power<'_>>], most: usize) -> Vec<bool> {
    let mut counts: HashMap<Power<'_>, u32> = HashMap::new();
    for power in powers.iter().flatten() {
        *counts.entry(*power).or_default() += 1;
    }
    let needed = |power: &Power<'_>| match power {
        Power::Bug(_) => counts[power].min(CATCHES),
        _ => 1,
    };
    let mut kept = Kept {
        powers,
        has: HashMap::new(),
        cases: vec![false; powers.len()],
    };
    let mut order = Vec::new();
    while let Some(best) = kept.best(|power, has| power.round() == 0 && has < needed(power)) {
        kept.add(best);
        order.push(best);
    }
    for case in order {
        let is_spare = |power: &Power<'_>| power.round() > 0 || kept.has[power] > needed(power);
        if powers[case].iter().all(is_spare) {
            kept.remove(case);
        }
    }
    let mut room = most.saturating_sub(kept.cases.iter().filter(|kept| **kept).count());
    for round in [1, 2] {
        while room > 0
            && let Some(best) = kept.best(|power, has| power.round() == round && has == 0)
        {
            kept.add(best);
            room -= 1;
        }
    }
    kept.cases
}

/// Cases that are kept, and how many of them have each power.
struct Kept<'a, 'p> {
    powers: &'a [Vec<Power<'p>>],
    has: HashMap<Power<'p>, u32>,
    cases: Vec<bool>,
}

impl<'p> Kept<'_, 'p> {
    /// Returns the first of the cases that add the most powers that are wanted, given how many have them.
    fn best(&self, is_wanted: impl Fn(&Power<'p>, u32) -> bool) -> Option<usize> {
        let has = |power: &Power<'p>| self.has.get(power).copied().unwrap_or(0);
        let gain = |n: &usize| {
            self.powers[*n]
                .iter()
                .filter(|p| is_wanted(p, has(p)))
                .count()
        };
        let left = (0..self.powers.len()).filter(|n| !self.cases[*n]);
        let (gain, Reverse(best)) = left.map(|n| (gain(&n), Reverse(n))).max()?;
        (gain > 0).then_some(best)
    }

    fn add(&mut self, case: usize) {
        self.cases[case] = true;
        for power in &self.powers[case] {
            *self.has.entry(*power).or_default() += 1;
        }
    }

    fn remove(&mut self, case: usize) {
        self.cases[case] = false;
        for power in &self.powers[case] {
            self.has.entry(*power).and_modify(|n| *n -= 1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_cases_have_everything_and_each_bug_is_caught_often_if_it_can_be() {
        let file = Power::File;
        let mut powers = vec![vec![Power::Bug(0)]; 6];
        powers.push(vec![Power::Bug(0), Power::Bug(1), file("a"), file("b")]);
        powers.push(vec![Power::Pair(2, 1), file("b")]);
        powers.push(vec![Power::Bug(2), Power::Pair(2, 1)]);
        powers.push(vec![]);
        let kept = [
            true, true, true, false, false, false, true, false, true, false,
        ];
        assert_eq!(choose(&powers, 0), kept);
    }

    #[test]
    fn a_case_goes_whose_part_later_ones_have_together() {
        let files = ["a", "b", "c", "d", "e", "f"].map(Power::File);
        let powers = [&files[1..5], &files[..3], &files[3..]].map(<[_]>::to_vec);
        assert_eq!(choose(&powers, 0), [false, true, true]);
    }

    #[test]
    fn values_come_while_there_is_room() {
        let value = |name| Power::FileValue("file", ("axis", name));
        let powers = [
            vec![Power::File("file"), value("a")],
            vec![value("a"), value("b")],
            vec![value("b"), value("c"), value("d")],
            vec![value("d")],
        ];
        assert_eq!(choose(&powers, 1), [true, false, false, false]);
        assert_eq!(choose(&powers, 2), [true, false, true, false]);
        assert_eq!(choose(&powers, 9), [true, false, true, false]);
    }
}
