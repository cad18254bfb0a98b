// Stochastic transparency (Enderton and others 2010): the vertex colour, discarded if its alpha is below a
// threshold. Texture 0 has a threshold for each of four samples. Runs once per sample.

@group(0) @binding(1) var thresholds: texture_2d<f32>;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) color: vec4f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f) -> Varying {
    return Varying(position, color);
}

@fragment
fn fs(in: Varying, @builtin(sample_index) index: u32) -> @location(0) vec4f {
    let texel = textureLoad(thresholds, vec2i(in.position.xy), 0);
    var threshold = texel.x;
    if index == 1u {
        threshold = texel.y;
    } else if index == 2u {
        threshold = texel.z;
    } else if index == 3u {
        threshold = texel.w;
    }
    if in.color.a < threshold {
        discard;
    }
    return vec4f(in.color.rgb, 1.0);
}
