//! The render pipelines of draws.

use crate::binding::Bindings;
use crate::format::GpuFormat;
use crate::pipeline_state::{
    DepthBiasState, DepthStencil, PipelineState, PipelineTarget, Primitive, VertexAttribute,
    VertexBuffer,
};
use crate::tables::Lowering;
use etalon_frame::{PathDraws, Requirement, TextureFormat};
use etalon_scene::{
    BlendComponent, BlendFactor, BlendState, CompareFunction, Draw, EarlyTests, Pass,
    PrimitiveTopology, Scene, Shader, Vertex,
};

/// The size of a vertex in bytes.
const VERTEX_BYTES: u64 = size_of::<Vertex>() as u64;

/// The slot of the colours of instances.
pub(crate) const INSTANCE_SLOT: u32 = 1;

/// The location of the colour.
const COLOR: u32 = 1;

/// Returns the pipeline of a draw.
pub(crate) fn of_draw(
    lowering: &mut Lowering<'_>,
    scene: &Scene,
    pass: &Pass,
    draw: &Draw,
) -> Result<usize, Requirement> {
    let depth_stencil = pass.depth_stencil.map(|i| scene.attachments[i].format);
    let (shader, early_tests) = shader_of(draw, depth_stencil);
    let module = lowering.shader(shader.name(), shader.wgsl_with(early_tests));
    // The bindings are the draw's; the shader can use fewer.
    let layout = lowering.layout(Bindings::of(draw.shader).entries());
    let targets = pass.color.iter().zip(&draw.targets).map(|(index, target)| {
        if scene.is_gap(*index) {
            return Ok(None);
        }
        Ok(Some(PipelineTarget {
            format: GpuFormat::of(scene.attachments[*index].format)?,
            blend: target.blend.map(with_constant),
            write_mask: target.write_mask,
        }))
    });
    let targets = targets.collect::<Result<Vec<_>, Requirement>>()?;
    let depth_stencil = depth_stencil.map(|format| of_depth_stencil(format, draw));
    let state = PipelineState {
        label: shader.name().into(),
        vertex: "vs".into(),
        fragment: shader.has_fragment().then(|| "fs".into()),
        buffers: vertex_buffers(shader, draw),
        primitive: primitive(draw, scene.path.draws),
        depth_stencil: depth_stencil.transpose()?,
        samples: scene.pass_samples(pass),
        mask: draw.multisample.mask,
        alpha_to_coverage: draw.multisample.alpha_to_coverage,
        targets: if shader.has_fragment() {
            targets
        } else {
            Vec::new()
        },
    };
    Ok(lowering.pipeline(module, Some(layout), state))
}

/// Returns blending with `constant` as the only constant factor, as in WebGPU. `constant-alpha` occurs only
/// in the alpha equation, where it means the same; in the colour equation it needs a feature that is denied.
fn with_constant(blend: BlendState) -> BlendState {
    let factor = |factor| match factor {
        BlendFactor::ConstantAlpha => BlendFactor::Constant,
        BlendFactor::OneMinusConstantAlpha => BlendFactor::OneMinusConstant,
        other => other,
    };
    let component = |component: BlendComponent| BlendComponent {
        src_factor: factor(component.src_factor),
        dst_factor: factor(component.dst_factor),
        ..component
    };
    BlendState {
        color: component(blend.color),
        alpha: component(blend.alpha),
    }
}

/// Returns the shader of a draw and its early tests, in a pass whose depth-stencil attachment has this
/// format.
fn shader_of(draw: &Draw, depth_stencil: Option<TextureFormat>) -> (Shader, EarlyTests) {
    let (mut shader, mut early_tests) = (draw.shader, draw.early_tests);
    // WebGPU refuses a shader that writes depth without a depth attachment (10.3.6). The depth would be
    // discarded, so a shader without it draws the same colours.
    if !depth_stencil.is_some_and(TextureFormat::has_depth) {
        shader = match shader {
            Shader::FlatColorDepth => Shader::UniformColor,
            Shader::CountedDepth => Shader::CountedColor,
            Shader::MaskedDepth => Shader::MaskedColor,
            Shader::FragCoordDepth => Shader::FlatColor,
            Shader::ExpensiveDepth => Shader::ExpensiveColor,
            Shader::LinearDepth | Shader::LogarithmicDepth => Shader::FlatColor,
            // This shader runs per sample, which a counter would reveal.
            Shader::SampleDepth if draw.counters.is_empty() => Shader::UniformColor,
            other => other,
        };
        if early_tests.is_conservative() {
            early_tests = EarlyTests::Implicit;
        }
    }
    (shader, early_tests)
}

/// Returns the depth-stencil state of a draw. A disabled test always passes and writes nothing.
fn of_depth_stencil(format: TextureFormat, draw: &Draw) -> Result<DepthStencil, Requirement> {
    let depth = draw.depth;
    Ok(DepthStencil {
        format: GpuFormat::of(format)?,
        depth_write: format.has_depth().then(|| depth.is_some_and(|d| d.write)),
        depth_compare: depth.map_or(CompareFunction::Always, |d| d.compare),
        stencil: draw.stencil.map(|mut stencil| {
            stencil.front.reference = 0;
            stencil.back.reference = 0;
            stencil
        }),
        bias: match draw.topology {
            // Only polygons have a bias; WebGPU refuses it for other topologies (GPUDepthStencilState).
            PrimitiveTopology::PointList
            | PrimitiveTopology::LineList
            | PrimitiveTopology::LineStrip => DepthBiasState::default(),
            PrimitiveTopology::TriangleList
            | PrimitiveTopology::TriangleStrip
            | PrimitiveTopology::TriangleFan => DepthBiasState::of(draw.depth_bias),
        },
    })
}

