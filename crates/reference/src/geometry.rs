//! The geometry of a scene: its primitives, and the signatures of its samples. Neighbouring cases of a file
//! often differ only in tests, blending or colours, and then share it.

use crate::bins::PassSetup;
use crate::rules::Rules;
use crate::setups::{pass_depth, setups};
use crate::snap::units_per_texel;
use crate::strokes::PassStrokes;
use crate::texels::Texels;
use crate::walk::Walk;
use etalon_frame::Limits;
use etalon_scene::{Attachment, AttachmentContents, Draw, Pass, Scene};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The maximum number of kept geometries.
const MOST_KEPT: usize = 32;

/// The maximum numbers of vertices and of samples, over all passes, of a scene whose geometry is kept. A kept
/// geometry then takes a few MB at most.
const MOST_VERTICES: usize = 1 << 12;
const MOST_SAMPLES: u64 = 1 << 18;

/// The geometry of a scene under some limits and rules.
#[derive(Debug)]
pub(crate) struct Geometry {
    /// Per pass.
    pub(crate) setups: Arc<[PassSetup]>,
    /// Per pass. Empty until a second scene needs them.
    pub(crate) strokes: Vec<Option<PassStrokes>>,
}

/// A geometry with everything that it was computed from.
#[derive(Debug)]
struct KeptGeometry {
    scene: Scene,
    limits: Limits,
    texels: Texels,
    /// The rules, which record the permissions that were asked for.
    rules: Rules,
    geometry: Arc<Geometry>,
}

/// The geometries of the scenes judged last.
#[derive(Debug, Default)]
pub struct Geometries(Mutex<VecDeque<KeptGeometry>>);

impl Geometries {
    /// Returns the geometry of a scene: a kept one if nothing that it depends on differs.
    pub(crate) fn get(
        &self,
        scene: &Scene,
        limits: &Limits,
        rules: &Rules,
        texels: Texels,
    ) -> Arc<Geometry> {
        if !is_small(scene) {
            return Arc::new(Geometry {
                setups: setups(scene, limits, rules, texels, false).into(),
                strokes: Vec::new(),
            });
        }
        let serves = |k: &KeptGeometry| {
            k.texels == texels
                && same_geometry((&k.scene, &k.limits), (scene, limits))
                && rules.agree_on_asked(&k.rules)
        };
        let mut kept = self.lock();
        let found = kept.iter().position(serves);
        let found = found.and_then(|index| kept.remove(index));
        let entry = match found {
            Some(found) if !found.geometry.strokes.is_empty() => found,
            found => {
                drop(kept);
                let entry = match found {
                    // Strokes cost more than one picture saves, so only the second scene records them.
                    Some(found) => found.with_strokes(rules),
                    None => KeptGeometry::new(scene, limits, rules, texels),
                };
                kept = self.lock();
                entry
            }
        };
        rules.ask(&entry.rules);
        let geometry = Arc::clone(&entry.geometry);
        kept.truncate(MOST_KEPT - 1);
        kept.push_front(entry);
        geometry
    }

    fn lock(&self) -> MutexGuard<'_, VecDeque<KeptGeometry>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl KeptGeometry {
    fn new(scene: &Scene, limits: &Limits, rules: &Rules, texels: Texels) -> Self {
        // A clone starts without recorded permissions, so it records only those of this computation.
        let asking = rules.clone();
        let geometry = Geometry {
            setups: setups(scene, limits, &asking, texels, false).into(),
            strokes: Vec::new(),
        };
        Self {
            scene: scene.clone(),
            limits: limits.clone(),
            texels,
            rules: asking,
            geometry: Arc::new(geometry),
        }
    }

    fn with_strokes(self, rules: &Rules) -> Self {
        let asking = rules.clone();
        asking.ask(&self.rules);
        let setups = Arc::clone(&self.geometry.setups);
        let walk = Walk::over(&self.scene, &self.limits, &asking, self.texels, setups);
        let geometry = Geometry {
            strokes: walk.strokes(),
            setups: walk.setups,
        };
        Self {
            rules: asking,
            geometry: Arc::new(geometry),
            ..self
        }
    }
}

