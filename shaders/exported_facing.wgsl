// On front faces, one colour, and the texel's red as stencil reference; on back faces, another colour and the
// texel's alpha.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var source: texture_2d<f32>;

struct Output {
    @location(0) color: vec4f,
    // WGSL has no such built-in: backends replace this location by it.
    @location(1) stencil_reference: i32,
}

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(position) position: vec4f, @builtin(front_facing) front: bool) -> Output {
    let texel = textureLoad(source, vec2i(position.xy), 0);
    if front {
        return Output(params.color, i32(texel.r));
    }
    return Output(params.back_color, i32(texel.a));
}
