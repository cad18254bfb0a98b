// Hashed alpha testing (Wyman and McGuire 2017): the vertex colour, opaque; discarded if its alpha is below
// the hash of a cell of the surface. The texture coordinates are the place on the surface, and the red and
// green of the parameters the number of cells per unit.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) color: vec4f,
    @location(1) uv: vec2f,
}

@vertex
fn vs(
    @location(0) position: vec4f,
    @location(1) color: vec4f,
    @location(2) uv: vec2f,
) -> Varying {
    return Varying(position, color, uv);
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
    let cell = vec2u(floor(in.uv * params.color.xy));
    if in.color.a < hash(cell) {
        discard;
    }
    return vec4f(in.color.rgb, 1.0);
}
