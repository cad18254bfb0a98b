//! From a frame to a verdict.

use crate::relation;
use etalon_case::{Case, Relation};
use etalon_frame::{
    Aspect, AspectStatistics, Band, ChannelMismatch, Comparison, CounterOutcome, Frame, LegalSet,
    Limits, SampleGroup, WrongTexel, compare,
};
use etalon_record::{Assertion, FrameFile, FrameImage, MAX_WRONG_TEXELS, Record, Verdict};
use etalon_reference::{Judgement, Rules, Sample, Texels, explain, judgements_of};
use etalon_scene::Scene;
use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Bytes of legal sets that are kept for the adapters that come to a case later.
const CACHE_BYTES: usize = 512 << 20;

/// The most texels of an image that are judged, on a lattice that meets every row and column: big
/// frames are there to be measured, and judging all of them would take longer than all drawing. What
/// is left out counts as not asserted.
const MOST_TEXELS: u64 = 4096;

/// A case, one of its scenes, and the limits it is judged by.
type Key = (usize, usize, Limits);
type Entry = Arc<OnceLock<Arc<Vec<Judgement>>>>;

/// Judges frames; legal sets are cached by case and limits, so that adapters share them.
#[derive(Debug, Default)]
pub struct Judge {
    cache: Mutex<Cache>,
}

#[derive(Debug, Default)]
struct Cache {
    entries: HashMap<Key, Entry>,
    order: VecDeque<Key>,
    bytes: usize,
}

/// A record without its times, and the frame file that belongs to it.
#[derive(Clone, Debug)]
pub struct Judged {
    /// The record.
    pub record: Record,
    /// The frame, where it is worth looking at.
    pub frame: Option<FrameFile>,
}

impl Judge {
    /// Holds the frames of a case, its scene's and its variants', against what the rules allow and
    /// against each other. `number` tells the case from others.
    pub fn judge(
        &self,
        number: usize,
        case: &Case,
        adapter: &str,
        limits: &Limits,
        frames: &[Frame],
    ) -> Judged {
        let mut judged: Option<Judged> = None;
        for (index, frame) in frames.iter().enumerate() {
            let one = self.judge_scene(number, case, index, adapter, limits, frame);
            judged = Some(match judged {
                None => one,
                Some(first) => worse(first, one, case, index),
            });
        }
        let Some(mut judged) = judged else {
            let mut record = Record::new(&case.id, adapter, Verdict::InternalError);
            record.message = "no frame came back".to_owned();
            return Judged {
                record,
                frame: None,
            };
        };
        if let Some(relation) = &case.relation
            && judged.record.verdict != Verdict::InternalError
        {
            let found = relation::check(relation, case, frames);
            note_relation(&mut judged.record, relation, limits, found);
        }
        judged
    }

    /// Holds the frame of one of a case's scenes against what the rules allow.
    fn judge_scene(
        &self,
        number: usize,
        case: &Case,
        index: usize,
        adapter: &str,
        limits: &Limits,
        frame: &Frame,
    ) -> Judged {
        let judgements = self.judgements(number, case, index, limits);
        let mut record = Record::new(&case.id, adapter, Verdict::Pass);
        record.due_fail = case.judged_as.is_some();
        let (comparison, judgement) = match best(&judgements, frame) {
            Ok(best) => best,
            Err(message) => {
                record.verdict = Verdict::InternalError;
                record.message = message;
                return Judged {
                    record,
                    frame: None,
                };
            }
        };
        let worst = comparison.worst();
        record.texels = comparison.texels;
        record.wrong = comparison.wrong;
        record.counters = comparison.counters;
        record.accuracy = comparison.accuracy;
        record.assertions = assertions(judgement);
        let texels: u64 = record.assertions.iter().map(|a| a.asserted).sum();
        let counters = record.counters.iter().filter(|c| c.is_asserted()).count();
        // Of a method whose outcome the rules leave open somewhere only the distance from the truth is
        // told.
        let unasserted =
            record.texels.open > record.texels.total.saturating_sub(judgement.looked_at);
        record.verdict = match worst {
            Some(Band::Fail) => Verdict::Fail,
            _ if case.method.is_some() && (unasserted || texels == 0) => Verdict::Measured,
            _ if texels == 0 && counters == 0 => Verdict::Open,
            Some(Band::Imprecise) => Verdict::Imprecise,
            None => Verdict::Pass,
        };
        if let Some(message) = counter_message(&record.counters) {
            record.message = message;
        }
        if index == 0 {
            expected_values(case, frame, &judgement.legal, &mut record);
        }
        let mut file = None;
        if matches!(record.verdict, Verdict::Fail | Verdict::Imprecise) {
            if let Some(wrong) = record.wrong.first() {
                let rules = match wrong.band {
                    Band::Fail => Rules::of(judgement.limits.api),
                    Band::Imprecise => Rules::yardstick(&judgement.limits),
                };
                if let Some(at) = sample_of(case, wrong) {
                    let scene = judged_scene(case, index);
                    record.story = Some(explain(scene, &judgement.limits, &rules, at));
                }
            }
            file = Some(frame_file(case, adapter, frame, judgement, record.verdict));
        }
        Judged {
            record,
            frame: file,
        }
    }