fn primitive(draw: &Draw, draws: PathDraws) -> Primitive {
    let strips = [
        PrimitiveTopology::LineStrip,
        PrimitiveTopology::TriangleStrip,
    ];
    let restarts = draw.mesh.indices.is_some() || draws == PathDraws::RestartUnindexed;
    let restarts = restarts && strips.contains(&draw.topology);
    Primitive {
        topology: draw.topology,
        strip_index: restarts.then_some(draw.fetch.index),
        front_face: draw.front_face,
        cull: draw.cull,
        unclipped_depth: draw.depth_clamp,
    }
}

/// Returns the vertex buffers of a draw. If it has instances, their colours have a separate buffer.
fn vertex_buffers(shader: Shader, draw: &Draw) -> Vec<VertexBuffer> {
    let instanced = draw.fetch.instances > 0;
    let (apart, shared): (Vec<_>, Vec<_>) = attributes(shader)
        .iter()
        .copied()
        .partition(|attribute| instanced && attribute.location == COLOR);
    let mut buffers = vec![VertexBuffer {
        stride: VERTEX_BYTES,
        per_instance: false,
        attributes: shared,
    }];
    if instanced {
        buffers.push(VertexBuffer {
            stride: size_of::<[f32; 4]>() as u64,
            per_instance: true,
            attributes: apart
                .into_iter()
                .map(|a| VertexAttribute::of(a.location, 0, a.floats))
                .collect(),
        });
    }
    buffers
}

/// Returns the vertex attributes that a shader reads. A validation layer warns about unread attributes.
fn attributes(shader: Shader) -> &'static [VertexAttribute] {
    const ALL: [VertexAttribute; 3] = [
        VertexAttribute::of(0, 0, 4),
        VertexAttribute::of(COLOR, 16, 4),
        VertexAttribute::of(2, 32, 2),
    ];
    const TEXTURED: [VertexAttribute; 2] = [ALL[0], ALL[2]];
    match shader {
        Shader::ClipFlat
        | Shader::ClipUniform
        | Shader::CullFlat
        | Shader::EdgeAlpha
        | Shader::HashedColor
        | Shader::HashedSample => &ALL,
        Shader::Centroid
        | Shader::Fxaa
        | Shader::SampledColor
        | Shader::SampledDiscard
        | Shader::SharpenedSample
        | Shader::SteppedLinear
        | Shader::SteppedLinearCentroid
        | Shader::SteppedLinearSample
        | Shader::SteppedPerspective
        | Shader::SteppedPerspectiveCentroid
        | Shader::SteppedPerspectiveSample => &TEXTURED,
        Shader::CountedDepth
        | Shader::DualPeel
        | Shader::ExpensiveColor
        | Shader::ExpensiveDepth
        | Shader::ExpensiveDiscard
        | Shader::FlatColor
        | Shader::FlatColorDepth
        | Shader::FlatEither
        | Shader::Fog
        | Shader::FragCoordDepth
        | Shader::LinearDepth
        | Shader::ListAppend
        | Shader::LogarithmicDepth
        | Shader::MomentAbsorbance
        | Shader::MomentTransmittance
        | Shader::NearestColors
        | Shader::Peel
        | Shader::Stochastic
        | Shader::WeightedAccumulate => &ALL[..2],
        Shader::CountedColor
        | Shader::CountedDiscard
        | Shader::DepthGrey
        | Shader::DepthLinearized
        | Shader::DepthRange
        | Shader::ExportedColor
        | Shader::ExportedDepth
        | Shader::ExportedDiscard
        | Shader::ExportedFacing
        | Shader::ExportedSample
        | Shader::FragCoordColor
        | Shader::FrontFacing
        | Shader::InputMask
        | Shader::InputMaskSample
        | Shader::MaskedColor
        | Shader::MaskedDepth
        | Shader::MaskedDiscard
        | Shader::MaskedSample
        | Shader::ListCompose
        | Shader::MomentResolve
        | Shader::NearestCompose
        | Shader::NearestDepths
        | Shader::SampleDepth
        | Shader::SampleIndex
        | Shader::SteppedFragCoord
        | Shader::TexelColor
        | Shader::TexelColorAll
        | Shader::TexelColorEight
        | Shader::TexelDiscard
        | Shader::TexelDualSource
        | Shader::TexelSample
        | Shader::TexelStencil
        | Shader::UintColor
        | Shader::UniformColor
        | Shader::VertexOnly
        | Shader::WeightedResolve => &ALL[..1],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the locations of a vertex entry point's arguments.
    fn locations(wgsl: &str) -> Vec<u32> {
        let (_, arguments) = wgsl.split_once("fn vs(").expect("a vertex entry point");
        let (arguments, _) = arguments.split_once("->").expect("its result");
        let parts = arguments.split("@location(").skip(1);
        let number = |part: &str| part.split(')').next()?.parse().ok();
        parts.filter_map(number).collect()
    }

    #[test]
    fn attributes_are_those_that_the_shader_reads() {
        for shader in Shader::ALL {
            let given = attributes(*shader).iter();
            let given: Vec<_> = given.map(|a| a.location).collect();
            assert_eq!(given, locations(shader.wgsl()), "{}", shader.name());
            for attribute in attributes(*shader) {
                let offset = [0, 16, 32][attribute.location as usize];
                assert_eq!(attribute.offset, offset, "{}", shader.name());
            }
        }
    }
}
