// Per-pixel linked lists (Yang and others 2010), second pass: the nodes of the texel's list, composed nearest
// first. The result is a premultiplied colour, with the transmittance of the background as alpha. Of two
// nodes at the same depth, the later one is in front. `list_append.wgsl` describes the pool.

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

fn word(at: u32) -> f32 {
    return bitcast<f32>(atomicLoad(&pool[at]));
}

@fragment
fn fs(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let size = vec2u(params.color.xy);
    let texel = vec2u(position.xy);
    let head = atomicLoad(&pool[1u + texel.y * size.x + texel.x]);
    let first = 1u + size.x * size.y;
    var color = vec3f(0.0);
    var left = 1.0;
    // The node that was composed last, and its depth.
    var last = 0u;
    var reached = -1.0;
    loop {
        var found = 0u;
        var nearest = 2.0;
        var node = head;
        while node != 0u {
            let at = first + (node - 1u) * 6u;
            let depth = word(at + 4u);
            let behind = depth > reached || (depth == reached && node < last);
            if behind && (depth < nearest || (depth == nearest && node > found)) {
                found = node;
                nearest = depth;
            }
            node = atomicLoad(&pool[at + 5u]);
        }
        if found == 0u {
            break;
        }
        let at = first + (found - 1u) * 6u;
        let alpha = word(at + 3u);
        color += vec3f(word(at), word(at + 1u), word(at + 2u)) * (alpha * left);
        left *= 1.0 - alpha;
        last = found;
        reached = nearest;
    }
    return vec4f(color, left);
}
