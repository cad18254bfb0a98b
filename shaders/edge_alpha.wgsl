// The vertex colour, with its alpha weighted by the part of the texel inside an edge. The first texture
// coordinate is the distance from the edge in texels, positive inside.

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

@fragment
fn fs(in: Varying) -> @location(0) vec4f {
    let coverage = clamp(in.uv.x + 0.5, 0.0, 1.0);
    return vec4f(in.color.rgb, in.color.a * coverage);
}
