//! Legal sets and stories: both bands of whole pictures, or one sample.

use crate::counting::EventTally;
use crate::geometry::Geometries;
use crate::known_sets::KnownSets;
use crate::notes::{Note, Notes};
use crate::picture::shapes;
use crate::read_back::as_read;
use crate::rules::Rules;
use crate::ruling::ruling;
use crate::sample::{Sample, SampleShape};
use crate::snap::basis_bits;
use crate::states::{OPEN, StateNumber};
use crate::texels::Texels;
use crate::walk::Walk;
use etalon_frame::{
    Api, CountRange, FormatSupport, Frame, LegalSet, LegalSetBuilder, Limits, ReadPath, Ruling,
    Story, TexelSet,
};
use etalon_scene::{Draw, Scene};
use rustc_hash::FxHashMap;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Both bands of one scene for one possible encoding of each depth format.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// The assumed limits: every depth format has one encoding.
    pub limits: Limits,
    /// The values that the API's specification allows.
    pub legal: Arc<LegalSet>,
    /// The values within the yardstick.
    pub yardstick: Arc<LegalSet>,
    /// The values that accuracy is measured from: those within the yardstick, under the depth bias step that the
    /// frame shows.
    pub ideal: Arc<LegalSet>,
    /// The number of judged samples of all images of one size, summed over sizes and sample counts. Nothing
    /// is asserted about other samples.
    pub looked_at: u64,
    /// The rules of the legal set, with the assumptions about them.
    pub rules: Rules,
}

/// Returns both bands of a scene, once per depth encoding that the adapter can have.
pub fn judgements(scene: &Scene, limits: &Limits) -> Vec<Judgement> {
    judgements_of(scene, limits, Texels::All)
}

/// Returns [`judgements`] of some texels; nothing is asserted about others. Counters are sums over all
/// texels: unless all are judged, nothing is asserted about counters either.
pub fn judgements_of(scene: &Scene, limits: &Limits, texels: Texels) -> Vec<Judgement> {
    let geometries = Geometries::default();
    judgements_by(
        scene,
        limits,
        texels,
        &shared_sets(scene, texels, &geometries),
    )
}

/// Returns the function that gives the sets of some texels of a scene, with a cache.
pub fn shared_sets(
    scene: &Scene,
    texels: Texels,
    geometries: &Geometries,
) -> impl Fn(&Limits, &Rules) -> Arc<LegalSet> {
    let known: RefCell<FxHashMap<Limits, KnownSets>> = RefCell::default();
    move |limits, rules| {
        let mut known = known.borrow_mut();
        let sets = known.entry(limits.clone()).or_default();
        sets.get(rules, |rules| {
            legal_set_of_texels(scene, limits, rules, texels, geometries)
        })
    }
}

/// Gives the legal set of some texels of a scene for limits and rules: the result of [`legal_set_of_texels`]
/// for these, or for equal limits and rules with the same values for all permissions that were asked for. The
/// limits contain only the values on which sets depend.
pub type Sets<'a> = dyn Fn(&Limits, &Rules) -> Arc<LegalSet> + 'a;

/// Returns the legal set of a scene for limits under which every depth format has one encoding.
pub fn set_by(scene: &Scene, limits: &Limits, rules: &Rules, sets: &Sets<'_>) -> Arc<LegalSet> {
    as_read(sets(&basis(scene, limits), rules), scene, limits, rules)
}

/// Returns [`judgements_of`] with sets from `sets`.
pub fn judgements_by(
    scene: &Scene,
    limits: &Limits,
    texels: Texels,
    sets: &Sets<'_>,
) -> Vec<Judgement> {
    let texels = texels.simplified_for(scene);
    limits
        .alternatives(&scene.formats())
        .into_iter()
        .map(|limits| {
            let rules = Rules::of(&limits);
            let set = |rules: &Rules| set_by(scene, &limits, rules, sets);
            let legal = set(&rules);
            let yardstick = set(&Rules::yardstick(&limits));
            let groups = legal.groups.iter();
            Judgement {
                looked_at: groups
                    .map(|g| texels.count(g.size) * u64::from(g.samples))
                    .sum(),
                legal,
                ideal: Arc::clone(&yardstick),
                yardstick,
                limits,
                rules,
            }
        })
        .collect()
}

/// Returns the limits that the legal sets of a scene depend on; the others are replaced by constants.
fn basis(scene: &Scene, limits: &Limits) -> Limits {
    let formats = scene.formats().into_iter().filter_map(|format| {
        let support = limits.formats.get(&format)?;
        let basis = FormatSupport {
            samples: Vec::new(),
            blendable: false,
            depth: support.depth.clone(),
            // The way of reading back is applied after the walk.
            read: ReadPath::Copy,
        };
        Some((format, basis))
    });
    let counts = scene.attachments.iter().map(|a| a.samples);
    let positions = counts.filter_map(|n| Some((n, limits.sample_positions.get(&n)?.clone())));
    Limits {
        // Where the grid itself matters, the rules are asked.
        sub_pixel_bits: basis_bits(limits.sub_pixel_bits),
        formats: formats.collect(),
        sample_positions: positions.collect(),
        // The others affect sets only through the rules, or not at all.
        ..Limits::nothing(Api::Vulkan)
    }
}

