//! Bugs of indices, offsets and instances: the mesh that a driver fetches which takes one number of a
//! draw call wrongly.

use crate::list::List;
use crate::plant::{Plant, draws, from_draw};
use etalon_scene::{Call, Draw, Fetch, IndexFormat, Mesh, PrimitiveTopology, RESTART};

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
    let vertex = |i| call.vertices.get(i).copied().unwrap_or(call.vertices[0]);
    let moved = |index: u32| {
        let sum = i64::from(index) + i64::from(call.base_vertex);
        let known = u32::try_from(sum).ok();
        known
            .filter(|i| (*i as usize) < call.vertices.len())
            .unwrap_or(0)
    };
    let index = |i| if i == RESTART { i } else { moved(i) };
    let part = match &call.indices {
        None => Mesh {
            vertices: range.map(vertex).collect(),
            indices: None,
        },
        Some(indices) => {
            let drawn = range.map(|i| indices.get(i).copied().unwrap_or(0));
            Mesh {
                indices: Some(drawn.map(index).collect()),
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

/// Changes the calls with indices.
fn indexed(bug: fn(&mut Call<'_>)) -> Plant {
    called(move |call, _| {
        if call.indices.is_some() {
            bug(call);
        }
    })
}

/// Changes the calls without indices.
fn straight(bug: fn(&mut Call<'_>)) -> Plant {
    called(move |call, _| {
        if call.indices.is_none() {
            bug(call);
        }
    })
}

/// Changes the indices of a size, of draws that it strikes.
fn indices(format: IndexFormat, strikes: fn(&Draw) -> bool, bug: fn(u32) -> u32) -> Plant {
    called(move |call, draw| {
        if call.index == format && strikes(draw) {
            each_index(call, bug);
        }
    })
}

fn each_index(call: &mut Call<'_>, bug: impl Fn(u32) -> u32) {
    for index in call.indices.iter_mut().flat_map(|list| list.to_mut()) {
        *index = bug(*index);
    }
}

fn any(_: &Draw) -> bool {
    true
}

fn lists(draw: &Draw) -> bool {
    use PrimitiveTopology::{LineList, PointList, TriangleList};
    [PointList, LineList, TriangleList].contains(&draw.topology)
}

pub(super) fn add(list: &mut List) {
    offsets(list);
    values(list);
    instances(list);
}

fn offsets(list: &mut List) {
    list.bug("base-vertex-lost: The base vertex is not added.")
        .plant(called(|call, _| call.base_vertex = 0));
    list.bug("base-vertex-doubled: The base vertex is added twice.")
        .plant(called(|call, _| call.base_vertex *= 2));
    list.bug("base-vertex-unsigned: A negative base vertex counts as 0.")
        .plant(called(|call, _| call.base_vertex = call.base_vertex.max(0)));
    list.bug("base-vertex-16-bits: The base vertex is kept in 16 bits.")
        .plant(called(|call, _| {
            call.base_vertex = i32::from(call.base_vertex as i16)
        }));
    list.bug(
        "base-vertex-with-first-index-lost: The base vertex is lost where there is a first index.",
    )
    .plant(indexed(|call| {
        call.base_vertex *= i32::from(call.first == 0)
    }));
    list.bug("first-index-lost: Draws start at index 0.")
        .plant(indexed(|call| call.first = 0));
    list.bug("first-index-16-bits: The first index is kept in 16 bits.")
        .plant(indexed(|call| call.first %= 65_536));
    list.bug("first-index-as-bytes: The first index counts as bytes.")
        .plant(indexed(|call| call.first /= 4));
    list.bug("first-index-of-long-indices: The first of short indices is found as if long.")
        .plant(indexed(|call| {
            if call.index == IndexFormat::Uint16 {
                call.first *= 2;
            }
        }));
    list.bug("first-vertex-lost: Draws start at vertex 0.")
        .plant(straight(|call| call.first = 0));
    list.bug("first-vertex-16-bits: The first vertex is kept in 16 bits.")
        .plant(straight(|call| call.first %= 65_536));
}

fn values(list: &mut List) {
    use IndexFormat::{Uint16, Uint32};
    let as_restart = |i| if i == 65_535 { RESTART } else { i };
    list.bug("long-indices-shortened: Long indices are kept in 16 bits.")
        .plant(indices(Uint32, any, |i| i % 65_536));
    list.bug("short-indices-signed: Short indices from 32,768 on count as negative.")
        .plant(indices(Uint16, any, |i| if i < 32_768 { i } else { 0 }));
    list.bug("last-short-index-as-restart: The index 65,535 ends a list of short indices.")
        .plant(indices(Uint16, lists, as_restart));
    list.bug("index-65535-of-long-as-restart: The index 65,535 ends a list of long indices.")
        .plant(indices(Uint32, lists, as_restart));
    list.bug("index-limit-65535: Indices from 65,535 on are held to 65,534.")
        .plant(called(|call, _| {
            each_index(call, |i| if i == RESTART { i } else { i.min(65_534) });
        }));
    list.bug("restart-after-base-vertex: The base vertex is added to the end of a strip too.")
        .plant(called(|call, _| {
            if call.base_vertex != 0 {
                each_index(call, |i| if i == RESTART { 0 } else { i });
            }
        }));
    list.bug("short-restart-lost: Strips of short indices do not end.")
        .plant(indices(Uint16, any, |i| if i == RESTART { 0 } else { i }));
}

fn instances(list: &mut List) {
    list.bug("first-instance-lost: Instances start at 0.")
        .plant(called(|call, _| call.first_instance = 0));
    list.bug("first-instance-doubled: The first instance is added twice.")
        .plant(called(|call, _| call.first_instance *= 2));
    list.bug("first-instance-of-indexed-lost: Instances of indexed draws start at 0.")
        .plant(indexed(|call| call.first_instance = 0));
    list.bug("last-instance-lost: The last instance is lost.")
        .plant(called(|call, _| {
            call.instances = (call.instances - 1).max(1)
        }));
    list.bug("instances-of-256: Instances from 256 on are lost.")
        .plant(called(|call, _| call.instances = call.instances.min(256)));
    list.bug("one-color-of-instances: All instances have the colour of the first.")
        .plant(called(|call, _| {
            if let Some(first) = call.colors.get(call.first_instance as usize).copied() {
                call.colors.fill(first);
            }
        }));
    list.bug("instance-rate-kept: The draw after one of instances has its first one's colour.")
        .plant(from_draw(|before, draw| {
            if before.fetch.instances > 0 {
                let color = before.mesh.vertices[0].color;
                draw.mesh.vertices.iter_mut().for_each(|v| v.color = color);
            }
        }));
    list.bug("offsets-kept: The draw after one with a base vertex adds it too.")
        .plant(from_draw(|before, draw| {
            let moved = i64::from(before.fetch.base_vertex);
            let last = draw.mesh.vertices.len() as i64 - 1;
            if moved != 0 && draw.fetch.base_vertex == 0 {
                let indices = draw.mesh.indices.iter_mut().flatten();
                for index in indices.filter(|i| **i != RESTART) {
                    *index = (i64::from(*index) + moved).clamp(0, last) as u32;
                }
            }
        }));
}
