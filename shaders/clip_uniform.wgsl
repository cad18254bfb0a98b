// One uniform colour, clipped by eight distances: the vertex colour, the texture coordinates, and the
// differences between the vertex colour's alpha and blue and the texture coordinates.

enable clip_distances;

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;

struct Varying {
    @builtin(position) position: vec4f,
    @builtin(clip_distances) distances: array<f32, 8>,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f, @location(2) uv: vec2f) -> Varying {
    let all = array<f32, 8>(
        color.r, color.g, color.b, color.a, uv.x, uv.y, color.a - uv.x, color.b - uv.y
    );
    return Varying(position, all);
}

@fragment
fn fs() -> @location(0) vec4f {
    return params.color;
}
