// The vertex colour, the same over the whole primitive. The two texture coordinates are clip distances.

enable clip_distances;

struct Varying {
    @builtin(position) position: vec4f,
    @builtin(clip_distances) distances: array<f32, 2>,
    @location(0) @interpolate(flat) color: vec4f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f, @location(2) uv: vec2f) -> Varying {
    return Varying(position, array<f32, 2>(uv.x, uv.y), color);
}

@fragment
fn fs(@location(0) @interpolate(flat) color: vec4f) -> @location(0) vec4f {
    return color;
}
