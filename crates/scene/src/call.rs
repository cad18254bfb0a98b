//! Draw calls: what backends upload and pass to the API.
//!
//! Every backend turns mesh and [`Fetch`](crate::Fetch) into a call with [`Draw::call`], so that all of them
//! add the same unused vertices, indices and instances before and after the drawn ones.

use crate::draw::Draw;
use crate::fetch::IndexFormat;
use crate::mesh::{Mesh, RESTART, Vertex};
use crate::rasterization::PrimitiveTopology;
use std::borrow::Cow;

/// The buffers of a draw call and its arguments.
#[derive(Clone, Debug, PartialEq)]
pub struct Call<'a> {
    /// The contents of the vertex buffer, with the unused vertices that the draw's fetch asks for.
    pub vertices: Cow<'a, [Vertex]>,
    /// The index buffer of an indexed draw, with [`RESTART`] for any index size.
    pub indices: Option<Cow<'a, [u32]>>,
    /// The size of an index in the buffer; unused if `indices` is `None`.
    pub index: IndexFormat,
    /// The first index, or the first vertex of a draw without indices.
    pub first: u32,
    /// The number of indices, or of vertices in a draw without indices.
    pub count: u32,
    /// The number added to every index.
    pub base_vertex: i32,
    /// The colours in the buffer that advances once per instance; empty if colours come from vertices.
    pub colors: Vec<[f32; 4]>,
    /// The index of the first instance, and of its colour in `colors`.
    pub first_instance: u32,
    /// The number of instances that the call draws; 1 for draws that are not instanced.
    pub instances: u32,
}

impl Call<'_> {
    /// Returns the vertices as bytes, [`Vertex`] after [`Vertex`].
    pub fn vertex_bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.vertices)
    }

    /// Returns the indices as bytes of their size.
    pub fn index_bytes(&self) -> Vec<u8> {
        let indices = self.indices.iter().flat_map(|list| list.iter());
        match self.index {
            IndexFormat::Uint32 => indices.flat_map(|i| i.to_ne_bytes()).collect(),
            IndexFormat::Uint16 => {
                // `RESTART` is truncated to the greatest 16-bit index.
                indices.flat_map(|i| (*i as u16).to_ne_bytes()).collect()
            }
        }
    }

    /// Returns the colours of the instances as bytes.
    pub fn color_bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.colors)
    }

    /// Returns true if an index restarts a strip.
    pub fn restarts(&self) -> bool {
        self.indices.as_ref().is_some_and(|i| i.contains(&RESTART))
    }

    /// Returns the call without restart indices and the incomplete primitives before them, for APIs that
    /// cannot restart lists: the primitives are the same. Strips and fans keep their restarts.
    #[must_use]
    pub fn without_list_restarts(mut self, topology: PrimitiveTopology) -> Self {
        let size = match topology {
            PrimitiveTopology::PointList => 1,
            PrimitiveTopology::LineList => 2,
            PrimitiveTopology::TriangleList => 3,
            PrimitiveTopology::LineStrip
            | PrimitiveTopology::TriangleStrip
            | PrimitiveTopology::TriangleFan => return self,
        };
        if let Some(indices) = &self.indices
            && self.restarts()
        {
            let (first, count) = (self.first as usize, self.count as usize);
            let (front, rest) = indices.split_at(first);
            let (drawn, behind) = rest.split_at(count);
            let runs = drawn.split(|i| *i == RESTART);
            let kept = runs.flat_map(|run| &run[..run.len() / size * size]);
            let drawn: Vec<u32> = kept.copied().collect();
            self.count = drawn.len() as u32;
            self.indices = Some([front, &drawn, behind].concat().into());
        }
        self
    }
}