    /// The verdict alone, with the first texel outside: [`Judge::judge`] without story, figures and
    /// literal values. A case that asserts nothing passes.
    ///
    /// # Errors
    /// When a frame is not one of the case.
    pub(crate) fn glance(
        &self,
        number: usize,
        case: &Case,
        limits: &Limits,
        frames: &[Frame],
    ) -> Result<(Verdict, Option<WrongTexel>), String> {
        let mut worst: Option<Band> = None;
        let mut first = None;
        for (index, frame) in frames.iter().enumerate() {
            let judgements = self.judgements(number, case, index, limits);
            let (comparison, _) = best(&judgements, frame)?;
            if comparison.worst() > worst {
                worst = comparison.worst();
                first = comparison.wrong.into_iter().next();
            }
        }
        if let Some(relation) = &case.relation {
            let found = relation::check(relation, case, frames);
            let band = Rules::invariance(limits.api, relation.invariance).value;
            if found.differences > 0 && band > worst {
                worst = band;
                first = found.wrong.into_iter().next();
            }
        }
        let verdict = match worst {
            Some(Band::Fail) => Verdict::Fail,
            Some(Band::Imprecise) => Verdict::Imprecise,
            None => Verdict::Pass,
        };
        Ok((verdict, first))
    }

    fn judgements(
        &self,
        number: usize,
        case: &Case,
        index: usize,
        limits: &Limits,
    ) -> Arc<Vec<Judgement>> {
        let key = (number, index, limits_that_matter(limits));
        let entry = {
            let mut cache = self.cache.lock().unwrap_or_else(PoisonError::into_inner);
            match cache.entries.get(&key) {
                Some(entry) => Arc::clone(entry),
                None => {
                    let entry = Entry::default();
                    cache.entries.insert(key.clone(), Arc::clone(&entry));
                    entry
                }
            }
        };
        let mut fresh = false;
        let sets = Arc::clone(entry.get_or_init(|| {
            fresh = true;
            let scene = judged_scene(case, index);
            Arc::new(judgements_of(scene, limits, Texels::AtMost(MOST_TEXELS)))
        }));
        if fresh {
            let weight = |all: &[Judgement]| -> usize {
                all.iter()
                    .map(|j| j.legal.weight() + j.yardstick.weight())
                    .sum()
            };
            let mut cache = self.cache.lock().unwrap_or_else(PoisonError::into_inner);
            cache.bytes += weight(&sets);
            cache.order.push_back(key);
            while cache.bytes > CACHE_BYTES {
                let Some(oldest) = cache.order.pop_front() else {
                    break;
                };
                if let Some(old) = cache.entries.remove(&oldest) {
                    let freed = old.get().map_or(0, |sets| weight(sets));
                    cache.bytes = cache.bytes.saturating_sub(freed);
                }
            }
        }
        sets
    }
}

/// The scene that the judge looks at: the case's own, or that of a variant.
fn judged_scene(case: &Case, index: usize) -> &Scene {
    match index.checked_sub(1).and_then(|v| case.variants.get(v)) {
        Some(variant) => &variant.scene,
        None => case.judged_scene(),
    }
}

