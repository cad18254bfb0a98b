//! The choice of kernels, made once per draw when a scene is prepared.

use super::resolve::ColorResolve;
use crate::lanes::LANES;
use crate::linear::UNITS;
use crate::raster::bounds;
use crate::steps::{Faithful, Steps};
use crate::surface::depth_encoding;
use etalon_frame::{ChannelEncoding, standard_sample_positions};
use etalon_pipeline::shader::KeepCondition;
use etalon_pipeline::{Arithmetic, Plain, takes_logic, window_position};
use etalon_scene::{
    AddressMode, ColorTarget, DepthState, Draw, EarlyTests, FilterMode, Mesh, Multisample, Pass,
    PolygonMode, PrimitiveTopology, PrimitiveVertices, ProvokingVertex, RESTART, Scene, Shader,
    StencilState, Vertex,
};

/// The largest distance of a vertex from the window's corner in texels. Beyond it, the kernels' integers
/// overflow.
const FARTHEST: f32 = 16384.0;

/// The kernels of a scene.
#[derive(Debug)]
pub(crate) struct KernelPlan {
    pub(crate) passes: Vec<PassKernels>,
}

/// The kernels of a pass.
#[derive(Debug)]
pub(crate) struct PassKernels {
    /// The colour attachment.
    pub(crate) color: Option<usize>,
    /// The attachment that the colour attachment is resolved to, and how.
    pub(crate) resolve: Option<(usize, ColorResolve)>,
    /// The depth-stencil attachment.
    pub(crate) depth_stencil: Option<usize>,
    pub(crate) size: [usize; 2],
    /// The positions of samples in a texel, in sub-texel units.
    pub(crate) positions: Vec<[i32; 2]>,
    /// The channels of the colour attachment.
    pub(crate) channels: &'static [ChannelEncoding],
    /// True if logic operations apply to the colour attachment.
    pub(crate) logic: bool,
    /// The colour attachments after the first.
    pub(crate) others: Vec<TargetPlan>,
    pub(crate) depth: Option<ChannelEncoding>,
    pub(crate) draws: Vec<DrawKernels>,
}

/// A colour attachment of a pass.
#[derive(Debug)]
pub(crate) struct TargetPlan {
    pub(crate) index: usize,
    pub(crate) channels: &'static [ChannelEncoding],
    /// True if logic operations apply to the attachment.
    pub(crate) logic: bool,
}

/// The kernels of a draw.
#[derive(Debug)]
pub(crate) struct DrawKernels {
    /// The index of the draw in the pass.
    pub(crate) index: usize,
    pub(crate) shading: Shading,
    /// The left, top, right and bottom edges of the texels whose sample can be written, one rectangle per
    /// sample. Right and bottom are exclusive.
    pub(crate) rects: Vec<[i32; 4]>,
    /// The smallest rectangle that contains all of them.
    pub(crate) bounds: [i32; 4],
    pub(crate) depth: Option<DepthState>,
    pub(crate) stencil: Option<StencilState>,
    /// True if whole triangles might be in front of the near plane or behind the far plane, and are then not
    /// drawn.
    pub(crate) rejects: bool,
    /// The runs of whole triangles whose first vertex is the provoking vertex; `None` if the topology is not
    /// such a list.
    pub(crate) runs: Option<Vec<PrimitiveRun>>,
}

/// Consecutive primitives of a list, up to a restart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PrimitiveRun {
    /// The number of the run's first primitive.
    pub(crate) first: usize,
    /// The number of primitives.
    pub(crate) count: usize,
    /// The index of the first vertex or index.
    pub(crate) at: usize,
}

impl PrimitiveRun {
    /// Returns the runs of a list.
    fn all(mesh: &Mesh) -> Vec<Self> {
        let Some(indices) = &mesh.indices else {
            let count = mesh.vertices.len() / 3;
            return vec![Self {
                first: 0,
                count,
                at: 0,
            }];
        };
        let (mut first, mut start) = (0, 0);
        let runs = indices.split(|i| *i == RESTART).map(|run| {
            let count = run.len() / 3;
            let this = Self {
                first,
                count,
                at: start,
            };
            first += count;
            start += run.len() + 1;
            this
        });
        runs.collect()
    }
}

