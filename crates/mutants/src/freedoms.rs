//! Behaviours that some specification permits, and that are no known bug of a driver.

use crate::blend::precision::CONSTANT;
use crate::blend::{Input, component, factor, is_extreme, joined, side};
use crate::fields::FieldPlaces;
use crate::formats::{store, value};
use crate::hooks::{
    advanced_blending, blending, code, color_code, color_value, counts_all_samples, depth_passes,
    faithful_advanced, faithful_blend, interpolation, owns_edge, resolve, sampled, second_source,
    slope, snap, tests_before_mask, window_depth,
};
use crate::list::{bugs, coarse};
use crate::permission::under;
use crate::plant::{Plant, draws, each, frames, images};
use etalon_cpu::steps::{ComparedDepths, Faithful, Steps};
use etalon_frame::ChannelEncoding::{self, Float16, Float32, Snorm, Ufloat, Unorm};
use etalon_frame::{Aspect, CounterKind};
use etalon_pipeline::{BlendInput, compare, is_top_left};
use etalon_reference::rules::{
    BlendPrecision, ConstantClamp, Copies, DepthOrder, DepthTerms, FlushedFloats, NegativeAlpha,
    Resolve, Rounding, SameDepth, SamplesCounted, SharedEdge, SmallFloats, Snap,
};
use etalon_scene::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, CompareFunction, Draw, FilterMode,
    InterpolationSampling, PrimitiveTopology, Shader, Vertex,
};

const RECT: FieldPlaces<[f32; 4]> = |d| vec![&mut d.viewport.rect];

/// Returns the 16-bit float nearest to a value, or in direction of zero.
fn half(v: f32) -> f32 {
    value(Float16, code(Float16, v))
}

fn is_at_most(bits: u8) -> impl Fn(ChannelEncoding) -> bool + Copy {
    move |encoding| match encoding {
        Unorm(own) | Snorm(own) => own <= bits,
        _ => false,
    }
}

/// Blends into encodings of a kind with each product and sum rounded, and operands first.
fn stepwise(
    of_kind: impl Fn(ChannelEncoding) -> bool + Send + Sync + 'static,
    round: fn(f32) -> f32,
) -> Plant {
    blending(move |state, encodings, input: &Input| {
        if !encodings.iter().all(|encoding| of_kind(*encoding)) {
            return faithful_blend(state, encodings, input);
        }
        let held = |values: [[f32; 1]; 4]| {
            let mut each = values;
            for (value, encoding) in each.iter_mut().zip(encodings) {
                if let Some((low, high)) = encoding.normalized_range() {
                    value[0] = value[0].clamp(low, high);
                }
                value[0] = round(value[0]);
            }
            each
        };
        let operands = BlendInput {
            src: held(input.src),
            src1: held(input.src1),
            dst: held(input.dst),
            constant: held(input.constant),
        };
        in_steps(state, encodings, &operands, round)
    })
}

/// Returns the result of a blend with each product and the sum rounded. Products with 1 and sums with 0 are exact.
fn in_steps(
    state: &BlendState,
    encodings: [ChannelEncoding; 4],
    operands: &Input,
    round: fn(f32) -> f32,
) -> [f32; 4] {
    let [source, destination] = [true, false].map(|which| side(state, encodings, operands, which));
    let extreme = faithful_blend(state, encodings, operands);
    std::array::from_fn(|c| {
        let operation = component(state, c).operation;
        if is_extreme(operation) {
            return extreme[c];
        }
        // 1 times x is x, whichever of the two is the factor (OpenGL 3.3, 2.1.1).
        let product = |side: f32, [operand]: [f32; 1]| {
            let is_exact = side == operand || operand == 1.0;
            if is_exact { side } else { round(side) }
        };
        let (s, d) = (
            product(source[c], operands.src[c]),
            product(destination[c], operands.dst[c]),
        );
        let sum = joined(operation, s, d);
        if s == 0.0 || d == 0.0 {
            sum
        } else {
            round(sum)
        }
    })
}