/// The record of the worse of two scenes, with the assertions of both.
fn worse(first: Judged, second: Judged, case: &Case, index: usize) -> Judged {
    // Not `Verdict::severity`: an open scene takes nothing from one that asserts something, and an
    // error of our own outranks a Fail.
    let badness = |judged: &Judged| match judged.record.verdict {
        Verdict::InternalError => 4,
        Verdict::Fail => 3,
        Verdict::Imprecise => 2,
        Verdict::Pass => 1,
        _ => 0,
    };
    let takes_second = badness(&second) > badness(&first) && badness(&second) > 1;
    let (mut kept, other) = if takes_second {
        let mut second = second;
        let name = case.variants.get(index - 1).map_or("", |v| v.name.as_str());
        let message = format!("variant {name}: {}", second.record.message);
        second.record.message = message.trim_end_matches([':', ' ']).to_owned();
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
            Some(own) => own.add(assertion),
            None => record.assertions.push(*assertion),
        }
    }
    for accuracy in &other.record.accuracy {
        match record
            .accuracy
            .iter_mut()
            .find(|a| a.aspect == accuracy.aspect)
        {
            Some(own) => own.add(accuracy),
            None => record.accuracy.push(*accuracy),
        }
    }
    kept
}

/// What is wrong with the counters, in words.
fn counter_message(counters: &[CounterOutcome]) -> Option<String> {
    let wrong: Vec<String> = counters
        .iter()
        .filter(|c| c.band.is_some())
        .map(|c| {
            let legal = c.range();
            let due = match c.band {
                Some(Band::Fail) => format!("{legal} is legal"),
                _ => format!("{legal} is legal, but the yardstick wants another"),
            };
            format!(
                "counter {} ({}) is {}, {due}",
                c.name,
                c.kind.name(),
                c.actual
            )
        })
        .collect();
    (!wrong.is_empty()).then(|| wrong.join("; "))
}

/// Adds what a relation found to a record.
fn note_relation(
    record: &mut Record,
    relation: &Relation,
    limits: &Limits,
    found: relation::Found,
) {
    let permission = Rules::invariance(limits.api, relation.invariance);
    let Some(band) = permission.value else { return };
    if record.verdict == Verdict::Open && found.compared > 0 {
        record.verdict = Verdict::Pass;
    }
    if found.differences == 0 {
        return;
    }
    let message = format!(
        "{} samples differ from {}: {}",
        found.differences, found.between, permission.citation
    );
    let fails = band == Band::Fail;
    if fails {
        record.texels.wrong += found.differences;
        record.verdict = Verdict::Fail;
    } else {
        record.texels.imprecise += found.differences;
        if record.verdict == Verdict::Pass {
            record.verdict = Verdict::Imprecise;
        }
    }
    record.message = match record.message.as_str() {
        "" => message,
        before => format!("{before}; {message}"),
    };
    let room = MAX_WRONG_TEXELS.saturating_sub(record.wrong.len());
    let wrong = found.wrong.into_iter().take(room);
    record
        .wrong
        .extend(wrong.map(|texel| WrongTexel { band, ..texel }));
}

