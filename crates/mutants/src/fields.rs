//! The fields of a draw: where they stand, which of them may be stale, and the neighbours of their values.

use etalon_scene::{
    BlendComponent, BlendFactor, BlendState, ColorTarget, CompareFunction, CullMode, DepthBias,
    DepthState, Draw, EarlyTests, FrontFace, PrimitiveTopology, SampleCoverage, Sampler,
    StencilFace, StencilOperation, StencilState,
};
use std::sync::Arc;

/// The places of a field in a draw: none where it is off, several where each face or target has its own.
pub(super) type Places<T> = for<'a> fn(&'a mut Draw) -> Vec<&'a mut T>;

pub(super) const DEPTH: Places<Option<DepthState>> = |d| vec![&mut d.depth];
pub(super) const DEPTH_COMPARE: Places<CompareFunction> =
    |d| d.depth.iter_mut().map(|s| &mut s.compare).collect();
pub(super) const DEPTH_WRITE: Places<bool> = |d| d.depth.iter_mut().map(|s| &mut s.write).collect();
pub(super) const DEPTH_BIAS: Places<DepthBias> = |d| vec![&mut d.depth_bias];
pub(super) const STENCIL_TEST: Places<Option<StencilState>> = |d| vec![&mut d.stencil];
pub(super) const STENCIL: Places<StencilState> = |d| d.stencil.iter_mut().collect();
pub(super) const FACES: Places<StencilFace> = |d| {
    let states = d.stencil.iter_mut();
    states.flat_map(|s| [&mut s.front, &mut s.back]).collect()
};
pub(super) const STENCIL_COMPARE: Places<CompareFunction> =
    |d| FACES(d).into_iter().map(|f| &mut f.compare).collect();
pub(super) const STENCIL_OPERATIONS: Places<StencilOperation> = |d| {
    let faces = FACES(d).into_iter();
    faces
        .flat_map(|f| [&mut f.fail_op, &mut f.depth_fail_op, &mut f.pass_op])
        .collect()
};
pub(super) const STENCIL_WRITE_MASK: Places<u8> =
    |d| FACES(d).into_iter().map(|f| &mut f.write_mask).collect();
pub(super) const TARGETS: Places<ColorTarget> = |d| d.targets.iter_mut().collect();
pub(super) const BLEND: Places<Option<BlendState>> =
    |d| d.targets.iter_mut().map(|t| &mut t.blend).collect();
pub(super) const EQUATIONS: Places<BlendState> =
    |d| d.targets.iter_mut().flat_map(|t| &mut t.blend).collect();
pub(super) const COLOR_EQUATION: Places<BlendComponent> =
    |d| EQUATIONS(d).into_iter().map(|b| &mut b.color).collect();
pub(super) const ALPHA_EQUATION: Places<BlendComponent> =
    |d| EQUATIONS(d).into_iter().map(|b| &mut b.alpha).collect();
pub(super) const COLOR_FACTORS: Places<BlendFactor> =
    |d| COLOR_EQUATION(d).into_iter().flat_map(factors).collect();
pub(super) const ALPHA_FACTORS: Places<BlendFactor> =
    |d| ALPHA_EQUATION(d).into_iter().flat_map(factors).collect();
pub(super) const WRITE_MASK: Places<u8> =
    |d| d.targets.iter_mut().map(|t| &mut t.write_mask).collect();
pub(super) const SAMPLER: Places<Sampler> = |d| d.sampler.iter_mut().collect();
pub(super) const CULL: Places<CullMode> = |d| vec![&mut d.cull];
pub(super) const FRONT_FACE: Places<FrontFace> = |d| vec![&mut d.front_face];
pub(super) const TOPOLOGY: Places<PrimitiveTopology> = |d| vec![&mut d.topology];
pub(super) const EARLY_TESTS: Places<EarlyTests> = |d| vec![&mut d.early_tests];
pub(super) const SAMPLE_COVERAGE: Places<SampleCoverage> =
    |d| d.multisample.sample_coverage.iter_mut().collect();

