// One step of depth peeling (Everitt 2001): the vertex colour and the depth of fragments behind the depth in
// texture 0. All others are discarded.

@group(0) @binding(1) var before: texture_2d<f32>;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) color: vec4f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f) -> Varying {
    return Varying(position, color);
}

struct Output {
    @location(0) color: vec4f,
    @location(1) depth: vec4f,
}

@fragment
fn fs(in: Varying) -> Output {
    if in.position.z <= textureLoad(before, vec2i(in.position.xy), 0).x {
        discard;
    }
    return Output(in.color, vec4f(in.position.z, 0.0, 0.0, 1.0));
}
