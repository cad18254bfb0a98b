//! The judge: compares frames with their legal sets and makes records of the results.

use crate::expected_values::expected_values;
use crate::frame_file::frame_file;
use crate::grade::Grades;
use crate::judgement_cache::{JudgementCache, judged_scene};
use crate::line_gap::{gap_reason, note_gap, proven_line_gap};
use crate::relation::{self, Differences, Equality};
use crate::story;
use etalon_case::{Case, Relation};
use etalon_frame::{
    Aspect, AspectStatistics, Band, Comparison, CounterOutcome, Frame, Grade, Limits, WrongTexel,
    accuracy, compare,
};
use etalon_record::{Assertion, FrameFile, MAX_WRONG_TEXELS, Reason, Record, Verdict};
use etalon_reference::{Judgement, Rules, Sample, Sets, set_by};
use etalon_scene::Scene;
use std::borrow::Cow;
use std::cmp::Reverse;

/// Judges frames; legal sets are cached by case and limits, so that adapters share them.
#[derive(Debug, Default)]
pub struct Judge {
    cache: JudgementCache,
}

/// A record without times, and its frame file.
#[derive(Clone, Debug)]
pub struct Judged {
    /// The record.
    pub record: Record,
    /// The frame, if it failed or is imprecise.
    pub frame: Option<FrameFile>,
}

impl Judge {
    /// Judges the frames of a case, its scene's and its variants', and compares them with each other.
    /// `number` identifies the case in the cache.
    pub fn judge(
        &self,
        number: usize,
        case: &Case,
        adapter: &str,
        limits: &Limits,
        frames: &[Frame],
    ) -> Judged {
        let mut judged: Option<Judged> = None;
        let each = self.compare_each(number, case, limits, frames, |compared| {
            judge_scene(case, adapter, limits, compared)
        });
        for (index, scene) in each.enumerate() {
            let scene = scene.unwrap_or_else(|e| unjudged(case, adapter, limits, Reason::Unfit(e)));
            judged = Some(match judged {
                None => scene,
                Some(first) => worse(first, scene, case, index),
            });
        }
        let Some(mut judged) = judged else {
            return unjudged(case, adapter, limits, Reason::NoFrame);
        };
        if let Some(relation) = &case.relation
            && judged.record.verdict != Verdict::InternalError
        {
            let found = relation::check(relation, case, frames);
            if let Some(equality) = Equality::of_relation(relation, limits) {
                if judged.record.verdict == Verdict::Open && found.compared > 0 {
                    judged.record.verdict = Verdict::Pass;
                }
                note_differences(&mut judged.record, case, &equality, limits, (frames, found));
            }
        }
        judged
    }

    /// Compares each frame of a case with the legal sets that it fits best and collects the results of
    /// `then`; returns a message if a frame does not fit the case.
    fn compare_each<T>(
        &self,
        number: usize,
        case: &Case,
        limits: &Limits,
        frames: &[Frame],
        then: impl Fn(ComparedFrame<'_>) -> T,
    ) -> impl Iterator<Item = Result<T, String>> {
        frames.iter().enumerate().map(move |(index, frame)| {
            let judgements = self.cache.get(number, case, index, limits);
            let sets = self.cache.sets(number, case, index);
            let scene = judged_scene(case, index);
            let (comparison, judgement) = best(scene, &judgements, frame, &sets)?;
            Ok(then(ComparedFrame {
                index,
                frames,
                comparison,
                judgement: &judgement,
                sets: &sets,
            }))
        })
    }

    /// Returns the verdict and the first wrong texel: [`Judge::judge`] without story, figures and literal
    /// values. A case that asserts nothing passes.
    ///
    /// # Errors
    /// If a frame does not fit the case.
    pub fn verdict(
        &self,
        number: usize,
        case: &Case,
        limits: &Limits,
        frames: &[Frame],
    ) -> Result<(Verdict, Option<WrongTexel>), String> {
        let mut worst: Option<Band> = None;
        let mut first = None;
        let each = self.compare_each(number, case, limits, frames, |compared| {
            let scene = judged_scene(case, compared.index);
            let legal = &compared.judgement.legal;
            let frame = &frames[compared.index];
            let judged = (frame, compared.comparison.worst());
            let gap = proven_line_gap(scene, limits, judged, legal);
            let gap = gap.map(|gap| (Some(Band::Fail), gap.wrong));
            let operands = unequal_operands(
                scene,
                (frame, compared.index, judged.1),
                compared.judgement,
                compared.sets,
            );
            let band = Equality::of_operands(limits).band;
            let operands = (operands.differing > 0).then_some((Some(band), operands.wrong));
            let own = (judged.1, compared.comparison.wrong);
            // The first of the worst.
            let all = [Some(own), gap, operands].into_iter().flatten();
            all.rev().max_by_key(|(band, _)| *band)
        });
        for compared in each {
            if let Some((band, wrong)) = compared?
                && band > worst
            {
                worst = band;
                first = wrong.into_iter().next();
            }
        }
        if let Some(relation) = &case.relation {
            let found = relation::check(relation, case, frames);
            let band = Rules::invariance(limits, relation.invariance).value();
            if found.differing > 0 && band > worst {
                worst = band;
                first = found.wrong.into_iter().next();
            }
        }
        let verdict = match worst {
            Some(band) => Verdict::of_band(band),
            None => Verdict::Pass,
        };
        Ok((verdict, first))
    }
}

/// A frame of one of a case's scenes, compared with the judgement that it fits best.
struct ComparedFrame<'a> {
    index: usize,
    /// The frames of all of the case's scenes.
    frames: &'a [Frame],
    comparison: Comparison,
    judgement: &'a Judgement,
    sets: &'a Sets<'a>,
}

