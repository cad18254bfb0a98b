//! Scenes rewritten for their paths.
//!
//! The values of [`PathStart`], [`PathDraws`] and [`PathTests`] need nothing from an API that a scene cannot
//! express: a load operation, a clear command, a draw, indices, a test. They are therefore applied here once,
//! as another scene with the same picture, for every backend; a backend executes the other keys itself.

use crate::attachment::AttachmentContents;
use crate::blend::ColorTarget;
use crate::depth_stencil::{
    CompareFunction, DepthState, StencilFace, StencilOperation, StencilState,
};
use crate::draw::{Draw, Params};
use crate::fetch::{IndexFormat, RESTART_16};
use crate::mesh::{Mesh, RESTART, Vertex};
use crate::pass::{Clear, ClearTarget, LoadOperation, Operations, Pass};
use crate::path::Path;
use crate::rasterization::{PrimitiveTopology, Viewport};
use crate::scene::Scene;
use crate::shader::Shader;
use etalon_frame::{ChannelEncoding, PathDraws, PathStart, PathTests, TextureFormat};
use std::borrow::Cow;

impl Scene {
    /// Returns the scene that backends draw: the same picture, with the path's `start`, `draws` and `tests`
    /// applied.
    ///
    /// Attachments that receive their contents within a pass have other contents before it, so that a lost
    /// start is visible. Some contents are not affected and stay with a transfer: uploaded texels,
    /// attachments that are read or resolved to before they are drawn to, and values that a draw might
    /// convert in two ways.
    pub fn on_path(&self) -> Cow<'_, Self> {
        let Path {
            start,
            draws,
            tests,
            ..
        } = self.path;
        if (start, draws, tests) == (PathStart::Transfer, PathDraws::Direct, PathTests::Off) {
            return Cow::Borrowed(self);
        }
        let mut made = self.clone();
        made.start();
        let draws = made.passes.iter_mut().flat_map(|p| &mut p.draws);
        draws.for_each(|draw| call_by(draw, self.path.draws));
        if tests == PathTests::Unattached {
            made.test_unattached();
        }
        Cow::Owned(made)
    }

    /// Enables the tests of aspects that passes do not have: such tests are skipped, or pass, and write
    /// nothing (Vulkan, Depth Test, Stencil Test; OpenGL 4.6, 17.3.3, 17.3.4; OpenGL ES 3.2, 15.1.2, 15.1.3).
    fn test_unattached(&mut self) {
        for pass in &mut self.passes {
            let format = pass
                .depth_stencil
                .map(|index| self.attachments[index].format);
            for draw in &mut pass.draws {
                if !format.is_some_and(TextureFormat::has_depth) {
                    draw.depth = Some(DepthState::REJECTING);
                }
                if !format.is_some_and(TextureFormat::has_stencil) {
                    draw.stencil = Some(StencilState {
                        front: StencilFace::REJECTING,
                        back: StencilFace::REJECTING,
                    });
                }
            }
        }
    }

    /// Moves the initial contents of attachments into the passes that first use them.
    fn start(&mut self) {
        let mut used = vec![false; self.attachments.len()];
        for number in 0..self.passes.len() {
            let mut pass = std::mem::take(&mut self.passes[number]);
            let read: Vec<usize> = pass
                .draws
                .iter()
                .flat_map(|d| &d.textures)
                .copied()
                .filter(|index| !pass.attaches(*index))
                .collect();
            for index in read.into_iter().chain(pass.resolve_targets()) {
                used[index] = true;
            }
            let first: Vec<usize> = pass
                .color
                .iter()
                .copied()
                .filter(|index| !std::mem::replace(&mut used[*index], true))
                .collect();
            let tested = pass
                .depth_stencil
                .filter(|index| !std::mem::replace(&mut used[*index], true))
                .filter(|_| !pass.depth_stencil_read_only);
            match self.path.start {
                PathStart::Transfer => {}
                PathStart::LoadOperation => self.load(&mut pass, &first, tested),
                PathStart::ClearCommand => self.clear(&mut pass, &first, tested),
                PathStart::Draw => self.draw(&mut pass, &first, tested),
            }
            self.passes[number] = pass;
        }
    }

    /// Takes the contents of a colour attachment that its pass loads, and replaces them by others.
    fn take_color(&mut self, pass: &Pass, location: usize, first: &[usize]) -> Option<[f32; 4]> {
        let index = pass.color[location];
        let loads = pass.color_operations(location).load == LoadOperation::Load;
        let contents = &mut self.attachments[index].contents;
        match *contents {
            AttachmentContents::Color(value) if loads && first.contains(&index) => {
                *contents =
                    AttachmentContents::Color(value.map(|v| if v > 0.5 { 0.0 } else { 1.0 }));
                Some(value)
            }
            _ => None,
        }
    }

    /// Takes the contents of the aspects of a depth-stencil attachment that its pass loads.
    fn take_depth_stencil(&mut self, pass: &Pass, index: usize) -> (Option<f32>, Option<u8>) {
        let attachment = &mut self.attachments[index];
        let format = attachment.format;
        let AttachmentContents::DepthStencil { depth, stencil } = &mut attachment.contents else {
            return (None, None);
        };
        let loads = pass.operations.depth.load == LoadOperation::Load;
        let near = (format.has_depth() && loads).then_some(*depth);
        if let Some(value) = near {
            *depth = if value > 0.5 { 0.0 } else { 1.0 };
        }
        let loads = pass.operations.stencil.load == LoadOperation::Load;
        let bits = (format.has_stencil() && loads).then_some(*stencil);
        if let Some(value) = bits {
            *stencil = !value;
        }
        (near, bits)
    }

    fn load(&mut self, pass: &mut Pass, first: &[usize], tested: Option<usize>) {
        for location in 0..pass.color.len() {
            let Some(value) = self.take_color(pass, location, first) else {
                continue;
            };
            let operations = &mut pass.operations.color;
            if operations.len() < pass.color.len() {
                operations.resize(pass.color.len(), Operations::default());
            }
            operations[location].load = LoadOperation::Clear(value);
        }
        if let Some(index) = tested {
            let (depth, stencil) = self.take_depth_stencil(pass, index);
            if let Some(value) = depth {
                pass.operations.depth.load = LoadOperation::Clear(value);
            }
            if let Some(value) = stencil {
                pass.operations.stencil.load = LoadOperation::Clear(value);
            }
        }
    }

    fn clear(&mut self, pass: &mut Pass, first: &[usize], tested: Option<usize>) {
        let mut clears = Vec::new();
        let mut add = |target| {
            clears.push(Clear {
                before: 0,
                target,
                rect: None,
            });
        };
        for location in 0..pass.color.len() {
            if let Some(value) = self.take_color(pass, location, first) {
                add(ClearTarget::Color {
                    location,
                    value,
                    write_mask: 0b1111,
                });
            }
        }
        if let Some(index) = tested {
            let (depth, stencil) = self.take_depth_stencil(pass, index);
            if depth.is_some() || stencil.is_some() {
                add(ClearTarget::DepthStencil {
                    depth,
                    stencil,
                    depth_write: true,
                    stencil_write_mask: 0xff,
                });
            }
        }
        pass.clears.splice(0..0, clears);
    }

    /// Draws the first colour attachment, depth and stencil with values that no conversion changes. The
    /// shader's color is a float, which WebGPU refuses next to integer attachments, whatever the write mask.
    fn draw(&mut self, pass: &mut Pass, first: &[usize], tested: Option<usize>) {
        let integer = |index: &usize| self.attachments[*index].format.is_integer();
        if pass.color.iter().any(integer) {
            return;
        }
        let color = match pass.color.first() {
            Some(index) if self.is_exact_color(*index) => self.take_color(pass, 0, first),
            _ => None,
        };
        let tested = tested.filter(|index| self.is_exact_depth(*index));
        let (depth, stencil) = match tested {
            Some(index) => self.take_depth_stencil(pass, index),
            None => (None, None),
        };
        if color.is_none() && depth.is_none() && stencil.is_none() {
            return;
        }
        let vertex = |[x, y]: [f32; 2]| Vertex {
            position: [x, y, 0.0, 1.0],
            color: [depth.unwrap_or(0.0); 4],
            uv: [0.0; 2],
        };
        let mesh = Mesh {
            vertices: [[-2.0, -2.0], [8.0, -2.0], [-2.0, 8.0]]
                .map(vertex)
                .to_vec(),
            indices: None,
        };
        let mut targets = vec![
            ColorTarget {
                write_mask: 0,
                ..ColorTarget::default()
            };
            pass.color.len()
        ];
        if let (Some(target), Some(_)) = (targets.first_mut(), color) {
            target.write_mask = 0b1111;
        }
        let face = |reference| StencilFace {
            compare: CompareFunction::Always,
            fail_op: StencilOperation::Replace,
            depth_fail_op: StencilOperation::Replace,
            pass_op: StencilOperation::Replace,
            read_mask: 0xff,
            write_mask: 0xff,
            reference,
        };
        let size = self.pass_size(pass);
        pass.draws.insert(
            0,
            Draw {
                params: Params {
                    color: color.unwrap_or_default(),
                    back_color: [0.0; 4],
                },
                depth: depth.map(|_| DepthState {
                    compare: CompareFunction::Always,
                    write: true,
                }),
                stencil: stencil.map(face).map(|face| StencilState {
                    front: face,
                    back: face,
                }),
                targets,
                ..Draw::new(Shader::FlatColorDepth, mesh, Viewport::whole(size))
            },
        );
        for clear in &mut pass.clears {
            clear.before += 1;
        }
    }

    /// Returns true if a draw stores exactly what a clear does.
    fn is_exact_color(&self, index: usize) -> bool {
        let attachment = &self.attachments[index];
        let AttachmentContents::Color(value) = attachment.contents else {
            return false;
        };
        let exact = |encoding: &ChannelEncoding, v: f32| match encoding {
            ChannelEncoding::Uint(_) => false,
            // Few bits and a small exponent, which the smallest float format can store.
            _ if encoding.is_float() => v == 0.0 || v == 1.0 || v == 0.5 || v == 0.25,
            _ => v == 0.0 || v == 1.0,
        };
        let channels = attachment.format.color_channels();
        channels.iter().zip(value).all(|(e, v)| exact(e, v))
    }

    /// Returns true if a shader's depth is stored exactly as a clear's is.
    fn is_exact_depth(&self, index: usize) -> bool {
        let attachment = &self.attachments[index];
        let AttachmentContents::DepthStencil { depth, .. } = attachment.contents else {
            return false;
        };
        let encodings = attachment.format.depth_encodings();
        depth == 0.0 || depth == 1.0 || encodings.iter().all(|e| e.is_float())
    }
}