fn factors(component: &mut BlendComponent) -> [&mut BlendFactor; 2] {
    [&mut component.src_factor, &mut component.dst_factor]
}

/// Takes a field over from another draw.
pub(super) type Take = Arc<dyn Fn(&Draw, &mut Draw) + Send + Sync>;

/// A field that may be stale.
pub(super) struct Field {
    pub(super) name: String,
    /// The area of cases that follow each other with other values of it, if some do.
    pub(super) area: Option<&'static str>,
    /// True if cases of the area `sequence` change it between draws and between passes.
    pub(super) in_sequences: bool,
    /// True if it is taken over by draws that have it switched off, and by no others.
    pub(super) when_off: bool,
    pub(super) take: Take,
}

impl Field {
    /// The name in a sentence.
    pub(super) fn words(&self) -> String {
        self.name.replace('-', " ")
    }
}

/// Fields while a table lists them, and the area of the next.
#[derive(Default)]
struct Table {
    area: &'static str,
    fields: Vec<Field>,
}

/// A field of which the places are not told yet.
struct Entry<'a> {
    table: &'a mut Table,
    name: String,
    area: Option<&'static str>,
    in_sequences: bool,
}

impl Table {
    fn entry(&mut self, name: &str, in_cases: bool, in_sequences: bool) -> Entry<'_> {
        Entry {
            name: name.to_owned(),
            area: in_cases.then_some(self.area),
            in_sequences,
            table: self,
        }
    }

    /// A field that is stale between cases, and in sequences.
    fn both(&mut self, name: &str) -> Entry<'_> {
        self.entry(name, true, true)
    }

    /// A field that is stale between cases.
    fn cases(&mut self, name: &str) -> Entry<'_> {
        self.entry(name, true, false)
    }

    /// A field that is stale in sequences.
    fn sequences(&mut self, name: &str) -> Entry<'_> {
        self.entry(name, false, true)
    }
}

impl Entry<'_> {
    fn take(self, take: impl Fn(&Draw, &mut Draw) + Send + Sync + 'static) {
        self.table.fields.push(Field {
            name: self.name,
            area: self.area,
            in_sequences: self.in_sequences,
            when_off: false,
            take: Arc::new(take),
        });
    }

    fn part<T: 'static>(
        self,
        places: Places<T>,
        part: impl Fn(&mut T, &T) + Send + Sync + 'static,
    ) {
        self.take(move |before, draw| {
            let mut before = before.clone();
            for (to, from) in places(draw).into_iter().zip(places(&mut before)) {
                part(to, from);
            }
        });
    }

    fn at<T: Clone + 'static>(self, places: Places<T>) {
        self.part(places, T::clone_from);
    }

    /// A field that has a value which switches it off, the default one.
    fn switch<T: Clone + Default + PartialEq + 'static>(self, places: Places<T>) {
        let (table, area) = (self.table, self.area);
        let name = self.name.clone();
        let in_sequences = self.in_sequences;
        Entry {
            table: &mut *table,
            name,
            area,
            in_sequences,
        }
        .at(places);
        let (name, in_sequences) = (self.name, false);
        Entry {
            table: &mut *table,
            name,
            area,
            in_sequences,
        }
        .part(places, |to, from| {
            if *to == T::default() {
                to.clone_from(from);
            }
        });
        if let Some(off) = table.fields.last_mut() {
            off.when_off = true;
        }
    }
}

/// Takes over a part of the state of a stencil face.
type FacePart = fn(&mut StencilFace, &StencilFace);

