//! Tests of settled polygons.

use super::*;
use crate::corners::{area, corners};
use crate::view::{View, cuboid};

const SIZE: [u32; 2] = [128, 128];

#[test]
fn settled_triangles_are_on_the_grid_without_gaps_and_touch_no_centre() {
    let eye = DVec3::new(1.0, 1.4, 2.6);
    let view = View::perspective(SIZE, [eye, DVec3::ZERO], 60.0, [0.1, 30.0]);
    let faces = cuboid(DVec3::splat(-1.0), DVec3::splat(1.0), [1.0; 4]);
    let seen = view.see(&faces);
    let triangles = settle(SIZE, &seen);
    assert!(triangles.len() >= 6 * 3);
    let grid = |p: &Polygon| {
        corners(p)
            .iter()
            .map(|c| [c.x, c.y].map(|v| (v * GRID) as i64))
            .collect()
    };
    let mut covered = 0.0;
    for triangle in &triangles {
        let points: Vec<[i64; 2]> = grid(triangle);
        for (i, point) in points.iter().enumerate() {
            let exact = point.map(|v| v as f64 / GRID);
            assert_eq!(exact, [triangle.corners[i][0], triangle.corners[i][1]]);
            assert!(!touches_centre(SIZE, *point, points[(i + 1) % 3]));
        }
        covered += area(&corners(triangle));
    }
    // The front and the back show the same area: the box stays closed.
    assert!(covered.abs() < 1e-9, "{covered}");
}

#[test]
fn an_edge_through_a_centre_is_found_and_moved_off() {
    let texels = |x: f64, y: f64| [(x * GRID) as i64, (y * GRID) as i64];
    let [a, b] = [texels(10.0, 10.0), texels(40.0, 40.0)];
    assert!(touches_centre(SIZE, a, b) && touches_centre(SIZE, b, a));
    assert!(touches_centre(SIZE, texels(0.0, 8.5), texels(128.0, 8.5)));
    assert!(touches_centre(SIZE, texels(8.5, 0.0), texels(8.5, 9.0)));
    assert!(!touches_centre(SIZE, texels(8.5, 0.0), texels(8.5, 0.25)));
    assert!(!touches_centre(SIZE, texels(0.0, 8.0), texels(128.0, 8.0)));
    let mut points = [a, b];
    untie(SIZE, &mut points, &[[0, 1]]);
    assert!(!touches_centre(SIZE, points[0], points[1]));
    let moved = points
        .iter()
        .zip([a, b])
        .map(|(p, q)| (p[0] - q[0]).abs() + (p[1] - q[1]).abs());
    assert!(moved.sum::<i64>() <= 2);
}
