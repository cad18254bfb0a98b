//! The fields of a draw: where they are, and which of them can be stale.

use etalon_scene::{
    BlendComponent, BlendFactor, BlendState, ColorTarget, CompareFunction, CullMode, DepthBias,
    DepthState, Draw, EarlyTests, FrontFace, LogicOperation, PrimitiveTopology, SampleCoverage,
    Sampler, StencilFace, StencilOperation, StencilState, Vertex,
};

/// Returns references to a field of a draw: none if the field is off, several if each face or target has its
/// own.
pub(super) type FieldPlaces<T> = for<'a> fn(&'a mut Draw) -> Vec<&'a mut T>;

/// Declares [`FieldPlaces`] from expressions that can be iterated.
macro_rules! places {
    ($($name:ident: $type:ty = |$draw:ident| $places:expr;)+) => {
        $(pub(super) const $name: FieldPlaces<$type> = |$draw| $places.into_iter().collect();)+
    };
}

places! {
    DEPTH: Option<DepthState> = |d| [&mut d.depth];
    DEPTH_COMPARE: CompareFunction = |d| d.depth.iter_mut().map(|s| &mut s.compare);
    DEPTH_WRITE: bool = |d| d.depth.iter_mut().map(|s| &mut s.write);
    DEPTH_BIAS: DepthBias = |d| [&mut d.depth_bias];
    STENCIL_TEST: Option<StencilState> = |d| [&mut d.stencil];
    STENCIL: StencilState = |d| &mut d.stencil;
    FACES: StencilFace = |d| d.stencil.iter_mut().flat_map(|s| [&mut s.front, &mut s.back]);
    FRONT: StencilFace = |d| d.stencil.iter_mut().map(|s| &mut s.front);
    BACK: StencilFace = |d| d.stencil.iter_mut().map(|s| &mut s.back);
    STENCIL_COMPARE: CompareFunction = |d| FACES(d).into_iter().map(|f| &mut f.compare);
    STENCIL_OPERATIONS: StencilOperation =
        |d| FACES(d).into_iter().flat_map(|f| [&mut f.fail_op, &mut f.depth_fail_op, &mut f.pass_op]);
    FAIL_OP: StencilOperation = |d| FACES(d).into_iter().map(|f| &mut f.fail_op);
    DEPTH_FAIL_OP: StencilOperation = |d| FACES(d).into_iter().map(|f| &mut f.depth_fail_op);
    PASS_OP: StencilOperation = |d| FACES(d).into_iter().map(|f| &mut f.pass_op);
    STENCIL_WRITE_MASK: u8 = |d| FACES(d).into_iter().map(|f| &mut f.write_mask);
    TARGETS: ColorTarget = |d| &mut d.targets;
    SECOND_TARGET: ColorTarget = |d| d.targets.iter_mut().skip(1).take(1);
    BLEND: Option<BlendState> = |d| d.targets.iter_mut().map(|t| &mut t.blend);
    EQUATIONS: BlendState = |d| d.targets.iter_mut().flat_map(|t| &mut t.blend);
    COLOR_EQUATION: BlendComponent = |d| EQUATIONS(d).into_iter().map(|b| &mut b.color);
    ALPHA_EQUATION: BlendComponent = |d| EQUATIONS(d).into_iter().map(|b| &mut b.alpha);
    COLOR_FACTORS: BlendFactor =
        |d| COLOR_EQUATION(d).into_iter().flat_map(|c| [&mut c.src_factor, &mut c.dst_factor]);
    ALPHA_FACTORS: BlendFactor =
        |d| ALPHA_EQUATION(d).into_iter().flat_map(|c| [&mut c.src_factor, &mut c.dst_factor]);
    WRITE_MASK: u8 = |d| d.targets.iter_mut().map(|t| &mut t.write_mask);
    SAMPLER: Sampler = |d| &mut d.sampler;
    VERTICES: Vertex = |d| &mut d.mesh.vertices;
    CULL: CullMode = |d| [&mut d.cull];
    FRONT_FACE: FrontFace = |d| [&mut d.front_face];
    TOPOLOGY: PrimitiveTopology = |d| [&mut d.topology];
    EARLY_TESTS: EarlyTests = |d| [&mut d.early_tests];
    SAMPLE_COVERAGE: SampleCoverage = |d| &mut d.multisample.sample_coverage;
    DEPTH_BOUNDS: Option<[f32; 2]> = |d| [&mut d.depth_bounds];
    LOGIC: Option<LogicOperation> = |d| [&mut d.logic];
    SCISSOR: Option<[u32; 4]> = |d| [&mut d.scissor];
    COVERAGE: Option<SampleCoverage> = |d| [&mut d.multisample.sample_coverage];
}