/// The source of a triangle's colour, which is constant over the triangle unless it comes from a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shading {
    /// The provoking vertex's colour.
    Vertex,
    /// The provoking vertex's colour, after this many steps of work for each texel.
    Expensive(f32),
    /// The provoking vertex's colour, unless its alpha is below a limit; then nothing is drawn.
    Kept(f32),
    /// The first colour of the parameters, at the depth that the provoking vertex's red gives.
    Depth,
    /// The first or second colour of the parameters, depending on the facing.
    Facing,
    /// The first colour of the parameters.
    Uniform,
    /// No source; the colour is zeros.
    Nothing,
    /// The texels of one or two textures at the position that is drawn.
    Texels(FetchedTexture, Option<FetchedTexture>),
    /// The nearest texels of a texture that has the attachment's format.
    Texture {
        /// The texture's attachment.
        index: usize,
        address: [AddressMode; 2],
        /// The least alpha that is not discarded; 256 if all texels are discarded.
        kept: u32,
    },
}

/// A texture whose texels are fetched at the position that is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FetchedTexture {
    /// The texture's attachment.
    pub(crate) index: usize,
    pub(crate) channels: &'static [ChannelEncoding],
}

/// The reason why a scene has no kernels.
pub(crate) type NoKernels = &'static str;

impl KernelPlan {
    /// Returns the kernels of a scene whose largest picture has at least `least` texels, or the reason why it
    /// has no kernels.
    pub(crate) fn new(scene: &Scene, least: usize) -> Result<Self, NoKernels> {
        if scene.pool.is_some() {
            return Err("a pool");
        }
        let largest = scene.attachments.iter().map(|a| a.size[0] * a.size[1]);
        if (largest.max().unwrap_or(0) as usize) < least {
            return Err("a small picture");
        }
        let passes = scene
            .passes
            .iter()
            .map(|pass| PassKernels::new(scene, pass));
        Ok(Self {
            passes: passes.collect::<Result<_, _>>()?,
        })
    }
}

impl PassKernels {
    fn new(scene: &Scene, pass: &Pass) -> Result<Self, NoKernels> {
        if pass.resolve.iter().skip(1).any(Option::is_some) {
            return Err("a resolve of several colour attachments");
        }
        if pass.depth_stencil_resolve.is_some() {
            return Err("a resolve of depth or stencil");
        }
        if !pass.clears.is_empty() {
            return Err("clear commands");
        }
        if pass.reads_itself() {
            return Err("an attachment of the pass as texture");
        }
        let color = pass.color.first().copied();
        let size = scene.pass_size(pass);
        let positions = standard_sample_positions(scene.pass_samples(pass));
        let format = |index: usize| scene.attachments[index].format;
        let target = |index: usize| TargetPlan {
            index,
            channels: format(index).color_channels(),
            logic: takes_logic(format(index)),
        };
        let depth_stencil = pass.depth_stencil;
        let channels = color.map_or(&[][..], |i| format(i).color_channels());
        let resolve = pass.resolve.first().copied().flatten();
        let mut plan = Self {
            color,
            resolve: resolve.map(|i| (i, ColorResolve::new(channels, positions.len()))),
            depth_stencil,
            size: size.map(|s| s as usize),
            positions: positions
                .into_iter()
                .map(|p| p.map(|v| i32::from(v) * UNITS as i32 / 256))
                .collect(),
            channels,
            logic: color.is_some_and(|i| takes_logic(format(i))),
            others: pass.color.iter().skip(1).map(|i| target(*i)).collect(),
            depth: depth_stencil.and_then(|i| depth_encoding(format(i))),
            draws: Vec::new(),
        };
        let stencil = depth_stencil.is_some_and(|i| format(i).has_stencil());
        for (index, draw) in pass.draws.iter().enumerate() {
            if !draw.rasterizer_discard {
                let draw = DrawKernels::new(scene, draw, index, size, &plan, stencil)?;
                plan.draws.push(draw);
            }
        }
        Ok(plan)
    }
}

