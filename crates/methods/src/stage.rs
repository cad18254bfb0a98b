//! Building scenes in code: attachments, passes, and draws with every test and blending off.

use crate::polygon::cover;
use etalon_frame::TextureFormat;
use etalon_scene::{
    AddressMode, Attachment, AttachmentContents, BlendComponent, BlendFactor, BlendOperation,
    BlendState, CompareFunction, DepthState, Draw, FilterMode, Mesh, Pass, Path, Pool, QueryScope,
    Sampler, Scene, Shader, Viewport,
};

/// Width and height of a method's picture in texels, unless a scene needs another size.
pub(crate) const SIZE: [u32; 2] = [128, 128];

/// Returns a draw of triangles with every test off and no blending. [`Stage::pass`] sets its viewport.
pub(crate) fn draw(shader: Shader, mesh: Mesh) -> Draw {
    Draw::new(shader, mesh, Viewport::whole([0, 0]))
}

/// Returns a depth test.
pub(crate) fn depth(compare: CompareFunction, write: bool) -> Option<DepthState> {
    Some(DepthState { compare, write })
}

/// The depth test that keeps the nearest surface, and the last one of those at the same depth, as the truth does.
pub(crate) const NEARER: Option<DepthState> = Some(DepthState {
    compare: CompareFunction::LessEqual,
    write: true,
});

/// The format of depths whose precision is not in question.
pub(crate) const DEPTHS: TextureFormat = TextureFormat::Depth32Float;

/// Returns the component of a blend equation that adds.
pub(crate) fn add(src_factor: BlendFactor, dst_factor: BlendFactor) -> BlendComponent {
    BlendComponent {
        operation: BlendOperation::Add,
        src_factor,
        dst_factor,
    }
}

/// Returns the same blend equation for colour and alpha.
pub(crate) fn both(component: BlendComponent) -> Option<BlendState> {
    Some(BlendState {
        color: component,
        alpha: component,
    })
}

/// Returns the blend state `over` for straight colours (Porter and Duff 1984).
pub(crate) fn over() -> Option<BlendState> {
    Some(BlendState {
        color: add(BlendFactor::SrcAlpha, BlendFactor::OneMinusSrcAlpha),
        alpha: add(BlendFactor::One, BlendFactor::OneMinusSrcAlpha),
    })
}

/// Returns a draw of a texture at half its size: a linear filter exactly between four texels returns their
/// mean.
fn halved(texture: usize) -> Draw {
    let mut draw = draw(Shader::SampledColor, cover());
    draw.textures = vec![texture];
    draw.sampler = Some(Sampler {
        filter: FilterMode::Linear,
        address: [AddressMode::ClampToEdge; 2],
    });
    draw
}

/// A scene that is being built.
#[derive(Clone, Debug)]
pub(crate) struct Stage {
    attachments: Vec<Attachment>,
    passes: Vec<Pass>,
    pool: Option<Pool>,
}

impl Stage {
    /// Returns an empty scene.
    pub(crate) fn new() -> Self {
        Self {
            attachments: Vec::new(),
            passes: Vec::new(),
            pool: None,
        }
    }

    /// Adds an attachment and returns its index.
    pub(crate) fn attachment(
        &mut self,
        name: impl Into<String>,
        format: TextureFormat,
        size: [u32; 2],
        samples: u32,
        contents: AttachmentContents,
    ) -> usize {
        self.attachments.push(Attachment {
            name: name.into(),
            format,
            size,
            samples,
            contents,
        });
        self.attachments.len() - 1
    }

    /// Adds a single-sample colour attachment that is cleared.
    pub(crate) fn color(
        &mut self,
        name: impl Into<String>,
        format: TextureFormat,
        size: [u32; 2],
        clear: [f64; 4],
    ) -> usize {
        let contents = AttachmentContents::Color(clear.map(|c| c as f32));
        self.attachment(name, format, size, 1, contents)
    }

    /// Adds a depth attachment, with or without stencil, that is cleared; stencil to 0.
    pub(crate) fn depth(
        &mut self,
        name: impl Into<String>,
        format: TextureFormat,
        size: [u32; 2],
        samples: u32,
        clear: f32,
    ) -> usize {
        let contents = AttachmentContents::DepthStencil {
            depth: clear,
            stencil: 0,
        };
        self.attachment(name, format, size, samples, contents)
    }

    /// Sets the scene's pool.
    pub(crate) fn pool(&mut self, pool: Pool) {
        self.pool = Some(pool);
    }

    /// Adds a pass. A draw with one target uses it for all colour attachments of the pass, and a draw
    /// without a viewport covers them.
    pub(crate) fn pass(&mut self, color: &[usize], depth_stencil: Option<usize>, draws: Vec<Draw>) {
        self.resolving_pass(color, vec![None; color.len()], depth_stencil, draws);
    }

    /// Adds passes that draw to an attachment whose sides are the picture's, doubled `doublings` times, and
    /// then halve it repeatedly. Meshes do not depend on texels, so the same mesh fills an attachment of any
    /// size. A draw that tests depths gets an attachment for them.
    pub(crate) fn supersampled(
        &mut self,
        picture: usize,
        clear: [f64; 4],
        doublings: u32,
        draw: Draw,
    ) {
        let Attachment { format, size, .. } = self.attachments[picture];
        let mut draw = Some(draw);
        let mut from = picture;
        for step in (0..=doublings).rev() {
            let to = match step {
                0 => picture,
                _ => self.color(
                    format!("large_{step}"),
                    format,
                    size.map(|s| s << step),
                    clear,
                ),
            };
            let next = draw.take().unwrap_or_else(|| halved(from));
            let large = self.attachments[to].size;
            let tested = next.depth.is_some();
            let depths = tested.then(|| self.depth("depth", DEPTHS, large, 1, 1.0));
            self.pass(&[to], depths, vec![next]);
            from = to;
        }
    }

    /// Adds a pass whose colour attachments are resolved to others.
    pub(crate) fn resolving_pass(
        &mut self,
        color: &[usize],
        resolve: Vec<Option<usize>>,
        depth_stencil: Option<usize>,
        mut draws: Vec<Draw>,
    ) {
        let first = color.first().copied().or(depth_stencil);
        let size = first.map_or([1, 1], |index| self.attachments[index].size);
        for draw in &mut draws {
            if draw.viewport.rect == [0.0; 4] {
                draw.viewport.rect = [0.0, 0.0, size[0] as f32, size[1] as f32];
            }
            if let [target] = draw.targets[..] {
                draw.targets = vec![target; color.len()];
            }
        }
        self.passes.push(Pass {
            color: color.to_vec(),
            resolve,
            depth_stencil,
            draws,
            ..Pass::default()
        });
    }

    /// Returns the scene, which reads back these attachments.
    pub(crate) fn read(self, read: &[usize]) -> Scene {
        Scene {
            attachments: self.attachments,
            passes: self.passes,
            read: read.to_vec(),
            counters: Vec::new(),
            query_scope: QueryScope::Draw,
            pool: self.pool,
            path: Path::default(),
        }
    }
}
