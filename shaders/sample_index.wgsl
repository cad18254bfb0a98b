// The number of the sample in binary; red is the lowest bit. Reading it makes the shader run once per sample.

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(sample_index) index: u32) -> @location(0) vec4f {
    let bits = vec3u(index, index >> 1u, index >> 2u) & vec3u(1u);
    return vec4f(vec3f(bits), 1.0);
}