fn is_small(scene: &Scene) -> bool {
    let draws = scene.passes.iter().flat_map(|pass| &pass.draws);
    let samples = scene.passes.iter().map(|pass| {
        let [width, height] = scene.pass_size(pass).map(u64::from);
        width * height * u64::from(scene.pass_samples(pass))
    });
    draws.map(|draw| draw.mesh.vertices.len()).sum::<usize>() <= MOST_VERTICES
        && samples.sum::<u64>() <= MOST_SAMPLES
}

/// Returns true if two scenes have the same geometry under rules that agree.
fn same_geometry((a, a_limits): (&Scene, &Limits), (b, b_limits): (&Scene, &Limits)) -> bool {
    let same_pass = |x: &Pass, y: &Pass| {
        let depth = pass_depth(a, a_limits, x) == pass_depth(b, b_limits, y);
        let targets = (&x.color, &x.resolve, x.depth_stencil, x.draws.len())
            == (&y.color, &y.resolve, y.depth_stencil, y.draws.len());
        let clears = x.clears.iter().map(|clear| clear.before);
        let others = y.clears.iter().map(|clear| clear.before);
        let mut draws = x.draws.iter().zip(&y.draws);
        depth && targets && clears.eq(others) && draws.all(|(x, y)| draw_key(x) == draw_key(y))
    };
    let textures = a.passes.iter().flat_map(|pass| &pass.draws);
    let mut textures = textures.flat_map(|draw| &draw.textures);
    units_per_texel(a_limits) == units_per_texel(b_limits)
        && a_limits.sample_positions == b_limits.sample_positions
        && a.passes.len() == b.passes.len()
        && a.attachments.len() == b.attachments.len()
        && (a.attachments.iter().zip(&b.attachments))
            .all(|(x, y)| (x.size, x.samples) == (y.size, y.samples))
        && a.passes.iter().zip(&b.passes).all(|(x, y)| same_pass(x, y))
        && textures.all(|i| same_texels(&a.attachments[*i], &b.attachments[*i]))
}

/// Returns true if two textures have the same uploaded texels, or if both have none.
fn same_texels(a: &Attachment, b: &Attachment) -> bool {
    match (&a.contents, &b.contents) {
        (AttachmentContents::Texels(x), AttachmentContents::Texels(y)) => {
            a.format == b.format && x == y
        }
        (AttachmentContents::Texels(_), _) | (_, AttachmentContents::Texels(_)) => false,
        _ => true,
    }
}

/// Returns the state of a draw on which its primitives and signatures depend. Every field is named, so that none
/// is forgotten.
fn draw_key(draw: &Draw) -> impl PartialEq + '_ {
    let Draw {
        mesh,
        fetch: _,
        topology,
        tessellation,
        provoking,
        shader,
        params: _,
        early_tests,
        textures,
        sampler,
        counters,
        cull: _,
        front_face: _,
        polygon_mode,
        rasterizer_discard,
        viewport,
        scissor,
        clip_distances,
        depth_bias: bias,
        depth_clamp,
        depth_bounds: _,
        depth,
        stencil: _,
        targets: _,
        logic: _,
        multisample,
        blend_constant: _,
    } = draw;
    let primitives = (mesh.bytes(), &mesh.indices, topology, tessellation);
    let shading = (shader, provoking, textures, sampler, multisample);
    // Numbers are compared by their bits: 0 and -0 are different.
    let position = (
        viewport.rect.map(f32::to_bits),
        viewport.depth.map(f32::to_bits),
        scissor,
    );
    let depth = (
        depth.is_some(),
        early_tests,
        depth_clamp,
        (bias.constant, [bias.slope, bias.clamp].map(f32::to_bits)),
    );
    let kept = (rasterizer_discard, clip_distances, counters.is_empty());
    (primitives, shading, polygon_mode, position, depth, kept)
}
