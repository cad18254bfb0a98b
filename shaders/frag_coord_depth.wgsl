// The vertex colour; the fragment's own window depth becomes its depth.

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) color: vec4f,
}

struct Output {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f) -> Varying {
    return Varying(position, color);
}

@fragment
fn fs(in: Varying) -> Output {
    return Output(in.color, in.position.z);
}
