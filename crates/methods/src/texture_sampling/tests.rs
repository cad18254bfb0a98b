//! The ground that a driver clips and divides must be the ground of the truth.

use super::*;
use crate::view::clip;

/// Returns the projected area of clip-space triangles in texels, clipped in 64-bit floats.
fn area(mesh: &Mesh) -> f64 {
    let triangles = mesh.vertices.chunks(3).map(|triangle| {
        let corners = triangle.iter().map(|v| v.position.map(f64::from));
        // Planes of clip space are linear in x, y and w; z plays no part on the ground.
        let mut points: Vec<DVec3> = corners.map(|[x, y, _, w]| DVec3::new(x, y, w)).collect();
        points = clip(&points, |p| p.z - 0.1);
        for side in [-1.0, 1.0] {
            points = clip(&points, |p| p.z + side * p.x);
            points = clip(&points, |p| p.z + side * p.y);
        }
        let half = f64::from(SIZE[0]) / 2.0;
        let flat: Vec<[f64; 2]> = points
            .iter()
            .map(|p| [p.x / p.z * half, p.y / p.z * half])
            .collect();
        polygon_area(&flat)
    });
    triangles.sum()
}

fn polygon_area(corners: &[[f64; 2]]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let sum: f64 = corners
        .iter()
        .zip(next)
        .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
        .sum();
    sum.abs() / 2.0
}

#[test]
fn the_drawn_ground_covers_the_tiles_of_the_truth() {
    for tiles in [0.25, 0.7, 1.0, 2.0] {
        let seen: f64 = seen(tiles)
            .iter()
            .map(|p| {
                let flat: Vec<[f64; 2]> = p.corners.iter().map(|c| [c[0], c[1]]).collect();
                polygon_area(&flat)
            })
            .sum();
        let drawn = area(&ground(ENDS, tiles, false));
        assert!(seen > 8000.0, "{seen}");
        assert!((seen - drawn).abs() < 0.01, "{tiles}: {seen} {drawn}");
        let affine = area(&ground([NEAREST, ENDS[1]], tiles, true));
        assert!((seen - affine).abs() < 0.01, "{tiles}: {seen} {affine}");
    }
}

#[test]
fn the_ground_begins_behind_the_eye_unless_it_is_affine() {
    let w = |mesh: &Mesh| {
        mesh.vertices
            .iter()
            .map(|v| v.position[3])
            .collect::<Vec<_>>()
    };
    let w_values = w(&ground(ENDS, 1.0, false));
    assert!(w_values.iter().any(|w| *w < -1.0) && w_values.iter().any(|w| *w > 20.0));
    assert!(
        w(&ground([NEAREST, ENDS[1]], 1.0, true))
            .iter()
            .all(|w| *w == 1.0)
    );
}

#[test]
fn every_visible_tile_has_a_color_of_the_texture() {
    let texels = tiles();
    for polygon in seen(1.0) {
        let color = polygon.color.map(|v| (v * 255.0).round() as u32);
        assert!(texels.contains(&color));
    }
}

#[test]
fn coordinates_name_the_tile_at_a_point() {
    // The third tile across and the second along.
    let (_, [u, v]) = corner(-HALF_WIDTH + 2.5, ENDS[0] - 1.5, 1.0);
    assert_eq!([u, v].map(|c| (c * f64::from(TEXTURE)) as u32), [2, 1]);
}
