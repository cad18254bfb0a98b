// One uniform colour for front faces, another for back faces.

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
fn fs(@builtin(front_facing) front: bool) -> @location(0) vec4f {
    if front {
        return params.color;
    }
    return params.back_color;
}
