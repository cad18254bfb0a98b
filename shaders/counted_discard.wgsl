// The texel of a texture under the fragment. Each run of the shader increments a counter, then discards the
// fragment if its alpha is below the parameter's.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var source: texture_2d<f32>;
@group(0) @binding(3) var<storage, read_write> runs: atomic<u32>;

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let texel = textureLoad(source, vec2i(position.xy), 0);
    atomicAdd(&runs, 1u);
    if texel.a < params.color.a {
        discard;
    }
    return texel;
}
