//! Tests of the expansion of meshes.

use super::*;
use crate::mesh::PrimitiveVertices;
use crate::rasterization::PrimitiveTopology;
use std::collections::HashMap;

/// Returns a vertex's position in texels, with y down.
fn texel_position(vertex: &Vertex, size: [u32; 2]) -> DVec2 {
    let [x, y, ..] = vertex.position.map(f64::from);
    DVec2::new(
        (x + 1.0) / 2.0 * f64::from(size[0]),
        (1.0 - y) / 2.0 * f64::from(size[1]),
    )
}

/// Returns twice the signed area in clip space, positive if the winding is counter-clockwise.
fn signed_area(mesh: &Mesh, triangle: [usize; 3]) -> f64 {
    let [a, b, c] = triangle.map(|i| {
        let [x, y, ..] = mesh.vertices[i].position.map(f64::from);
        DVec2::new(x, y)
    });
    (b - a).perp_dot(c - a)
}

/// Returns the triangles of a mesh, which has at least one, and nothing else.
fn triangles(mesh: &Mesh) -> Vec<[usize; 3]> {
    let primitives = mesh.primitives(PrimitiveTopology::TriangleList);
    assert!(!primitives.is_empty());
    primitives
        .into_iter()
        .map(|p| match p {
            PrimitiveVertices::Triangle(triangle) => triangle,
            other => panic!("{other:?} is not a triangle"),
        })
        .collect()
}

/// Returns the least distance of any edge from any texel centre, in texels.
fn least_distance_to_centres(mesh: &Mesh, size: [u32; 2]) -> f64 {
    let mut least = f64::MAX;
    for triangle in triangles(mesh) {
        let p = triangle.map(|i| texel_position(&mesh.vertices[i], size));
        for (a, b) in [(p[0], p[1]), (p[1], p[2]), (p[2], p[0])] {
            for y in 0..size[1] {
                for x in 0..size[0] {
                    let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                    let direction = (b - a).normalize();
                    let along = (centre - a).dot(direction).clamp(0.0, (b - a).length());
                    least = least.min((a + direction * along).distance(centre));
                }
            }
        }
    }
    least
}

fn columns(count: usize) -> MeshSource {
    MeshSource::Columns {
        values: vec![Splat::default(); count],
        z: zero(),
        windings: one_ccw(),
    }
}

/// Returns counter-clockwise sources, whose edges must avoid centres.
fn sources() -> [MeshSource; 3] {
    [
        MeshSource::Full {
            z: 0.0,
            value: Splat::default(),
            winding: FrontFace::Ccw,
        },
        columns(5),
        MeshSource::Rect {
            texels: [3, 1, 10, 4],
            z: 0.0,
            value: Splat::default(),
            winding: FrontFace::Ccw,
        },
    ]
}

#[test]
fn every_edge_keeps_away_from_every_centre() {
    for source in sources() {
        let mesh = source.expand([16, 16]).expect("valid");
        let least = least_distance_to_centres(&mesh, [16, 16]);
        // The slanted edge of the full-screen triangles comes nearest.
        assert!(least > 0.17, "{source:?}: {least}");
    }
}

#[test]
fn a_counter_clockwise_source_gives_counter_clockwise_triangles() {
    for source in sources() {
        let mesh = source.expand([16, 16]).expect("valid");
        for triangle in triangles(&mesh) {
            assert!(signed_area(&mesh, triangle) > 0.0, "{source:?}");
        }
    }
}

#[test]
fn a_clockwise_source_gives_clockwise_triangles() {
    let source = MeshSource::Full {
        z: 0.5,
        value: Splat([1.0; 4]),
        winding: FrontFace::Cw,
    };
    let mesh = source.expand([16, 16]).expect("valid");
    for triangle in triangles(&mesh) {
        assert!(signed_area(&mesh, triangle) < 0.0);
    }
}

#[test]
fn more_columns_than_texels_are_refused() {
    assert!(columns(16).expand([16, 16]).is_ok());
    assert!(columns(17).expand([16, 16]).is_err());
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
        assert!(triangles.iter().all(|t| signed_area(&mesh, *t) > 0.0));
        // The first cells' diagonals pass through centres, which both triangles of the cell share.
        let fine = cells[0] >= size[0];
        for y in 0..size[1] {
            for x in 0..size[0] {
                let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let mut covered = 0;
                for triangle in &triangles {
                    let p = triangle.map(|i| texel_position(&mesh.vertices[i], size));
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
    for triangle in triangles {
        let depth = triangle.map(|i| f64::from(mesh.vertices[i].position[2]));
        let nearer = depth.iter().sum::<f64>() / 3.0 < 0.5;
        assert_eq!(signed_area(&mesh, triangle) > 0.0, nearer, "{triangle:?}");
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
