//! Bugs of indices, offsets and instances: the mesh that a driver fetches which takes one number of a
//! draw call wrongly.

use crate::list::{CONFUSION, List};
use crate::plant::{Plant, draws, from_draw};
use etalon_scene::{Call, Draw, Fetch, IndexFormat, Mesh, PrimitiveTopology, RESTART, Vertex};

/// Draws what is fetched for another call than was asked for. Fetches beyond a buffer give its first
/// vertex, as robust access does.
fn called(bug: impl Fn(&mut Call<'_>, &Draw) + Send + Sync + 'static) -> Plant {
    draws(move |draw| {
        if draw.fetch == Fetch::default() && draw.mesh.vertices.len() < 65_000 {
            return;
        }
        let asked = draw.clone();
        let mut call = asked.call();
        bug(&mut call, &asked);
        draw.mesh = fetched(&call);
        // A backend would fetch the mesh by its path once more.
        draw.fetch = Fetch::default();
    })
}

/// The mesh that a call fetches.
fn fetched(call: &Call<'_>) -> Mesh {
    let range = call.first as usize..(call.first + call.count) as usize;
    let first = call.vertices[0];
    let part = match &call.indices {
        None => Mesh {
            vertices: range
                .map(|i| call.vertices.get(i).copied().unwrap_or(first))
                .collect(),
            indices: None,
        },
        Some(indices) => {
            let drawn = range.map(|i| indices.get(i).copied().unwrap_or(0));
            let moved = |index: u32| match index {
                RESTART => RESTART,
                index => {
                    let sum = i64::from(index) + i64::from(call.base_vertex);
                    let known = usize::try_from(sum)
                        .ok()
                        .filter(|i| *i < call.vertices.len());
                    known.unwrap_or(0) as u32
                }
            };
            Mesh {
                indices: Some(drawn.map(moved).collect()),
                vertices: call.vertices.to_vec(),
            }
        }
    };
    if call.colors.is_empty() {
        return part;
    }
    let instances = (0..call.instances).map(|i| (call.first_instance + i) as usize);
    let last = call.colors[call.colors.len() - 1];
    let colors: Vec<_> = instances
        .map(|i| call.colors.get(i).copied().unwrap_or(last))
        .collect();
    part.instanced(&colors)
}

pub(super) fn add(list: &mut List) {
    type Bug = fn(&mut Call<'_>, &Draw);
    let rows: [(&str, &str, Bug); 24] = [
        (
            "base-vertex-lost",
            "The base vertex is not added.",
            |call, _| {
                call.base_vertex = 0;
            },
        ),
        (
            "base-vertex-doubled",
            "The base vertex is added twice.",
            |call, _| {
                call.base_vertex *= 2;
            },
        ),
        (
            "base-vertex-unsigned",
            "A negative base vertex counts as 0.",
            |call, _| call.base_vertex = call.base_vertex.max(0),
        ),
        (
            "base-vertex-16-bits",
            "The base vertex is kept in 16 bits.",
            |call, _| call.base_vertex = i32::from(call.base_vertex as i16),
        ),
        (
            "base-vertex-with-first-index-lost",
            "A base vertex is lost where there is a first index.",
            |call, _| {
                if call.first > 0 && call.indices.is_some() {
                    call.base_vertex = 0;
                }
            },
        ),
        ("first-index-lost", "Draws start at index 0.", |call, _| {
            if call.indices.is_some() {
                call.first = 0;
            }
        }),
        (
            "first-index-16-bits",
            "The first index is kept in 16 bits.",
            |call, _| {
                if call.indices.is_some() {
                    call.first %= 65_536;
                }
            },
        ),
        (
            "first-index-as-bytes",
            "The first index counts as bytes.",
            |call, _| {
                if call.indices.is_some() {
                    call.first /= 4;
                }
            },
        ),
        (
            "first-index-of-long-indices",
            "The first of short indices is found as if they were long.",
            |call, _| {
                if call.indices.is_some() && call.index == IndexFormat::Uint16 {
                    call.first *= 2;
                }
            },
        ),
        (
            "first-vertex-lost",
            "Draws start at vertex 0.",
            |call, _| {
                if call.indices.is_none() {
                    call.first = 0;
                }
            },
        ),
        (
            "first-vertex-16-bits",
            "The first vertex is kept in 16 bits.",
            |call, _| {
                if call.indices.is_none() {
                    call.first %= 65_536;
                }
            },
        ),
        (
            "long-indices-shortened",
            "Long indices are kept in 16 bits.",
            |call, _| each_index(call, IndexFormat::Uint32, |i| i % 65_536),
        ),
        (
            "short-indices-signed",
            "Short indices from 32,768 on count as negative.",
            |call, _| {
                each_index(
                    call,
                    IndexFormat::Uint16,
                    |i| if i < 32_768 { i } else { 0 },
                )
            },
        ),
        (
            "last-short-index-as-restart",
            "The index 65,535 ends a list of short indices.",
            |call, draw| {
                if lists(draw) {
                    each_index(call, IndexFormat::Uint16, |i| {
                        if i == 65_535 { RESTART } else { i }
                    });
                }
            },
        ),
        (
            "index-65535-of-long-as-restart",
            "The index 65,535 ends a list of long indices.",
            |call, draw| {
                if lists(draw) {
                    each_index(call, IndexFormat::Uint32, |i| {
                        if i == 65_535 { RESTART } else { i }
                    });
                }
            },
        ),
        (
            "index-limit-65535",
            "Indices from 65,535 on are held to 65,534.",
            |call, _| {
                for format in [IndexFormat::Uint16, IndexFormat::Uint32] {
                    each_index(
                        call,
                        format,
                        |i| if i == RESTART { i } else { i.min(65_534) },
                    );
                }
            },
        ),
        (
            "restart-after-base-vertex",
            "The end of a strip is looked for after the base vertex is added.",
            |call, _| {
                if call.base_vertex != 0 {
                    let format = call.index;
                    each_index(call, format, |i| if i == RESTART { 0 } else { i });
                }
            },
        ),
        (
            "short-restart-lost",
            "Strips of short indices do not end.",
            |call, _| {
                each_index(
                    call,
                    IndexFormat::Uint16,
                    |i| if i == RESTART { 0 } else { i },
                )
            },
        ),
        ("first-instance-lost", "Instances start at 0.", |call, _| {
            call.first_instance = 0;
        }),
        (
            "first-instance-doubled",
            "The first instance is added twice.",
            |call, _| call.first_instance *= 2,
        ),
        (
            "first-instance-of-indexed-lost",
            "Instances of indexed draws start at 0.",
            |call, _| {
                if call.indices.is_some() {
                    call.first_instance = 0;
                }
            },
        ),
        (
            "last-instance-lost",
            "The last instance is lost.",
            |call, _| {
                call.instances = (call.instances - 1).max(1);
            },
        ),
        (
            "instances-of-256",
            "Instances from 256 on are lost.",
            |call, _| call.instances = call.instances.min(256),
        ),
        (
            "one-color-of-instances",
            "All instances have the colour of the first.",
            |call, _| {
                let first = call.colors.get(call.first_instance as usize).copied();
                if let Some(first) = first {
                    call.colors.fill(first);
                }
            },
        ),
    ];
    for (name, about, bug) in rows {
        list.add(name, CONFUSION, about, called(bug));
    }
    list.add(
        "instance-rate-kept",
        CONFUSION,
        "The draw after one of instances has the colour of its first instance.",
        from_draw(|before, draw| {
            if before.fetch.instances > 0 {
                let color = before.mesh.vertices[0].color;
                recolor(&mut draw.mesh.vertices, color);
            }
        }),
    );
    list.add(
        "offsets-kept",
        CONFUSION,
        "The draw after one with a base vertex adds it too.",
        from_draw(|before, draw| {
            let moved = before.fetch.base_vertex;
            let count = draw.mesh.vertices.len() as i64;
            if moved != 0 && draw.fetch.base_vertex == 0 {
                for index in draw.mesh.indices.iter_mut().flatten() {
                    if *index != RESTART {
                        *index = (i64::from(*index) + i64::from(moved)).clamp(0, count - 1) as u32;
                    }
                }
            }
        }),
    );
}

fn recolor(vertices: &mut [Vertex], color: [f32; 4]) {
    for vertex in vertices {
        vertex.color = color;
    }
}

fn lists(draw: &Draw) -> bool {
    use PrimitiveTopology::{LineList, PointList, TriangleList};
    [PointList, LineList, TriangleList].contains(&draw.topology)
}

/// Changes the indices of a size.
fn each_index(call: &mut Call<'_>, format: IndexFormat, bug: impl Fn(u32) -> u32) {
    if call.index != format {
        return;
    }
    for index in call.indices.iter_mut().flat_map(|list| list.to_mut()) {
        *index = bug(*index);
    }
}
