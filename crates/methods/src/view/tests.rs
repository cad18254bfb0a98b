//! Tests of clipping and projection.

use super::*;
use crate::corners::{area, corners};

const SIZE: [u32; 2] = [128, 128];

/// Returns a regular polygon that is turned by an angle.
fn disc(sides: u32, turn: f64) -> Vec<DVec3> {
    let corner = |i: u32| {
        let (sin, cos) = (turn + f64::from(i) / f64::from(sides) * std::f64::consts::TAU).sin_cos();
        DVec3::new(cos, sin, 0.3 * cos + 0.1)
    };
    (0..sides).map(corner).collect()
}

#[test]
fn a_clipped_polygon_and_its_cut_part_make_the_whole() {
    for i in 0..200 {
        let shape = disc(3 + i % 6, f64::from(i) * 0.7);
        let (sin, cos) = (f64::from(i) * 0.41).sin_cos();
        let offset = f64::from(i % 9) * 0.3 - 1.2;
        let side = |p: DVec3| cos * p.x + sin * p.y - offset;
        let [kept, cut] = [clip(&shape, side), clip(&shape, |p| -side(p))];
        assert!(kept.iter().all(|p| side(*p) > -1e-12));
        assert!(cut.iter().all(|p| side(*p) < 1e-12));
        let total = area(&kept) + area(&cut);
        assert!((total - area(&shape)).abs() < 1e-12, "{total}");
        // The polygon is still flat.
        assert!(kept.iter().all(|p| (p.z - 0.3 * p.x - 0.1).abs() < 1e-12));
    }
}

#[test]
fn neighbours_cut_their_common_edge_at_the_same_point() {
    let [a, b, c, d] =
        [[0.1, 0.2], [3.7, 5.3], [-2.0, 4.0], [4.0, 0.3]].map(|[x, y]| DVec3::new(x, y, x * y));
    for i in 0..50 {
        let offset = 0.3 + f64::from(i) * 0.1;
        let side = |p: DVec3| p.x * 0.3 + p.y - offset;
        let left = clip(&[a, b, c], side);
        let right = clip(&[b, a, d], side);
        let common = left.iter().filter(|p| right.contains(p)).count();
        // The upper end of the edge and the cut, or the whole edge.
        assert_eq!(common, if side(b) >= 0.0 { 2 } else { 0 }, "{offset}");
    }
}

#[test]
fn window_depth_is_0_at_the_near_and_1_at_the_far_plane() {
    let planes = [0.1, 1000.0];
    assert_eq!(window_depth(0.1, planes), 0.0);
    assert_eq!(window_depth(1000.0, planes), 1.0);
    assert!((window_depth(0.2, planes) - 0.50005).abs() < 1e-6);
    // With the planes exchanged, the same depths from the other end.
    let reversed = window_depth(7.0, [1000.0, 0.1]);
    assert!((window_depth(7.0, planes) + reversed - 1.0).abs() < 1e-12);
}

#[test]
fn a_point_appears_where_its_ray_meets_the_picture() {
    let eye = DVec3::new(0.0, 0.0, 5.0);
    let view = View::perspective(SIZE, [eye, DVec3::ZERO], 90.0, [1.0, 9.0]);
    // A square of 2 at distance 5, a fifth of the height that is seen there.
    let faces = cuboid(
        DVec3::new(-1.0, -1.0, -1.0),
        DVec3::new(1.0, 1.0, 0.0),
        [1.0; 4],
    );
    let front: Vec<Polygon> = view.see(&faces[5..]);
    let [polygon] = &front[..] else {
        panic!("a single face is seen as a single polygon");
    };
    let [low, high] = [64.0 - 12.8, 64.0 + 12.8];
    for (corner, expected) in
        polygon
            .corners
            .iter()
            .zip([[low, high], [high, high], [high, low], [low, low]])
    {
        assert!((corner[0] - expected[0]).abs() < 1e-9 && (corner[1] - expected[1]).abs() < 1e-9);
        assert!((corner[2] - window_depth(5.0, [1.0, 9.0])).abs() < 1e-12);
    }
    // Seen from its front it is counter-clockwise, which with y down is a negative area.
    assert!(area(&corners(polygon)) < 0.0);
}

#[test]
fn visible_polygons_stay_within_the_picture_and_beyond_the_near_plane() {
    let faces = cuboid(DVec3::splat(-3.0), DVec3::splat(3.0), [1.0; 4]);
    for (z, some) in [(2.0, true), (3.05, true), (8.0, true), (-9.0, false)] {
        let eye = DVec3::new(0.5, 0.2, z);
        let view = View::perspective(SIZE, [eye, eye - DVec3::Z], 60.0, [0.1, 30.0]);
        let seen = view.see(&faces);
        assert_eq!(!seen.is_empty(), some, "{z}");
        for [x, y, depth] in seen.iter().flat_map(|p| p.corners.iter().copied()) {
            assert!((-1e-9..=128.000_001).contains(&x) && (-1e-9..=128.000_001).contains(&y));
            assert!((-1e-9..=1.000_001).contains(&depth), "{depth}");
        }
    }
}
