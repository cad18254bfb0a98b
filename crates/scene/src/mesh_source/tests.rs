//! Tests of the expansion of meshes.

use super::*;
use crate::mesh::PrimitiveVertices;
use crate::rasterization::PrimitiveTopology;
use std::collections::HashMap;

/// Returns twice the signed area of each triangle with y up, and the least distance of any edge from any
/// texel centre.
fn measure(mesh: &Mesh, size: [u32; 2]) -> (Vec<f64>, f64) {
    let to_texels = |v: &Vertex| {
        DVec2::new(
            (f64::from(v.position[0]) + 1.0) / 2.0 * f64::from(size[0]),
            (1.0 - f64::from(v.position[1])) / 2.0 * f64::from(size[1]),
        )
    };
    let mut areas = Vec::new();
    let mut least = f64::MAX;
    for primitive in mesh.primitives(PrimitiveTopology::TriangleList) {
        let PrimitiveVertices::Triangle(t) = primitive else {
            continue;
        };
        let p = t.map(|i| to_texels(&mesh.vertices[i]));
        areas.push(-(p[1] - p[0]).perp_dot(p[2] - p[0]));
        for (a, b) in [(p[0], p[1]), (p[1], p[2]), (p[2], p[0])] {
            for y in 0..size[1] {
                for x in 0..size[0] {
                    let c = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                    let along = (b - a).normalize();
                    let t = (c - a).dot(along).clamp(0.0, (b - a).length());
                    least = least.min((a + along * t).distance(c));
                }
            }
        }
    }
    (areas, least)
}

#[test]
fn every_edge_keeps_away_from_every_centre() {
    let sources = [
        MeshSource::Full {
            z: 0.0,
            value: Splat::default(),
            winding: FrontFace::Ccw,
        },
        MeshSource::Columns {
            values: vec![Splat::default(); 5],
            z: zero(),
            windings: one_ccw(),
        },
        MeshSource::Rect {
            texels: [3, 1, 10, 4],
            z: 0.0,
            value: Splat::default(),
            winding: FrontFace::Ccw,
        },
    ];
    for source in sources {
        let mesh = source.expand([16, 16]).expect("valid");
        let (areas, least) = measure(&mesh, [16, 16]);
        assert!(areas.iter().all(|a| *a > 0.0), "{source:?} is not ccw");
        assert!(least > 0.17, "{source:?}: {least}");
    }
}

#[test]
fn a_clockwise_mesh_has_negative_areas() {
    let source = MeshSource::Full {
        z: 0.5,
        value: Splat([1.0; 4]),
        winding: FrontFace::Cw,
    };
    let mesh = source.expand([16, 16]).expect("valid");
    let (areas, _) = measure(&mesh, [16, 16]);
    assert!(areas.iter().all(|a| *a < 0.0));
}

#[test]
fn more_columns_than_texels_are_refused() {
    let source = MeshSource::Columns {
        values: vec![Splat::default(); 17],
        z: zero(),
        windings: one_ccw(),
    };
    assert!(source.expand([16, 16]).is_err());
}

fn triangles(mesh: &Mesh) -> Vec<[usize; 3]> {
    let primitives = mesh.primitives(PrimitiveTopology::TriangleList);
    primitives
        .into_iter()
        .map(|p| match p {
            PrimitiveVertices::Triangle(t) => t,
            other => panic!("{other:?} is not a triangle"),
        })
        .collect()
}

/// Returns twice the signed area in clip space, positive if the winding is counter-clockwise.
fn area(mesh: &Mesh, t: [usize; 3]) -> f64 {
    let p = t.map(|i| {
        let [x, y, ..] = mesh.vertices[i].position.map(f64::from);
        DVec2::new(x, y)
    });
    (p[1] - p[0]).perp_dot(p[2] - p[0])
}

fn grid(cells: [u32; 2], size: [u32; 2]) -> Mesh {
    let source = MeshSource::Grid {
        cells,
        z: 0.5,
        value: Splat([1.0; 4]),
    };
    source.expand(size).expect("valid")
}

#[test]
fn a_grid_covers_every_centre_once_with_room() {
    // Cells of several texels, of one texel, and parts of a texel.
    for (cells, size) in [([4, 3], [16, 12]), ([8, 8], [8, 8]), ([24, 24], [8, 8])] {
        let mesh = grid(cells, size);
        let triangles = triangles(&mesh);
        assert_eq!(triangles.len() as u32, 2 * cells[0] * cells[1]);
        assert!(triangles.iter().all(|t| area(&mesh, *t) > 0.0));
        let texels = |i: usize| {
            let [x, y, ..] = mesh.vertices[i].position.map(f64::from);
            DVec2::new(
                (x + 1.0) / 2.0 * f64::from(size[0]),
                (1.0 - y) / 2.0 * f64::from(size[1]),
            )
        };
        // The first cells' diagonals pass through centres, which both triangles of the cell share.
        let fine = cells[0] >= size[0];
        for y in 0..size[1] {
            for x in 0..size[0] {
                let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let mut covered = 0;
                for t in &triangles {
                    let p = t.map(texels);
                    let sides = [(p[0], p[1]), (p[1], p[2]), (p[2], p[0])];
                    let distances = sides.map(|(a, b)| -(b - a).normalize().perp_dot(centre - a));
                    let least = distances.into_iter().fold(f64::MAX, f64::min);
                    covered += u32::from(least > 0.0);
                    assert!(!fine || least.abs() > 0.08, "{cells:?} ({x}, {y}): {least}");
                }
                assert_eq!(covered, 1, "{cells:?} ({x}, {y})");
            }
        }
    }
}

#[test]
fn a_torus_is_closed_and_faces_outwards() {
    let source = MeshSource::Torus {
        segments: [16, 12],
        value: Splat([1.0; 4]),
    };
    let mesh = source.expand([64, 64]).expect("valid");
    let triangles = triangles(&mesh);
    assert_eq!(triangles.len(), 2 * 16 * 12);
    let mut edges: HashMap<(usize, usize), i32> = HashMap::new();
    for [a, b, c] in &triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((*from, *to)).or_default() += 1;
        }
    }
    // Each edge belongs to two triangles, which run along it in opposite directions.
    for ((from, to), count) in &edges {
        assert_eq!((*count, edges.get(&(*to, *from))), (1, Some(&1)));
    }
    // Triangles of the nearer half face the eye.
    for t in triangles {
        let depth = t.map(|i| f64::from(mesh.vertices[i].position[2]));
        let nearer = depth.iter().sum::<f64>() / 3.0 < 0.5;
        assert_eq!(area(&mesh, t) > 0.0, nearer, "{t:?}");
    }
}

#[test]
fn an_empty_or_too_large_surface_is_refused() {
    for cells in [[0, 4], [4, 0], [5000, 5000], [u32::MAX, u32::MAX]] {
        let source = MeshSource::Grid {
            cells,
            z: 0.0,
            value: Splat::default(),
        };
        assert!(source.expand([16, 16]).is_err(), "{cells:?}");
    }
    let source = MeshSource::Torus {
        segments: [2, 8],
        value: Splat::default(),
    };
    assert!(source.expand([16, 16]).is_err());
}