/// Returns the record of a case whose frames cannot be judged.
fn unjudged(case: &Case, adapter: &str, limits: &Limits, reason: Reason) -> Judged {
    let mut record = Record::new(&case.id, adapter, Verdict::InternalError);
    record.due_fail = is_due_to_fail(case, limits);
    record.reasons = vec![reason];
    Judged {
        record,
        frame: None,
    }
}

/// Judges the frame of one of a case's scenes.
fn judge_scene(case: &Case, adapter: &str, limits: &Limits, compared: ComparedFrame<'_>) -> Judged {
    let ComparedFrame {
        index,
        frames,
        mut comparison,
        judgement,
        sets,
    } = compared;
    let frame = &frames[index];
    let mut record = Record::new(&case.id, adapter, Verdict::Pass);
    record.due_fail = is_due_to_fail(case, limits);
    let mut worst = comparison.worst();
    if worst == Some(Band::Fail)
        && let Some(grades) = Grades::of(
            judged_scene(case, index),
            limits,
            (frame, comparison.texels.wrong),
            sets,
        )
    {
        worst = Some(grades.frame());
        regrade(&mut comparison, &grades);
    }
    let scene = judged_scene(case, index);
    let gap = proven_line_gap(scene, limits, (frame, worst), &judgement.legal);
    let has_story = gap.as_ref().is_none_or(|gap| {
        worst = Some(Band::Fail);
        note_gap(&mut comparison, gap)
    });
    record.texels = comparison.texels;
    record.wrong = comparison.wrong;
    record.counters = comparison.counters;
    // The expectation of a selftest is wrong on purpose, so a distance from it says nothing.
    if case.judged_as.is_none() {
        let (legal, ideal) = (&judgement.legal, &judgement.ideal);
        // The frame was compared with the same images, so it fits.
        record.accuracy = accuracy(frame, legal, ideal).unwrap_or_default();
    }
    record.assertions = assertions(judgement);
    let texels: u64 = record.assertions.iter().map(|a| a.asserted).sum();
    let counters = record.counters.iter().filter(|c| c.is_asserted()).count();
    // If the rules leave a method's outcome open, only its distance from the truth is reported.
    let unasserted = record.texels.open > record.texels.total.saturating_sub(judgement.looked_at);
    record.verdict = match worst {
        Some(band) if band > Band::Imprecise => Verdict::of_band(band),
        _ if case.method.is_some() && (unasserted || texels == 0) => Verdict::Measured,
        _ if texels == 0 && counters == 0 => Verdict::Open,
        Some(_) => Verdict::Imprecise,
        None => Verdict::Pass,
    };
    let wrong_counters: Vec<CounterOutcome> = record
        .counters
        .iter()
        .filter(|c| c.band.is_some())
        .cloned()
        .collect();
    record.reasons = if !wrong_counters.is_empty() {
        vec![Reason::Counters(wrong_counters)]
    } else if let Some(gap) = &gap {
        vec![gap_reason(gap)]
    } else if judgement.looked_at < record.texels.total {
        vec![Reason::Share {
            judged: judgement.looked_at,
            total: record.texels.total,
        }]
    } else {
        Vec::new()
    };
    if index == 0 {
        expected_values(case, frame, &judgement.legal, &mut record);
    }
    let found = unequal_operands(scene, (frame, index, worst), judgement, sets);
    let equality = Equality::of_operands(limits);
    note_differences(&mut record, case, &equality, limits, (frames, found));
    let mut file = None;
    if record.verdict.is_violation() || record.verdict == Verdict::Imprecise {
        if let Some(wrong) = record
            .wrong
            .first()
            .filter(|_| has_story && record.story.is_none())
        {
            let rules = match wrong.band {
                Band::Imprecise => Rules::yardstick(&judgement.limits),
                _ => judgement.rules.clone(),
            };
            if let Some(position) = sample_of(case, wrong) {
                let by = (&judgement.limits, &rules);
                let came = (Some(frame), Some(wrong.band));
                record.story = Some(story::story_of_sample(case, index, by, position, came));
            }
        }
        file = Some(frame_file(case, adapter, frame, judgement, record.verdict));
    }
    Judged {
        record,
        frame: file,
    }
}