impl Draw {
    /// Returns the draw call: what a backend uploads, and the numbers that it passes.
    ///
    /// Unused vertices are corners of a triangle over everything, unused instances have a colour of their
    /// own, and unused indices refer to the mesh's vertices from the last one on, so that drawing any of them
    /// is visible. They come before as well as after the used ones: even an offset that is added twice stays
    /// inside the buffers.
    pub fn call(&self) -> Call<'_> {
        let (mesh, fetch) = (&self.mesh, &self.fetch);
        let parts = (fetch.instances as usize).max(1);
        let vertices = &mesh.vertices[..mesh.vertices.len() / parts];
        let indices = mesh
            .indices
            .as_deref()
            .map(|indices| one_of(indices, parts));
        let front = match &indices {
            Some(_) => fetch.base_vertex.max(0).unsigned_abs(),
            None => fetch.first_vertex,
        };
        let (first, count) = match indices {
            Some(list) => (fetch.first_index, list.len()),
            None => (front, vertices.len()),
        };
        let mut call = Call {
            vertices: between(vertices, front as usize, unused_vertex),
            indices: indices.map(|list| {
                let last = vertices.len().saturating_sub(1) as u32;
                let unused = |i: usize| last - i as u32 % (last + 1);
                between(list, fetch.first_index as usize, unused)
            }),
            index: fetch.index,
            first,
            count: count as u32,
            base_vertex: fetch.base_vertex,
            colors: Vec::new(),
            first_instance: fetch.first_instance,
            instances: parts as u32,
        };
        if fetch.base_vertex < 0 {
            let moved = fetch.base_vertex.unsigned_abs();
            for index in call.indices.iter_mut().flat_map(|list| list.to_mut()) {
                if *index != RESTART {
                    *index += moved;
                }
            }
        }
        if fetch.instances > 0 {
            let first = |part: usize| mesh.vertices[part * vertices.len()].color;
            let colors: Vec<_> = (0..parts).map(first).collect();
            let unused = |_| UNUSED_COLOR;
            call.colors = between(&colors, fetch.first_instance as usize, unused).into_owned();
        }
        call
    }
}

/// Returns the first of several equal runs, which restart indices separate.
fn one_of(indices: &[u32], parts: usize) -> &[u32] {
    // n runs of k indices and n - 1 restarts between them are n (k + 1) - 1 indices.
    &indices[..(indices.len() + 1) / parts - 1]
}

/// Returns a list with `unused` unused values before and after it.
fn between<T: Clone>(list: &[T], unused: usize, value: impl Fn(usize) -> T) -> Cow<'_, [T]> {
    if unused == 0 {
        return Cow::Borrowed(list);
    }
    let around = (0..unused).map(&value);
    let padded = around.clone().chain(list.iter().cloned()).chain(around);
    Cow::Owned(padded.collect())
}

/// The colour of unused vertices and instances: not an exact code of any normalized format.
const UNUSED_COLOR: [f32; 4] = [0.3, 0.6, 0.3, 0.6];

/// Returns a vertex that is not drawn.
fn unused_vertex(index: usize) -> Vertex {
    let [x, y] = [[-2.0, -2.0], [8.0, -2.0], [-2.0, 8.0]][index % 3];
    Vertex {
        position: [x, y, 0.0, 1.0],
        color: UNUSED_COLOR,
        uv: [0.0; 2],
    }
}