impl DrawKernels {
    fn new(
        scene: &Scene,
        draw: &Draw,
        index: usize,
        size: [u32; 2],
        pass: &PassKernels,
        stencil: bool,
    ) -> Result<Self, NoKernels> {
        // Forced early tests also store for fragments that the shader discards, and store a depth that it
        // does not write.
        let late = draw.early_tests == EarlyTests::Implicit;
        let shading = match draw.shader {
            Shader::FlatColor => Shading::Vertex,
            Shader::ExpensiveColor if pass.positions.len() == 1 => {
                Shading::Expensive(draw.params.back_color[0])
            }
            Shader::ExpensiveDiscard if late && draw.params.back_color[0] as u32 == 0 => {
                Shading::Kept(draw.params.color[3])
            }
            Shader::FlatColorDepth if late => Shading::Depth,
            Shader::FrontFacing => Shading::Facing,
            Shader::UniformColor | Shader::UintColor => Shading::Uniform,
            Shader::VertexOnly => Shading::Nothing,
            Shader::SampledColor | Shader::SampledDiscard => texture(scene, draw, pass)?,
            Shader::TexelColor
            | Shader::TexelColorAll
            | Shader::TexelColorEight
            | Shader::TexelDualSource => texels(scene, draw, size)?,
            _ => return Err("a shader"),
        };
        use PrimitiveTopology::{TriangleFan, TriangleList, TriangleStrip};
        if !matches!(draw.topology, TriangleList | TriangleStrip | TriangleFan)
            || draw.polygon_mode != PolygonMode::Fill
        {
            return Err("points or lines");
        }
        if !draw.counters.is_empty() {
            return Err("counters");
        }
        if draw.depth_bounds.is_some() {
            return Err("depth bounds");
        }
        if draw.targets.iter().any(|t| t.advanced.is_some()) {
            return Err("advanced blending");
        }
        if draw.stencil.is_some() && !stencil {
            return Err("a stencil test without stencil");
        }
        let near = draw.mesh.vertices.iter().all(|v| {
            let [[x], [y], [z]] = window_position(&mut Plain::<1>, v.position, &draw.viewport);
            let texture = v.uv.iter().all(|c| c.is_finite());
            let front = v.position[3] > 0.0;
            front && x.abs() <= FARTHEST && y.abs() <= FARTHEST && z.is_finite() && texture
        });
        if !near {
            return Err("vertices far outside, or behind the eye");
        }
        let w = draw.mesh.vertices.iter().map(|v| v.position[3]);
        if draw.shader.uses_uv() && w.clone().any(|w| w != draw.mesh.vertices[0].position[3]) {
            return Err("texture coordinates in perspective");
        }
        let clips = |v: &Vertex| Behind::of(v).is_some();
        let rejects = !draw.depth_clamp && draw.mesh.vertices.iter().any(clips);
        if rejects && draw.primitives().iter().any(|p| is_cut(draw, p)) {
            return Err("triangles cut by the near or far plane");
        }
        let drawn = bounds(draw, size).map(|v| v as i32);
        let rects: Vec<_> = pass
            .positions
            .iter()
            .map(|p| rect(draw, drawn, *p))
            .collect();
        let around = rects.iter().copied().reduce(|a, b| {
            [
                a[0].min(b[0]),
                a[1].min(b[1]),
                a[2].max(b[2]),
                a[3].max(b[3]),
            ]
        });
        let listed = draw.topology == TriangleList
            && draw.tessellation.is_none()
            && draw.provoking != Some(ProvokingVertex::Last);
        Ok(Self {
            index,
            shading,
            bounds: around.unwrap_or_default(),
            rects,
            depth: draw.depth.filter(|_| pass.depth.is_some()),
            stencil: draw.stencil,
            rejects,
            runs: listed.then(|| PrimitiveRun::all(&draw.mesh)),
        })
    }
}

