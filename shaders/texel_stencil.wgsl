// The stencil value of a texture under the fragment as red, with alpha 1.

@group(0) @binding(1) var source: texture_2d<u32>;

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let value = textureLoad(source, vec2i(position.xy), 0).r;
    return vec4f(f32(value), 0.0, 0.0, 1.0);
}