/// The parts of the state of a stencil face.
pub(super) const FACE_PARTS: [(&str, FacePart); 7] = [
    ("compare", |to, from| to.compare = from.compare),
    ("fail-op", |to, from| to.fail_op = from.fail_op),
    ("depth-fail-op", |to, from| {
        to.depth_fail_op = from.depth_fail_op
    }),
    ("pass-op", |to, from| to.pass_op = from.pass_op),
    ("reference", |to, from| to.reference = from.reference),
    ("read-mask", |to, from| to.read_mask = from.read_mask),
    ("write-mask", |to, from| to.write_mask = from.write_mask),
];

/// Returns the fields that may be stale.
pub(super) fn fields() -> Vec<Field> {
    let mut table = Table::default();
    tests(&mut table);
    stencil(&mut table);
    colors(&mut table);
    rasterization(&mut table);
    inputs(&mut table);
    table.fields
}

fn tests(table: &mut Table) {
    table.area = "depth";
    table.both("depth-test").switch(DEPTH);
    table.both("depth-compare").at(DEPTH_COMPARE);
    table.both("depth-write").at(DEPTH_WRITE);
    table.cases("depth-bias").switch(DEPTH_BIAS);
    table
        .sequences("depth-bias-constant")
        .at(|d| vec![&mut d.depth_bias.constant]);
    table
        .sequences("depth-bias-slope")
        .at(|d| vec![&mut d.depth_bias.slope]);
    table
        .sequences("depth-bias-clamp")
        .at(|d| vec![&mut d.depth_bias.clamp]);
    table.both("depth-clamp").at(|d| vec![&mut d.depth_clamp]);
    table
        .both("depth-bounds")
        .switch(|d| vec![&mut d.depth_bounds]);
    table
        .cases("depth-range")
        .at(|d| vec![&mut d.viewport.depth]);
    table
        .sequences("viewport-depth")
        .at(|d| vec![&mut d.viewport.depth]);
}

fn stencil(table: &mut Table) {
    table.area = "stencil";
    table.cases("stencil").switch(STENCIL_TEST);
    table.sequences("stencil-test").at(STENCIL_TEST);
    table.cases("stencil-operations").at(STENCIL_OPERATIONS);
    for (name, part) in FACE_PARTS {
        let front: Places<StencilFace> = |d| d.stencil.iter_mut().map(|s| &mut s.front).collect();
        let back: Places<StencilFace> = |d| d.stencil.iter_mut().map(|s| &mut s.back).collect();
        table
            .sequences(&format!("stencil-front-{name}"))
            .part(front, part);
        table
            .sequences(&format!("stencil-back-{name}"))
            .part(back, part);
        let name = format!("stencil-{name}");
        match &*name {
            "stencil-read-mask" => table.sequences(&name).part(FACES, part),
            "stencil-reference" | "stencil-write-mask" => table.both(&name).part(FACES, part),
            _ => {}
        }
    }
}

fn colors(table: &mut Table) {
    table.area = "blend";
    table.both("blend").switch(BLEND);
    type Part = fn(&mut BlendState, &BlendState);
    let parts: [(&str, Part); 6] = [
        ("color-operation", |to, from| {
            to.color.operation = from.color.operation
        }),
        ("color-src-factor", |to, from| {
            to.color.src_factor = from.color.src_factor
        }),
        ("color-dst-factor", |to, from| {
            to.color.dst_factor = from.color.dst_factor
        }),
        ("alpha-operation", |to, from| {
            to.alpha.operation = from.alpha.operation
        }),
        ("alpha-src-factor", |to, from| {
            to.alpha.src_factor = from.alpha.src_factor
        }),
        ("alpha-dst-factor", |to, from| {
            to.alpha.dst_factor = from.alpha.dst_factor
        }),
    ];
    for (name, part) in parts {
        table
            .sequences(&format!("blend-{name}"))
            .part(TARGETS, move |to, from| {
                if let (Some(to), Some(from)) = (&mut to.blend, &from.blend) {
                    part(to, from);
                }
            });
    }
    table
        .both("advanced-blend")
        .at(|d| d.targets.iter_mut().map(|t| &mut t.advanced).collect());
    table
        .both("blend-constant")
        .at(|d| vec![&mut d.blend_constant]);
    table.both("write-mask").at(WRITE_MASK);
    table.both("logic").switch(|d| vec![&mut d.logic]);
    let second: Places<ColorTarget> = |d| d.targets.iter_mut().skip(1).take(1).collect();
    table.cases("second-target").at(second);
    table
        .sequences("blend-second-target")
        .part(second, |to, from| to.blend = from.blend);
    table
        .sequences("write-mask-second-target")
        .part(second, |to, from| to.write_mask = from.write_mask);
}

