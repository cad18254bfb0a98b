// The texel of a texture under the fragment, written to eight colour attachments.

@group(0) @binding(1) var source: texture_2d<f32>;

struct Output {
    @location(0) color0: vec4f,
    @location(1) color1: vec4f,
    @location(2) color2: vec4f,
    @location(3) color3: vec4f,
    @location(4) color4: vec4f,
    @location(5) color5: vec4f,
    @location(6) color6: vec4f,
    @location(7) color7: vec4f,
}

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(position) position: vec4f) -> Output {
    let texel = textureLoad(source, vec2i(position.xy), 0);
    return Output(texel, texel, texel, texel, texel, texel, texel, texel);
}