/// Compares the colours of a frame that come from the same operands by the "must" clauses alone: weaker evidence can
/// decide which draws reach a sample. Nothing is compared if the frame fails anyway.
fn unequal_operands(
    scene: &Scene,
    (frame, index, worst): (&Frame, usize, Option<Band>),
    judgement: &Judgement,
    sets: &Sets<'_>,
) -> Differences {
    if worst == Some(Band::Fail) {
        return Differences::default();
    }
    let found = relation::check_operands(frame, index, &judgement.legal);
    let proven = judgement.rules.bound_by(Grade::Proven);
    if found.differing == 0 || proven == judgement.rules {
        return found;
    }
    let legal = set_by(scene, &judgement.limits, &proven, sets);
    relation::check_operands(frame, index, &legal)
}

/// Gives a comparison's violations the bands of the evidence that forbids them, the strongest first.
pub(crate) fn regrade(comparison: &mut Comparison, grades: &Grades) {
    for wrong in &mut comparison.wrong {
        if wrong.band == Band::Fail {
            wrong.band = grades.sample((wrong.x, wrong.y, wrong.sample));
        }
    }
    comparison.wrong.sort_by_key(|w| Reverse(w.band));
    let texels = &mut comparison.texels;
    if let Some(violations) = grades.violations() {
        texels.imprecise += texels.wrong.saturating_sub(violations);
        texels.wrong = texels.wrong.min(violations);
    }
    for (index, counter) in comparison.counters.iter_mut().enumerate() {
        if counter.band == Some(Band::Fail) {
            counter.band = Some(grades.counter(index));
        }
    }
}

/// Returns true if a case is a selftest that must fail under an adapter's rules. If the specification does
/// not bind the case's relation, the case is correctly Imprecise instead.
pub fn is_due_to_fail(case: &Case, limits: &Limits) -> bool {
    let bound = |relation: &Relation| {
        let permission = Rules::invariance(limits, relation.invariance);
        permission.value() > Some(Band::Imprecise)
    };
    case.judged_as.is_some() && case.relation.as_ref().is_none_or(bound)
}

