// The whole steps of the texture coordinates, interpolated in perspective at each sample. The first
// coordinate's step is a Gray code in red, green and blue; the second's is its lowest bit in alpha.

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(perspective, sample) uv: vec2f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(2) uv: vec2f) -> Varying {
    return Varying(position, uv);
}

@fragment
fn fs(in: Varying) -> @location(0) vec4f {
    let steps = vec2i(clamp(floor(in.uv), vec2f(0.0), vec2f(7.0)));
    let bits = steps.x ^ (steps.x >> 1u);
    return vec4f(vec4i(bits, bits >> 1u, bits >> 2u, steps.y) & vec4i(1));
}
