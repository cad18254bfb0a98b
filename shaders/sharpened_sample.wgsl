// A texture with sharpened alpha, for alpha to coverage (Golus 2017): alpha is a half at the cutoff, the
// parameter's alpha, and goes from 0 to 1 over the width of a texel of the picture.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var source: texture_2d<f32>;
@group(0) @binding(4) var filtering: sampler;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(2) uv: vec2f) -> Varying {
    return Varying(position, uv);
}

@fragment
fn fs(in: Varying) -> @location(0) vec4f {
    let texel = textureSampleLevel(source, filtering, in.uv, 0.0);
    let slope = max(fwidth(texel.a), 0.0001);
    let alpha = (texel.a - params.color.a) / slope + 0.5;
    return vec4f(texel.rgb, clamp(alpha, 0.0, 1.0));
}
