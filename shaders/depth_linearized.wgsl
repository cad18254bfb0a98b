// The distance that corresponds to a window depth of a perspective projection, as grey: 0 at the near plane,
// whose distance is the parameter's red, and 1 at the far plane, whose distance is the green.

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
    let near = params.color.r;
    let far = params.color.g;
    let distance = near * far / (far - position.z * (far - near));
    return vec4f(vec3f((distance - near) / (far - near)), 1.0);
}
