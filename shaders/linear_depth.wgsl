// The vertex colour. The depth grows linearly with the distance, whose inverse is the first texture
// coordinate: 0 at the near plane, whose distance is the parameter's red, 1 at the far plane, its green.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) color: vec4f,
    @location(1) uv: vec2f,
}

@vertex
fn vs(
    @location(0) position: vec4f,
    @location(1) color: vec4f,
    @location(2) uv: vec2f,
) -> Varying {
    return Varying(position, color, uv);
}

struct Output {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fs(in: Varying) -> Output {
    let near = params.color.r;
    let far = params.color.g;
    return Output(in.color, (1.0 / in.uv.x - near) / (far - near));
}
