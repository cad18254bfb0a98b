// A texture sampled at the interpolated texture coordinates. The alpha test discards fragments whose alpha is
// below the parameter's.

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
    if texel.a < params.color.a {
        discard;
    }
    return texel;
}
