// Hashed alpha testing (Wyman and McGuire 2017) of a texture: its colour, opaque; discarded if its alpha is
// below the hash of a cell of the surface. The vertex colour has the size of the surface and its place; the
// red and green of the parameters are the number of cells per unit.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var source: texture_2d<f32>;
@group(0) @binding(4) var filtering: sampler;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) surface: vec4f,
    @location(1) uv: vec2f,
}

@vertex
fn vs(
    @location(0) position: vec4f,
    @location(1) surface: vec4f,
    @location(2) uv: vec2f,
) -> Varying {
    return Varying(position, surface, uv);
}

// The hash of a cell, above 0 and at most 1.
fn hash(cell: vec2u) -> f32 {
    var bits = cell.x * 0x9e3779b1u;
    bits = ((bits ^ (bits >> 15u)) + cell.y) * 0x85ebca6bu;
    bits = (bits ^ (bits >> 13u)) * 0xc2b2ae35u;
    bits ^= bits >> 16u;
    return (f32(bits >> 8u) + 1.0) / 16777216.0;
}

@fragment
fn fs(in: Varying) -> @location(0) vec4f {
    let texel = textureSampleLevel(source, filtering, in.uv, 0.0);
    let place = in.surface.zw + in.uv * in.surface.xy;
    if texel.a < hash(vec2u(floor(place * params.color.xy))) {
        discard;
    }
    return vec4f(texel.rgb, 1.0);
}
