//! The facts of a draw: its states that are not the defaults, those of its pass, and how its scene is drawn.
//!
//! Drivers break where two facts meet, so the suite counts in how many scenes each pair of them does.

use crate::excluded::ExcludedPair;
use etalon_case::Case;
use etalon_frame::{ChannelEncoding, PathValue, TextureFormat};
use etalon_scene::{
    BlendFactor, BlendState, CullMode, Draw, EarlyTests, Fetch, FilterMode, FrontFace, Pass,
    PolygonMode, PrimitiveTopology, Scene, Shader, Viewport,
};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::iter;
use std::sync::OnceLock;

/// A draw with what surrounds it.
#[derive(Clone, Copy)]
struct DrawPlace<'a> {
    scene: &'a Scene,
    pass: &'a Pass,
    draw: &'a Draw,
}

/// What a fact is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FactKind {
    /// A state of the draw or of its pass.
    State,
    /// The number of samples.
    Samples,
    /// The class of a format.
    Format,
    /// The topology.
    Topology,
    /// A value of the path.
    Path,
}

impl FactKind {
    /// Returns the name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::State => "state",
            Self::Samples => "samples",
            Self::Format => "format",
            Self::Topology => "topology",
            Self::Path => "path",
        }
    }
}

/// A fact that a draw can have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DrawFact {
    /// What it is about.
    pub kind: FactKind,
    /// Its name: `depth-clamp`, `samples=4`, `color=half-float`, `topology=line-list`, `path.end=blit`.
    pub name: String,
}

