// One uniform colour if the first texture coordinate, interpolated at a point inside the primitive, is not
// negative; another if it is.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(perspective, centroid) uv: vec2f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(2) uv: vec2f) -> Varying {
    return Varying(position, uv);
}

@fragment
fn fs(in: Varying) -> @location(0) vec4f {
    if in.uv.x >= -0.0009765625 {
        return params.color;
    }
    return params.back_color;
}