/// Rounds a float towards 0 to 20 bits.
fn in_20_bits(v: f32) -> f32 {
    f32::from_bits(v.to_bits() & !0xf)
}

/// Blends by alpha into floats as the destination plus a part of its difference to the source.
fn by_difference() -> Plant {
    blending(|state, encodings, input: &Input| {
        let mut result = faithful_blend(state, encodings, input);
        let round = float_rounding(encodings[0]);
        for (c, value) in result.iter_mut().enumerate() {
            let BlendComponent {
                operation,
                src_factor,
                dst_factor,
            } = *component(state, c);
            let is_over = (operation, src_factor, dst_factor)
                == (
                    BlendOperation::Add,
                    BlendFactor::SrcAlpha,
                    BlendFactor::OneMinusSrcAlpha,
                );
            if encodings[0].is_float() && is_over {
                let ([src], [dst], [alpha]) = (input.src[c], input.dst[c], input.src[3]);
                *value = dst + round(round(src - dst) * alpha);
            }
        }
        result
    })
}

/// Moves vertices to the grid of this many bits, at or below their positions.
fn floored(bits: i32) -> Plant {
    let steps = 2_f32.powi(bits);
    snap(move |v| Faithful.snap((v * steps).floor() / steps))
}

/// Reads textures at coordinates rounded down to this many steps per texel.
fn filtered_in(steps: f32) -> Plant {
    sampled(move |right, texture, _, [u, v]| {
        let at = |v: f32, size: usize| (v * size as f32 * steps).floor() / steps / size as f32;
        right([at(u, texture.width), at(v, texture.height)])
    })
}

/// Returns the rounding of a blend's steps into a float encoding.
fn float_rounding(encoding: ChannelEncoding) -> fn(f32) -> f32 {
    if encoding == Float16 { half } else { |v| v }
}

/// Blends into floats with one rounding for the second product and the sum, at the destination's precision.
fn fused() -> Plant {
    blending(|state, encodings, input: &Input| {
        let operands = [input.src, input.dst, input.constant, input.src1];
        let operands = operands.map(|color| color.map(|[v]| v));
        let mut result = faithful_blend(state, encodings, input);
        for (c, value) in result.iter_mut().enumerate() {
            let component = component(state, c);
            if encodings[0].is_float() && component.operation == BlendOperation::Add {
                let [source, destination] = [component.src_factor, component.dst_factor]
                    .map(|f| factor(operands, f, c, 1.0));
                let [src, dst, ..] = operands;
                let round = float_rounding(encodings[0]);
                *value = dst[c].mul_add(destination, round(src[c] * source));
            }
        }
        result
    })
}

/// Averages halves of the samples' codes until one is left, each average rounded down.
fn halved(codes: &[u32]) -> u32 {
    match codes {
        [one] => *one,
        _ => {
            let (first, second) = codes.split_at(codes.len() / 2);
            (halved(first) + halved(second)) / 2
        }
    }
}

/// Changes each line of a list along an axis that is longer than 3 texels.
fn axial_lines(bug: fn([Vertex; 2], usize, f32) -> Vec<Vertex>) -> Plant {
    draws(move |draw: &mut Draw| {
        if draw.topology != PrimitiveTopology::LineList || draw.mesh.indices.is_some() {
            return;
        }
        let [.., width, height] = draw.viewport.rect;
        let lines = draw.mesh.vertices.chunks_exact(2);
        draw.mesh.vertices = lines
            .flat_map(|ends| {
                let ends = [ends[0], ends[1]];
                let along = |axis: usize, size: f32| {
                    let [a, b] = ends.map(|v| v.position);
                    let is_flat = a[3] == 1.0 && b[3] == 1.0 && a[1 - axis] == b[1 - axis];
                    let texels = (b[axis] - a[axis]).abs() * size / 2.0;
                    (is_flat && texels > 3.0).then(|| bug(ends, axis, 2.0 / size))
                };
                let changed = along(0, width).or_else(|| along(1, height));
                changed.unwrap_or_else(|| ends.to_vec())
            })
            .collect();
    })
}

