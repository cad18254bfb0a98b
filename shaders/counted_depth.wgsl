// A uniform colour. The vertex colour's red becomes the fragment's depth, bit for bit. Each run of the shader
// increments a counter.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(3) var<storage, read_write> runs: atomic<u32>;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) depth: f32,
}

struct Output {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f) -> Varying {
    return Varying(position, color.r);
}

@fragment
fn fs(in: Varying) -> Output {
    atomicAdd(&runs, 1u);
    return Output(params.color, in.depth);
}
