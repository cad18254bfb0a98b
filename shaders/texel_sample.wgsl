// The texel of a texture under the fragment, of the sample that is being shaded. Runs once per sample.

@group(0) @binding(1) var source: texture_multisampled_2d<f32>;

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(position) position: vec4f, @builtin(sample_index) index: u32) -> @location(0) vec4f {
    return textureLoad(source, vec2i(position.xy), i32(index));
}
