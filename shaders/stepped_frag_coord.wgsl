// The whole steps of the fragment coordinate's w and depth, scaled by the parameter's red and green. The step
// of w is a Gray code in red, green and blue; the step of the depth is its lowest bit in alpha.

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
fn fs(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let scaled = position.wz * params.color.xy;
    let steps = vec2i(clamp(floor(scaled), vec2f(0.0), vec2f(7.0)));
    let bits = steps.x ^ (steps.x >> 1u);
    return vec4f(vec4i(bits, bits >> 1u, bits >> 2u, steps.y) & vec4i(1));
}