/// Decides whether a draw has a state.
#[derive(Clone, Copy)]
enum StateOf {
    /// The shader has it.
    Shader(fn(Shader) -> bool),
    /// The draw has it, with a shader that can have it.
    Both(fn(Shader) -> bool, fn(&DrawPlace<'_>) -> bool),
    /// The draw or its pass has it.
    Draw(fn(&DrawPlace<'_>) -> bool),
}
use StateOf::{Both as OfBoth, Draw as OfDraw, Shader as OfShader};

/// The state without which nothing of a draw shows.
const RASTERIZER_DISCARD: &str = "rasterizer-discard";

/// The states that are not the defaults.
const STATES: [(&str, StateOf); 58] = [
    ("depth-test", OfDraw(|p| p.draw.depth.is_some())),
    (
        "depth-write",
        OfDraw(|p| p.draw.depth.is_some_and(|d| d.write)),
    ),
    ("depth-clamp", OfDraw(|p| p.draw.depth_clamp)),
    (
        "depth-bias",
        OfDraw(|p| p.draw.depth_bias.constant != 0 || p.draw.depth_bias.slope != 0.0),
    ),
    (
        "depth-bias-clamp",
        OfDraw(|p| p.draw.depth_bias.clamp != 0.0),
    ),
    ("depth-bounds", OfDraw(|p| p.draw.depth_bounds.is_some())),
    ("written-depth", OfShader(Shader::writes_depth)),
    ("stencil-test", OfDraw(|p| p.draw.stencil.is_some())),
    (
        "stencil-by-face",
        OfDraw(|p| p.draw.stencil.is_some_and(|s| s.front != s.back)),
    ),
    (
        "stencil-masks",
        OfDraw(|p| {
            p.draw
                .stencil
                .is_some_and(|s| s.front.write_mask != 0xff || s.front.read_mask != 0xff)
        }),
    ),
    (
        "written-stencil-reference",
        OfShader(Shader::writes_reference),
    ),
    ("scissor", OfDraw(|p| p.draw.scissor.is_some())),
    (
        "viewport-part",
        OfDraw(|p| p.draw.viewport.area() != p.whole()),
    ),
    (
        "viewport-fractional",
        OfDraw(|p| p.draw.viewport.rect.iter().any(|v| v.fract() != 0.0)),
    ),
    (
        "viewport-mirrored",
        OfDraw(|p| p.draw.viewport.is_mirrored()),
    ),
    (
        "depth-range-part",
        OfDraw(|p| !matches!(p.draw.viewport.depth, [0.0, 1.0] | [1.0, 0.0])),
    ),
    ("depth-range-reversed", OfDraw(|p| p.has_reversed_range())),
    ("cull", OfDraw(|p| p.draw.cull != CullMode::None)),
    (
        "front-face-cw",
        OfDraw(|p| p.draw.front_face == FrontFace::Cw),
    ),
    (
        "polygon-mode-line",
        OfDraw(|p| p.draw.polygon_mode == PolygonMode::Line),
    ),
    (RASTERIZER_DISCARD, OfDraw(|p| p.draw.rasterizer_discard)),
    ("tessellation", OfDraw(|p| p.draw.tessellation.is_some())),
    (
        "provoking-vertex",
        OfBoth(
            |s| !s.passes_position_alone(),
            |p| p.draw.provoking.is_some(),
        ),
    ),
    ("indices", OfDraw(|p| p.draw.mesh.indices.is_some())),
    (
        "first-or-base-vertex",
        OfDraw(|p| {
            p.draw.fetch.first_vertex + p.draw.fetch.first_index > 0
                || p.draw.fetch.base_vertex != 0
        }),
    ),
    (
        "instances",
        OfDraw(|p| {
            p.draw.fetch.instances != Fetch::default().instances || p.draw.fetch.first_instance != 0
        }),
    ),
    (
        "clip-distances",
        OfBoth(
            |s| s.clip_distances() > 0,
            |p| p.draw.clipping_distances() != 0,
        ),
    ),
    ("cull-distances", OfShader(|s| s.cull_distances() > 0)),
    ("no-fragment-shader", OfShader(|s| !s.has_fragment())),
    (
        "early-tests-forced",
        OfDraw(|p| p.draw.early_tests != EarlyTests::Implicit),
    ),
    ("discard", OfShader(Shader::discards)),
    ("texture", OfShader(|s| s.textures() > 0)),
    (
        "linear-filter",
        OfBoth(Shader::samples_texture, |p| {
            p.draw
                .sampler
                .as_ref()
                .is_some_and(|s| s.filter == FilterMode::Linear)
        }),
    ),
    (
        "blend",
        OfDraw(|p| p.draw.targets.iter().any(|t| t.blend.is_some())),
    ),
    (
        "blend-alike",
        OfDraw(|p| p.has_blend(|b| b.color == b.alpha)),
    ),
    (
        "blend-apart",
        OfDraw(|p| p.has_blend(|b| b.color != b.alpha)),
    ),
    (
        "blend-constant",
        OfDraw(|p| p.has_factor(BlendFactor::is_constant)),
    ),
    ("dual-source", OfShader(Shader::has_second_source)),
    (
        "advanced-blend",
        OfDraw(|p| p.draw.targets.iter().any(|t| t.advanced.is_some())),
    ),
    ("logic-operation", OfDraw(|p| p.draw.logic.is_some())),
    (
        "write-mask-part",
        OfDraw(|p| {
            p.draw
                .targets
                .iter()
                .any(|t| !matches!(t.write_mask, 0 | 0b1111))
        }),
    ),
    (
        "write-mask-none",
        OfDraw(|p| p.draw.targets.iter().any(|t| t.write_mask == 0)),
    ),
    (
        "alpha-to-coverage",
        OfDraw(|p| p.draw.multisample.alpha_to_coverage),
    ),
    ("alpha-to-one", OfDraw(|p| p.draw.multisample.alpha_to_one)),
    (
        "sample-mask",
        OfDraw(|p| {
            p.draw.multisample.mask != u32::MAX || p.draw.multisample.sample_coverage.is_some()
        }),
    ),
    ("written-sample-mask", OfShader(Shader::writes_mask)),
    (
        "sample-shading",
        OfDraw(|p| {
            p.draw.multisample.min_sample_shading.is_some() || p.draw.shader.runs_per_sample()
        }),
    ),
    ("counters", OfDraw(|p| !p.draw.counters.is_empty())),
    ("pool", OfShader(Shader::uses_pool)),
    (
        "several-targets",
        OfBoth(|s| s.outputs() != 1, |p| p.pass.color.len() > 1),
    ),
    ("no-color", OfDraw(|p| p.pass.color.is_empty())),
    (
        "resolve",
        OfDraw(|p| p.pass.resolve.iter().any(Option::is_some)),
    ),
    (
        "depth-stencil-resolve",
        OfDraw(|p| p.pass.depth_stencil_resolve.is_some()),
    ),
    (
        "depth-stencil-read-only",
        OfDraw(|p| p.pass.depth_stencil_read_only),
    ),
    ("load-clear", OfDraw(|p| !p.pass.cleared().is_empty())),
    ("store-discard", OfDraw(|p| !p.pass.discarded().is_empty())),
    ("clear-command", OfDraw(|p| !p.pass.clears.is_empty())),
    (
        "clear-command-part",
        OfDraw(|p| {
            p.pass
                .clears
                .iter()
                .any(|clear| clear.rect.is_some() || clear.target.is_masked())
        }),
    ),
];

impl DrawPlace<'_> {
    fn whole(&self) -> [f32; 4] {
        Viewport::whole(self.scene.pass_size(self.pass)).area()
    }

    fn has_reversed_range(&self) -> bool {
        self.draw.viewport.depth[0] > self.draw.viewport.depth[1]
    }

    fn has_blend(&self, is: impl Fn(&BlendState) -> bool) -> bool {
        self.draw
            .targets
            .iter()
            .filter_map(|t| t.blend.as_ref())
            .any(is)
    }

    fn has_factor(&self, is: impl Fn(BlendFactor) -> bool) -> bool {
        self.has_blend(|b| {
            [b.color, b.alpha]
                .iter()
                .any(|c| is(c.src_factor) || is(c.dst_factor))
        })
    }

    /// Returns the names of its facts other than states.
    fn others(&self) -> Vec<String> {
        let format = |index: &usize| self.scene.attachments.get(*index).map(|a| a.format);
        let targets = self.pass.color.iter().chain(&self.pass.depth_stencil);
        let mut names: Vec<String> = targets.filter_map(format).map(format_fact).collect();
        let samples = self.scene.pass_samples(self.pass);
        names.push(named("samples", &samples.to_string()));
        names.push(named("topology", self.draw.topology.name()));
        names.extend(self.scene.path.values().into_iter().map(of_path));
        names
    }
}

fn named(key: &str, value: &str) -> String {
    format!("{key}={value}")
}

fn of_path(value: PathValue) -> String {
    format!("path.{}={}", value.key(), value.name())
}

/// Returns the fact of a draw into an attachment of a format: `color=packed`, `depth=depth16unorm`.
pub fn format_fact(format: TextureFormat) -> String {
    if format.is_color() {
        named("color", color_class(format))
    } else {
        named("depth", format.name())
    }
}

/// The facts that even the plainest draw has.
pub const PLAIN_FACTS: [&str; 3] = ["color=unorm8", "samples=1", "topology=triangle-list"];

/// Returns the class of a colour format: the formats of a class have the same rules.
fn color_class(format: TextureFormat) -> &'static str {
    match format {
        TextureFormat::Bgra8Unorm => "bgra",
        _ => match format.color_channels().first() {
            Some(ChannelEncoding::Srgb8) => "srgb",
            Some(ChannelEncoding::Unorm(8)) => "unorm8",
            Some(ChannelEncoding::Unorm(16)) => "unorm16",
            Some(ChannelEncoding::Unorm(1..8)) => "packed-16",
            Some(ChannelEncoding::Unorm(_)) => "packed",
            Some(ChannelEncoding::Ufloat(_)) => "packed-float",
            Some(ChannelEncoding::Snorm(_)) => "snorm",
            Some(ChannelEncoding::Float16) => "half-float",
            Some(ChannelEncoding::Float32) => "float",
            Some(ChannelEncoding::Uint(_)) | None => "uint",
        },
    }
}

/// All facts that draws can have, by number.
#[derive(Clone, Debug)]
struct Facts {
    facts: Vec<DrawFact>,
    numbers: HashMap<String, usize>,
}

impl Default for Facts {
    fn default() -> Self {
        let states = STATES
            .iter()
            .map(|(name, _)| (FactKind::State, (*name).to_owned()));
        let samples =
            [1, 2, 4, 8, 16].map(|n| (FactKind::Samples, named("samples", &n.to_string())));
        let classes: BTreeSet<&str> = TextureFormat::ALL
            .into_iter()
            .filter(|f| f.is_color())
            .map(color_class)
            .collect();
        let classes = classes
            .into_iter()
            .map(|class| (FactKind::Format, named("color", class)));
        let depths = TextureFormat::ALL.into_iter().filter(|f| !f.is_color());
        let depths = depths.map(|format| (FactKind::Format, named("depth", format.name())));
        let topologies = PrimitiveTopology::ALL.iter();
        let topologies = topologies.map(|t| (FactKind::Topology, named("topology", t.name())));
        let paths = PathValue::all()
            .into_iter()
            .map(|value| (FactKind::Path, of_path(value)));
        let all = states
            .chain(samples)
            .chain(classes)
            .chain(depths)
            .chain(topologies)
            .chain(paths);
        let facts: Vec<DrawFact> = all.map(|(kind, name)| DrawFact { kind, name }).collect();
        let numbers = facts
            .iter()
            .enumerate()
            .map(|(number, fact)| (fact.name.clone(), number))
            .collect();
        Self { facts, numbers }
    }
}

impl Facts {
    /// Returns the numbers of the facts of each draw of a scene, in ascending order.
    fn of(&self, scene: &Scene) -> Vec<Vec<usize>> {
        let places = scene.passes.iter().flat_map(|pass| {
            let draws = pass.draws.iter();
            draws.map(move |draw| DrawPlace { scene, pass, draw })
        });
        let of_draw = |place: DrawPlace<'_>| {
            let states = (0..STATES.len()).filter(|i| match STATES[*i].1 {
                OfShader(is) => is(place.draw.shader),
                OfBoth(_, is) | OfDraw(is) => is(&place),
            });
            let others = place.others();
            let others = others
                .iter()
                .filter_map(|name| self.numbers.get(name).copied());
            let mut numbers: Vec<usize> = states.chain(others).collect();
            numbers.sort_unstable();
            numbers.dedup();
            numbers
        };
        places.map(of_draw).collect()
    }

    /// Returns true if the scene model can say two facts together: no draw has two topologies, and no shader has
    /// everything that shaders can do.
    fn can_meet(&self, a: usize, b: usize) -> bool {
        let key = |number: usize| self.facts[number].name.split_once('=').map(|(key, _)| key);
        // A pass has one format of depth, but several of colour.
        let is_same_choice = key(a).is_some_and(|of_a| of_a != "color" && key(b) == Some(of_a));
        let of_shader = |number: usize| match STATES.get(number) {
            Some((_, OfShader(is) | OfBoth(is, _))) => Some(*is),
            _ => None,
        };
        let by_shader = match (of_shader(a), of_shader(b)) {
            (Some(a), Some(b)) => Shader::ALL.iter().any(|shader| a(*shader) && b(*shader)),
            _ => true,
        };
        a != b && !is_same_choice && by_shader
    }
}

/// Returns the names of all facts that draws can have.
pub fn fact_names() -> impl Iterator<Item = String> {
    Facts::default().facts.into_iter().map(|fact| fact.name)
}

/// Returns the names of the facts of each draw of a case's scenes.
pub fn draw_facts(case: &Case) -> Vec<Vec<String>> {
    let facts = Facts::default();
    let name = |number: usize| facts.facts[number].name.clone();
    let variants = case.variants.iter().map(|variant| &variant.scene);
    let draws = iter::once(&case.scene)
        .chain(variants)
        .flat_map(|scene| facts.of(scene));
    draws
        .map(|numbers| numbers.into_iter().map(name).collect())
        .collect()
}

/// Returns the names of the facts of each draw of a case's scenes. A case without draws has those of its attachments and
/// of its path.
pub fn case_facts(case: &Case) -> Vec<Vec<String>> {
    let draws = draw_facts(case);
    if !draws.is_empty() {
        return draws;
    }
    let scene = &case.scene;
    let of_attachments = scene.attachments.iter().flat_map(|attachment| {
        let samples = named("samples", &attachment.samples.to_string());
        [format_fact(attachment.format), samples]
    });
    let of_path = scene.path.values().into_iter().map(of_path);
    let facts: BTreeSet<String> = of_attachments.chain(of_path).collect();
    vec![facts.into_iter().collect()]
}

/// Two facts that the scene model can say together.
#[derive(Clone, Copy, Debug)]
pub struct FactPair<'a> {
    /// The facts.
    pub facts: [&'a DrawFact; 2],
    /// The number of scenes that have a draw with both.
    pub scenes: u64,
    /// True if `cases/pairs.txt` says that they cannot meet.
    pub is_excluded: bool,
}

/// In how many scenes two facts meet in a draw.
#[derive(Clone, Debug)]
pub struct FactPairs {
    facts: Facts,
    /// The number of scenes, by the numbers of both facts, the greater one first.
    scenes: Vec<Vec<u64>>,
}

impl Default for FactPairs {
    fn default() -> Self {
        let facts = Facts::default();
        let scenes = (0..facts.facts.len())
            .map(|number| vec![0; number])
            .collect();
        Self { facts, scenes }
    }
}

impl FactPairs {
    /// Adds the pairs of a scene.
    pub fn add(&mut self, scene: &Scene) {
        for (greater, lesser) in self.met_in(scene) {
            self.scenes[greater][lesser] += 1;
        }
    }

