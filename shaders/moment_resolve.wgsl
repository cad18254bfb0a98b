// Moment-based transparency (Münstermann and others 2018), last pass: the mean of all colours from texture 0,
// weighted by alpha and transmittance, with the background's transmittance from texture 1 as alpha.

@group(0) @binding(1) var sum: texture_2d<f32>;
@group(0) @binding(2) var absorbance: texture_2d<f32>;

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let texel = vec2i(position.xy);
    let all = textureLoad(sum, texel, 0);
    let background = exp2(-textureLoad(absorbance, texel, 0).r);
    return vec4f(all.rgb / max(all.a, 0.00001), background);
}
