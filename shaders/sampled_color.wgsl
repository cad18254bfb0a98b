// A texture sampled at the interpolated texture coordinates.

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
    return textureSampleLevel(source, filtering, in.uv, 0.0);
}
