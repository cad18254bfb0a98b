// A uniform colour. The depth is the number of the sample plus 1, in 32nds. Reading the number makes the
// shader run once per sample.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;

struct Output {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(sample_index) index: u32) -> Output {
    return Output(params.color, f32(index + 1u) / 32.0);
}
