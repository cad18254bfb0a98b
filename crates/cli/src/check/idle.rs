//! Draws that change nothing in any case of a file, and tests that decide nothing.
//!
//! The rasterizer draws a scene up to a draw, and again without the draw or with another state; all attachments
//! and counters are compared. The first case settles most draws of a file. A draw that its own state holds back
//! in every case, such as its scissor rectangle, is what its file asks about, and gives no warning.

use etalon_backend::Backend;
use etalon_case::{CaseError, CaseFile, CaseRef, Profile};
use etalon_cpu::CpuBackend;
use etalon_frame::{CounterKind, Frame};
use etalon_scene::{
    CompareFunction, Counter, CullMode, Draw, EarlyTests, Multisample, Path, QueryScope, Scene,
    StoreOperation,
};
use std::collections::BTreeMap;

/// The number of cases that are looked at, even if all draws of the first ones are settled.
const LOOKED_AT: usize = 64;
/// The largest number of draws of a scene, and of bytes of its attachments, in files that are checked.
const MAX_DRAWS: usize = 64;
const MAX_BYTES: u64 = 1 << 20;
/// The largest number of frames, and of their bytes, that are drawn for a file.
const MAX_FRAMES: u64 = 10_000;
const MAX_FRAME_BYTES: u64 = 1 << 29;

/// The indices of a pass and a draw.
type DrawIndices = [usize; 2];

/// The effect of a draw, by its place in the file, in the cases so far.
#[derive(Default)]
struct DrawEffect {
    /// The draw in one of the cases.
    indices: DrawIndices,
    /// True if it changes a texel or a count.
    changes: bool,
    /// True if it would change something with another state, or if the file can ask about something other than
    /// its texels: it adds to a counter or a pool, its shader can remove all fragments, or its vertices miss the
    /// picture.
    is_excused: bool,
    depth: TestEffect,
    stencil: TestEffect,
}

/// The effect of a test in the cases so far.
#[derive(Default)]
struct TestEffect {
    /// True if it can reject a fragment.
    is_on: bool,
    /// True if its outcome changes something.
    decides: bool,
}

/// Returns warnings about draws and tests that change nothing in any case; none if the file is too large.
pub(crate) fn idle(file: &CaseFile) -> Vec<CaseError> {
    let is_random = matches!(file.scene_key(), "random" | "states" | "method");
    if is_random || file.is_measured() {
        return Vec::new();
    }
    let mut rasterizer = Rasterizer::default();
    let places = effects(file, &mut rasterizer);
    places.map_or_else(Vec::new, |places| warnings(file, places.into_values()))
}

/// Returns what the cases show of each place of the file with a draw; `None` if they are too many or too large.
fn effects(file: &CaseFile, rasterizer: &mut Rasterizer) -> Option<BTreeMap<String, DrawEffect>> {
    let mut places: BTreeMap<String, DrawEffect> = BTreeMap::new();
    let mut keys: BTreeMap<DrawIndices, String> = BTreeMap::new();
    for (index, case_ref) in file.cases(Profile::Full).enumerate() {
        if index >= LOOKED_AT && places.values().all(DrawEffect::is_settled) {
            break;
        }
        let case = case_ref.build().ok()?;
        // Variants can have their draws in another order.
        if case.variants.iter().any(|v| v.submissions.is_none()) {
            return None;
        }
        let scenes = [Some(&case.scene), case.judged_as.as_ref()];
        for scene in scenes.into_iter().flatten() {
            let draws: usize = scene.passes.iter().map(|pass| pass.draws.len()).sum();
            if draws > MAX_DRAWS || scene.bytes() > MAX_BYTES {
                return None;
            }
            let mut kinds = None;
            for indices in all_indices(scene) {
                let place = keys.entry(indices).or_insert_with(|| place(file, indices));
                let effect = places.entry(place.clone()).or_insert_with(|| DrawEffect {
                    indices,
                    ..DrawEffect::default()
                });
                let draw = draw(scene, indices);
                effect.note(draw);
                if effect.is_settled() {
                    continue;
                }
                if kinds.is_none() {
                    kinds = Some(mesh_kinds(case_ref, scene)?);
                }
                let kind = kinds.as_ref().and_then(|kinds| kinds.get(&indices));
                let is_handmade = kind.is_some_and(|kind| kind == "vertices");
                effect.look(scene, indices, is_handmade, rasterizer)?;
            }
        }
    }
    Some(places)
}

/// Returns the place of the file that stands for a draw. In a sequence, its indices stand for the place.
fn place(file: &CaseFile, indices: DrawIndices) -> String {
    match file.scene_key() {
        "scene" => file.key_of_draw(indices),
        _ => format!("{indices:?}"),
    }
}

fn all_indices(scene: &Scene) -> impl Iterator<Item = DrawIndices> {
    let passes = scene.passes.iter().enumerate();
    passes.flat_map(|(p, pass)| (0..pass.draws.len()).map(move |d| [p, d]))
}

