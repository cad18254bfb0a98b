#version 450
// Each corner of the domain has the position of its vertex, bit for bit. ORDER is cw or ccw.

layout(triangles, equal_spacing, ORDER) in;

void main() {
    if (gl_TessCoord.x > 0.5) {
        gl_Position = gl_in[0].gl_Position;
    } else if (gl_TessCoord.y > 0.5) {
        gl_Position = gl_in[1].gl_Position;
    } else {
        gl_Position = gl_in[2].gl_Position;
    }
}
