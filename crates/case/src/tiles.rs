//! One draw for each tile of the attachments: thousands of draws in a line of a case file.
//!
//! Every draw has a tile to itself, so that a draw that is lost, or left over from an earlier batch, is
//! visible there and nowhere else.

use crate::error::At;
use crate::wire::{DrawWire, TileBy, TilesWire};
use etalon_scene::{MeshSource, Viewport};

/// The maximum number of draws that one draw of a pass can become.
const MOST: u32 = 10_000;

/// The offset of the colours from row to row: with thirteen colours, no tile has the colour of one of its
/// eight neighbours.
const ROW: usize = 5;

/// Returns the draws of a description: the draw itself, or one for each tile.
pub(crate) fn tiles(wire: &DrawWire, size: [u32; 2]) -> Result<Vec<DrawWire>, At> {
    let Some(tiles) = &wire.tiles else {
        return Ok(vec![wire.clone()]);
    };
    each(wire, tiles, size).map_err(|e| e.key("tiles"))
}

fn each(wire: &DrawWire, tiles: &TilesWire, size: [u32; 2]) -> Result<Vec<DrawWire>, At> {
    let [width, height] = tiles.size;
    if width == 0 || height == 0 || tiles.colors.is_empty() {
        return Err(At::new(
            "a tile needs a width and a height, and at least one colour",
        ));
    }
    let [left, top] = tiles.origin;
    let rest = [size[0].saturating_sub(left), size[1].saturating_sub(top)];
    let [columns, rows] = [rest[0].div_ceil(width), rest[1].div_ceil(height)];
    if columns.saturating_mul(rows) > MOST {
        return Err(At::new(format!(
            "{columns} by {rows} are more than {MOST} tiles"
        )));
    }
    let mut draws = Vec::new();
    for (row, y) in (top..size[1]).step_by(height as usize).enumerate() {
        for (column, x) in (left..size[0]).step_by(width as usize).enumerate() {
            let Some(color) = tiles.colors[(column + ROW * row) % tiles.colors.len()] else {
                continue;
            };
            let (w, h) = (width.min(size[0] - x), height.min(size[1] - y));
            let mut draw = DrawWire {
                tiles: None,
                ..wire.clone()
            };
            draw.params.color = color;
            match tiles.by {
                TileBy::Mesh => {
                    let MeshSource::Full { z, value, winding } = wire.mesh else {
                        return Err(At::new("tiles by mesh need the mesh `full`"));
                    };
                    draw.mesh = MeshSource::Rect {
                        texels: [x, y, x + w, y + h],
                        z,
                        value,
                        winding,
                    };
                }
                TileBy::Scissor => draw.scissor = Some([x, y, w, h]),
                TileBy::Viewport => {
                    draw.viewport = Some(Viewport {
                        rect: [x, y, w, h].map(|v| v as f32),
                        depth: [0.0, 1.0],
                    });
                }
            }
            draws.push(draw);
        }
    }
    Ok(draws)
}

#[cfg(test)]
mod tests {
    use crate::resolve::parse_scene;
    use etalon_scene::{Pass, Viewport};
    use serde_json::{Value, json};

    fn pass(tiles: Value, mesh: &str) -> Option<Pass> {
        let draw = json!({ "mesh": { "kind": mesh }, "shader": "uniform_color", "tiles": tiles });
        let scene = json!({
            "attachments": { "color": { "format": "rgba8unorm", "size": [9, 5] } },
            "passes": [{ "color": ["color"], "draws": [draw] }],
            "read": ["color"]
        });
        let scene = parse_scene(&scene).ok()?;
        scene.passes.into_iter().next()
    }

    #[test]
    fn every_tile_has_a_draw() {
        let colors = json!([1, 0.5, 0]);
        let by = |by: &str| {
            pass(
                json!({ "size": [4, 4], "colors": colors, "by": by }),
                "full",
            )
        };
        let draws = by("mesh").expect("it fits").draws;
        let red: Vec<_> = draws.iter().map(|d| d.params.color[0]).collect();
        assert_eq!(red, [1.0, 0.5, 0.0, 0.0, 1.0, 0.5]);
        let draws = by("scissor").expect("it fits").draws;
        assert_eq!(draws[5].scissor, Some([8, 4, 1, 1]));
        let draws = by("viewport").expect("it fits").draws;
        assert_eq!(
            draws[2].viewport,
            Viewport {
                rect: [8.0, 0.0, 1.0, 4.0],
                depth: [0.0, 1.0]
            }
        );
    }

    #[test]
    fn tiles_start_at_their_origin() {
        let tiles = json!({ "origin": [5, 3], "size": [4, 4], "colors": [1], "by": "scissor" });
        let scissors = pass(tiles, "full").expect("it fits").draws.into_iter();
        let scissors: Vec<_> = scissors.filter_map(|d| d.scissor).collect();
        assert_eq!(scissors, [[5, 3, 4, 2]]);
    }

    #[test]
    fn a_tile_without_a_colour_is_not_drawn() {
        let draws = pass(json!({ "size": [3, 5], "colors": [1, null] }), "full");
        assert_eq!(draws.expect("it fits").draws.len(), 2);
    }

    #[test]
    fn impossible_tiles_are_refused() {
        assert!(pass(json!({ "size": [0, 4], "colors": [1] }), "full").is_none());
        assert!(pass(json!({ "size": [4, 4], "colors": [] }), "full").is_none());
        assert!(pass(json!({ "size": [4, 4], "colors": [1] }), "cover").is_none());
        let by_scissor = json!({ "size": [4, 4], "colors": [1], "by": "scissor" });
        assert!(pass(by_scissor, "cover").is_some());
    }
}
