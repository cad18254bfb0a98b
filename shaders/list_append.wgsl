// Per-pixel linked lists (Yang, Hensley, Grün and Thibieroz 2010), first pass: the fragment becomes the first
// node of its texel's list. The pool is the number of requested nodes, one head for each texel, and nodes of
// six words: colour, depth, and the next node. Nodes are numbered from 1, and 0 ends a list. Fragments
// without room in the pool are lost. The first parameter is the picture's size.

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

@fragment
fn fs(in: Varying) -> @location(0) vec4f {
    let size = vec2u(params.color.xy);
    let texel = vec2u(in.position.xy);
    let head = 1u + texel.y * size.x + texel.x;
    let first = 1u + size.x * size.y;
    let node = atomicAdd(&pool[0], 1u);
    if node < (arrayLength(&pool) - first) / 6u {
        let at = first + node * 6u;
        atomicStore(&pool[at], bitcast<u32>(in.color.r));
        atomicStore(&pool[at + 1u], bitcast<u32>(in.color.g));
        atomicStore(&pool[at + 2u], bitcast<u32>(in.color.b));
        atomicStore(&pool[at + 3u], bitcast<u32>(in.color.a));
        atomicStore(&pool[at + 4u], bitcast<u32>(in.position.z));
        let behind = atomicExchange(&pool[head], node + 1u);
        atomicStore(&pool[at + 5u], behind);
    }
    return vec4f(0.0);
}