fn draw(scene: &Scene, [pass, draw]: DrawIndices) -> &Draw {
    &scene.passes[pass].draws[draw]
}

/// Returns the kind of each draw's mesh in the file; `None` if draws of the file become several in the scene.
fn mesh_kinds(case: CaseRef<'_>, scene: &Scene) -> Option<BTreeMap<DrawIndices, String>> {
    let document = case.document().ok()?;
    let passes = document["scene"]["passes"].as_array()?;
    let mut kinds = BTreeMap::new();
    for (p, pass) in passes.iter().enumerate() {
        let draws = pass["draws"].as_array()?;
        if draws.len() != scene.passes.get(p)?.draws.len() {
            return None;
        }
        for (d, draw) in draws.iter().enumerate() {
            let kind = draw["mesh"]["kind"].as_str().unwrap_or_default();
            kinds.insert([p, d], kind.to_owned());
        }
    }
    Some(kinds)
}

impl DrawEffect {
    fn is_settled(&self) -> bool {
        (self.changes || self.is_excused) && self.depth.is_settled() && self.stencil.is_settled()
    }

    /// Notes what needs no frame.
    fn note(&mut self, draw: &Draw) {
        let shader = draw.shader;
        let removes = shader.discards() || shader.writes_mask() || shader.cull_distances() > 0;
        self.is_excused |= removes || shader.uses_pool() || !draw.counters.is_empty();
        let rejects = |compare| compare != CompareFunction::Always;
        self.depth.is_on |= draw.depth.is_some_and(|test| rejects(test.compare));
        let stencil = draw
            .stencil
            .is_some_and(|test| rejects(test.front.compare) || rejects(test.back.compare));
        self.stencil.is_on |= stencil;
    }

    /// Draws a case with and without the draw and its tests; `None` if that is too much.
    fn look(
        &mut self,
        scene: &Scene,
        indices: DrawIndices,
        is_handmade: bool,
        rasterizer: &mut Rasterizer,
    ) -> Option<()> {
        let scene = until(scene, indices);
        let draw = draw(&scene, indices);
        let frame = rasterizer.frame(&scene)?;
        if !self.changes {
            let mut without = scene.clone();
            without.passes[indices[0]].draws.truncate(indices[1]);
            let without = rasterizer.frame(&without)?;
            self.changes = without != frame;
            if !self.changes && !self.is_excused {
                self.is_excused = is_held_back(&scene, indices, is_handmade, &without, rasterizer)?;
            }
        }
        if draw.depth.is_some() && !self.depth.is_settled() {
            self.depth.decides = decides(&scene, indices, &frame, set_depth, rasterizer)?;
        }
        if draw.stencil.is_some() && !self.stencil.is_settled() {
            self.stencil.decides = decides(&scene, indices, &frame, set_stencil, rasterizer)?;
        }
        Some(())
    }
}

impl TestEffect {
    fn is_settled(&self) -> bool {
        !self.is_on || self.decides
    }

    fn is_idle(&self) -> bool {
        self.is_on && !self.decides
    }
}

/// Sets the comparison of a test, if that is on.
type SetTest = fn(&mut Draw, CompareFunction);

fn set_depth(draw: &mut Draw, compare: CompareFunction) {
    if let Some(test) = &mut draw.depth {
        test.compare = compare;
    }
}

fn set_stencil(draw: &mut Draw, compare: CompareFunction) {
    if let Some(test) = &mut draw.stencil {
        test.front.compare = compare;
        test.back.compare = compare;
    }
}

/// Returns true if the outcome of a test changes something, with the draw's state or if nothing else rejects
/// fragments.
fn decides(
    scene: &Scene,
    indices: DrawIndices,
    frame: &Frame,
    set: SetTest,
    rasterizer: &mut Rasterizer,
) -> Option<bool> {
    let never = |draw: &mut Draw| set(draw, CompareFunction::Never);
    let always = |draw: &mut Draw| set(draw, CompareFunction::Always);
    if rasterizer.differs(scene, indices, frame, &[&never, &always])? {
        return Some(true);
    }
    let mut alone = scene.clone();
    pass_all(&mut alone.passes[indices[0]].draws[indices[1]]);
    let frame = rasterizer.frame(&alone)?;
    rasterizer.differs(&alone, indices, &frame, &[&never])
}

/// Lets every fragment pass.
fn pass_all(draw: &mut Draw) {
    set_depth(draw, CompareFunction::Always);
    set_stencil(draw, CompareFunction::Always);
    draw.depth_bounds = None;
    draw.depth_clamp = true;
    draw.early_tests = EarlyTests::Implicit;
    draw.cull = CullMode::None;
    draw.scissor = None;
    draw.rasterizer_discard = false;
    draw.clip_distances = 0;
    draw.multisample = Multisample::default();
}

