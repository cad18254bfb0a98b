// Moment-based transparency with four power moments (Münstermann and others 2018), second pass: the
// premultiplied colour and alpha times the transmittance in front of the fragment, to be summed. Many
// distributions of absorbance along depth have the moments in texture 1. The distribution with three places,
// one of them the fragment's depth, absorbs least in front of the fragment (the Hamburger problem). The
// moments are moved by 5e-7 towards (0, 0.375, 0, 0.375), which keeps their matrix regular, and a quarter of
// the absorbance at the fragment's own depth counts as in front of it: the bias and overestimation of the
// authors.

@group(0) @binding(1) var absorbance: texture_2d<f32>;
@group(0) @binding(2) var moments: texture_2d<f32>;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) color: vec4f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f) -> Varying {
    return Varying(position, color);
}

// Returns the share of the absorbance in front of a depth.
fn in_front(b: vec4f, z: f32) -> f32 {
    // The matrix of the moments is L D Lt, where D is (1, d1, d2) and l the lowest element of L.
    let mixed = b.z - b.x * b.y;
    let d1 = b.y - b.x * b.x;
    let l = mixed / d1;
    let d2 = (b.w - b.y * b.y) - mixed * l;
    // The inverse matrix between the powers of z and those of a second depth is a parabola in the second
    // depth.
    let first = z - b.x;
    let second = (z * z - b.y) - first * l;
    let first_over = first / d1;
    let second_over = second / d2;
    let own = 1.0 / ((first * first_over + second * second_over) + 1.0);
    var c2 = second_over;
    if abs(c2) < 1e-9 {
        c2 = 1e-9;
    }
    let c1 = first_over - second_over * l;
    let c0 = (1.0 - b.x * first_over) + second_over * (b.x * l - b.y);
    // The roots of the parabola are the two other places.
    var root = sqrt(max(c1 * c1 - (c0 * c2) * 4.0, 0.0));
    if c1 < 0.0 {
        root = -root;
    }
    let half = (c1 + root) * -0.5;
    let one = half / c2;
    let other = c0 / half;
    let near = min(one, other);
    let far = max(one, other);
    var others = 0.0;
    if far < z {
        others = 1.0 - own;
    } else if near < z {
        others = ((far * z - (far + z) * b.x) + b.y) / ((near - z) * (near - far));
    }
    return clamp(own * 0.25 + others, 0.0, 1.0);
}

@fragment
fn fs(in: Varying) -> @location(0) vec4f {
    let texel = vec2i(in.position.xy);
    let total = max(textureLoad(absorbance, texel, 0).r, 0.000001);
    let whole = textureLoad(moments, texel, 0) / total;
    let b = whole * 0.9999995 + vec4f(0.0, 1.875e-7, 0.0, 1.875e-7);
    let transmittance = exp2(-(total * in_front(b, in.position.z * 2.0 - 1.0)));
    return vec4f(in.color.rgb * in.color.a, in.color.a) * transmittance;
}
