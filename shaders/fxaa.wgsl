// Fast approximate anti-aliasing (Lottes 2009; the search of version 3.11 with twelve steps) of a drawn
// picture. It finds the texels next to an edge by their luma, searches along the edge for both of its ends,
// and reads the picture at an offset across the edge that depends on the nearer end. The first parameter is
// the size of a texel in texture coordinates, the contrast relative to the brightest neighbour and the least
// contrast that count as an edge. The second parameter's red is the weight of single texels.

struct Params {
    color: vec4f,
    back_color: vec4f,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var source: texture_2d<f32>;
@group(0) @binding(4) var filtering: sampler;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(2) uv: vec2f) -> Varying {
    return Varying(position, uv);
}

fn luma(at: vec2f) -> f32 {
    let color = textureSampleLevel(source, filtering, at, 0.0);
    return color.r * 0.299 + color.g * 0.587 + color.b * 0.114;
}

// Returns the number of texels that a step of the search advances.
fn stride(step: i32) -> f32 {
    if step < 5 {
        return 1.0;
    }
    if step < 6 {
        return 1.5;
    }
    if step < 10 {
        return 2.0;
    }
    if step < 11 {
        return 4.0;
    }
    return 8.0;
}

@fragment
fn fs(in: Varying) -> @location(0) vec4f {
    let texel = params.color.rg;
    let uv = in.uv;
    let m = luma(uv);
    let n = luma(uv + vec2f(0.0, -texel.y));
    let s = luma(uv + vec2f(0.0, texel.y));
    let w = luma(uv + vec2f(-texel.x, 0.0));
    let e = luma(uv + vec2f(texel.x, 0.0));
    let brightest = max(max(max(n, s), max(w, e)), m);
    let darkest = min(min(min(n, s), min(w, e)), m);
    let contrast = brightest - darkest;
    if contrast < max(params.color.a, brightest * params.color.b) {
        return textureSampleLevel(source, filtering, uv, 0.0);
    }

    let nw = luma(uv - texel);
    let se = luma(uv + texel);
    let ne = luma(uv + vec2f(texel.x, -texel.y));
    let sw = luma(uv + vec2f(-texel.x, texel.y));

    // The difference of the texel from the mean of its neighbours.
    let mean = ((n + s + w + e) * 2.0 + (nw + ne) + (sw + se)) / 12.0;
    let apart = min(abs(mean - m) / contrast, 1.0);
    let smoothed = apart * apart * (3.0 - apart * 2.0);
    let single = smoothed * smoothed * params.back_color.r;

    let level = abs(nw + sw - w * 2.0) + abs(n + s - m * 2.0) * 2.0 + abs(ne + se - e * 2.0);
    let upright = abs(nw + ne - n * 2.0) + abs(w + e - m * 2.0) * 2.0 + abs(sw + se - s * 2.0);
    var along = vec2f(0.0, texel.y);
    var across = vec2f(texel.x, 0.0);
    var before = w;
    var behind = e;
    if !(level < upright) {
        along = vec2f(texel.x, 0.0);
        across = vec2f(0.0, texel.y);
        before = n;
        behind = s;
    }
    let rise = abs(before - m);
    let fall = abs(behind - m);
    var side = 1.0;
    var other = behind;
    if !(rise < fall) {
        side = -1.0;
        other = before;
    }
    let enough = max(rise, fall) * 0.25;
    let average = (other + m) * 0.5;

    // Between the two rows or columns of the edge.
    let start = uv + across * (side * 0.5);
    var walked = vec2f(0.0);
    var ends = vec2f(0.0);
    var arrived = vec2<bool>(false, false);
    for (var step = 0; step < 12; step++) {
        if !arrived.x {
            walked.x += stride(step);
            ends.x = luma(start - along * walked.x) - average;
            arrived.x = !(abs(ends.x) < enough);
        }
        if !arrived.y {
            walked.y += stride(step);
            ends.y = luma(start + along * walked.y) - average;
            arrived.y = !(abs(ends.y) < enough);
        }
        if all(arrived) {
            break;
        }
    }

    var end = ends.y;
    if walked.x < walked.y {
        end = ends.x;
    }
    // The texel keeps its colour on the side of the edge towards which the nearer end leans.
    var shift = 0.0;
    if (end < 0.0) != (m < average) {
        shift = 0.5 - min(walked.x, walked.y) / (walked.x + walked.y);
    }
    return textureSampleLevel(source, filtering, uv + across * (side * max(shift, single)), 0.0);
}
