//! Legal sets and stories: the walk, over all samples in both bands or over one.

use crate::counting::Tally;
use crate::notes::{Note, Notes};
use crate::rules::Rules;
use crate::texels::Texels;
use crate::verdict::verdict;
use crate::walk::{Sample, Walk};
use etalon_frame::{
    CountRange, Frame, LegalSet, LegalSetBuilder, Limits, Story, StoryLine, TexelSet,
};
use etalon_scene::{Draw, Scene};

/// Both bands of one scene for one possible set of limits.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// The limits that were assumed: every depth format has one encoding.
    pub limits: Limits,
    /// The values that the API's text allows.
    pub legal: LegalSet,
    /// The values within the yardstick.
    pub yardstick: LegalSet,
    /// The number of judged samples of all images of one size, summed over sizes and sample counts. Of
    /// others nothing is asserted.
    pub looked_at: u64,
    /// The rules of the legal set, with what was assumed of them.
    pub rules: Rules,
    pub(crate) texels: Texels,
}

/// Returns both bands of a scene, once per depth encoding that the adapter may have.
pub fn judgements(scene: &Scene, limits: &Limits) -> Vec<Judgement> {
    judgements_of(scene, limits, Texels::All)
}

/// Returns [`judgements`] of some texels; of others nothing is asserted. Counters are sums over all
/// texels: unless all are judged, nothing is asserted of counters either.
pub fn judgements_of(scene: &Scene, limits: &Limits, texels: Texels) -> Vec<Judgement> {
    let texels = texels.of(scene);
    limits
        .alternatives(&scene.formats())
        .into_iter()
        .map(|limits| {
            let rules = Rules::of(&limits);
            let legal = judge_some(scene, &limits, &rules, texels);
            let yardstick = judge_some(scene, &limits, &Rules::yardstick(&limits), texels);
            let groups = legal.groups.iter();
            Judgement {
                looked_at: groups
                    .map(|g| texels.count(g.size) * u64::from(g.samples))
                    .sum(),
                legal,
                yardstick,
                limits,
                rules,
                texels,
            }
        })
        .collect()
}

/// Returns the legal set of all attachments that the scene reads back. Of a depth format with several
/// possible encodings the first is assumed; see [`judgements`].
pub fn judge(scene: &Scene, limits: &Limits, rules: &Rules) -> LegalSet {
    judge_some(scene, limits, rules, Texels::All)
}

/// Returns [`judge`]'s set of some texels; see [`judgements_of`].
pub fn judge_some(scene: &Scene, limits: &Limits, rules: &Rules, texels: Texels) -> LegalSet {
    let texels = texels.of(scene);
    let walk = Walk::new(scene, limits, rules, texels);
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
    let mut shapes: Vec<([u32; 2], u32)> = Vec::new();
    let add = |shapes: &mut Vec<([u32; 2], u32)>, shape| {
        if !shapes.contains(&shape) {
            shapes.push(shape);
        }
    };
    for index in &scene.read {
        let attachment = &scene.attachments[*index];
        add(&mut shapes, (attachment.size, attachment.samples));
    }
    let read = shapes.len();
    let counted = if texels.is_all() {
        &scene.passes[..]
    } else {
        &[]
    };
    for pass in counted {
        if pass.draws.iter().any(|d| !d.counters.is_empty()) {
            let shape = (scene.pass_size(pass), scene.pass_samples(pass));
            add(&mut shapes, shape);
        }
    }
    let mut tally = Tally::new(scene, rules);
    for (group, shape) in shapes.iter().enumerate() {
        let (size, lattice) = (shape.0, texels.lattice(shape.0));
        for y in 0..size[1] {
            let mut next = 0;
            while next < size[0] {
                let x = lattice.first(next, y).map_or(size[0], |x| x.min(size[0]));
                builder.open(group, u64::from(x - next) * u64::from(shape.1));
                next = x + 1;
                if x == size[0] {
                    break;
                }
                walk.forget();
                for sample in 0..shape.1 {
                    let at = Sample {
                        size: shape.0,
                        samples: shape.1,
                        x,
                        y,
                        sample,
                    };
                    let mut notes = Notes(None);
                    let worlds = walk.worlds(at, scene.passes.len(), &mut notes);
                    tally.sample(worlds.as_deref());
                    if group < read {
                        builder.sample(
                            group,
                            match worlds {
                                Some(worlds) => walk.finish(&worlds, at, &mut notes),
                                None => TexelSet::default(),
                            },
                        );
                    }
                }
                tally.texel(shape.1);
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

/// Returns the story of one sample: the verdict in one sentence, then every operation on it with its
/// outcome and the citation of each permission that was used, and every draw and primitive that ends
/// before it with its clause. With the frame that a driver returned, the verdict tells what came back.
pub fn explain(
    scene: &Scene,
    limits: &Limits,
    rules: &Rules,
    at: Sample,
    frame: Option<&Frame>,
) -> Story {
    let (_, mut lines, notes) = told(scene, limits, rules, at, frame);
    lines.extend(notes.into_iter().map(|note| note.line));
    Story { lines }
}

/// Returns the legal values of one sample, the line of its verdict, and its notes.
fn told(
    scene: &Scene,
    limits: &Limits,
    rules: &Rules,
    at: Sample,
    frame: Option<&Frame>,
) -> (TexelSet, Vec<StoryLine>, Vec<Note>) {
    // A sampler may read what was drawn to other texels.
    let samples = |draw: &Draw| draw.sampler.is_some();
    let mut later = scene.passes.iter().skip(1).flat_map(|p| &p.draws);
    let texels = match later.any(samples) {
        true => Texels::All,
        false => Texels::One([at.x, at.y]),
    };
    let walk = Walk::new(scene, limits, rules, texels);
    let mut notes = Vec::new();
    let set = walk.sample(at, &mut notes);
    let initial = walk.initial(at, &mut Notes(None));
    let verdict = verdict(&walk, at, &set, &initial, &notes, frame);
    (set, vec![verdict], notes)
}

#[cfg(test)]
mod stories;
#[cfg(test)]
mod tests;
