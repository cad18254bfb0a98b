// Brings depth or stencil into a colour texture, where it cannot be copied.

@group(0) @binding(1) var source: texture_2d<f32>;

// One triangle over everything.
@vertex
fn everywhere(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn depth(@builtin(position) position: vec4f) -> @location(0) u32 {
    return bitcast<u32>(textureLoad(source, vec2i(position.xy), 0).r);
}

// The stencil test decides where.
@fragment
fn one() -> @location(0) vec4f {
    return vec4f(1.0);
}
