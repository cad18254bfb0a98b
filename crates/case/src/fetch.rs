//! Vertex fetching of draws: checks that a draw call can express it.

use crate::error::At;
use crate::wire::{FetchWire, InstancesWire};
use etalon_scene::{Fetch, IndexFormat, MAX_VERTICES, Mesh, PrimitiveTopology, RESTART_16};

/// The maximum number of unused vertices, indices or instances.
const MOST_UNUSED: u32 = 1 << 20;

/// Returns how a mesh is fetched, and the mesh with all its instances.
pub(crate) fn fetch(
    mesh: Mesh,
    topology: PrimitiveTopology,
    wire: FetchWire,
    instances: Option<&InstancesWire>,
) -> Result<(Mesh, Fetch), At> {
    offsets(&mesh, wire).map_err(|e| e.key("fetch"))?;
    if wire.index == IndexFormat::Uint16 {
        short_indices(&mesh, topology, wire.base_vertex)
            .map_err(|e| e.key("index").key("fetch"))?;
    }
    let mut fetch = Fetch {
        index: wire.index,
        base_vertex: wire.base_vertex,
        first_index: wire.first_index,
        first_vertex: wire.first_vertex,
        ..Fetch::default()
    };
    let Some(instances) = instances else {
        return Ok((mesh, fetch));
    };
    repeatable(&mesh, topology, instances).map_err(|e| e.key("instances"))?;
    let repeated = instances.colors.iter().cycle().map(|c| c.0);
    let colors: Vec<_> = repeated.take(parts(instances)).collect();
    fetch.instances = colors.len() as u32;
    fetch.first_instance = instances.first;
    Ok((mesh.instanced(&colors), fetch))
}

/// Checks that the offsets apply to this kind of draw.
fn offsets(mesh: &Mesh, wire: FetchWire) -> Result<(), At> {
    let of_indices = [
        ("base_vertex", wire.base_vertex != 0),
        ("first_index", wire.first_index != 0),
        ("index", wire.index != IndexFormat::Uint32),
    ];
    let of_vertices = [("first_vertex", wire.first_vertex != 0)];
    let (foreign, message): (&[_], _) = match mesh.indices {
        Some(_) => (&of_vertices, "an indexed draw starts at an index"),
        None => (&of_indices, "the mesh has no indices"),
    };
    if let Some((key, _)) = foreign.iter().find(|(_, given)| *given) {
        return Err(At::new(message).key(key));
    }
    let unused = [
        wire.base_vertex.unsigned_abs(),
        wire.first_index,
        wire.first_vertex,
    ];
    if unused.iter().any(|n| *n > MOST_UNUSED) {
        return Err(At::new(format!("an offset must be at most {MOST_UNUSED}")));
    }
    Ok(())
}

/// Checks that indices fit into 16 bits. The greatest one restarts strips, but is a vertex in lists.
fn short_indices(mesh: &Mesh, topology: PrimitiveTopology, base: i32) -> Result<(), At> {
    let moved = base.min(0).unsigned_abs();
    let indices = mesh.indices.iter().flatten();
    let restarts = mesh.indices.iter().flatten().any(|i| *i == u32::MAX);
    let lists = [
        PrimitiveTopology::PointList,
        PrimitiveTopology::LineList,
        PrimitiveTopology::TriangleList,
    ];
    let kept = u32::from(restarts || !lists.contains(&topology));
    let most = u32::from(RESTART_16) - kept;
    let greatest = indices
        .filter(|i| **i != u32::MAX)
        .max()
        .copied()
        .unwrap_or(0);
    if greatest + moved > most {
        return Err(At::new(format!(
            "indices must be at most {most}, {} is given",
            greatest + moved
        )));
    }
    Ok(())
}

/// Returns the number of instances.
fn parts(wire: &InstancesWire) -> usize {
    wire.count.map_or(wire.colors.len(), |n| n as usize)
}

