// Weighted blended transparency (McGuire and Bavoil 2013), last pass: the weighted mean of all colours from
// texture 0, with the background's transmittance from texture 1 as alpha.

@group(0) @binding(1) var sum: texture_2d<f32>;
@group(0) @binding(2) var left: texture_2d<f32>;

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let texel = vec2i(position.xy);
    let all = textureLoad(sum, texel, 0);
    let background = textureLoad(left, texel, 0).r;
    return vec4f(all.rgb / max(all.a, 0.00001), background);
}