fn rasterization(table: &mut Table) {
    table.area = "cull";
    table.cases("cull").take(|before, draw| {
        draw.cull = before.cull;
        draw.front_face = before.front_face;
    });
    table.sequences("cull").at(CULL);
    table.sequences("front-face").at(FRONT_FACE);
    table.both("polygon-mode").at(|d| vec![&mut d.polygon_mode]);
    table
        .both("rasterizer-discard")
        .at(|d| vec![&mut d.rasterizer_discard]);
    table.both("topology").at(TOPOLOGY);
    table.area = "scissor";
    table.cases("viewport").at(|d| vec![&mut d.viewport.rect]);
    table
        .sequences("viewport-rect")
        .at(|d| vec![&mut d.viewport.rect]);
    table.both("scissor").switch(|d| vec![&mut d.scissor]);
    table.area = "multisample";
    table
        .both("sample-mask")
        .at(|d| vec![&mut d.multisample.mask]);
    table
        .both("alpha-to-coverage")
        .at(|d| vec![&mut d.multisample.alpha_to_coverage]);
    table
        .both("alpha-to-one")
        .at(|d| vec![&mut d.multisample.alpha_to_one]);
    table
        .cases("min-sample-shading")
        .at(|d| vec![&mut d.multisample.min_sample_shading]);
    table
        .sequences("sample-shading")
        .at(|d| vec![&mut d.multisample.min_sample_shading]);
    table
        .both("sample-coverage")
        .switch(|d| vec![&mut d.multisample.sample_coverage]);
    table
        .sequences("sample-coverage-value")
        .part(SAMPLE_COVERAGE, |to, from| to.value = from.value);
    table
        .sequences("sample-coverage-invert")
        .part(SAMPLE_COVERAGE, |to, from| to.invert = from.invert);
}

fn inputs(table: &mut Table) {
    table.sequences("indices").at(|d| vec![&mut d.mesh.indices]);
    table
        .sequences("params-color")
        .at(|d| vec![&mut d.params.color]);
    table
        .sequences("params-back-color")
        .at(|d| vec![&mut d.params.back_color]);
    table
        .sequences("sampler-filter")
        .part(SAMPLER, |to, from| to.filter = from.filter);
    table
        .sequences("sampler-address-across")
        .part(SAMPLER, |to, from| to.address[0] = from.address[0]);
    table
        .sequences("sampler-address-down")
        .part(SAMPLER, |to, from| to.address[1] = from.address[1]);
    // What follows is taken over where the scene stays one that a driver could be asked for.
    table.sequences("shader").take(|before, draw| {
        let textures = before.shader.textures() == draw.shader.textures();
        if textures && before.shader.counts_runs() == draw.shader.counts_runs() {
            draw.shader = before.shader;
        }
    });
    table.sequences("textures").take(|before, draw| {
        if before.textures.len() == draw.textures.len() {
            draw.textures.clone_from(&before.textures);
        }
    });
    table.sequences("counters").take(|before, draw| {
        if before.shader.counts_runs() == draw.shader.counts_runs() {
            draw.counters.clone_from(&before.counters);
        }
    });
    table.sequences("early-tests").take(|before, draw| {
        if !before.early_tests.is_conservative() || draw.shader.writes_depth() {
            draw.early_tests = before.early_tests;
        }
    });
}