/// Checks that the mesh repeated in one list draws the same as the mesh drawn several times.
fn repeatable(
    mesh: &Mesh,
    topology: PrimitiveTopology,
    instances: &InstancesWire,
) -> Result<(), At> {
    let parts = parts(instances);
    let none = parts == 0 || instances.colors.is_empty();
    if none || parts * mesh.vertices.len() > MAX_VERTICES || instances.first > MOST_UNUSED {
        return Err(At::new(
            "at least one instance is needed, and in total at most as many vertices as a mesh can have",
        ));
    }
    if instances
        .colors
        .iter()
        .any(|c| c.0.iter().any(|v| !v.is_finite()))
    {
        return Err(At::new("a colour does not fit into 32-bit floats").key("colors"));
    }
    let size = match topology {
        PrimitiveTopology::PointList => Some(1),
        PrimitiveTopology::LineList => Some(2),
        PrimitiveTopology::TriangleList => Some(3),
        _ => None,
    };
    let has_whole_primitives = size.is_some_and(|size| mesh.vertices.len().is_multiple_of(size));
    if mesh.indices.is_none() && !has_whole_primitives {
        return Err(At::new(
            "instances of strips or of incomplete primitives need indices",
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::resolve::parse_scene;
    use etalon_scene::Draw;
    use serde_json::{Value, json};

    fn draw(mesh: Value, keys: Value) -> Option<Draw> {
        let mut draw = json!({ "mesh": mesh, "shader": "flat_color" });
        let object = draw.as_object_mut().expect("an object");
        object.extend(keys.as_object().expect("an object").clone());
        let scene = json!({
            "attachments": { "color": { "format": "rgba8unorm", "size": [256, 257] } },
            "passes": [{ "color": ["color"], "draws": [draw] }],
            "read": ["color"]
        });
        let scene = parse_scene(&scene).ok()?;
        scene.passes.into_iter().next()?.draws.into_iter().next()
    }

    fn points(count: u32) -> Value {
        json!({ "kind": "field", "of": "points", "count": count, "indexed": true })
    }

    #[test]
    fn the_greatest_short_index_is_allowed_only_in_lists() {
        let given = |topology: &str, count| {
            let keys = json!({ "topology": topology, "fetch": { "index": "uint16" } });
            draw(points(count), keys).is_some()
        };
        assert!(given("point-list", 65_536));
        assert!(!given("point-list", 65_537));
        assert!(given("line-strip", 65_535));
        assert!(!given("line-strip", 65_536));
        let keys = json!({
            "topology": "point-list", "fetch": { "index": "uint16", "base_vertex": -1 }
        });
        assert!(draw(points(65_536), keys).is_none());
    }

    #[test]
    fn offsets_belong_to_their_kind_of_draw() {
        let rect = json!({ "kind": "full" });
        assert!(draw(rect.clone(), json!({ "fetch": { "first_vertex": 3 } })).is_some());
        assert!(draw(rect.clone(), json!({ "fetch": { "first_index": 3 } })).is_none());
        assert!(draw(rect, json!({ "fetch": { "base_vertex": 3 } })).is_none());
        assert!(draw(points(9), json!({ "fetch": { "first_vertex": 3 } })).is_none());
        assert!(
            draw(
                points(9),
                json!({ "fetch": { "first_index": 3, "base_vertex": -3 } })
            )
            .is_some()
        );
    }

    #[test]
    fn instances_are_the_mesh_again() {
        let full = json!({ "kind": "full" });
        let keys = json!({ "instances": { "colors": [0, 1, 0.5], "first": 2 } });
        let single = draw(full.clone(), json!({})).expect("it is valid");
        let instanced = draw(full, keys.clone()).expect("it is valid");
        assert_eq!(
            instanced.mesh.vertices.len(),
            3 * single.mesh.vertices.len()
        );
        assert_eq!(
            (instanced.fetch.instances, instanced.fetch.first_instance),
            (3, 2)
        );
        let mut more = keys.clone();
        more["instances"]["count"] = json!(4);
        let more = draw(json!({ "kind": "full" }), more).expect("it is valid");
        let last = more.mesh.vertices.last().expect("there are vertices");
        assert_eq!((more.fetch.instances, last.color), (4, [0.0; 4]));
        let mut strip = keys;
        strip["topology"] = json!("triangle-strip");
        assert!(draw(json!({ "kind": "full" }), strip.clone()).is_none());
        let indexed = draw(points(9), strip).expect("it is valid");
        assert_eq!(indexed.mesh.primitives(indexed.topology).len(), 3 * 7);
    }
}
