//! Probing of what wgpu advertises.
//!
//! wgpu's OpenGL advertises four samples on drivers that have one, and then draws to one. With
//! four, wgpu 30 creates textures for shaders with the single-sample target, which OpenGL refuses.
//! So a scene is drawn whose samples must differ, and each is read back.
//!
//! It also advertises shaders that it cannot translate, or that the driver cannot compile, so one
//! of each kind is compiled.

use crate::gpu::Gpu;
use crate::limits::SAMPLES;
use crate::prepared::PreparedScene;
use etalon_backend::{BackendError, Prepared};
use etalon_frame::{CounterKind, Feature, Frame, TextureFormat};
use etalon_scene::{
    Attachment, CompareFunction, Contents, Counter, DepthState, Draw, EarlyTests, Mesh, Pass,
    PrimitiveTopology, Scene, Shader, StencilFace, StencilOperation, StencilState, Vertex,
    Viewport,
};

/// Width and height of the attachments.
const SIDE: u32 = 4;
/// The half-covered column.
const EDGE: u32 = 2;
const COLOR: TextureFormat = TextureFormat::Rgba8Unorm;
const DEPTH_STENCIL: TextureFormat = TextureFormat::Depth24PlusStencil8;

/// Returns true if an edge through a column of texels covers some of its samples, in colour, depth
/// and stencil alike, all to its left and none to its right.
///
/// # Errors
/// If the device is lost. After any other error multisampling does not work.
pub(crate) fn samples_work(gpu: &Gpu) -> Result<bool, BackendError> {
    let offered = [COLOR, DEPTH_STENCIL].iter().all(|format| {
        let support = gpu.limits.formats.get(format);
        support.is_some_and(|s| s.samples.contains(&SAMPLES))
    });
    if !offered {
        return Ok(false);
    }
    let drawn = PreparedScene::new(gpu, &scene(SAMPLES)).and_then(|mut prepared| {
        prepared.submit()?;
        prepared.read_back()
    });
    match drawn {
        Ok(frame) => Ok(has_samples(&frame)),
        Err(error @ BackendError::DeviceLost(_)) => Err(error),
        Err(_) => Ok(false),
    }
}

/// Removes the features whose shaders do not compile. Returns true if any was removed. Conservative
/// depth may need an extension that wgpu does not request, and wgpu offers storage buffers in GLSL
/// 330, to which it does not translate them.
///
/// # Errors
/// If the device is lost.
pub(crate) fn deny_uncompilable_features(gpu: &mut Gpu) -> Result<bool, BackendError> {
    let mut denied = false;
    let shaders = [
        (
            Feature::ConservativeDepth,
            Shader::FragCoordDepth,
            EarlyTests::Unchanged,
        ),
        (
            Feature::StorageCounters,
            Shader::CountedColor,
            EarlyTests::Implicit,
        ),
    ];
    for (feature, shader, early_tests) in shaders {
        if !gpu.limits.features.contains(&feature) {
            continue;
        }
        let mut scene = scene(1);
        for draw in scene.passes.iter_mut().flat_map(|pass| &mut pass.draws) {
            (draw.shader, draw.early_tests) = (shader, early_tests);
            if shader.counts_runs() {
                draw.counters = vec![0];
            }
        }
        if shader.counts_runs() {
            scene.counters = vec![Counter {
                name: "runs".to_owned(),
                kind: CounterKind::ShaderRuns,
            }];
        }
        let compiled = match PreparedScene::new(gpu, &scene) {
            Ok(_) => true,
            Err(error @ BackendError::DeviceLost(_)) => return Err(error),
            Err(_) => false,
        };
        if !compiled {
            denied |= gpu.limits.features.remove(&feature);
        }
    }
    Ok(denied)
}

fn has_samples(frame: &Frame) -> bool {
    let [color, depth, stencil] = frame.images.as_slice() else {
        return false;
    };
    let covered = |x, y, sample| {
        let first = |image: &etalon_frame::Image| image.sample(x, y, sample)[0];
        match (first(color), first(depth), first(stencil)) {
            (255, 0, 1) => Some(true),
            (0, one, 0) if one == 1_f32.to_bits() => Some(false),
            _ => None,
        }
    };
    let texel_is_right = |x, y| {
        let samples: Option<Vec<bool>> = (0..SAMPLES).map(|s| covered(x, y, s)).collect();
        samples.is_some_and(|samples| {
            let count = samples.iter().filter(|covered| **covered).count() as u32;
            match x {
                EDGE => count > 0 && count < SAMPLES,
                _ if x < EDGE => count == SAMPLES,
                _ => count == 0,
            }
        })
    };
    (0..SIDE).all(|y| (0..SIDE).all(|x| texel_is_right(x, y)))
}

fn scene(samples: u32) -> Scene {
    let attachment = |name: &str, format, contents| Attachment {
        name: name.to_owned(),
        format,
        size: [SIDE; 2],
        samples,
        contents,
    };
    let cleared = Contents::DepthStencil {
        depth: 1.0,
        stencil: 0,
    };
    Scene {
        attachments: vec![
            attachment("color", COLOR, Contents::Color([0.0; 4])),
            attachment("depth_stencil", DEPTH_STENCIL, cleared),
        ],
        passes: vec![Pass {
            color: vec![0],
            resolve: vec![None],
            depth_stencil: Some(1),
            depth_stencil_read_only: false,
            draws: vec![draw()],
        }],
        read: vec![0, 1],
        counters: Vec::new(),
    }
}

/// Draws a white rectangle left of the middle of the edge column, with depth 0 and stencil 1.
fn draw() -> Draw {
    let edge = (EDGE as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0;
    let corners = [[-1.0, -1.0], [edge, -1.0], [-1.0, 1.0], [edge, 1.0]];
    let vertex = |[x, y]: [f32; 2]| Vertex {
        position: [x, y, 0.0, 1.0],
        color: [1.0; 4],
        uv: [0.0; 2],
    };
    let face = StencilFace {
        compare: CompareFunction::Always,
        fail_op: StencilOperation::Keep,
        depth_fail_op: StencilOperation::Keep,
        pass_op: StencilOperation::Replace,
        read_mask: 0xff,
        write_mask: 0xff,
        reference: 1,
    };
    let mesh = Mesh {
        vertices: corners.map(vertex).to_vec(),
        indices: None,
    };
    Draw {
        topology: PrimitiveTopology::TriangleStrip,
        depth: Some(DepthState {
            compare: CompareFunction::Always,
            write: true,
        }),
        stencil: Some(StencilState {
            front: face,
            back: face,
        }),
        ..Draw::new(Shader::FlatColor, mesh, Viewport::whole([SIDE; 2]))
    }
}