/// The reading of hidden encodings under which fewer samples are wrong: a format whose encoding the
/// API hides is one or the other for the whole frame.
fn best<'a>(
    judgements: &'a [Judgement],
    frame: &Frame,
) -> Result<(Comparison, &'a Judgement), String> {
    let mut best: Option<(Comparison, &Judgement)> = None;
    for judgement in judgements {
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

/// Limits without what no legal set depends on, so that more adapters share one.
fn limits_that_matter(limits: &Limits) -> Limits {
    let mut key = limits.clone();
    key.features.clear();
    key.max_size = 0;
    for support in key.formats.values_mut() {
        support.samples.clear();
    }
    key
}

fn assertions(judgement: &Judgement) -> Vec<Assertion> {
    let tight = judgement.yardstick.statistics();
    let of = |aspect: Aspect| -> AspectStatistics {
        tight
            .iter()
            .find(|(a, _)| *a == aspect)
            .map(|(_, figures)| *figures)
            .unwrap_or_default()
    };
    judgement
        .legal
        .statistics()
        .into_iter()
        .map(|(aspect, legal)| Assertion::new(aspect, legal, of(aspect)))
        .collect()
}

/// Holds the case's literal values against frame and legal set. A literal outside the legal set
/// is the reference's error; a frame that is legal but not the literal is imprecise.
fn expected_values(case: &Case, frame: &Frame, legal: &LegalSet, record: &mut Record) {
    for expect in &case.expect {
        let name = &case.scene.attachments[expect.attachment].name;
        let found = legal
            .images
            .iter()
            .position(|i| &i.attachment == name && i.aspect == Aspect::Color);
        let Some(index) = found else { continue };
        let info = &legal.images[index];
        let [x, y] = expect.texel;
        let set = legal.groups[info.group].sample(x, y, 0);
        let mut channels = Vec::new();
        for (c, value) in expect.value.iter().enumerate() {
            let encoding = info.channels[c];
            let due = encoding.nearest_code(*value);
            let at = info.first_channel + c;
            let legal_here = set
                .hull(at)
                .is_none_or(|hull| hull.contains(encoding.order_of_code(due)));
            if !legal_here {
                record.verdict = Verdict::InternalError;
                record.message = format!(
                    "the literal {value} of channel {c} at ({x}, {y}) is outside the legal set"
                );
                return;
            }
            let actual = frame.images[index].sample(x, y, 0)[c];
            if actual != due {
                channels.push(ChannelMismatch {
                    attachment: name.clone(),
                    aspect: Aspect::Color,
                    channel: c as u8,
                    encoding,
                    low: due,
                    high: due,
                    actual,
                });
            }
        }
        if !channels.is_empty() {
            if record.verdict == Verdict::Pass {
                record.verdict = Verdict::Imprecise;
                record.texels.imprecise += 1;
            }
            record.message = format!("texel ({x}, {y}) is not the literal value of the case");
            record.wrong.push(WrongTexel {
                x,
                y,
                sample: 0,
                band: Band::Imprecise,
                channels,
            });
        }
    }
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

fn frame_file(
    case: &Case,
    adapter: &str,
    frame: &Frame,
    judgement: &Judgement,
    verdict: Verdict,
) -> FrameFile {
    let shown = match verdict {
        Verdict::Fail => &judgement.legal,
        _ => &judgement.yardstick,
    };
    let mut images = Vec::new();
    for (image, info) in frame.images.iter().zip(&shown.images) {
        let group = &shown.groups[info.group];
        let mut low = Vec::with_capacity(image.codes.len());
        let mut high = Vec::with_capacity(image.codes.len());
        let mut wrong = Vec::new();
        let mut orders = Vec::new();
        for y in 0..image.size[1] {
            for x in 0..image.size[0] {
                for sample in 0..image.samples {
                    let set = group.sample(x, y, sample);
                    for (c, encoding) in info.channels.iter().enumerate() {
                        let hull = set.hull(info.first_channel + c);
                        let (l, h) = hull.map_or_else(
                            || (encoding.min_order(), encoding.max_order()),
                            |hull| (hull.low, hull.high),
                        );
                        low.push(encoding.code_of_order(l));
                        high.push(encoding.code_of_order(h));
                    }
                    sample_orders(frame, shown, group, info.group, (x, y, sample), &mut orders);
                    let legal = judgement.legal.groups[info.group].sample(x, y, sample);
                    let tight = judgement.yardstick.groups[info.group].sample(x, y, sample);
                    wrong.push(if !legal.allows(&orders) {
                        FrameImage::FAIL
                    } else if !tight.allows(&orders) {
                        FrameImage::IMPRECISE
                    } else {
                        FrameImage::FINE
                    });
                }
            }
        }
        images.push(FrameImage {
            attachment: image.attachment.clone(),
            aspect: image.aspect,
            size: image.size,
            samples: image.samples,
            channels: image.channels.clone(),
            low,
            high,
            actual: image.codes.clone(),
            wrong,
        });
    }
    FrameFile {
        case: case.id.clone(),
        adapter: adapter.to_owned(),
        about: case.about.clone(),
        spec: case.spec.clone(),
        images,
    }
}

/// The orders of one sample in all images of its group.
fn sample_orders(
    frame: &Frame,
    set: &LegalSet,
    group: &SampleGroup,
    index: usize,
    (x, y, sample): (u32, u32, u32),
    orders: &mut Vec<i64>,
) {
    orders.clear();
    orders.reserve(group.channels.len());
    for (image, info) in frame.images.iter().zip(&set.images) {
        if info.group == index {
            let codes = image.sample(x, y, sample);
            orders.extend(
                codes
                    .iter()
                    .zip(&info.channels)
                    .map(|(code, e)| e.order_of_code(*code)),
            );
        }
    }
}