/// Copies a field from another draw.
pub(super) type Take = fn(&Draw, &mut Draw);

/// The cases that show that a field is stale.
#[derive(PartialEq)]
pub(super) enum Shows {
    /// The cases of the field's area, which change it from one case to the next.
    Cases,
    /// The cases of the area `sequence`, which change the field between draws and between passes.
    Sequences,
    Both,
}

/// A field that can be stale.
pub(super) struct StaleField {
    pub(super) shows: Shows,
    pub(super) area: &'static str,
    pub(super) name: &'static str,
    pub(super) take: Take,
    /// Copies the field only if it is off in the draw, that is, at its default.
    pub(super) take_when_off: Option<Take>,
}

impl StaleField {
    /// Returns the name for use in a sentence.
    pub(super) fn words(&self) -> String {
        self.name.replace('-', " ")
    }

    /// Returns true if cases of its area show it.
    pub(super) fn in_cases(&self) -> bool {
        self.shows != Shows::Sequences
    }

    /// Returns true if sequences show it.
    pub(super) fn in_sequences(&self) -> bool {
        self.shows != Shows::Cases
    }
}

/// Copies a part of a field from another draw, for each face or target.
fn part<T>(places: FieldPlaces<T>, before: &Draw, draw: &mut Draw, part: fn(&mut T, &T)) {
    let mut before = before.clone();
    let places = places(draw).into_iter().zip(places(&mut before));
    places.for_each(|(to, from)| part(to, from));
}

fn take_default<T: Clone + Default + PartialEq>(to: &mut T, from: &T) {
    if *to == T::default() {
        to.clone_from(from);
    }
}

/// Writes a [`Take`] that copies a field of the draw (`.field`), whole [`FieldPlaces`] (`in PLACES`), a field of
/// each of them (`in PLACES.field`, with `?` if it can be off on either side), or anything else (`=
/// function`).
macro_rules! take {
    (.$($field:tt)+) => { |before, draw| draw.$($field)+.clone_from(&before.$($field)+) };
    (in $places:ident) => { |before, draw| part($places, before, draw, Clone::clone_from) };
    (in $places:ident.$($field:tt)+) => {
        |before, draw| part($places, before, draw, |to, from| to.$($field)+.clone_from(&from.$($field)+))
    };
    (in $places:ident?.$($field:tt)+) => {
        |before, draw| part($places, before, draw, |to, from| if let (Some(to), Some(from)) = (to, from) {
            to.$($field)+.clone_from(&from.$($field)+);
        })
    };
    (= $take:expr) => { $take };
}

/// Lists fields by area. Fields that can be switched off name the places for this (`off PLACES`).
macro_rules! fields {
    ($($area:literal { $($shows:ident $name:literal $take:tt $(off $places:ident)?;)+ })+) => {
        pub(super) const FIELDS: &[StaleField] = &[$($(StaleField {
            shows: Shows::$shows,
            area: $area,
            name: $name,
            take: take! $take,
            take_when_off: fields!($($places)?),
        },)+)+];
    };
    ($places:ident) => { Some(|before, draw| part($places, before, draw, take_default)) };
    () => { None };
}

