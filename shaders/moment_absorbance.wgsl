// Moment-based transparency with four power moments (Münstermann, Krumpen, Klein and Peters 2018), first
// pass: a fragment's absorbance, and the absorbance times the first four powers of the depth, to be summed.
// Absorbance counts halvings of light, so logarithms are binary. Depths go from -1 to 1. An opaque fragment
// would have infinite absorbance, so absorbance is limited to a transmittance of e^-10, as in the authors'
// code.

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) color: vec4f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f) -> Varying {
    return Varying(position, color);
}

struct Output {
    @location(0) absorbance: vec4f,
    @location(1) moments: vec4f,
}

@fragment
fn fs(in: Varying) -> Output {
    let absorbance = -log2(max(1.0 - in.color.a, 0.0000454));
    let z = in.position.z * 2.0 - 1.0;
    let square = z * z;
    let powers = vec4f(z, square, square * z, square * square);
    return Output(vec4f(absorbance), powers * absorbance);
}
