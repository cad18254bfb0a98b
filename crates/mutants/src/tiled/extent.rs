//! Texels that no draw reaches: beyond an extent, at the last edge, in one tile.

use super::super::hooks::covered;
use super::super::list::{CONFUSION, List};
use super::super::plant::Plant;
use super::tiles::TILES;

/// Draws nothing at texels of which `bug([x, y], [width, height])` is true.
fn lost(bug: impl Fn([u32; 2], [u32; 2]) -> bool + Send + Sync + 'static) -> Plant {
    covered(move |at, size| !bug(at, size))
}

pub(super) fn add(list: &mut List) {
    for n in [16, 32] {
        list.add(
            &format!("only-first-{n}"),
            CONFUSION,
            format!("Only the first {n}×{n} texels are drawn."),
            lost(move |[x, y], _| x >= n || y >= n),
        );
    }
    type Bug = (&'static str, &'static str, fn([u32; 2], [u32; 2]) -> bool);
    let edges: [Bug; 2] = [
        (
            "last-column",
            "The last column is not drawn.",
            |at, size| at[0] + 1 == size[0],
        ),
        ("last-row", "The last row is not drawn.", |at, size| {
            at[1] + 1 == size[1]
        }),
    ];
    for (name, about, bug) in edges {
        list.add(name, CONFUSION, about, lost(bug));
    }
    for n in TILES {
        list.add(
            &format!("first-tile-of-{n}"),
            CONFUSION,
            format!("Of several tiles of {n}×{n}, the first is not drawn."),
            lost(move |[x, y], size| x < n && y < n && size.iter().any(|s| *s > n)),
        );
        list.add(
            &format!("second-tile-of-{n}"),
            CONFUSION,
            format!("The second tile of {n}×{n} in the first row is not drawn."),
            lost(move |[x, y], _| x / n == 1 && y / n == 0),
        );
        list.add(
            &format!("last-tile-of-{n}"),
            CONFUSION,
            format!("Of several tiles of {n}×{n}, the last is not drawn."),
            lost(move |at, size| {
                let last = |axis: usize| at[axis] / n == (size[axis] - 1) / n;
                last(0) && last(1) && size.iter().any(|s| *s > n)
            }),
        );
        list.add(
            &format!("second-row-of-tiles-of-{n}"),
            CONFUSION,
            format!("The second row of tiles of {n}×{n} is not drawn."),
            lost(move |[_, y], _| y / n == 1),
        );
    }
    for n in [16, 32, 64, 128, 256, 1024] {
        list.add(
            &format!("column-{n}"),
            CONFUSION,
            format!("Column {n} is not drawn."),
            lost(move |[x, _], _| x == n),
        );
        list.add(
            &format!("row-{n}"),
            CONFUSION,
            format!("Row {n} is not drawn."),
            lost(move |[_, y], _| y == n),
        );
    }
}
