// Like `input_mask`, with the sample's own bit inverted. Reading the sample's number makes the shader run
// once per sample with only this bit in its mask, so the result is 0.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(sample_mask) covered: u32, @builtin(sample_index) index: u32) -> @location(0) vec4f {
    let others = covered ^ (1u << index);
    let numbers = vec4u(u32(params.color.r)) + vec4u(0u, 1u, 2u, 3u);
    return vec4f((vec4u(others) >> numbers) & vec4u(1u));
}
