// The texels of two textures under the fragment: the source and the second source for blend factors.

enable dual_source_blending;

@group(0) @binding(1) var source: texture_2d<f32>;
@group(0) @binding(2) var second: texture_2d<f32>;

struct Output {
    @location(0) @blend_src(0) color: vec4f,
    @location(0) @blend_src(1) second: vec4f,
}

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(position) position: vec4f) -> Output {
    let at = vec2i(position.xy);
    return Output(textureLoad(source, at, 0), textureLoad(second, at, 0));
}
