// One step of dual depth peeling (Bavoil and Myers 2008). Texture 0 has minus the nearest and the farthest
// depth that are not peeled yet; texture 1 has the premultiplied colour in front of them. All three outputs
// are blended by their maximum: depths for the next step, front, and the farthest layer's own colour.

@group(0) @binding(1) var depths: texture_2d<f32>;
@group(0) @binding(2) var front: texture_2d<f32>;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) color: vec4f,
}

@vertex
fn vs(@location(0) position: vec4f, @location(1) color: vec4f) -> Varying {
    return Varying(position, color);
}

struct Output {
    @location(0) depths: vec4f,
    @location(1) front: vec4f,
    @location(2) back: vec4f,
}

@fragment
fn fs(in: Varying) -> Output {
    let texel = vec2i(in.position.xy);
    let range = textureLoad(depths, texel, 0);
    let before = textureLoad(front, texel, 0);
    let nearest = -range.x;
    let farthest = range.y;
    let depth = in.position.z;
    var output = Output(vec4f(-1.0, -1.0, 0.0, 1.0), before, vec4f(0.0));
    if depth < nearest || depth > farthest {
        return output;
    }
    if depth > nearest && depth < farthest {
        output.depths = vec4f(-depth, depth, 0.0, 1.0);
        return output;
    }
    if depth == nearest {
        let left = 1.0 - before.a;
        output.front = before + vec4f(in.color.rgb * in.color.a, in.color.a) * left;
    } else {
        output.back = in.color;
    }
    return output;
}