impl Mesh {
    /// Returns the mesh repeated once for each colour, in order: what its instances draw.
    ///
    /// Indexed parts are separated by [`RESTART`], which restarts strips and does not affect lists.
    #[must_use]
    pub fn instanced(&self, colors: &[[f32; 4]]) -> Self {
        let mut repeated = Self {
            vertices: Vec::with_capacity(self.vertices.len() * colors.len()),
            indices: self.indices.as_ref().map(|_| Vec::new()),
        };
        for (part, color) in colors.iter().enumerate() {
            let first = repeated.vertices.len() as u32;
            let colored = self.vertices.iter().map(|v| Vertex {
                color: *color,
                ..*v
            });
            repeated.vertices.extend(colored);
            if let (Some(indices), Some(source)) = (&mut repeated.indices, &self.indices) {
                if part > 0 {
                    indices.push(RESTART);
                }
                let moved = |i: &u32| match *i {
                    RESTART => RESTART,
                    i => first + i,
                };
                indices.extend(source.iter().map(moved));
            }
        }
        repeated
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fetch::{Fetch, RESTART_16};
    use crate::rasterization::Viewport;
    use crate::shader::Shader;

    fn vertex(number: u32) -> Vertex {
        Vertex {
            position: [number as f32, 0.0, 0.0, 1.0],
            color: [0.0; 4],
            uv: [0.0; 2],
        }
    }

    fn draw(indices: Option<Vec<u32>>, fetch: Fetch) -> Draw {
        let mesh = Mesh {
            vertices: (0..4).map(vertex).collect(),
            indices,
        };
        let viewport = Viewport::whole([1, 1]);
        Draw {
            fetch,
            ..Draw::new(Shader::FlatColor, mesh, viewport)
        }
    }

    /// Returns the vertices that an API would fetch for the first instance.
    fn fetched(call: &Call<'_>) -> Vec<Option<Vertex>> {
        let range = call.first as usize..(call.first + call.count) as usize;
        match &call.indices {
            None => call.vertices[range].iter().copied().map(Some).collect(),
            Some(indices) => {
                let fetched_vertex = |i: &u32| match *i {
                    RESTART => None,
                    i => Some(call.vertices[(i64::from(i) + i64::from(call.base_vertex)) as usize]),
                };
                indices[range].iter().map(fetched_vertex).collect()
            }
        }
    }

    #[test]
    fn every_path_fetches_the_mesh() {
        let expected: Vec<_> = [3, 2, 1].map(|i| Some(vertex(i))).to_vec();
        for base_vertex in [-7, -1, 0, 1, 9] {
            for first_index in [0, 1, 5] {
                let fetch = Fetch {
                    base_vertex,
                    first_index,
                    first_vertex: 3,
                    ..Fetch::default()
                };
                let draw = draw(Some(vec![3, 2, 1]), fetch);
                let call = draw.call();
                assert_eq!(fetched(&call), expected);
                assert_eq!((call.first, call.base_vertex), (first_index, base_vertex));
                // A lost or doubled offset fetches other vertices, but never reaches outside the buffers.
                if base_vertex > 0 {
                    let lost = Call {
                        base_vertex: 0,
                        ..call.clone()
                    };
                    assert_ne!(fetched(&lost), expected);
                    let base_vertex = 2 * base_vertex;
                    assert_ne!(
                        fetched(&Call {
                            base_vertex,
                            ..call
                        }),
                        expected
                    );
                }
            }
        }
        let fetch = Fetch {
            first_vertex: 5,
            ..Fetch::default()
        };
        let draw = draw(None, fetch);
        let call = draw.call();
        assert_eq!((call.first, call.count, call.vertices.len()), (5, 4, 14));
        let expected: Vec<_> = (0..4).map(|i| Some(vertex(i))).collect();
        assert_eq!(fetched(&call), expected);
    }

    #[test]
    fn a_default_path_copies_nothing() {
        let draw = draw(Some(vec![0, 1, 2]), Fetch::default());
        let call = draw.call();
        assert!(matches!(call.vertices, Cow::Borrowed(_)));
        assert!(matches!(call.indices, Some(Cow::Borrowed(_))));
        assert!(call.colors.is_empty());
        assert_eq!(call.instances, 1);
    }

    #[test]
    fn instances_draw_the_parts_of_an_instanced_mesh() {
        let colors = [[1.0; 4], [0.5; 4], [0.25; 4]];
        for indices in [None, Some(vec![0, 1, 2, RESTART, 1, 2, 3])] {
            let mut draw = draw(
                indices,
                Fetch {
                    instances: 3,
                    first_instance: 2,
                    ..Fetch::default()
                },
            );
            let mesh = draw.mesh.clone();
            draw.mesh = mesh.instanced(&colors).into();
            let call = draw.call();
            let first: Vec<_> = call.vertices.iter().map(|v| v.position).collect();
            let expected: Vec<_> = mesh.vertices.iter().map(|v| v.position).collect();
            assert_eq!(first, expected);
            assert_eq!(call.indices.as_deref(), mesh.indices.as_deref());
            assert_eq!(call.colors[2..5], colors);
            assert_eq!((call.instances, call.first_instance), (3, 2));
            assert_eq!(call.colors.len(), 7);
        }
    }

    #[test]
    fn restarts_of_a_list_remove_incomplete_primitives() {
        let indices = [0, 1, 2, 3, RESTART, 3, 2, 1, RESTART, 0];
        let list = |topology| {
            let fetch = Fetch {
                first_index: 2,
                ..Fetch::default()
            };
            let draw = draw(Some(indices.to_vec()), fetch);
            let call = draw.call().without_list_restarts(topology);
            let range = call.first as usize..(call.first + call.count) as usize;
            call.indices.expect("it is indexed")[range].to_vec()
        };
        assert_eq!(list(PrimitiveTopology::TriangleList), [0, 1, 2, 3, 2, 1]);
        assert_eq!(list(PrimitiveTopology::LineList), [0, 1, 2, 3, 3, 2]);
        assert_eq!(list(PrimitiveTopology::PointList), [0, 1, 2, 3, 3, 2, 1, 0]);
        assert_eq!(list(PrimitiveTopology::TriangleFan), indices);
    }

    #[test]
    fn short_indices_keep_the_restart() {
        let fetch = Fetch {
            index: IndexFormat::Uint16,
            ..Fetch::default()
        };
        let draw = draw(Some(vec![1, RESTART, 2]), fetch);
        let bytes = draw.call().index_bytes();
        let expected: Vec<u8> = [1, RESTART_16, 2].map(u16::to_ne_bytes).concat();
        assert_eq!(bytes, expected);
    }
}
