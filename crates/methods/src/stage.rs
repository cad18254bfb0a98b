//! Building scenes in code: attachments, passes, draws with everything off, polygons.

use crate::picture::{Paint, Surface};
use etalon_frame::TextureFormat;
use etalon_scene::{
    Attachment, BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTarget,
    CompareFunction, Contents, CullMode, DepthBias, DepthState, Draw, EarlyTests, FrontFace, Mesh,
    Multisample, Params, Pass, PolygonMode, PrimitiveTopology, Scene, Shader, Vertex, Viewport,
};

/// A flat convex polygon, as it is drawn.
#[derive(Clone, Debug)]
pub(crate) struct Polygon {
    /// Corners in order: x and y in texels from the top left corner, and the window depth.
    pub(crate) corners: Vec<[f64; 3]>,
    /// The vertex colour: straight red, green, blue and alpha.
    pub(crate) color: [f64; 4],
    /// Texture coordinates of each corner; empty for none.
    pub(crate) uv: Vec<[f64; 2]>,
}

impl Polygon {
    /// A polygon of one colour.
    pub(crate) fn new(corners: Vec<[f64; 3]>, color: [f64; 4]) -> Self {
        Self {
            corners,
            color,
            uv: Vec::new(),
        }
    }

    /// An upright rectangle between left, top, right and bottom in texels at one depth,
    /// counter-clockwise as it is seen: a front face.
    pub(crate) fn rect([left, top, right, bottom]: [f64; 4], depth: f64, color: [f64; 4]) -> Self {
        let corners = vec![
            [left, top, depth],
            [left, bottom, depth],
            [right, bottom, depth],
            [right, top, depth],
        ];
        Self::new(corners, color)
    }

    /// The polygon as the truth knows it, in its own colour.
    pub(crate) fn surface(&self) -> Surface {
        Surface {
            corners: self.corners.clone(),
            paint: Paint::Flat(self.color),
        }
    }
}

/// Polygons as a list of triangles, each polygon a fan around its first corner.
pub(crate) fn mesh(size: [u32; 2], polygons: &[Polygon]) -> Mesh {
    let clip = |value: f64, size: u32| value / f64::from(size) * 2.0 - 1.0;
    let vertex = |polygon: &Polygon, i: usize| {
        let [x, y, z] = polygon.corners[i];
        let uv = polygon.uv.get(i).copied().unwrap_or_default();
        Vertex {
            position: [
                clip(x, size[0]) as f32,
                -clip(y, size[1]) as f32,
                z as f32,
                1.0,
            ],
            color: polygon.color.map(|c| c as f32),
            uv: uv.map(|c| c as f32),
        }
    };
    let mut vertices = Vec::new();
    for polygon in polygons {
        for i in 1..polygon.corners.len().saturating_sub(1) {
            vertices.extend([0, i, i + 1].map(|i| vertex(polygon, i)));
        }
    }
    Mesh {
        vertices,
        indices: None,
    }
}

/// A draw of triangles with every test off and no blending.
pub(crate) fn draw(shader: Shader, mesh: Mesh) -> Draw {
    Draw {
        mesh,
        topology: PrimitiveTopology::TriangleList,
        shader,
        params: Params::default(),
        early_tests: EarlyTests::Implicit,
        textures: Vec::new(),
        sampler: None,
        counters: Vec::new(),
        cull: CullMode::None,
        front_face: FrontFace::Ccw,
        polygon_mode: PolygonMode::Fill,
        rasterizer_discard: false,
        // The pass knows better: `Stage::pass`.
        viewport: Viewport {
            rect: [0.0; 4],
            depth: [0.0, 1.0],
        },
        scissor: None,
        depth_bias: DepthBias::default(),
        depth_clamp: false,
        depth_bounds: None,
        depth: None,
        stencil: None,
        targets: vec![ColorTarget {
            blend: None,
            write_mask: 0b1111,
        }],
        logic: None,
        multisample: Multisample::default(),
        blend_constant: [0.0; 4],
    }
}

/// A triangle that covers everything, with texture coordinates 0 to 1 from the top left corner.
pub(crate) fn cover() -> Mesh {
    let vertex = |x: f32, y: f32| Vertex {
        position: [x, y, 0.0, 1.0],
        color: [1.0; 4],
        uv: [(x + 1.0) / 2.0, (1.0 - y) / 2.0],
    };
    Mesh {
        vertices: vec![vertex(-1.0, 1.0), vertex(-1.0, -3.0), vertex(3.0, 1.0)],
        indices: None,
    }
}

/// A depth test.
pub(crate) fn depth(compare: CompareFunction, write: bool) -> Option<DepthState> {
    Some(DepthState { compare, write })
}

/// A blend equation that adds.
pub(crate) fn add(src_factor: BlendFactor, dst_factor: BlendFactor) -> BlendComponent {
    BlendComponent {
        operation: BlendOperation::Add,
        src_factor,
        dst_factor,
    }
}

/// The same blend for colour and alpha.
pub(crate) fn both(component: BlendComponent) -> Option<BlendState> {
    Some(BlendState {
        color: component,
        alpha: component,
    })
}

/// Straight colours over what is there (Porter and Duff 1984): `over`.
pub(crate) fn over() -> Option<BlendState> {
    Some(BlendState {
        color: add(BlendFactor::SrcAlpha, BlendFactor::OneMinusSrcAlpha),
        alpha: add(BlendFactor::One, BlendFactor::OneMinusSrcAlpha),
    })
}

