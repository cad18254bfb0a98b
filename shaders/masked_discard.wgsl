// A uniform colour with the alpha of the texel under the fragment. The texel's red becomes the sample mask.
// The fragment is discarded if the texel's blue is below the parameter's.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var source: texture_2d<f32>;

struct Output {
    @location(0) color: vec4f,
    @builtin(sample_mask) mask: u32,
}

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(position) position: vec4f) -> Output {
    let texel = textureLoad(source, vec2i(position.xy), 0);
    if texel.b < params.color.b {
        discard;
    }
    return Output(vec4f(params.color.rgb, texel.a), u32(texel.r));
}
