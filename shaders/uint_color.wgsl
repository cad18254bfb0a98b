// A uniform colour as integers, for integer attachments.

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
fn fs() -> @location(0) vec4u {
    return vec4u(params.color);
}
