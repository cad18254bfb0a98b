//! Legal sets and stories: the walk, over all samples in both bands or over one.

use crate::counting::Tally;
use crate::rules::Rules;
use crate::texels::Texels;
use crate::walk::{Notes, Sample, Walk};
use etalon_frame::{CountRange, LegalSet, LegalSetBuilder, Limits, Story, TexelSet};
use etalon_scene::Scene;

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
            let legal = judge_some(scene, &limits, &Rules::of(&limits), texels);
            let yardstick = judge_some(scene, &limits, &Rules::yardstick(&limits), texels);
            let groups = legal.groups.iter();
            Judgement {
                looked_at: groups
                    .map(|g| texels.count(g.size) * u64::from(g.samples))
                    .sum(),
                legal,
                yardstick,
                limits,
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
    for mut counter in tally.finish() {
        if !texels.is_all() {
            counter.range = CountRange { low: 0, high: None };
        }
        builder.counter(counter);
    }
    builder.build()
}

/// Returns the story of one sample: every operation on it with its outcome and the citation of each
/// permission that was used.
pub fn explain(scene: &Scene, limits: &Limits, rules: &Rules, at: Sample) -> Story {
    let mut story = Story::default();
    let texels = Texels::One([at.x, at.y]);
    Walk::new(scene, limits, rules, texels).sample(at, Some(&mut story));
    story
}

#[cfg(test)]
mod tests;
