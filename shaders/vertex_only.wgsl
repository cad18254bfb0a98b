// No fragment shader.

@vertex
fn vs(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}