/// The number of vertices and indices before those of a draw with a base vertex.
const UNUSED: u32 = 2;

/// Rewrites a draw for other draw calls, if possible.
fn call_by(draw: &mut Draw, draws: PathDraws) {
    match draws {
        PathDraws::Direct
        | PathDraws::Indirect
        | PathDraws::IndirectCount
        | PathDraws::IndirectBeside
        | PathDraws::AfterEmpty
        | PathDraws::RestartUnindexed => {}
        PathDraws::Indexed16 => index(draw, IndexFormat::Uint16),
        PathDraws::Indexed32 => index(draw, IndexFormat::Uint32),
        PathDraws::BaseVertex => {
            index(draw, draw.fetch.index);
            if draw.mesh.indices.is_some() && draw.fetch.base_vertex == 0 {
                draw.fetch.base_vertex = UNUSED as i32;
                draw.fetch.first_index += UNUSED + 1;
            }
        }
        PathDraws::Instanced => {
            let colors = || draw.mesh.vertices.iter().map(|v| v.color.map(f32::to_bits));
            let is_uniform = colors()
                .next()
                .is_some_and(|first| colors().all(|c| c == first));
            if is_uniform && draw.fetch.instances == 0 {
                draw.fetch.instances = 1;
            }
        }
        PathDraws::Restart => restart(draw),
    }
}

