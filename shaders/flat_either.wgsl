// The vertex colour of the first or the last vertex, the same over the whole primitive.

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat, either) color: vec4f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f) -> Varying {
    return Varying(position, color);
}

@fragment
fn fs(in: Varying) -> @location(0) vec4f {
    return in.color;
}
