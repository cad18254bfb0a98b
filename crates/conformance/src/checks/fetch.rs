//! Vertex fetching: indices, offsets and instances, which must not change the picture.

use super::CheckEnd;
use crate::frames::{BLUE, Expect, GREEN, RED};
use crate::scenes::{blue, with};
use crate::subject::CheckedBackend;
use serde_json::{Value, json};

const WHITE: [u32; 4] = [255; 4];

/// Returns a row of four triangles of a texel each: red, green, white, red.
fn row(keys: Value) -> Value {
    let values = json!([[1, 0, 0, 1], [0, 1, 0, 1], [1, 1, 1, 1]]);
    with(
        json!({ "kind": "field", "of": "triangles", "values": values }),
        keys,
    )
}

/// Returns a draw of [`row`] to one of three rows of texels.
fn draw(row: u32, mesh: Value, keys: Value) -> Value {
    let viewport = json!({ "rect": [0, row, 4, 1], "depth": [0, 1] });
    with(
        json!({ "mesh": mesh, "shader": "flat_color", "viewport": viewport }),
        keys,
    )
}

/// Draws a row with these keys between two rows without them, and checks that all three are the same.
fn draws_like_the_others(s: &CheckedBackend, mesh: Value, keys: Value) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": { "color": with(blue(), json!({ "size": [4, 3] })) },
        "draws": [draw(0, mesh.clone(), json!({})), draw(1, mesh.clone(), keys), draw(2, mesh, json!({}))],
    }))?;
    frame.color_is("color", |x, _| [RED, GREEN, WHITE, RED][x as usize]);
    Ok(())
}

pub(crate) fn a_base_vertex_is_added_to_every_index(s: &CheckedBackend) -> CheckEnd {
    for base in [1, -1, 3, 1000, -70_000] {
        let fetch = json!({ "fetch": { "base_vertex": base } });
        draws_like_the_others(s, row(json!({ "indexed": true })), fetch)?;
    }
    Ok(())
}

pub(crate) fn draws_start_at_their_first_index(s: &CheckedBackend) -> CheckEnd {
    for index in ["uint16", "uint32"] {
        for first in [0, 1, 3, 70_000] {
            let fetch = json!({ "fetch": { "index": index, "first_index": first } });
            draws_like_the_others(s, row(json!({ "indexed": true })), fetch)?;
        }
    }
    Ok(())
}

pub(crate) fn draws_start_at_their_first_vertex(s: &CheckedBackend) -> CheckEnd {
    for first in [1, 3, 70_000] {
        let fetch = json!({ "fetch": { "first_vertex": first } });
        draws_like_the_others(s, row(json!({})), fetch)?;
    }
    Ok(())
}

/// The last 16-bit index is 65,535, which does not restart a list.
pub(crate) fn the_last_16_bit_index_names_a_vertex(s: &CheckedBackend) -> CheckEnd {
    let mesh = row(json!({ "indexed": true, "spare": 65_536 - 12 }));
    draws_like_the_others(s, mesh, json!({ "fetch": { "index": "uint16" } }))
}

/// Two strips of a column each, which would join into one without a restart.
pub(crate) fn strips_of_16_bit_indices_restart(s: &CheckedBackend) -> CheckEnd {
    for base in [0, 5] {
        let frame = s.show(json!({
            "attachments": { "color": blue() },
            "draws": [{
                "mesh": {
                    "kind": "vertices", "units": "texels",
                    "positions": [[0, 16, 0], [4, 16, 0], [0, 0, 0], [4, 0, 0],
                                  [12, 16, 0], [16, 16, 0], [12, 0, 0], [16, 0, 0]],
                    "values": [[1, 0, 0, 1]],
                    "indices": [0, 1, 2, 3, null, 4, 5, 6, 7] },
                "topology": "triangle-strip", "shader": "flat_color",
                "fetch": { "index": "uint16", "base_vertex": base } }],
        }))?;
        frame.color_is(
            "color",
            |x, _| if (4..12).contains(&x) { BLUE } else { RED },
        );
    }
    Ok(())
}

/// The last of three instances stays visible, and each instance is counted.
fn instances(s: &CheckedBackend, mesh: Value, first: u32, fetch: Value) -> CheckEnd {
    let colors = json!([[0, 1, 0, 1], [1, 1, 1, 1], [1, 0, 0, 1]]);
    let count = json!({ "front": { "compare": "always", "pass_op": "increment-clamp" } });
    let middle = json!({
        "instances": { "colors": colors, "first": first }, "fetch": fetch, "stencil": count });
    let frame = s.show(json!({
        "attachments": {
            "color": with(blue(), json!({ "size": [4, 3] })),
            "ds": { "format": "depth24plus-stencil8", "size": [4, 3] } },
        "draws": [draw(0, mesh.clone(), json!({})), draw(1, mesh.clone(), middle), draw(2, mesh, json!({}))],
    }))?;
    frame.color_is("color", |x, y| match y {
        1 => RED,
        _ => [RED, GREEN, WHITE, RED][x as usize],
    });
    frame.stencil_is("ds", |_, y| if y == 1 { 3 } else { 0 });
    Ok(())
}

pub(crate) fn instances_have_a_color_each(s: &CheckedBackend) -> CheckEnd {
    for indexed in [false, true] {
        instances(s, row(json!({ "indexed": indexed })), 0, json!({}))?;
    }
    Ok(())
}

pub(crate) fn instances_start_at_their_first_instance(s: &CheckedBackend) -> CheckEnd {
    for indexed in [false, true] {
        for first in [1, 1000] {
            instances(s, row(json!({ "indexed": indexed })), first, json!({}))?;
        }
    }
    Ok(())
}

pub(crate) fn instances_have_offsets_too(s: &CheckedBackend) -> CheckEnd {
    instances(s, row(json!({})), 0, json!({ "first_vertex": 4 }))?;
    let fetch = json!({ "index": "uint16", "base_vertex": 7, "first_index": 5 });
    instances(s, row(json!({ "indexed": true })), 0, fetch.clone())?;
    instances(s, row(json!({ "indexed": true })), 2, fetch)
}
