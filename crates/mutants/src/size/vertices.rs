//! Bugs of indices, offsets and instances: a driver misreads one number of a draw call and fetches another
//! mesh.

use crate::list::bugs;
use crate::plant::{Plant, draws, from_draw};
use IndexFormat::{Uint16, Uint32};
use etalon_scene::{Call, Draw, Fetch, IndexFormat, Mesh, PrimitiveTopology, RESTART};

/// The number of vertices from which on a plain draw can have an index that a bug of this class changes: a
/// little below 65,535. Smaller plain draws are skipped, because expanding their calls takes time.
const MANY_VERTICES: usize = 65_000;

/// Replaces a draw's mesh by what its call fetches once `bug` has changed the call. Fetches beyond a buffer return
/// its first vertex, as robust access does.
fn changed_call(bug: impl Fn(&mut Call<'_>, &Draw) + Send + Sync + 'static) -> Plant {
    draws(move |draw| {
        if draw.fetch == Fetch::default() && draw.mesh.vertices.len() < MANY_VERTICES {
            return;
        }
        let original = draw.clone();
        let mut call = original.call();
        bug(&mut call, &original);
        draw.mesh = fetched(&call).into();
        // A backend would otherwise apply the numbers to the fetched mesh again.
        draw.fetch = Fetch::default();
    })
}

/// Returns the mesh that a call fetches.
fn fetched(call: &Call<'_>) -> Mesh {
    let range = call.first as usize..(call.first + call.count) as usize;
    let with_base_vertex = |index: u32| {
        let sum = i64::from(index) + i64::from(call.base_vertex);
        let index = u32::try_from(sum).ok();
        index
            .filter(|i| (*i as usize) < call.vertices.len())
            .unwrap_or(0)
    };
    let index = |i| except_restart(i, with_base_vertex);
    let vertex = |i| call.vertices.get(i).copied().unwrap_or(call.vertices[0]);
    let mesh = match &call.indices {
        None => Mesh {
            vertices: range.map(vertex).collect(),
            indices: None,
        },
        Some(indices) => Mesh {
            vertices: call.vertices.to_vec(),
            indices: Some(
                range
                    .map(|i| index(indices.get(i).copied().unwrap_or(0)))
                    .collect(),
            ),
        },
    };
    let Some(last) = call.colors.last() else {
        return mesh;
    };
    let instances = (0..call.instances).map(|i| (call.first_instance + i) as usize);
    let colors: Vec<_> = instances
        .map(|i| *call.colors.get(i).unwrap_or(last))
        .collect();
    mesh.instanced(&colors)
}

/// Returns a changed index, unless it ends a strip.
fn except_restart(index: u32, bug: impl FnOnce(u32) -> u32) -> u32 {
    if index == RESTART { index } else { bug(index) }
}

/// Changes calls with indices.
fn indexed(bug: fn(&mut Call<'_>)) -> Plant {
    changed_call(move |call, _| {
        if call.indices.is_some() {
            bug(call);
        }
    })
}

/// Changes calls without indices.
fn not_indexed(bug: fn(&mut Call<'_>)) -> Plant {
    changed_call(move |call, _| {
        if call.indices.is_none() {
            bug(call);
        }
    })
}

/// Changes the indices of one format, in draws for which `strikes` is true.
fn changed_indices(format: IndexFormat, strikes: fn(&Draw) -> bool, bug: fn(u32) -> u32) -> Plant {
    changed_call(move |call, draw| {
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

fn always(_: &Draw) -> bool {
    true
}

/// Returns true for topologies whose primitives share no vertices.
fn is_list(draw: &Draw) -> bool {
    use PrimitiveTopology::{LineList, PointList, TriangleList};
    [PointList, LineList, TriangleList].contains(&draw.topology)
}

bugs! {
    "base-vertex-lost: The base vertex is not added." => changed_call(|call, _| call.base_vertex = 0);
    "base-vertex-doubled: The base vertex is added twice." => changed_call(|call, _| call.base_vertex *= 2);
    "base-vertex-unsigned: A negative base vertex counts as 0." =>
        changed_call(|call, _| call.base_vertex = call.base_vertex.max(0));
    "base-vertex-16-bits: The base vertex is kept in 16 bits." =>
        changed_call(|call, _| call.base_vertex = i32::from(call.base_vertex as i16));
    "base-vertex-with-first-index-lost: The base vertex is lost where there is a first index." =>
        indexed(|call| call.base_vertex *= i32::from(call.first == 0));
    "first-index-lost: Draws start at index 0." => indexed(|call| call.first = 0);
    "first-index-16-bits: The first index is kept in 16 bits." => indexed(|call| call.first %= 65_536);
    "first-index-as-bytes: The first index counts as bytes." => indexed(|call| call.first /= 4);
    "first-index-of-long-indices: The first of short indices is found as if long." =>
        indexed(|call| if call.index == Uint16 { call.first *= 2 });
    "first-vertex-lost: Draws start at vertex 0." => not_indexed(|call| call.first = 0);
    "first-vertex-16-bits: The first vertex is kept in 16 bits." => not_indexed(|call| call.first %= 65_536);
    let as_restart = |i| if i == 65_535 { RESTART } else { i };
    "long-indices-shortened: Long indices are kept in 16 bits." => changed_indices(Uint32, always, |i| i % 65_536);
    "short-indices-signed: Short indices from 32,768 on count as negative." =>
        changed_indices(Uint16, always, |i| if i < 32_768 { i } else { 0 });
    "last-short-index-as-restart: The index 65,535 ends a list of short indices." =>
        changed_indices(Uint16, is_list, as_restart);
    "index-65535-of-long-as-restart: The index 65,535 ends a list of long indices." =>
        changed_indices(Uint32, is_list, as_restart);
    "index-limit-65535: Indices from 65,535 on are held to 65,534." =>
        changed_call(|call, _| { each_index(call, |i| except_restart(i, |i| i.min(65_534))); });
    "restart-after-base-vertex: The base vertex is added to the end of a strip too." =>
        changed_call(|call, _| {
            if call.base_vertex != 0 { each_index(call, |i| if i == RESTART { 0 } else { i }); }
        });
    "short-restart-lost: Strips of short indices do not end." =>
        changed_indices(Uint16, always, |i| if i == RESTART { 0 } else { i });
    "first-instance-lost: Instances start at 0." => changed_call(|call, _| call.first_instance = 0);
    "first-instance-doubled: The first instance is added twice." => changed_call(|call, _| call.first_instance *= 2);
    "first-instance-of-indexed-lost: Instances of indexed draws start at 0." => indexed(|call| call.first_instance = 0);
    "last-instance-lost: The last instance is lost." =>
        changed_call(|call, _| call.instances = (call.instances - 1).max(1));
    "instances-of-256: Instances from 256 on are lost." =>
        changed_call(|call, _| call.instances = call.instances.min(256));
    "instances-16-bits: The number of instances is kept in 16 bits." =>
        changed_call(|call, _| call.instances %= 65_536);
    "instances-from-65535-lost: Instances from 65,535 on are lost." =>
        changed_call(|call, _| call.instances = call.instances.min(65_535));
    "first-instance-16-bits: The first instance is kept in 16 bits." =>
        changed_call(|call, _| call.first_instance %= 65_536);
    "one-color-of-instances: All instances have the colour of the first." =>
        changed_call(|call, _| {
            if let Some(first) = call.colors.get(call.first_instance as usize).copied() { call.colors.fill(first); }
        });
    "instance-rate-kept: The draw after one of instances has its first one's colour." =>
        from_draw(|before, draw| {
            if before.fetch.instances > 0 {
                let color = before.mesh.vertices[0].color;
                draw.mesh.vertices.iter_mut().for_each(|v| v.color = color);
            }
        });
    "offsets-kept: The draw after one with a base vertex adds it too." =>
        from_draw(|before, draw| {
            let offset = i64::from(before.fetch.base_vertex);
            let last = draw.mesh.vertices.len() as i64 - 1;
            if offset != 0 && draw.fetch.base_vertex == 0 {
                let indices = draw.mesh.indices.iter_mut().flatten();
                let shifted = |i: u32| (i64::from(i) + offset).clamp(0, last) as u32;
                indices.filter(|i| **i != RESTART).for_each(|i| *i = shifted(*i));
            }
        });
}