/// Returns the legal set of all attachments that the scene reads back. For a depth format with several
/// possible encodings, the first is assumed; see [`judgements`].
pub fn legal_set(scene: &Scene, limits: &Limits, rules: &Rules) -> LegalSet {
    legal_set_of_texels(scene, limits, rules, Texels::All, &Geometries::default())
}

/// Returns the result of [`legal_set`] for some texels; see [`judgements_of`].
pub fn legal_set_of_texels(
    scene: &Scene,
    limits: &Limits,
    rules: &Rules,
    texels: Texels,
    geometries: &Geometries,
) -> LegalSet {
    let texels = texels.simplified_for(scene);
    let geometry = geometries.get(scene, limits, rules, texels);
    let walk = Walk::over(scene, limits, rules, texels, Arc::clone(&geometry.setups));
    let mut builder = LegalSetBuilder::default();
    for index in &scene.read {
        let attachment = &scene.attachments[*index];
        for aspect in attachment.format.aspects() {
            let (channels, read) = walk.read_encoding(*index, *aspect);
            builder.image(
                &attachment.name,
                *aspect,
                attachment.size,
                attachment.samples,
                &channels,
                read,
            );
        }
    }
    walk.paint(&shapes(scene), &geometry.strokes);
    let pictures = walk.pictures.borrow();
    for group in 0..builder.groups() {
        let (size, samples) = builder.shape(group);
        // For each state, the number of its set.
        let mut sets: Vec<Option<u32>> = Vec::new();
        let mut open = None;
        let states = pictures.of_shape((size, samples));
        let mut start = 0;
        while let Some(state) = states.get(start).copied() {
            let same = states[start..].iter().take_while(|s| **s == state).count();
            let known = match sets.get_mut(state as usize) {
                _ if state == OPEN => &mut open,
                Some(known) => known,
                None => {
                    sets.resize(state as usize + 1, None);
                    &mut sets[state as usize]
                }
            };
            let set = *known.get_or_insert_with(|| {
                let shape = (size, samples);
                builder.set(group, walk.set(pictures.states.worlds(state), shape))
            });
            builder.samples(group, set, same);
            start += same;
        }
    }
    let mut tally = EventTally::new(scene, rules);
    if texels.is_all() && !scene.counters.is_empty() {
        for shape in counted(scene) {
            let mut texels: FxHashMap<&[StateNumber], u64> = FxHashMap::default();
            for texel in pictures.of_shape(shape).chunks_exact(shape.1 as usize) {
                *texels.entry(texel).or_default() += 1;
            }
            for (texel, times) in texels {
                let worlds = texel.iter().map(|state| pictures.states.worlds(*state));
                tally.texel(worlds.map(|w| w.map(|w| &w[..])), times);
            }
        }
    }
    for (index, mut counter) in tally.finish().enumerate() {
        if !texels.is_all() || walk.undefined.counter(index) {
            counter.range = CountRange { low: 0, high: None };
        }
        builder.counter(counter);
    }
    builder.build()
}

/// Returns the shapes of passes with counters.
fn counted(scene: &Scene) -> BTreeSet<SampleShape> {
    let counts = scene
        .passes
        .iter()
        .filter(|pass| pass.draws.iter().any(|d| !d.counters.is_empty()));
    counts
        .map(|pass| (scene.pass_size(pass), scene.pass_samples(pass)))
        .collect()
}

/// Returns the story of one sample: the ruling, then every operation on it with its outcome and the citation of
/// each permission that was used, and every draw and primitive that does not reach the sample, with the clause
/// that stops it. If the frame that a driver returned is given, the ruling includes its values.
pub fn explain(
    scene: &Scene,
    limits: &Limits,
    rules: &Rules,
    at: Sample,
    frame: Option<&Frame>,
) -> Story {
    let (_, ruling, notes) = explained(scene, limits, rules, at, frame);
    Story {
        ruling: Some(ruling),
        events: notes.into_iter().map(|note| note.event).collect(),
        ..Story::default()
    }
}

/// Returns the legal values of one sample, its ruling, and its notes.
fn explained(
    scene: &Scene,
    limits: &Limits,
    rules: &Rules,
    at: Sample,
    frame: Option<&Frame>,
) -> (TexelSet, Ruling, Vec<Note>) {
    // A sampler can read what was drawn to other texels.
    let samples = |draw: &Draw| draw.sampler.is_some();
    let mut later = scene.passes.iter().skip(1).flat_map(|p| &p.draws);
    let texels = if later.any(samples) {
        Texels::All
    } else {
        Texels::One([at.x, at.y])
    };
    let walk = Walk::new(scene, limits, rules, texels);
    let mut notes = Vec::new();
    let set = walk.sample(at, &mut notes);
    let initial = walk.initial(at, &mut Notes(None));
    let ruling = ruling(&walk, at, &set, &initial, &notes, frame);
    (set, ruling, notes)
}

#[cfg(test)]
mod pictures;
#[cfg(test)]
mod stories;
#[cfg(test)]
mod tests;
