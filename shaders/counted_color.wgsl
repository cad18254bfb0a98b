// A uniform colour. Each run of the shader increments a counter.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(3) var<storage, read_write> runs: atomic<u32>;

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs() -> @location(0) vec4f {
    atomicAdd(&runs, 1u);
    return params.color;
}
