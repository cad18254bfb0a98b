// The vertex colour. The depth grows linearly with the distance, which is the clip-space w: 0 at the near
// plane, whose distance is the parameter's red, and 1 at the far plane, whose distance is the green.

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
fn vs(
    @location(0) position: vec4f,
    @location(1) color: vec4f,
) -> Varying {
    return Varying(position, color);
}

struct Output {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fs(in: Varying) -> Output {
    let near = params.color.r;
    let far = params.color.g;
    return Output(in.color, (1.0 / in.position.w - near) / (far - near));
}
