//! Requirements of a scene: the formats, sizes, counts and features that an adapter must have.

use crate::blend::{BlendFactor, BlendOperation};
use crate::depth_stencil::StencilFace;
use crate::draw::Draw;
use crate::early_tests::EarlyTests;
use crate::overlap::may_overlap;
use crate::pass::{DepthStencilResolve, Pass, ResolveMode};
use crate::pool::Pool;
use crate::rasterization::{CullMode, PolygonMode, PrimitiveTopology, ProvokingVertex};
use crate::scene::Scene;
use crate::shader::{Interpolation, InterpolationSampling};
use crate::tessellation::DomainOrigin;
use etalon_frame::{Aspect, CounterKind, Feature, PathCommands, Requirement};
use std::collections::BTreeSet;

impl Scene {
    /// Returns the requirements of the scene, in ascending order and without duplicates.
    pub fn requirements(&self) -> Vec<Requirement> {
        let values = self.path.values().into_iter().map(Requirement::Path);
        let requirements: BTreeSet<_> = values.chain(self.on_path().needed()).collect();
        requirements.into_iter().collect()
    }

    /// Returns the requirements of the scene on the default path.
    fn needed(&self) -> BTreeSet<Requirement> {
        let mut needed = BTreeSet::new();
        for attachment in &self.attachments {
            needed.insert(Requirement::Format(attachment.format));
            if attachment.samples > 1 {
                needed.insert(Requirement::Samples(attachment.format, attachment.samples));
            }
            let largest = attachment.size[0].max(attachment.size[1]);
            needed.insert(Requirement::Size(largest));
        }
        if let Some(pool) = self.pool {
            needed.insert(Requirement::Feature(Feature::FragmentStorage));
            if pool.bytes() > Pool::MOST_BYTES {
                needed.insert(Requirement::Storage(pool.bytes()));
            }
        }
        for counter in &self.counters {
            needed.extend(match counter.kind {
                CounterKind::SamplesPassed => Some(Requirement::Feature(Feature::PreciseOcclusion)),
                CounterKind::AnySamplesPassed => None,
                CounterKind::ShaderRuns => Some(Requirement::Feature(Feature::StorageCounters)),
                CounterKind::FragmentInvocations => {
                    Some(Requirement::Feature(Feature::FragmentInvocations))
                }
            });
        }
        if self.queries().iter().any(|query| query.over_passes) {
            needed.insert(Requirement::Feature(Feature::QueriesOverPasses));
            let secondary = [PathCommands::Secondary, PathCommands::SecondaryEach];
            if secondary.contains(&self.path.commands) {
                needed.insert(Requirement::Feature(Feature::InheritedQueries));
            }
        }
        for pass in &self.passes {
            let size = self.pass_size(pass);
            needed.insert(Requirement::ColorAttachments(pass.color.len() as u32));
            if !pass.clears.is_empty() {
                needed.insert(Requirement::Feature(Feature::ClearCommands));
            }
            if let (Some(resolve), Some(index)) = (&pass.depth_stencil_resolve, pass.depth_stencil)
            {
                let both = self.attachments[index].format.aspects().len() == 2;
                let needs = resolve_features(resolve, both).into_iter();
                needed.extend(needs.map(Requirement::Feature));
            }
            if pass.clears.iter().any(|c| c.target.is_masked()) {
                needed.insert(Requirement::Feature(Feature::MaskedClears));
            }
            if mixes_provoking_vertices(pass) {
                needed.insert(Requirement::Feature(Feature::MixedProvokingVertices));
            }
            let held = pass.depth_stencil;
            let holds_depth = held.is_some_and(|i| self.attachments[i].format.has_depth());
            for draw in &pass.draws {
                if draw.multisample.alpha_to_coverage && self.pass_samples(pass) == 1 {
                    needed.insert(Requirement::Feature(Feature::AlphaToCoverageOfOneSample));
                }
                if draw.multisample.alpha_to_coverage && !self.has_alpha(pass) {
                    needed.insert(Requirement::Feature(Feature::AlphaToCoverageWithoutAlpha));
                }
                if draw.shader.writes_depth() && !holds_depth {
                    needed.insert(Requirement::Feature(Feature::DepthOutputWithoutDepth));
                }
                needed.extend(features(draw, size).into_iter().map(Requirement::Feature));
                needed.extend(self.own_reads(pass, draw).map(Requirement::Feature));
                for (target, index) in draw.targets.iter().zip(&pass.color) {
                    if target.blends() {
                        needed.insert(Requirement::Blending(self.attachments[*index].format));
                    }
                }
            }
            for index in pass.color.iter().chain(&pass.depth_stencil) {
                needed.insert(Requirement::Drawing(self.attachments[*index].format));
            }
        }
        needed
    }
}

