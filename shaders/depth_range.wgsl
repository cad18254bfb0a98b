// The fragment's depth with both signs, for a blend that keeps the maximum: first minus the nearest,
// then the farthest.

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(-position.z, position.z, 0.0, 1.0);
}
