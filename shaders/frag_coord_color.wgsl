// The fragment's window coordinates, scaled by the parameter's red and green, as red and green; the
// parameter's blue and alpha.

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
    return vec4f(position.xy * params.color.xy, params.color.zw);
}
