// Weighted blended transparency (McGuire and Bavoil 2013), accumulation: premultiplied colour and alpha,
// weighted by equation 10 and to be summed; and alpha alone, to be multiplied.

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) color: vec4f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f) -> Varying {
    return Varying(position, color);
}

struct Output {
    @location(0) sum: vec4f,
    @location(1) alpha: vec4f,
}

@fragment
fn fs(in: Varying) -> Output {
    let left = 1.0 - in.position.z;
    let weight = in.color.a * max(0.01, 3000.0 * left * left * left);
    let sum = vec4f(in.color.rgb * in.color.a, in.color.a) * weight;
    return Output(sum, vec4f(in.color.a));
}