/// A scene while it is being built.
#[derive(Clone, Debug)]
pub(crate) struct Stage {
    attachments: Vec<Attachment>,
    passes: Vec<Pass>,
}

impl Stage {
    /// An empty scene.
    pub(crate) fn new() -> Self {
        Self {
            attachments: Vec::new(),
            passes: Vec::new(),
        }
    }

    /// Adds an attachment and gives its index.
    pub(crate) fn attachment(
        &mut self,
        name: impl Into<String>,
        format: TextureFormat,
        size: [u32; 2],
        samples: u32,
        contents: Contents,
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

    /// A single-sample colour attachment that is cleared.
    pub(crate) fn color(
        &mut self,
        name: impl Into<String>,
        format: TextureFormat,
        size: [u32; 2],
        clear: [f64; 4],
    ) -> usize {
        let contents = Contents::Color(clear.map(|c| c as f32));
        self.attachment(name, format, size, 1, contents)
    }

    /// A depth attachment, or one of depth and stencil, that is cleared; stencil to 0.
    pub(crate) fn depth(
        &mut self,
        name: impl Into<String>,
        format: TextureFormat,
        size: [u32; 2],
        samples: u32,
        clear: f32,
    ) -> usize {
        let contents = Contents::DepthStencil {
            depth: clear,
            stencil: 0,
        };
        self.attachment(name, format, size, samples, contents)
    }

    /// Adds a pass. A draw with one target has it for all of the pass's colour attachments, a draw
    /// without a viewport fills them.
    pub(crate) fn pass(&mut self, color: &[usize], depth_stencil: Option<usize>, draws: Vec<Draw>) {
        self.resolving_pass(color, vec![None; color.len()], depth_stencil, draws);
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
            depth_stencil_read_only: false,
            draws,
        });
    }

    /// The scene, of which these attachments are read back.
    pub(crate) fn read(self, read: &[usize]) -> Scene {
        Scene {
            attachments: self.attachments,
            passes: self.passes,
            read: read.to_vec(),
            counters: Vec::new(),
        }
    }
}

/// Numbers that look random and are the same for ever (SplitMix64: Steele and others 2014).
#[derive(Clone, Debug)]
pub(crate) struct Noise(u64);

impl Noise {
    /// The numbers of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next number from 0 to just below 1.
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The next number between two others.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + self.next() * (high - low)
    }
}

/// Asserts what the model promises of every scene: indices in range, sizes and samples that agree, no
/// pass that reads what it draws to, targets that the shader writes.
#[cfg(test)]
pub(crate) fn assert_valid(scene: &Scene) {
    assert!(!scene.read.is_empty());
    assert!(scene.read.iter().all(|i| *i < scene.attachments.len()));
    for a in &scene.attachments {
        let named = scene.attachments.iter().filter(|b| b.name == a.name);
        assert_eq!(named.count(), 1, "{}", a.name);
        if let Contents::Texels(codes) = &a.contents {
            let channels = a.format.color_channels().len();
            assert_eq!(codes.len(), (a.size[0] * a.size[1]) as usize * channels);
            assert_eq!(a.samples, 1);
        }
    }
    for pass in &scene.passes {
        let shape = |i: &usize| {
            let a = &scene.attachments[*i];
            (a.size, a.samples)
        };
        let drawn: Vec<usize> = pass
            .color
            .iter()
            .chain(&pass.depth_stencil)
            .copied()
            .collect();
        assert!(!drawn.is_empty());
        assert!(drawn.iter().all(|i| shape(i) == shape(&drawn[0])));
        let is_color = |i: &usize| scene.attachments[*i].format.is_color();
        assert!(pass.color.iter().all(is_color));
        assert!(!pass.depth_stencil.iter().any(is_color));
        assert_eq!(pass.resolve.len(), pass.color.len());
        for (from, to) in pass.color.iter().zip(&pass.resolve) {
            let Some(to) = to else { continue };
            let [from, to] = [from, to].map(|i| &scene.attachments[*i]);
            assert_eq!((from.format, from.size), (to.format, to.size));
            assert!(from.samples > 1 && to.samples == 1);
        }
        for draw in &pass.draws {
            assert_eq!(draw.targets.len(), pass.color.len());
            assert!(draw.targets.len() <= draw.shader.outputs());
            assert_eq!(draw.textures.len(), draw.shader.textures());
            assert_eq!(draw.sampler.is_some(), draw.shader.samples_texture());
            assert!(draw.depth.is_none() || pass.depth_stencil.is_some());
            assert!(!draw.multisample.alpha_to_coverage || shape(&drawn[0]).1 > 1);
            assert!(!draw.mesh.vertices.is_empty());
            let count = draw.mesh.vertices.len() as u32;
            let known = |i: &u32| *i < count;
            assert!(draw.mesh.indices.iter().flatten().all(known));
            for vertex in &draw.mesh.vertices {
                let [x, y, z, w] = vertex.position;
                assert!(x.abs() <= 64.0 && y.abs() <= 64.0, "{vertex:?}");
                assert!((0.0..=1.0).contains(&z) && w > 0.0, "{vertex:?}");
            }
            for texture in &draw.textures {
                let a = &scene.attachments[*texture];
                assert!(a.format.is_color() && a.samples == 1);
                assert!(!drawn.contains(texture) && !pass.resolve.contains(&Some(*texture)));
                assert!(draw.shader.samples_texture() || a.size == shape(&drawn[0]).0);
            }
        }
    }
}
