// Four bits of the sample mask that the shader receives. The red of the uniform colour is the number of the
// bit in red; green, blue and alpha are the next three bits.

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
fn fs(@builtin(sample_mask) covered: u32) -> @location(0) vec4f {
    let numbers = vec4u(u32(params.color.r)) + vec4u(0u, 1u, 2u, 3u);
    return vec4f((vec4u(covered) >> numbers) & vec4u(1u));
}
