// The nearest layers of a texel, second pass: a fragment whose depth is stored adds its colour to the node, and
// outputs zeros. Other fragments are the tail: they output premultiplied colour and alpha, to be summed, and
// alpha alone, to be multiplied. `nearest_depths.wgsl` describes the pool.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(3) var<storage, read_write> pool: array<atomic<u32>>;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) color: vec4f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f) -> Varying {
    return Varying(position, color);
}

struct Output {
    @location(0) sum: vec4f,
    @location(1) alpha: vec4f,
}

@fragment
fn fs(in: Varying) -> Output {
    let size = vec2u(params.color.xy);
    let layers = u32(params.color.z);
    let texel = vec2u(in.position.xy);
    let first = 1u + size.x * size.y + (texel.y * size.x + texel.x) * layers * 6u;
    let depth = ~bitcast<u32>(in.position.z);
    for (var layer = 0u; layer < layers; layer++) {
        let at = first + layer * 6u;
        if atomicLoad(&pool[at + 4u]) != depth {
            continue;
        }
        // Of fragments at one depth, each has a node of its own.
        if atomicExchange(&pool[at + 5u], 1u) == 0u {
            atomicStore(&pool[at], bitcast<u32>(in.color.r));
            atomicStore(&pool[at + 1u], bitcast<u32>(in.color.g));
            atomicStore(&pool[at + 2u], bitcast<u32>(in.color.b));
            atomicStore(&pool[at + 3u], bitcast<u32>(in.color.a));
            return Output(vec4f(0.0), vec4f(0.0));
        }
    }
    return Output(vec4f(in.color.rgb * in.color.a, in.color.a), vec4f(in.color.a));
}
