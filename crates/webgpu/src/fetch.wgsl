// Brings depth, stencil or single samples that cannot be copied into a colour texture.

@group(0) @binding(1) var source: texture_2d<f32>;
@group(0) @binding(1) var samples: texture_multisampled_2d<f32>;
@group(0) @binding(1) var integer_samples: texture_multisampled_2d<u32>;
@group(0) @binding(1) var integer_source: texture_2d<u32>;

// One triangle that covers everything.
fn corner(i: u32) -> vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@vertex
fn everywhere(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return corner(i);
}

struct Sampled {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) sample: u32,
}

// Vertices 3n to 3n + 2 are for sample n.
@vertex
fn sampled(@builtin(vertex_index) i: u32) -> Sampled {
    return Sampled(corner(i % 3u), i / 3u);
}

@fragment
fn depth(@builtin(position) position: vec4f) -> @location(0) u32 {
    return bitcast<u32>(textureLoad(source, vec2i(position.xy), 0).r);
}

@fragment
fn texel(@builtin(position) position: vec4f) -> @location(0) vec4u {
    return bitcast<vec4u>(textureLoad(source, vec2i(position.xy), 0));
}

@fragment
fn integer_texel(@builtin(position) position: vec4f) -> @location(0) vec4u {
    return textureLoad(integer_source, vec2i(position.xy), 0);
}

@fragment
fn floats(in: Sampled) -> @location(0) vec4u {
    return bitcast<vec4u>(textureLoad(samples, vec2i(in.position.xy), i32(in.sample)));
}

@fragment
fn integers(in: Sampled) -> @location(0) vec4u {
    return textureLoad(integer_samples, vec2i(in.position.xy), i32(in.sample));
}

// The stencil test decides where it is written.
@fragment
fn one() -> @location(0) vec4f {
    return vec4f(1.0);
}
