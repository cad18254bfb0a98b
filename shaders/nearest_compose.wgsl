// The nearest layers of a texel, last pass: the layers, composed nearest first over the tail. The tail is the
// mean of the colours summed in texture 0; texture 1 has its transmittance. The result is a premultiplied
// colour, with the transmittance of the background as alpha. `nearest_depths.wgsl` describes the pool.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var sum: texture_2d<f32>;
@group(0) @binding(2) var transmittance: texture_2d<f32>;
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
    let layers = u32(params.color.z);
    let texel = vec2u(position.xy);
    let first = 1u + size.x * size.y + (texel.y * size.x + texel.x) * layers * 6u;
    var color = vec3f(0.0);
    var left = 1.0;
    for (var layer = 0u; layer < layers; layer++) {
        let at = first + layer * 6u;
        if atomicLoad(&pool[at + 4u]) == 0u {
            break;
        }
        let alpha = word(at + 3u);
        color += vec3f(word(at), word(at + 1u), word(at + 2u)) * (alpha * left);
        left *= 1.0 - alpha;
    }
    let tail = textureLoad(sum, vec2i(texel), 0);
    let through = textureLoad(transmittance, vec2i(texel), 0).r;
    color += tail.rgb / max(tail.a, 0.00001) * ((1.0 - through) * left);
    return vec4f(color, left * through);
}