/// The plane of the clip volume that a vertex is beyond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Behind {
    Near,
    Far,
}

impl Behind {
    /// Returns the plane that a vertex is beyond, if it is the near or the far plane.
    pub(crate) fn of(vertex: &Vertex) -> Option<Self> {
        let [.., z, w] = vertex.position;
        if z < 0.0 {
            Some(Self::Near)
        } else if z > w {
            Some(Self::Far)
        } else {
            None
        }
    }
}

/// Returns true if the near or the far plane might cut a primitive.
fn is_cut(draw: &Draw, primitive: &PrimitiveVertices) -> bool {
    let PrimitiveVertices::Triangle(triangle) = primitive else {
        return true;
    };
    let vertices = triangle.map(|i| &draw.mesh.vertices[i]);
    let [a, b, c] = vertices.map(Behind::of);
    let w = vertices.iter().all(|v| v.position[3] > 0.0);
    !(w && a == b && a == c)
}

/// Returns the shading by the texels of textures that have the attachments' size.
fn texels(scene: &Scene, draw: &Draw, size: [u32; 2]) -> Result<Shading, NoKernels> {
    let fetched = |place: usize| match draw.textures.get(place) {
        Some(index) => {
            let attachment = &scene.attachments[*index];
            let fits = attachment.size == size && attachment.samples == 1;
            (fits && attachment.format.is_color()).then_some(FetchedTexture {
                index: *index,
                channels: attachment.format.color_channels(),
            })
        }
        None => None,
    };
    let two = draw.shader.textures() > 1;
    let (Some(first), second) = (fetched(0), fetched(1).filter(|_| two)) else {
        return Err("a texture of another size, or of depths");
    };
    if two && second.is_none() {
        return Err("a texture of another size, or of depths");
    }
    if draw.sampler.is_some() || draw.alpha_to_coverage() {
        return Err("fetched texels with a sampler or alpha to coverage");
    }
    Ok(Shading::Texels(first, second))
}

/// Returns the shading by a texture whose codes are stored unchanged.
fn texture(scene: &Scene, draw: &Draw, pass: &PassKernels) -> Result<Shading, NoKernels> {
    let (Some(index), Some(sampler)) = (draw.textures.first(), draw.sampler) else {
        return Err("a shader without its texture");
    };
    let plain = draw.targets.iter().all(|t| *t == ColorTarget::default());
    let texels = scene.attachments[*index].format.color_channels();
    let same = texels == pass.channels && texels == [ChannelEncoding::Unorm(8); 4];
    if sampler.filter != FilterMode::Nearest
        || draw.early_tests != EarlyTests::Implicit
        || draw.multisample != Multisample::default()
        || pass.positions.len() > 1
        || draw.logic.is_some()
        || !plain
        || !same
    {
        return Err("a texture that is filtered, blended or converted");
    }
    let is_kept = |code: &u32| {
        let [alpha] = Plain::<1>.decode(ChannelEncoding::Unorm(8), [*code]);
        let kept = KeepCondition::unless_below([alpha; LANES], [draw.params.color[3]; LANES]);
        !draw.shader.discards() || Faithful.kept(&kept)[0]
    };
    Ok(Shading::Texture {
        index: *index,
        address: sampler.address,
        kept: (0..256).find(is_kept).unwrap_or(256),
    })
}

/// Returns the texels of a rectangle whose sample, at a position in the texel, is inside the viewport.
fn rect(draw: &Draw, [left, top, right, bottom]: [i32; 4], position: [i32; 2]) -> [i32; 4] {
    let [x, y, w, h] = draw.viewport.area();
    // The cast saturates, far above any number of texels.
    let edge = |v: f32, position: i32| {
        let edge = (v * UNITS as f32).ceil() as i64 - i64::from(position);
        // The quotient is rounded up.
        let texel = -(-edge).div_euclid(UNITS);
        texel.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
    };
    [
        left.max(edge(x, position[0])),
        top.max(edge(y, position[1])),
        right.min(edge(x + w, position[0])),
        bottom.min(edge(y + h, position[1])),
    ]
}
