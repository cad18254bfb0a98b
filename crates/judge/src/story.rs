//! Stories of wrong samples: of one frame, or of two that a relation requires to be equal. The judge makes
//! them for records, `etalon explain` for any texel.

use crate::judgement_cache::judged_scene;
use crate::relation::{self, Differences, Equality};
use etalon_case::Case;
use etalon_frame::{
    Band, Demand, Effect, Event, Frame, Limits, Origin, Ruling, SceneName, Side, Step, Story,
};
use etalon_record::Record;
use etalon_reference::{Rules, Sample, explain};

/// Returns the story of a sample of one of a case's scenes, with its frame's contents there.
pub fn story_of_sample(
    case: &Case,
    index: usize,
    (limits, rules): (&Limits, &Rules),
    position: Sample,
    (frame, band): (Option<&Frame>, Option<Band>),
) -> Story {
    let mut story = explain(judged_scene(case, index), limits, rules, position, frame);
    if let Some(ruling) = &mut story.ruling {
        ruling.band = band;
        ruling.variant = match scene_name(case, index) {
            SceneName::Own => None,
            SceneName::Variant(name) => Some(name),
        };
    }
    story
}

/// Returns the story of a texel in which pictures differ although a relation demands equality; `None` if they
/// do not differ there, or if the relation does not bind the API.
pub fn story_of_relation(
    case: &Case,
    limits: &Limits,
    frames: &[Frame],
    [x, y]: [u32; 2],
) -> Option<(Band, Story)> {
    let relation = case.relation.as_ref()?;
    let mut texel_relation = relation.clone();
    texel_relation.within = Some([x, y, 1, 1]);
    if let Some([left, top, width, height]) = relation.within {
        let inside = x >= left && y >= top && x - left < width && y - top < height;
        inside.then_some(())?;
    }
    let found = relation::check(&texel_relation, case, frames);
    let equality = Equality::of_relation(relation, limits)?;
    let story = of_differences(case, &equality, limits, frames, &found)?;
    Some((equality.band, story))
}

/// Gives a record the story of a forbidden difference, unless a sample of one frame is at least as wrong on its
/// own.
pub(crate) fn add_difference(
    record: &mut Record,
    case: &Case,
    equality: &Equality,
    limits: &Limits,
    (frames, found): (&[Frame], &Differences),
) {
    let graver = record
        .wrong
        .first()
        .is_none_or(|first| first.band < equality.band);
    if (record.story.is_none() || graver)
        && let Some(story) = of_differences(case, equality, limits, frames, found)
    {
        record.story = Some(story);
    }
}

fn scene_name(case: &Case, index: usize) -> SceneName {
    let variant = index.checked_sub(1).and_then(|i| case.variants.get(i));
    variant.map_or(SceneName::Own, |v| SceneName::Variant(v.name.clone()))
}

/// Returns the story of the first difference, with the operations on both sides.
fn of_differences(
    case: &Case,
    equality: &Equality,
    limits: &Limits,
    frames: &[Frame],
    found: &Differences,
) -> Option<Story> {
    let (first, compared) = (found.wrong.first()?, found.sides.as_ref()?);
    let rules = Rules::of(limits);
    let sides = compared.each_ref().map(|side| match &side.attachment {
        Some(name) => Side::Attachment(name.clone()),
        None => Side::Scene(scene_name(case, side.scene)),
    });
    let samples = compared[0].samples;
    let invariance = Step::Relation(equality.name.to_owned());
    let mut story = Story {
        ruling: Some(Ruling {
            variant: None,
            texel: compared[0].at,
            samples: (samples > 1).then_some(first.sample).into_iter().collect(),
            demand: Demand::Same {
                sides: sides.clone(),
                texel: compared[1].at,
                channels: first.channels.clone(),
                citation: equality.citation.to_owned(),
            },
            rules: rules.text.to_string(),
            after: Vec::new(),
            band: Some(equality.band),
        }),
        events: vec![Event {
            scene: None,
            origin: Origin::Sides(sides),
            step: invariance,
            effect: Effect::None,
            citation: None,
        }],
        ..Story::default()
    };
    let mut seen = Vec::new();
    for side in compared {
        if seen.contains(&(side.scene, side.at, side.sample)) {
            continue;
        }
        seen.push((side.scene, side.at, side.sample));
        let position = Sample {
            size: side.size,
            samples,
            x: side.at[0],
            y: side.at[1],
            sample: side.sample,
        };
        let scene = judged_scene(case, side.scene);
        let alone = explain(scene, limits, &rules, position, frames.get(side.scene));
        let name = scene_name(case, side.scene);
        let ruling = alone.ruling.map(|ruling| (name.clone(), ruling));
        story.alone.extend(ruling);
        let events = alone.events.into_iter();
        story.events.extend(events.map(|event| Event {
            scene: Some(name.clone()),
            ..event
        }));
    }
    Some(story)
}