/// Returns the vertex at a place along an axis, with the other values of a given one.
fn moved(mut vertex: Vertex, axis: usize, place: f32) -> Vertex {
    vertex.position[axis] = place;
    vertex
}

/// Returns true if an advanced blend divides a colour above its alpha.
fn is_beyond_alpha([src, dst]: [[f32; 4]; 2]) -> bool {
    let beyond = |color: [f32; 4]| color[..3].iter().any(|v| *v > color[3]);
    beyond(src) || beyond(dst)
}

/// Compares the incoming depth before its conversion.
fn unconverted(function: CompareFunction, depths: &ComparedDepths) -> bool {
    let stored = value(depths.encoding, depths.stored);
    let incoming = depths.depth.clamp(0.0, 1.0) + 0.0;
    compare(function, incoming.to_bits(), stored.to_bits())
}

bugs! {
    class "freedom", "blend";
    source "GPUs whose blend units compute in 16-bit floats";
    "blends-in-halves: Blends into formats of 10 bits and fewer are computed in 16-bit floats." =>
        stepwise(is_at_most(10), half),
        permitted coarse();
    "advanced-in-halves: Advanced blends take their operands as 16-bit floats." =>
        advanced_blending(|mode, encodings, colors: [[f32; 4]; 2]| {
            faithful_advanced(mode, encodings, colors.map(|color| color.map(half)))
        }),
        permitted vec![under!(advanced_blend: BlendPrecision::DestinationCodes | BlendPrecision::AnySteps)];
    "exported-as-halves: Colours reach formats of 8 bits and fewer as 16-bit floats." =>
        color_code(|e, v, _| if is_at_most(8)(e) { code(e, half(v)) } else { code(e, v) }),
        source "AMD: shaders export 16-bit floats to formats of 8 bits",
        permitted vec![under!(store: Rounding::EitherNeighbour)];
    "float-blends-fused: Blends into floats round the second product and the sum together." =>
        fused(), source "blend units with fused multiply-add",
        permitted vec![under!(float32_blend_error: error if error >= 1e-7)];
    "float-blends-by-difference: A blend by alpha into floats adds a part of the difference to the destination." =>
        by_difference(), source "Direct3D 11.3, 17.5: operations may be reordered",
        permitted vec![under!(blends_in_order: false)];
    "float32-blends-in-20-bits: Products and sums of blends into 32-bit floats keep 20 bits." =>
        blending(|state, encodings, input: &Input| match encodings[0] {
            Float32 => in_steps(state, encodings, input, in_20_bits),
            _ => faithful_blend(state, encodings, input),
        }), source "OpenGL 3.3: 1 part in 10^5",
        permitted vec![under!(float32_blend_error: error if error >= 2e-6)];
    "blends-in-even-steps: Operands and products of blends into 8 bits are multiples of 1/300." =>
        stepwise(|encoding| encoding == Unorm(8), |v| (v * 300.0).round() / 300.0),
        source "no grid is named",
        permitted coarse();
    "sources-in-codes: Sources of blends into 8 bits are rounded to codes, and blended in floats." =>
        blending(|state, encodings, input: &Input| {
            let mut operands = *input;
            if encodings == [Unorm(8); 4] {
                operands.src = input.src.map(|[v]| [(v.clamp(0.0, 1.0) * 255.0).round() / 255.0]);
            }
            faithful_blend(state, encodings, &operands)
        }), source "OpenGL: a source held in fixed point",
        permitted coarse();
    "alpha-weighs-in-its-bits: A source's alpha weighs wider channels with the bits of the stored alpha." =>
        blending(|state, encodings, input: &Input| {
            let mut operands = *input;
            if let Unorm(bits @ 1..=2) = encodings[3] {
                let most = ((1_u32 << bits) - 1) as f32;
                operands.src[3] = [(input.src[3][0].clamp(0.0, 1.0) * most).round() / most];
            }
            faithful_blend(state, encodings, &operands)
        }), source "blend units that take a colour apart after rounding",
        permitted [coarse(), vec![under!(weights_by_channel: false)]].concat();
    "destination-read-coarsely: A stored code is read one part in 200,000 too small." =>
        color_value(|e, c| {
            let right = value(e, c);
            let is_inside = e.normalized_range().is_some() && right.abs() < 1.0;
            if is_inside { right * (1.0 - 5e-6) } else { right }
        }), source "codes that are multiplied by an approximate 1/255",
        permitted vec![under!(decode_error: error if error >= 5e-6)];
    "constant-always-clamped: The blend constant is clamped to 0 to 1 when it is set." =>
        each(CONSTANT, |constant| *constant = constant.map(|v| v.clamp(0.0, 1.0))),
        source "drivers of OpenGL 3.3",
        permitted vec![under!(constant_clamp: ConstantClamp::Always | ConstantClamp::Either)];
    source "GPUs without subnormal floats of 16 bits";
    "subnormal-halves-flushed: Subnormal 16-bit floats are stored as 0." =>
        store(Float16, |v| if v.abs() < 2_f32.powi(-14) { code(Float16, 0.0_f32.copysign(v)) } else { code(Float16, v) }),
        permitted vec![under!(flushes_small_floats: FlushedFloats::Half | FlushedFloats::All)];
    "subnormal-small-floats-flushed: Subnormal floats of 11 and 10 bits are stored as 0." =>
        color_code(|e, v, _| match e {
            Ufloat(_) if v < 2_f32.powi(-14) => code(e, 0.0),
            _ => code(e, v),
        }),
        permitted vec![under!(flushes_small_floats: FlushedFloats::All)];
    source "conversions that saturate, and others that do not";
    "small-floats-overflow-to-infinity: Floats of 11 and 10 bits beyond the largest become infinity." =>
        color_code(|e, v, _| match e {
            Ufloat(6) if v > 65024.0 => code(e, f32::INFINITY),
            Ufloat(5) if v > 64512.0 => code(e, f32::INFINITY),
            _ => code(e, v),
        }),
        permitted vec![under!(small_floats: SmallFloats::EitherNeighbour)];
    "second-alpha-stays: Alpha to one leaves the second source's alpha." =>
        second_source(|_, second| second), area "multisample", source "Vulkan names the first output alone",
        permitted vec![under!(one_is_first_output: true)];
    "quotients-beyond-one-lost: An advanced blend of a colour above its alpha gives 0 in normalized formats." =>
        advanced_blending(|mode, encodings, colors: [[f32; 4]; 2]| {
            let is_normalized = encodings[0].normalized_range().is_some();
            let right = faithful_advanced(mode, encodings, colors);
            if is_normalized && is_beyond_alpha(colors) { [0.0, 0.0, 0.0, right[3]] } else { right }
        }), source "colours that are not premultiplied",
        permitted vec![under!(quotients_beyond_one: false)];
    "negative-alpha-lost: An advanced blend of a negative alpha gives 0 in float formats." =>
        advanced_blending(|mode, encodings, colors: [[f32; 4]; 2]| {
            let is_negative = colors.iter().any(|color| color[3] < 0.0);
            if encodings[0].is_float() && is_negative { [0.0; 4] } else { faithful_advanced(mode, encodings, colors) }
        }), source "a square root of a negative number",
        permitted vec![under!(negative_alpha: NegativeAlpha::Undefined | NegativeAlpha::IfNormalized)];
    "subnormals-lost-in-copies: A copy returns 0 for a subnormal 16-bit float." =>
        images(Aspect::Color, |image| {
            let channels = image.channels.clone();
            for texel in image.codes.chunks_exact_mut(channels.len()) {
                for (code, encoding) in texel.iter_mut().zip(&channels) {
                    if *encoding == Float16 && *code & 0x7c00 == 0 { *code &= 0x8000; }
                }
            }
        }), source "copies that convert",
        permitted vec![under!(copies: Copies::SameNumbers, or flushes_small_floats: FlushedFloats::Half | FlushedFloats::All)];

    class "freedom", "depth";
    source "depth tests before the conversion";
    "depth-compared-unconverted: The incoming depth is compared before its conversion." =>
        depth_passes(unconverted),
        permitted vec![under!(depth_order: DepthOrder::Either), under!(same_depth: SameDepth::WrittenAsFloat)];
    "own-depth-compared-unconverted: A depth that no shader writes is compared before its conversion." =>
        depth_passes(|function, depths| {
            if depths.written { Faithful.depth_passes(function, depths) } else { unconverted(function, depths) }
        }),
        permitted vec![under!(depth_order: DepthOrder::Either | DepthOrder::WrittenConvertedFirst)];
    source "the exact slope of the text";
    "slope-root: The slope is the root of the squares." =>
        slope(f64::hypot), permitted vec![under!(slope_root: true)];
    source "drivers whose clip space has depths from -1 to 1";
    "depth-about-the-middle: Depth is half of the range times -1 to 1, plus its middle." =>
        window_depth(|_, clip, [near, far]| (2.0 * clip - 1.0) * ((far - near) / 2.0) + f32::midpoint(near, far)),
        permitted vec![under!(depth_terms: DepthTerms::Middle)];
    "whole-viewports: Bounds of viewports are rounded down to whole texels." =>
        each(RECT, |rect| {
            let [left, top, width, height] = *rect;
            let [x, y] = [left, top].map(f32::floor);
            *rect = [x, y, (left + width).floor() - x, (top + height).floor() - y];
        }), area "scissor",
        source "devices that report 0 viewportSubPixelBits",
        reports |limits| limits.viewport_bits = Some(0),
        permitted vec![under!(viewport_step: step if step >= 1.0), under!(lines_cover_their_shape: false)];

    class "freedom", "cull";
    source "GPUs of 4, 6 and 8 bits of sub-pixel precision";
    "vertices-floored: Vertices are moved down to a grid of 8 bits." =>
        floored(8), reports |limits| limits.sub_pixel_bits = 8,
        permitted vec![under!(snap: Snap::EitherSide)];
    "vertices-in-4-bits: Vertices are moved down to a grid of 4 bits." =>
        floored(4), reports |limits| limits.sub_pixel_bits = 4,
        permitted vec![under!(sub_pixel_bits: 0..=4), under!(snap: Snap::EitherSide)];
    "vertices-in-6-bits: Vertices are moved down to a grid of 6 bits." =>
        floored(6), reports |limits| limits.sub_pixel_bits = 6,
        permitted vec![under!(sub_pixel_bits: 0..=6), under!(snap: Snap::EitherSide)];
    "bottom-right-rule: Samples on an edge belong to the triangle above or left of it." =>
        owns_edge(|from, to| !is_top_left(from, to)), source "GPUs with another fill rule",
        permitted vec![under!(shared_edge: SharedEdge::ExactlyOne | SharedEdge::Independent)];
    "edges-of-both: Samples on an edge belong to the triangles on both sides." =>
        owns_edge(|_, _| true), source "conservative edges",
        permitted vec![under!(shared_edge: SharedEdge::Independent)];
    source "the letter of Bresenham's rule";
    "axial-lines-with-a-gap: A line along an axis lacks the texel in its middle." =>
        axial_lines(|[a, b], axis, texel| {
            let (from, to) = (a.position[axis], b.position[axis]);
            let (middle, gap) = (f32::midpoint(from, to), texel.copysign(to - from) / 2.0);
            vec![a, moved(b, axis, middle - gap), moved(a, axis, middle + gap), b]
        }),
        permitted vec![
            under!(lines_cover_texels: false),
            under!(lines_cover_their_shape: false),
            under!(lines_lack: None | Some(1..)),
        ];
    "axial-lines-one-texel-short: A line along an axis ends a texel early." =>
        axial_lines(|[a, b], axis, texel| {
            let (from, to) = (a.position[axis], b.position[axis]);
            vec![a, moved(b, axis, to - texel.copysign(to - from))]
        }),
        permitted vec![under!(lines_cover_their_shape: false), under!(lines_lack: None | Some(1..))];
    "lines-behind-lost: A line with an end behind the eye is lost." =>
        draws(|draw| {
            let vertices = &mut draw.mesh.vertices;
            let lines = vertices.chunks_exact(2).filter(|ends| ends.iter().all(|v| v.position[3] > 0.0));
            *vertices = lines.flatten().copied().collect();
        }), when |draw| draw.topology == PrimitiveTopology::LineList && draw.mesh.indices.is_none(),
        source "lines that are not clipped",
        permitted vec![under!(keeps_lines_that_end_behind: false, or lines_cover_texels: false)];

    class "freedom", "multisample";
    "resolve-halves-truncated: Resolves average pairs of codes, rounding each down." =>
        resolve(|e, codes| match e {
            Unorm(_) => halved(codes),
            ChannelEncoding::Uint(_) => codes[0],
            _ => Faithful.resolve(e, codes),
        }), source "resolves in the destination's codes",
        permitted vec![under!(resolve: Resolve::Between | Resolve::BetweenOrFirst | Resolve::CoarseAverage)];
    "inputs-at-a-covered-sample: Without sample shading, inputs are interpolated at a covered sample." =>
        interpolation(|shader: Shader, state| {
            let sampling = match shader.interpolation_sampling() {
                InterpolationSampling::Center if state.min_sample_shading.is_none() => InterpolationSampling::Centroid,
                other => other,
            };
            (shader.interpolation(), sampling)
        }), source "centroid sampling for all inputs",
        permitted vec![under!(inputs_at_samples: _)];

    class "freedom", "early-z";
    "mask-after-early-tests: Forced early tests precede the sample mask." =>
        tests_before_mask(|| true), source "GPUs that mask samples at the output",
        permitted vec![under!(mask_acts_first: false)];
    "all-samples-counted: A fragment counts all its samples if one passes." =>
        counts_all_samples(|| true), source "counters of fragments",
        permitted vec![under!(samples_counted: SamplesCounted::PassingOrAll)];
    "runs-doubled-with-samples: With several samples, a shader runs twice as often." =>
        frames(|scene, frame| {
            if !scene.passes.iter().any(|pass| scene.pass_samples(pass) > 1) { return; }
            for (counter, count) in scene.counters.iter().zip(&mut frame.counters) {
                if counter.kind == CounterKind::ShaderRuns { *count *= 2; }
            }
        }), source "more samples than the state says",
        permitted vec![under!(samples_as_told: false, or runs_once: false)];

    class "freedom", "texture";
    source "filters of 4 and 8 bits of sub-texel precision";
    "filter-in-16-steps: Texture coordinates are rounded down to a 16th of a texel." =>
        filtered_in(16.0), reports |limits| limits.texel_bits = Some(4),
        permitted vec![under!(filter_step: step if step >= 1.0 / 16.0)];
    "filter-in-256-steps: Texture coordinates are rounded down to a 256th of a texel." =>
        filtered_in(256.0), reports |limits| limits.texel_bits = Some(8),
        permitted vec![under!(filter_step: step if step >= 1.0 / 256.0)];
    "filtered-to-codes: Linear filters of 8 bits return codes, rounded down." =>
        sampled(|right, texture, sampler, uv| {
            let value = right(uv);
            let is_coarse = sampler.filter == FilterMode::Linear && texture.encodings.iter().all(|e| *e == Unorm(8));
            if is_coarse { value.map(|v| (v * 255.0 + 1e-3).floor() / 255.0) } else { value }
        }), source "filters that return codes",
        permitted vec![under!(filters_to_codes: true)];
}
