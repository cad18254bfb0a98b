// The number of the sample in binary; red is the lowest bit. The red of the texel under the fragment plus the
// sample's number becomes the stencil reference.

@group(0) @binding(1) var source: texture_2d<f32>;

struct Output {
    @location(0) color: vec4f,
    // WGSL has no such built-in: backends replace this location by it.
    @location(1) stencil_reference: i32,
}

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(position) position: vec4f, @builtin(sample_index) index: u32) -> Output {
    let texel = textureLoad(source, vec2i(position.xy), 0);
    let bits = vec3u(index, index >> 1u, index >> 2u) & vec3u(1u);
    return Output(vec4f(vec3f(bits), 1.0), i32(texel.r) + i32(index));
}