impl Scene {
    /// Returns the features by which a draw reads attachments of its pass. The order of its fragments matters
    /// if it reads what it draws, which depth and stencil are not.
    fn own_reads(&self, pass: &Pass, draw: &Draw) -> impl Iterator<Item = Feature> {
        let own = draw.textures.iter().filter(|index| pass.attaches(**index));
        own.flat_map(|index| {
            let mut targets = pass.color.iter().zip(&draw.targets);
            let draws = targets.any(|(drawn, target)| drawn == index && target.write_mask != 0);
            let read = match draw.aspect_read(self.attachments[*index].format) {
                Aspect::Color => Feature::OwnPassReads,
                Aspect::Depth => Feature::OwnPassDepthReads,
                Aspect::Stencil => Feature::OwnPassStencilReads,
            };
            let in_order = (draws && may_overlap(draw)).then_some(Feature::OwnPassReadsInOrder);
            std::iter::once(read).chain(in_order)
        })
    }

    /// Returns true if the first color attachment of a pass has an alpha channel and can be blended into.
    fn has_alpha(&self, pass: &Pass) -> bool {
        let first = pass.color.first();
        first.is_some_and(|index| self.attachments[*index].format.has_alpha())
    }
}

/// Returns true if draws of a pass differ in their provoking vertex. A draw that does not set it counts as
/// first: a Vulkan pipeline that does not set it uses the first vertex.
fn mixes_provoking_vertices(pass: &Pass) -> bool {
    let last = |draw: &Draw| draw.provoking == Some(ProvokingVertex::Last);
    pass.draws
        .windows(2)
        .any(|two| last(&two[0]) != last(&two[1]))
}

/// Returns the features that a resolve of depth and stencil needs; `both` is true if the format has both.
fn resolve_features(resolve: &DepthStencilResolve, both: bool) -> Vec<Feature> {
    let mut needed = vec![Feature::DepthStencilResolve];
    needed.extend(match resolve.depth {
        ResolveMode::Average => Some(Feature::DepthResolveAverage),
        ResolveMode::Min => Some(Feature::DepthResolveMin),
        ResolveMode::Max => Some(Feature::DepthResolveMax),
        ResolveMode::None | ResolveMode::SampleZero => None,
    });
    needed.extend(match resolve.stencil {
        ResolveMode::Min => Some(Feature::StencilResolveMin),
        ResolveMode::Max => Some(Feature::StencilResolveMax),
        ResolveMode::None | ResolveMode::SampleZero | ResolveMode::Average => None,
    });
    if both && resolve.depth != resolve.stencil {
        let modes = [resolve.depth, resolve.stencil];
        needed.push(if modes.contains(&ResolveMode::None) {
            Feature::IndependentResolveNone
        } else {
            Feature::IndependentResolve
        });
    }
    needed
}

