// A uniform colour; the red of the texel under the fragment becomes the stencil reference.

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
fn fs(@builtin(position) position: vec4f) -> Output {
    let texel = textureLoad(source, vec2i(position.xy), 0);
    return Output(params.color, i32(texel.r));
}