/// Lets every fragment pass, and stores its colour.
fn store_all(draw: &mut Draw) {
    pass_all(draw);
    draw.logic = None;
    for target in &mut draw.targets {
        target.blend = None;
        target.advanced = None;
        target.write_mask = 0b1111;
    }
}

/// Returns true if a draw would change something with another state. A mesh whose vertices are given one by
/// one, and which covers nothing, asks whether it covers nothing.
fn is_held_back(
    scene: &Scene,
    indices: DrawIndices,
    is_handmade: bool,
    without: &Frame,
    rasterizer: &mut Rasterizer,
) -> Option<bool> {
    if rasterizer.differs(scene, indices, without, &[&pass_all, &store_all])? {
        return Some(true);
    }
    if !is_handmade {
        return Some(false);
    }
    let mut counted = scene.clone();
    counted.counters = vec![Counter {
        name: String::new(),
        kind: CounterKind::SamplesPassed,
    }];
    for draw in counted.passes.iter_mut().flat_map(|pass| &mut pass.draws) {
        draw.counters.clear();
    }
    let draw = &mut counted.passes[indices[0]].draws[indices[1]];
    pass_all(draw);
    draw.counters.push(0);
    let frame = rasterizer.frame(&counted)?;
    Some(frame.counters.iter().all(|count| *count == 0))
}

/// Returns the scene up to a draw, with everything read back.
fn until(scene: &Scene, [last_pass, last_draw]: DrawIndices) -> Scene {
    let mut scene = scene.clone();
    scene.passes.truncate(last_pass + 1);
    if let Some(pass) = scene.passes.last_mut() {
        pass.draws.truncate(last_draw + 1);
        pass.clears.retain(|clear| clear.before <= last_draw);
        pass.resolve.fill(None);
        pass.depth_stencil_resolve = None;
        for operations in &mut pass.operations.color {
            operations.store = StoreOperation::Store;
        }
        pass.operations.depth.store = StoreOperation::Store;
        pass.operations.stencil.store = StoreOperation::Store;
    }
    scene.read = (0..scene.attachments.len()).collect();
    scene.query_scope = QueryScope::Draw;
    scene.path = Path::default();
    scene
}

/// The rasterizer, and how much it has drawn.
struct Rasterizer {
    backend: CpuBackend,
    frames: u64,
    bytes: u64,
}

impl Default for Rasterizer {
    fn default() -> Self {
        Self {
            backend: CpuBackend::new("cpu"),
            frames: 0,
            bytes: 0,
        }
    }
}

impl Rasterizer {
    /// Draws a scene; `None` if that is too much, or the scene cannot be drawn.
    fn frame(&mut self, scene: &Scene) -> Option<Frame> {
        self.frames += 1;
        self.bytes += scene.bytes();
        if self.frames > MAX_FRAMES || self.bytes > MAX_FRAME_BYTES {
            return None;
        }
        let mut prepared = self.backend.prepare(scene).ok()?;
        prepared.submit().ok()?;
        prepared.read_back().ok()
    }

    /// Returns true if a frame changes by one of these changes of a draw.
    fn differs(
        &mut self,
        scene: &Scene,
        [pass, draw]: DrawIndices,
        frame: &Frame,
        changes: &[&dyn Fn(&mut Draw)],
    ) -> Option<bool> {
        for change in changes {
            let mut changed = scene.clone();
            change(&mut changed.passes[pass].draws[draw]);
            if self.frame(&changed)? != *frame {
                return Some(true);
            }
        }
        Some(false)
    }
}

fn warnings(file: &CaseFile, places: impl Iterator<Item = DrawEffect>) -> Vec<CaseError> {
    let mut warnings: Vec<CaseError> = Vec::new();
    for effect in places {
        let [pass, draw] = effect.indices.map(|index| index.to_string());
        let mut warn = |key: Option<&str>, message: &str| {
            let keys = [file.scene_key(), "passes", &pass, "draws", &draw];
            // A sequence has no passes in the file.
            let count = if file.scene_key() == "scene" {
                keys.len()
            } else {
                1
            };
            let keys: Vec<&str> = keys[..count].iter().copied().chain(key).collect();
            warnings.push(file.warning(&keys, message));
        };
        if !effect.changes && !effect.is_excused {
            warn(
                None,
                "this draw changes no texel in any case, even with all tests off and all channels written: give it \
                 another colour or place, or remove it",
            );
        }
        for (key, test) in [("depth", &effect.depth), ("stencil", &effect.stencil)] {
            if effect.changes && test.is_idle() {
                let message = format!(
                    "the {key} test decides nothing: no case changes if it always passes or never passes; \
                     let passing and failing fragments store different values, or remove the test"
                );
                warn(Some(key), &message);
            }
        }
    }
    warnings
}