/// Gives a draw indices of this size, if it is not instanced and they fit.
fn index(draw: &mut Draw, format: IndexFormat) {
    if draw.fetch.instances > 0 {
        return;
    }
    let vertices = draw.mesh.vertices.len() as u32;
    // The greatest 16-bit index restarts a strip.
    if format == IndexFormat::Uint16 && vertices >= u32::from(RESTART_16) {
        return;
    }
    draw.fetch.first_vertex = 0;
    draw.fetch.index = format;
    draw.mesh
        .indices
        .get_or_insert_with(|| (0..vertices).collect());
}

/// Turns a list into a strip, with restart indices between the primitives.
fn restart(draw: &mut Draw) {
    let (topology, size) = match draw.topology {
        PrimitiveTopology::LineList => (PrimitiveTopology::LineStrip, 2),
        PrimitiveTopology::TriangleList => (PrimitiveTopology::TriangleStrip, 3),
        _ => return,
    };
    if draw.fetch.instances > 0 {
        return;
    }
    index(draw, draw.fetch.index);
    let Some(list) = draw.mesh.indices.take() else {
        return;
    };
    let primitives = list
        .split(|i| *i == RESTART)
        .flat_map(|run| run.chunks_exact(size));
    let parted: Vec<Vec<u32>> = primitives.map(<[u32]>::to_vec).collect();
    draw.mesh.indices = Some(parted.join(&RESTART));
    draw.topology = topology;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::Attachment;
    use crate::query_scope::QueryScope;

    fn scene(path: Path) -> Scene {
        let attachment = |format, contents| Attachment {
            name: String::new(),
            format,
            size: [4, 4],
            samples: 1,
            contents,
        };
        let near = AttachmentContents::DepthStencil {
            depth: 1.0,
            stencil: 7,
        };
        let mesh = Mesh {
            vertices: vec![
                Vertex {
                    position: [0.0; 4],
                    color: [0.0; 4],
                    uv: [0.0; 2]
                };
                6
            ],
            indices: None,
        };
        let draw = Draw::new(Shader::FlatColor, mesh, Viewport::whole([4, 4]));
        let pass = Pass {
            color: vec![0],
            resolve: vec![None],
            depth_stencil: Some(1),
            draws: vec![draw],
            ..Pass::default()
        };
        Scene {
            attachments: vec![
                attachment(
                    TextureFormat::Rgba8Unorm,
                    AttachmentContents::Color([1.0; 4]),
                ),
                attachment(TextureFormat::Depth24PlusStencil8, near),
            ],
            passes: vec![pass.clone(), pass],
            read: vec![0],
            counters: Vec::new(),
            query_scope: QueryScope::Draw,
            pool: None,
            path,
        }
    }

    fn started(start: PathStart) -> Scene {
        let path = Path {
            start,
            ..Path::default()
        };
        scene(path).on_path().into_owned()
    }

    #[test]
    fn tests_without_an_attachment_are_enabled() {
        let mut scene = scene(Path {
            tests: PathTests::Unattached,
            ..Path::default()
        });
        scene.passes[1].depth_stencil = None;
        scene.attachments[1].format = TextureFormat::Depth16Unorm;
        let tests = |pass: usize| {
            let draw = scene.on_path().passes[pass].draws[0].clone();
            (draw.depth.is_some(), draw.stencil.is_some())
        };
        assert_eq!((tests(0), tests(1)), ((false, true), (true, true)));
    }

    fn drawn(draws: PathDraws) -> Draw {
        let path = Path {
            draws,
            ..Path::default()
        };
        scene(path).on_path().passes[0].draws[0].clone()
    }

    #[test]
    fn contents_move_to_the_first_pass_and_attachments_start_with_others() {
        let loaded = started(PathStart::LoadOperation);
        let operations = &loaded.passes[0].operations;
        assert_eq!(operations.color[0].load.clear_value(), Some([1.0; 4]));
        assert_eq!(operations.depth.load.clear_value(), Some(1.0));
        assert_eq!(operations.stencil.load.clear_value(), Some(7));
        assert_eq!(loaded.passes[1].operations, Default::default());
        assert_eq!(
            loaded.attachments[0].contents,
            AttachmentContents::Color([0.0; 4])
        );
        let other = AttachmentContents::DepthStencil {
            depth: 0.0,
            stencil: !7,
        };
        assert_eq!(loaded.attachments[1].contents, other);
        let cleared = started(PathStart::ClearCommand);
        assert_eq!(cleared.passes[0].clears.len(), 2);
        assert!(cleared.passes[1].clears.is_empty());
        let drawn = started(PathStart::Draw);
        assert_eq!(
            (drawn.passes[0].draws.len(), drawn.passes[1].draws.len()),
            (2, 1)
        );
        let first = &drawn.passes[0].draws[0];
        assert_eq!(first.mesh.vertices[0].color[0], 1.0);
        assert_eq!(first.stencil.map(|s| s.front.reference), Some(7));
    }

    #[test]
    fn a_draw_that_might_convert_in_two_ways_is_left_out() {
        let mut scene = scene(Path {
            start: PathStart::Draw,
            ..Path::default()
        });
        scene.attachments[0].contents = AttachmentContents::Color([0.3; 4]);
        scene.attachments[1].contents = AttachmentContents::DepthStencil {
            depth: 0.5,
            stencil: 0,
        };
        assert_eq!(scene.on_path().attachments, scene.attachments);
        assert_eq!(scene.on_path().passes, scene.passes);
    }

    #[test]
    fn integer_attachments_are_not_initialized_by_a_draw() {
        let path = Path {
            start: PathStart::Draw,
            ..Path::default()
        };
        let mut scene = scene(path);
        scene.attachments[0].format = TextureFormat::Rgba8Uint;
        assert_eq!(scene.on_path().passes[0].draws.len(), 1);
    }

    #[test]
    fn all_draw_calls_draw_the_same_primitives() {
        let expected = drawn(PathDraws::Direct);
        let primitives = |draw: &Draw| draw.mesh.primitives(draw.topology);
        for draws in PathDraws::ALL {
            let draw = drawn(*draws);
            assert_eq!(primitives(&draw), primitives(&expected), "{draws}");
        }
        let short = drawn(PathDraws::Indexed16);
        assert_eq!(short.fetch.index, IndexFormat::Uint16);
        assert_eq!(drawn(PathDraws::BaseVertex).fetch.base_vertex, 2);
        assert_eq!(drawn(PathDraws::Instanced).fetch.instances, 1);
        let strip = drawn(PathDraws::Restart);
        assert_eq!(strip.topology, PrimitiveTopology::TriangleStrip);
        assert_eq!(strip.mesh.indices, Some(vec![0, 1, 2, RESTART, 3, 4, 5]));
    }
}
