// The fragment's own window depth as grey.

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}

@fragment
fn fs(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(vec3f(position.z), 1.0);
}
