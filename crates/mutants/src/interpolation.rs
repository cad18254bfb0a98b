//! Bugs of interpolation: how attributes vary over a primitive, and where they are sampled.

use crate::fields::{FieldPlaces, VERTICES};
use crate::hooks::interpolation;
use crate::list::bugs;
use crate::plant::{Plant, draws, each};
use Interpolation::{Linear, Perspective};
use InterpolationSampling::{Center, Centroid, Sample};
use etalon_scene::{Interpolation, InterpolationSampling, Shader, Vertex};

/// The vertices of draws that read interpolated coordinates.
const READ: FieldPlaces<Vertex> = |d| {
    let reads = d.shader.uses_uv();
    d.mesh.vertices.iter_mut().filter(|_| reads).collect()
};

/// Moves per-sample interpolation to other points.
fn sampled(elsewhere: InterpolationSampling) -> Plant {
    interpolation(
        move |shader: Shader, _| match shader.interpolation_sampling() {
            Sample => (shader.interpolation(), elsewhere),
            sampling => (shader.interpolation(), sampling),
        },
    )
}

bugs! {
    class "interpolation", "texture";
    "always-linear: Attributes are linear in the window, whatever w is." =>
        interpolation(|shader: Shader, _| (Linear, shader.interpolation_sampling()));
    "always-perspective: Attributes are linear in space, where the shader wants them in the window too." =>
        interpolation(|shader: Shader, _| (Perspective, shader.interpolation_sampling())),
        source "a driver without `noperspective`";
    "samples-at-centre: What is interpolated at samples is that of the texel's centre." => sampled(Center);
    "samples-at-centroid: What is interpolated at samples is that of the first covered one." => sampled(Centroid);
    "over-w: Attributes are divided by w, and not multiplied again." =>
        each(READ, |v| { let w = v.position[3]; if w > 0.0 { v.uv = v.uv.map(|c| c / w); } });
    "of-the-cut: A clipped triangle's attributes run over what is left of it." =>
        each(VERTICES, |v| if v.position[3] < 0.0 { v.uv = v.uv.map(|c| c * 0.5) });
    "w-for-its-reciprocal: The fragment's coordinates hold w instead of 1 over w." =>
        each(VERTICES, |v| {
            let w = v.position[3];
            if w > 0.0 { v.position = v.position.map(|p| p / (w * w)); }
        }), when |draw| draw.shader.reads_w();
    "either-is-the-middle: A flat value of either end is that of the second vertex." =>
        draws(|draw| {
            for triangle in draw.mesh.vertices.chunks_mut(3) {
                let color = triangle.get(1).map_or([0.0; 4], |v| v.color);
                triangle.iter_mut().for_each(|v| v.color = color);
            }
        }), when |draw| draw.shader.flat_from_either();
}
