//! Stories of wrong samples: of one frame, of two that a relation ties to each other, and of a case that
//! goes wrong only after others. The judge tells them for records, `etalon explain` for any texel.

use crate::judgement_cache::judged_scene;
use crate::relation::{self, Differences, Side};
use etalon_case::{Case, Relation};
use etalon_frame::{
    Band, ChannelMismatch, CodeInterval, Frame, Limits, Story, StoryLine, WrongTexel,
};
use etalon_record::Record;
use etalon_reference::{Rules, Sample, codes_text, explain};

/// Returns the story of a sample of one of a case's scenes, with what its frame holds there.
pub fn story_of_sample(
    case: &Case,
    index: usize,
    (limits, rules): (&Limits, &Rules),
    at: Sample,
    (frame, band): (Option<&Frame>, Option<Band>),
) -> Story {
    let mut story = explain(judged_scene(case, index), limits, rules, at, frame);
    if let Some(verdict) = story.verdict_mut() {
        if index > 0 {
            verdict.at = format!("{}, {}", in_scene(case, index), verdict.at);
        }
        add_grade(verdict, band);
    }
    story
}

/// Returns the story of a texel in which pictures differ that a relation demands to be the same; `None` if
/// they do not differ there, or nothing binds the API.
pub fn story_of_relation(
    case: &Case,
    limits: &Limits,
    frames: &[Frame],
    [x, y]: [u32; 2],
) -> Option<(Band, Story)> {
    let relation = case.relation.as_ref()?;
    let mut one = relation.clone();
    one.within = Some([x, y, 1, 1]);
    if let Some([left, top, width, height]) = relation.within {
        let inside = x >= left && y >= top && x - left < width && y - top < height;
        inside.then_some(())?;
    }
    let found = relation::check(&one, case, frames);
    let band = Rules::invariance(limits, relation.invariance).value()?;
    Some((
        band,
        of_differences(case, relation, limits, frames, &found)?,
    ))
}

/// Gives a record the story of what a relation forbids, unless a sample of one frame is as wrong alone.
pub(crate) fn tell_relation(
    record: &mut Record,
    case: &Case,
    relation: &Relation,
    limits: &Limits,
    (frames, found): (&[Frame], &Differences),
) {
    let Some(band) = Rules::invariance(limits, relation.invariance).value() else {
        return;
    };
    let graver = record.wrong.first().is_none_or(|first| first.band < band);
    if (record.story.is_none() || graver)
        && let Some(story) = of_differences(case, relation, limits, frames, found)
    {
        record.story = Some(story);
    }
}

/// Adds to a record's story the cases that had to be drawn before.
pub fn tell_chain(record: &mut Record) {
    let after = record.after.join(", then ");
    if let Some(verdict) = record.story.as_mut().and_then(Story::verdict_mut)
        && !after.is_empty()
    {
        verdict.detail = format!("{}; only when drawn after {after}", verdict.detail);
    }
}

fn in_scene(case: &Case, index: usize) -> String {
    let variant = index.checked_sub(1).and_then(|i| case.variants.get(i));
    match variant {
        Some(variant) => format!("in variant {}", variant.name),
        None => "in the scene".to_owned(),
    }
}

fn add_grade(verdict: &mut StoryLine, band: Option<Band>) {
    let grade = match band {
        None => return,
        Some(Band::Fail) => "proven: the text forbids it",
        Some(Band::RequiredByCts) => {
            "required by the CTS: the text is open, a Khronos mustpass case is not"
        }
        Some(Band::Disputed) => "disputed: only one reading of the text forbids it",
        Some(Band::Imprecise) => "imprecise: legal, but not as good as it should be",
    };
    if let Some(judged_by) = &mut verdict.citation {
        *judged_by = format!("{judged_by}; {grade}");
    }
}

/// Returns the story of the first difference, with the operations on both sides.
fn of_differences(
    case: &Case,
    relation: &Relation,
    limits: &Limits,
    frames: &[Frame],
    found: &Differences,
) -> Option<Story> {
    let (first, sides) = (found.wrong.first()?, found.sides.as_ref()?);
    let permission = Rules::invariance(limits, relation.invariance);
    let rules = Rules::of(limits);
    let name = |side: &Side| match &side.attachment {
        Some(name) => format!("in attachment {name}"),
        None => in_scene(case, side.scene),
    };
    let names = [name(&sides[0]), name(&sides[1])];
    let samples = sides[0].samples;
    let texel = |side: &Side| {
        let [x, y] = side.at;
        match samples {
            1 => format!("texel {x},{y}"),
            _ => format!("sample {} of texel {x},{y}", first.sample),
        }
    };
    let (subject, same) = if sides[0].at == sides[1].at {
        (texel(&sides[0]), format!("{} and {}", names[0], names[1]))
    } else {
        let moved = format!("{} and, as {}, {}", names[0], texel(&sides[1]), names[1]);
        (texel(&sides[0]), moved)
    };
    let predicate = format!("must be the same {same}: {}", differences(first, &names));
    let judged_by = format!("judged by {}: {}", rules.text, permission.citation);
    let mut verdict = StoryLine::verdict(subject, predicate, judged_by);
    add_grade(&mut verdict, permission.value());
    let relation = StoryLine {
        at: format!("{} and {}", names[0], names[1]),
        operation: "relation".to_owned(),
        detail: relation.invariance.name().to_owned(),
        citation: None,
    };
    let mut lines = vec![verdict, relation];
    let mut told = Vec::new();
    for (side, name) in sides.iter().zip(&names) {
        if told.contains(&(side.scene, side.at)) {
            continue;
        }
        told.push((side.scene, side.at));
        let at = Sample {
            size: side.size,
            samples,
            x: side.at[0],
            y: side.at[1],
            sample: first.sample,
        };
        let scene = judged_scene(case, side.scene);
        let story = explain(scene, limits, &rules, at, frames.get(side.scene));
        let name = match side.attachment {
            Some(_) => in_scene(case, side.scene),
            None => name.clone(),
        };
        lines.push(StoryLine {
            at: name.clone(),
            operation: "alone".to_owned(),
            detail: story.sentence().unwrap_or_default(),
            citation: None,
        });
        lines.extend(story.operations().iter().map(|line| StoryLine {
            at: format!("{name}: {}", line.at),
            ..line.clone()
        }));
    }
    Some(Story { lines })
}

/// Returns the values on both sides: `red is 51 in the scene and 52 in variant twice`.
fn differences(texel: &WrongTexel, names: &[String; 2]) -> String {
    let one = |m: &ChannelMismatch| {
        let channel = m.aspect.channel(m.channel.into());
        let value = |code: u32| {
            let order = m.encoding.order_of_code(code);
            codes_text(m.encoding, CodeInterval::exact(order))
        };
        let (due, actual) = (value(m.low), value(m.actual));
        format!("{channel} is {due} {} and {actual} {}", names[0], names[1])
    };
    texel
        .channels
        .iter()
        .map(one)
        .collect::<Vec<_>>()
        .join(", ")
}
