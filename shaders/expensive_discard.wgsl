// Like `expensive_color`; discards the fragment if the vertex colour's alpha is below the parameter's.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) color: vec4f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f) -> Varying {
    return Varying(position, color);
}

// Returns 0 after `steps` dependent steps of work.
fn cost(position: vec4f, steps: f32) -> f32 {
    var hash = u32(position.x) * 747796405u + u32(position.y);
    for (var i = 0u; i < u32(max(steps, 0.0)); i++) {
        hash = hash * 1664525u + 1013904223u;
        hash = hash ^ (hash >> 15u);
    }
    // One of two consecutive numbers is even, so the product's lowest bit is 0.
    return f32((hash * (hash + 1u)) & 1u);
}

@fragment
fn fs(in: Varying) -> @location(0) vec4f {
    if in.color.a < params.color.a {
        discard;
    }
    return in.color + vec4f(cost(in.position, params.back_color.r));
}
