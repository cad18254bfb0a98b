// The nearest layers of a texel (Bavoil and others 2007, the k-buffer; Maule and others 2013, hybrid
// transparency), first pass: each fragment stores its depth if it is among the nearest. Each texel has nodes of
// its own after the heads of the pool, nearest first; their number is the blue of the parameters. A node is
// six words: colour, depth, and whether it has a colour. A depth is stored as the complement of its bits, so
// that a nearer one is larger, and 0 is no depth. Red and green are the picture's size.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(3) var<storage, read_write> pool: array<atomic<u32>>;

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let size = vec2u(params.color.xy);
    let layers = u32(params.color.z);
    let texel = vec2u(position.xy);
    let first = 1u + size.x * size.y + (texel.y * size.x + texel.x) * layers * 6u;
    // The farther of two depths goes on to the next node.
    var depth = ~bitcast<u32>(position.z);
    for (var layer = 0u; layer < layers; layer++) {
        let before = atomicMax(&pool[first + layer * 6u + 4u], depth);
        depth = min(before, depth);
        if depth == 0u {
            break;
        }
    }
    return vec4f(0.0);
}
