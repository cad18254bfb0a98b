//! Descriptions of a scene's kernels.

use super::layout::WordLayout;
use super::paint::{Kernel, TexelPaint};
use super::plan::{KernelPlan, PassKernels, Shading};
use etalon_scene::{Draw, Scene};
use fearless_simd::{Level, dispatch};

/// Returns the kernels of a scene's draws, one line per draw, or one line with the reason why the scene has
/// no kernels.
pub(crate) fn lines(scene: &Scene, least: usize) -> Vec<String> {
    let plan = match KernelPlan::new(scene, least) {
        Ok(plan) => plan,
        Err(reason) => return vec![format!("spans, since there is no kernel for {reason}")],
    };
    let mut lines = Vec::new();
    for (number, pass) in plan.passes.iter().enumerate() {
        for draw_plan in &pass.draws {
            let draw = &scene.passes[number].draws[draw_plan.index];
            let mut line = format!("pass {number}, draw {}: tiles", draw_plan.index);
            let colors = match draw_plan.shading {
                Shading::Vertex => "flat colours of vertices",
                Shading::Expensive(_) => "flat colours of vertices after work",
                Shading::Kept(_) => "flat colours of vertices unless discarded",
                Shading::Depth => "one colour at exported depths",
                Shading::Texels(_, None) => "texels",
                Shading::Texels(..) => "texels of two textures",
                Shading::Facing => "a colour for each facing",
                Shading::Uniform => "one colour",
                Shading::Nothing => "no colour",
                Shading::Texture { .. } => "nearest texels",
            };
            line.push_str(&format!(
                "; {colors}, {}",
                paint(draw, draw_plan.shading, pass)
            ));
            if let Some(depth) = &draw_plan.depth {
                let write = if depth.write { ", written" } else { "" };
                line.push_str(&format!("; depth {:?}{write}", depth.compare));
            }
            if draw_plan.stencil.is_some() {
                line.push_str("; stencil");
            }
            if pass.positions.len() > 1 {
                line.push_str(&format!("; {} samples", pass.positions.len()));
            }
            lines.push(line);
        }
    }
    lines
}

/// Returns a description of the kernel of a draw's first colour.
fn paint(draw: &Draw, shading: Shading, pass: &PassKernels) -> &'static str {
    let color = match shading {
        Shading::Texture { .. } => return "stored unchanged",
        Shading::Vertex | Shading::Expensive(_) | Shading::Kept(_) => {
            draw.mesh.vertices.first().map_or([0.0; 4], |v| v.color)
        }
        Shading::Depth | Shading::Facing | Shading::Uniform => draw.params.color,
        Shading::Nothing | Shading::Texels(..) => [0.0; 4],
    };
    let paint = dispatch!(Level::new(), simd => TexelPaint::new(
        simd, draw, shading, color, pass, false
    ));
    match paint.kernel {
        Kernel::Keep => "not written",
        Kernel::Store(_) => "stored",
        Kernel::Bits(bits) if bits.replaces() => "stored",
        Kernel::Bits(bits) if bits.is_mask(&WordLayout::new(pass.channels)) => {
            "stored through a mask"
        }
        Kernel::Bits(_) => "a function of each code's bits",
        Kernel::Linear(_) => "a linear function of each code",
        Kernel::Table(_) => "a table of each code",
        Kernel::Weighted(_) => "factors of few channels",
        Kernel::Affine(_) => "a product and a sum in each channel",
        Kernel::Copy => "copied",
        Kernel::Varying(_) => "plain arithmetic on two operands",
        Kernel::Lanes(_) => "plain arithmetic on codes",
    }
}
