// The vertex colour, faded to the second parameter with the distance, which follows from the window depth of
// a perspective projection. It is not faded at the near plane, whose distance is the first parameter's red,
// and completely at the far plane, whose distance is the green.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) color: vec4f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f) -> Varying {
    return Varying(position, color);
}

@fragment
fn fs(in: Varying) -> @location(0) vec4f {
    let near = params.color.r;
    let far = params.color.g;
    let distance = near * far / (far - in.position.z * (far - near));
    let fade = clamp((distance - near) / (far - near), 0.0, 1.0);
    return vec4f(in.color.rgb * (1.0 - fade) + params.back_color.rgb * fade, in.color.a);
}