fields! {
    "depth" {
        Both "depth-test" (.depth) off DEPTH;
        Both "depth-compare" (in DEPTH_COMPARE);
        Both "depth-write" (in DEPTH_WRITE);
        Cases "depth-bias" (.depth_bias) off DEPTH_BIAS;
        Sequences "depth-bias-constant" (.depth_bias.constant);
        Sequences "depth-bias-slope" (.depth_bias.slope);
        Sequences "depth-bias-clamp" (.depth_bias.clamp);
        Both "depth-clamp" (.depth_clamp);
        Both "depth-bounds" (.depth_bounds) off DEPTH_BOUNDS;
        Cases "depth-range" (.viewport.depth);
        Sequences "viewport-depth" (.viewport.depth);
    }
    "stencil" {
        Cases "stencil" (.stencil) off STENCIL_TEST;
        Sequences "stencil-test" (.stencil);
        Cases "stencil-operations" (in STENCIL_OPERATIONS);
        Sequences "stencil-front-compare" (in FRONT.compare);
        Sequences "stencil-front-fail-op" (in FRONT.fail_op);
        Sequences "stencil-front-depth-fail-op" (in FRONT.depth_fail_op);
        Sequences "stencil-front-pass-op" (in FRONT.pass_op);
        Sequences "stencil-front-reference" (in FRONT.reference);
        Sequences "stencil-front-read-mask" (in FRONT.read_mask);
        Sequences "stencil-front-write-mask" (in FRONT.write_mask);
        Sequences "stencil-back-compare" (in BACK.compare);
        Sequences "stencil-back-fail-op" (in BACK.fail_op);
        Sequences "stencil-back-depth-fail-op" (in BACK.depth_fail_op);
        Sequences "stencil-back-pass-op" (in BACK.pass_op);
        Sequences "stencil-back-reference" (in BACK.reference);
        Sequences "stencil-back-read-mask" (in BACK.read_mask);
        Sequences "stencil-back-write-mask" (in BACK.write_mask);
        Both "stencil-reference" (in FACES.reference);
        Sequences "stencil-read-mask" (in FACES.read_mask);
        Both "stencil-write-mask" (in FACES.write_mask);
    }
    "blend" {
        Both "blend" (in BLEND) off BLEND;
        Sequences "blend-color-operation" (in BLEND?.color.operation);
        Sequences "blend-color-src-factor" (in BLEND?.color.src_factor);
        Sequences "blend-color-dst-factor" (in BLEND?.color.dst_factor);
        Sequences "blend-alpha-operation" (in BLEND?.alpha.operation);
        Sequences "blend-alpha-src-factor" (in BLEND?.alpha.src_factor);
        Sequences "blend-alpha-dst-factor" (in BLEND?.alpha.dst_factor);
        Both "advanced-blend" (in TARGETS.advanced);
        Both "blend-constant" (.blend_constant);
        Both "write-mask" (in WRITE_MASK);
        Both "logic" (.logic) off LOGIC;
        Cases "second-target" (in SECOND_TARGET);
        Sequences "blend-second-target" (in SECOND_TARGET.blend);
        Sequences "write-mask-second-target" (in SECOND_TARGET.write_mask);
    }
    "cull" {
        Cases "cull" (= |before, draw| (draw.cull, draw.front_face) = (before.cull, before.front_face));
        Sequences "cull" (.cull);
        Sequences "front-face" (.front_face);
        Both "polygon-mode" (.polygon_mode);
        Both "rasterizer-discard" (.rasterizer_discard);
        Both "topology" (.topology);
    }
    "scissor" {
        Cases "viewport" (.viewport.rect);
        Sequences "viewport-rect" (.viewport.rect);
        Both "scissor" (.scissor) off SCISSOR;
    }
    "multisample" {
        Both "sample-mask" (.multisample.mask);
        Both "alpha-to-coverage" (.multisample.alpha_to_coverage);
        Both "alpha-to-one" (.multisample.alpha_to_one);
        Cases "min-sample-shading" (.multisample.min_sample_shading);
        Sequences "sample-shading" (.multisample.min_sample_shading);
        Both "sample-coverage" (.multisample.sample_coverage) off COVERAGE;
        Sequences "sample-coverage-value" (in SAMPLE_COVERAGE.value);
        Sequences "sample-coverage-invert" (in SAMPLE_COVERAGE.invert);
    }
    "sequence" {
        Sequences "indices" (.mesh.indices);
        Sequences "params-color" (.params.color);
        Sequences "params-back-color" (.params.back_color);
        Sequences "sampler-filter" (in SAMPLER.filter);
        Sequences "sampler-address-across" (in SAMPLER.address[0]);
        Sequences "sampler-address-down" (in SAMPLER.address[1]);
        // These fields are copied only if the scene remains valid.
        Sequences "shader" (= |before, draw| {
            let textures = before.shader.textures() == draw.shader.textures();
            if textures && before.shader.counts_runs() == draw.shader.counts_runs() {
                draw.shader = before.shader;
            }
        });
        Sequences "textures" (= |before, draw| {
            if before.textures.len() == draw.textures.len() {
                draw.textures.clone_from(&before.textures);
            }
        });
        Sequences "counters" (= |before, draw| {
            if before.shader.counts_runs() == draw.shader.counts_runs() {
                draw.counters.clone_from(&before.counters);
            }
        });
        Sequences "early-tests" (= |before, draw| {
            if !before.early_tests.is_conservative() || draw.shader.writes_depth() {
                draw.early_tests = before.early_tests;
            }
        });
    }
}