/// Returns the features that a draw needs with attachments of this size. One condition per feature.
fn features(draw: &Draw, size: [u32; 2]) -> Vec<Feature> {
    let mut needed = Vec::new();
    let mut need = |when: bool, feature: Feature| {
        if when {
            needed.push(feature);
        }
    };
    need(
        draw.cull == CullMode::FrontAndBack,
        Feature::FrontAndBackCulling,
    );
    need(
        draw.topology == PrimitiveTopology::TriangleFan,
        Feature::TriangleFans,
    );
    let distances = draw.shader.clip_distances();
    need(distances > 0, Feature::ClipDistances);
    need(
        draw.clipping_distances().count_ones() < distances,
        Feature::ClipDistanceMask,
    );
    need(draw.shader.cull_distances() > 0, Feature::CullDistances);
    need(draw.tessellation.is_some(), Feature::Tessellation);
    need(
        draw.tessellation
            .is_some_and(|t| t.origin == DomainOrigin::UpperLeft),
        Feature::UpperLeftDomain,
    );
    need(
        draw.provoking == Some(ProvokingVertex::First),
        Feature::FirstProvokingVertex,
    );
    need(
        draw.provoking == Some(ProvokingVertex::Last),
        Feature::LastProvokingVertex,
    );
    need(
        draw.polygon_mode == PolygonMode::Line,
        Feature::PolygonModeLine,
    );
    need(draw.rasterizer_discard, Feature::RasterizerDiscard);
    let indexed = draw.mesh.indices.is_some();
    need(indexed && draw.fetch.base_vertex != 0, Feature::BaseVertex);
    need(draw.fetch.first_instance > 0, Feature::FirstInstance);
    need(draw.logic.is_some(), Feature::LogicOperations);
    need(draw.depth_clamp, Feature::DepthClamp);
    need(draw.depth_bounds.is_some(), Feature::DepthBounds);
    need(draw.depth_bias.clamp != 0.0, Feature::DepthBiasClamp);
    need(
        draw.viewport.depth[0] > draw.viewport.depth[1],
        Feature::ReversedDepthRange,
    );
    need(draw.viewport.is_mirrored(), Feature::MirroredViewport);
    let [x, y, w, h] = draw.viewport.area();
    let outside = x < 0.0 || y < 0.0 || x + w > size[0] as f32 || y + h > size[1] as f32;
    need(outside, Feature::ViewportOutside);
    let is_fractional = draw.viewport.rect.iter().any(|bound| bound.fract() != 0.0);
    need(is_fractional, Feature::FractionalViewport);
    if let Some([x, y, w, h]) = draw.scissor {
        let outside = x.saturating_add(w) > size[0] || y.saturating_add(h) > size[1];
        need(outside, Feature::ScissorOutside);
    }
    let early = draw.early_tests;
    need(early == EarlyTests::Forced, Feature::ForcedEarlyTests);
    need(early.is_conservative(), Feature::ConservativeDepth);
    let shader = draw.shader;
    need(
        early == EarlyTests::Forced && shader.writes_depth(),
        Feature::ForcedEarlyTestsWithDepth,
    );
    need(
        shader.interpolation_sampling() == InterpolationSampling::Centroid,
        Feature::CentroidInterpolation,
    );
    need(
        shader.interpolation_sampling() == InterpolationSampling::Sample,
        Feature::SampleInterpolation,
    );
    need(
        shader.interpolation() == Interpolation::Linear,
        Feature::LinearInterpolation,
    );
    need(draw.multisample.alpha_to_one, Feature::AlphaToOne);
    need(draw.shader.runs_per_sample(), Feature::SampleShading);
    need(
        draw.multisample.min_sample_shading.is_some(),
        Feature::MinSampleShading,
    );
    need(
        draw.multisample.sample_coverage.is_some(),
        Feature::SampleCoverage,
    );
    need(draw.shader.has_second_source(), Feature::DualSourceBlending);
    need(draw.shader.reads_mask(), Feature::SampleMaskInput);
    let masks = draw.shader.writes_mask();
    need(masks, Feature::SampleMaskOutput);
    need(
        masks && draw.multisample.alpha_to_coverage,
        Feature::SampleMaskOutputWithAlphaToCoverage,
    );
    need(draw.shader.writes_reference(), Feature::StencilExport);
    let shaderless = !draw.shader.has_fragment();
    need(shaderless, Feature::FragmentShaderAbsent);
    need(
        shaderless && !draw.targets.is_empty(),
        Feature::FragmentShaderAbsentWithColor,
    );
    need(
        draw.targets.windows(2).any(|pair| pair[0] != pair[1]),
        Feature::IndependentBlend,
    );
    if let Some(stencil) = &draw.stencil {
        let key = |f: &StencilFace| (f.read_mask, f.write_mask, f.reference);
        need(
            key(&stencil.front) != key(&stencil.back),
            Feature::SeparateStencilMasks,
        );
    }
    if draw.targets.iter().any(|t| t.advanced.is_some()) {
        need(true, Feature::AdvancedBlend);
        need(may_overlap(draw), Feature::AdvancedBlendCoherent);
    }
    for blend in draw.targets.iter().filter_map(|t| t.blend) {
        let constant_alpha = [
            BlendFactor::ConstantAlpha,
            BlendFactor::OneMinusConstantAlpha,
        ];
        for (component, is_color) in [(blend.color, true), (blend.alpha, false)] {
            let factors = [component.src_factor, component.dst_factor];
            let ignores = matches!(
                component.operation,
                BlendOperation::Min | BlendOperation::Max
            );
            need(
                ignores && factors != [BlendFactor::One; 2],
                Feature::MinMaxBlendFactors,
            );
            need(
                is_color && factors.iter().any(|f| constant_alpha.contains(f)),
                Feature::ConstantAlphaBlendFactor,
            );
        }
    }
    needed
}