/// Returns the record of the worse of two scenes of one case, with the assertions of both.
fn worse(first: Judged, second: Judged, case: &Case, index: usize) -> Judged {
    // Within one case, an open scene does not weaken one that asserts something, and an InternalError next to a
    // Fail means that the Fail is not a proof.
    let rank = |verdict: Verdict| match verdict {
        Verdict::Open => (false, 0),
        Verdict::InternalError => (true, 0),
        verdict => (false, verdict.severity()),
    };
    let least = rank(first.record.verdict).max(rank(Verdict::Pass));
    let takes_second = rank(second.record.verdict) > least;
    let (mut kept, other) = if takes_second {
        let mut second = second;
        let variant = case.variants.get(index - 1);
        let name = variant.map_or_else(String::new, |v| v.name.clone());
        second.record.reasons.insert(0, Reason::Variant(name));
        (second, first)
    } else {
        (first, second)
    };
    let record = &mut kept.record;
    if record.verdict == Verdict::Open {
        record.verdict = other.record.verdict;
    }
    record.texels.total += other.record.texels.total;
    record.texels.wrong += other.record.texels.wrong;
    record.texels.imprecise += other.record.texels.imprecise;
    record.texels.open += other.record.texels.open;
    for assertion in &other.record.assertions {
        match record
            .assertions
            .iter_mut()
            .find(|a| a.aspect == assertion.aspect)
        {
            Some(known) => known.add(assertion),
            None => record.assertions.push(*assertion),
        }
    }
    for accuracy in &other.record.accuracy {
        match record.accuracy.iter_mut().find(|a| a.is_alike(accuracy)) {
            Some(known) => known.add(accuracy),
            None => record.accuracy.push(*accuracy),
        }
    }
    kept
}

/// Adds to a record the differences that a specification forbids.
fn note_differences(
    record: &mut Record,
    case: &Case,
    equality: &Equality,
    limits: &Limits,
    (frames, found): (&[Frame], Differences),
) {
    let band = equality.band;
    story::add_difference(record, case, equality, limits, (frames, &found));
    if found.differing == 0 {
        return;
    }
    let fails = band == Band::Fail;
    if fails {
        record.texels.wrong += found.differing;
        record.verdict = Verdict::Fail;
    } else {
        record.texels.imprecise += found.differing;
        if record.verdict == Verdict::Pass {
            record.verdict = Verdict::Imprecise;
        }
    }
    let difference = found.between.map(|pair| Reason::Difference {
        samples: found.differing,
        pair,
        citation: equality.citation.to_owned(),
    });
    record.reasons.extend(difference);
    let room = MAX_WRONG_TEXELS.saturating_sub(record.wrong.len());
    let wrong = found.wrong.into_iter().take(room);
    record
        .wrong
        .extend(wrong.map(|texel| WrongTexel { band, ..texel }));
}

/// Returns the judgement under which the fewest samples are wrong. An API can hide which of several encodings
/// a format has, but it is the same for the whole frame. The step of a depth bias is handled in the same way.
pub(crate) fn best<'a>(
    scene: &Scene,
    judgements: &'a [Judgement],
    frame: &Frame,
    sets: &Sets<'_>,
) -> Result<(Comparison, Cow<'a, Judgement>), String> {
    let mut best: Option<(Comparison, Cow<'_, Judgement>)> = None;
    for judgement in judgements {
        let judgement = judgement
            .fitted(scene, frame, sets)
            .map_err(|e| e.to_string())?;
        let (legal, yardstick) = (&judgement.legal, &judgement.yardstick);
        let comparison =
            compare(frame, legal, yardstick, MAX_WRONG_TEXELS).map_err(|e| e.to_string())?;
        let badness = |c: &Comparison| (c.texels.wrong, c.texels.imprecise);
        if best
            .as_ref()
            .is_none_or(|(b, _)| badness(&comparison) < badness(b))
        {
            best = Some((comparison, judgement));
        }
    }
    best.ok_or_else(|| "the limits leave no encoding to judge by".to_owned())
}

fn assertions(judgement: &Judgement) -> Vec<Assertion> {
    let tight = judgement.yardstick.statistics();
    let tightest = |aspect: Aspect| -> AspectStatistics {
        tight
            .iter()
            .find(|(a, _)| *a == aspect)
            .map(|(_, figures)| *figures)
            .unwrap_or_default()
    };
    judgement
        .legal
        .statistics()
        .iter()
        .map(|(aspect, legal)| Assertion::new(*aspect, *legal, tightest(*aspect)))
        .collect()
}

fn sample_of(case: &Case, wrong: &WrongTexel) -> Option<Sample> {
    let name = &wrong.channels.first()?.attachment;
    let attachment = case.scene.attachments.iter().find(|a| &a.name == name)?;
    Some(Sample {
        size: attachment.size,
        samples: attachment.samples,
        x: wrong.x,
        y: wrong.y,
        sample: wrong.sample,
    })
}