    /// Adds the pairs that were counted elsewhere.
    pub fn add_all(&mut self, other: &Self) {
        let counts = self.scenes.iter_mut().flatten();
        for (count, more) in counts.zip(other.scenes.iter().flatten()) {
            *count += more;
        }
    }

    /// Returns the pairs that the scene model can say, each with the number of scenes that have it.
    pub fn pairs(&self) -> impl Iterator<Item = FactPair<'_>> {
        self.numbers().map(|[a, b]| self.pair(b, a))
    }

    /// Returns the number of scenes that have a draw with two facts, by their names.
    pub fn scenes(&self, names: [&str; 2]) -> u64 {
        let [a, b] = names.map(|name| self.facts.numbers.get(name).copied());
        let (Some(a), Some(b)) = (a, b) else { return 0 };
        let row = self.scenes.get(a.max(b));
        row.and_then(|row| row.get(a.min(b))).copied().unwrap_or(0)
    }

    /// Returns the pairs of a scene that no scene had so far, though they can meet.
    pub fn missing_in(&self, scene: &Scene) -> Vec<FactPair<'_>> {
        let met = self.met_in(scene).into_iter();
        met.map(|(greater, lesser)| self.pair(greater, lesser))
            .filter(|pair| pair.scenes == 0 && !pair.is_excluded)
            .collect()
    }

    /// Returns the facts of the draws of a scene.
    pub fn facts_of(&self, scene: &Scene) -> BTreeSet<&str> {
        let numbers = self.facts.of(scene).into_iter().flatten();
        numbers.map(|n| self.facts.facts[n].name.as_str()).collect()
    }

    fn pair(&self, greater: usize, lesser: usize) -> FactPair<'_> {
        FactPair {
            facts: [lesser, greater].map(|n| &self.facts.facts[n]),
            scenes: self.scenes[greater][lesser],
            is_excluded: self.excluded().contains(&(greater, lesser)),
        }
    }

    /// Returns the numbers of the pairs that cannot meet, the greater one first. They are the same in a whole process,
    /// and a count of many files asks for them once.
    fn excluded(&self) -> &'static HashSet<(usize, usize)> {
        static EXCLUDED: OnceLock<HashSet<(usize, usize)>> = OnceLock::new();
        EXCLUDED.get_or_init(|| {
            let all = ExcludedPair::all();
            let is_named = |[a, b]: &[usize; 2]| {
                let facts = [*a, *b].map(|n| self.facts.facts[n].name.as_str());
                all.iter().any(|e| e.names(facts))
            };
            let named = self.numbers().filter(is_named);
            named.map(|[a, b]| (b, a)).collect()
        })
    }

    /// Returns the numbers of the pairs that the scene model can say, the lesser one first.
    fn numbers(&self) -> impl Iterator<Item = [usize; 2]> {
        let all =
            (0..self.scenes.len()).flat_map(|a| (a + 1..self.scenes.len()).map(move |b| [a, b]));
        all.filter(|[a, b]| self.facts.can_meet(*a, *b))
    }

    /// Returns the numbers of the pairs that a scene has, the greater one first.
    /// Returns the pairs that a scene has, as the numbers of their facts, the greater one first.
    pub fn met_in(&self, scene: &Scene) -> BTreeSet<(usize, usize)> {
        let mut met = BTreeSet::new();
        let discard = self.facts.numbers.get(RASTERIZER_DISCARD);
        for facts in self.facts.of(scene) {
            let is_discarded = discard.is_some_and(|discard| facts.contains(discard));
            for (place, greater) in facts.iter().enumerate() {
                let pairs = facts[..place].iter().map(|lesser| (*greater, *lesser));
                // What would have been drawn shows nothing of two other facts.
                met.extend(pairs.filter(|(a, b)| {
                    !is_discarded || [a, b].into_iter().any(|n| Some(n) == discard)
                }));
            }
        }
        met
    }
}
