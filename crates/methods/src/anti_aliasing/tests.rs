//! Tests of the methods' scenes. Other tests draw and measure the pictures.

use super::scenes::EdgeScene;
use super::wire::{AntiAliasingMethod, AntiAliasingScene, AntiAliasingWire};
use super::{jittered, make};
use crate::polygon::Polygon;
use crate::stage::SIZE;
use crate::validity::assert_valid;

const SCENES: [AntiAliasingScene; 4] = [
    AntiAliasingScene::HalfPlanes,
    AntiAliasingScene::ThinWedge,
    AntiAliasingScene::CheckerFan,
    AntiAliasingScene::WireTorus,
];

const METHODS: [AntiAliasingMethod; 13] = [
    AntiAliasingMethod::None,
    AntiAliasingMethod::Msaa2,
    AntiAliasingMethod::Msaa4,
    AntiAliasingMethod::Msaa8,
    AntiAliasingMethod::Msaa16,
    AntiAliasingMethod::Supersampling2x2,
    AntiAliasingMethod::Supersampling4x4,
    AntiAliasingMethod::Jittered4,
    AntiAliasingMethod::Jittered8,
    AntiAliasingMethod::Jittered16,
    AntiAliasingMethod::Fxaa,
    AntiAliasingMethod::CoverageToAlpha,
    AntiAliasingMethod::CoverageToAlphaOverlap,
];

fn wire(scene: AntiAliasingScene, method: AntiAliasingMethod) -> AntiAliasingWire {
    AntiAliasingWire {
        scene,
        method,
        angle: None,
        opening: None,
        speed: None,
    }
}

fn edges(wire: &AntiAliasingWire) -> EdgeScene {
    EdgeScene::new(wire).expect("the parameters are in range")
}

#[test]
fn every_method_draws_every_scene_over_the_same_truth() {
    for name in SCENES {
        let truth = edges(&wire(name, AntiAliasingMethod::None)).truth();
        for method in METHODS {
            let made = make(&wire(name, method)).expect("the parameters are in range");
            assert_valid(&made.scene);
            assert_eq!(made.truth, truth, "{name:?} {method:?}");
            let picture = &made.scene.attachments[made.scene.read[0]];
            assert_eq!((picture.size, picture.samples), (SIZE, 1));
        }
    }
}

#[test]
fn parameters_out_of_range_are_refused_by_name() {
    let half = wire(AntiAliasingScene::HalfPlanes, AntiAliasingMethod::None);
    let wedge = wire(AntiAliasingScene::ThinWedge, AntiAliasingMethod::None);
    let bad = [
        (
            "angle",
            AntiAliasingWire {
                angle: Some(91.0),
                ..half.clone()
            },
        ),
        (
            "angle",
            AntiAliasingWire {
                angle: Some(f64::NAN),
                ..half
            },
        ),
        (
            "speed",
            AntiAliasingWire {
                speed: Some(4.5),
                ..wedge.clone()
            },
        ),
        (
            "opening",
            AntiAliasingWire {
                opening: Some(0.0),
                ..wedge.clone()
            },
        ),
        (
            "opening",
            AntiAliasingWire {
                opening: Some(61.0),
                ..wedge
            },
        ),
    ];
    for (key, wire) in bad {
        let Err(error) = make(&wire) else {
            panic!("{wire:?} is drawn");
        };
        assert_eq!(error.key, key);
    }
}

#[test]
fn jittered_frames_have_their_own_rows_and_columns_around_the_centre() {
    for count in [4, 8, 16] {
        let offsets: Vec<[f64; 2]> = jittered::offsets(count).collect();
        for axis in 0..2 {
            let cell = |o: &[f64; 2]| ((o[axis] + 0.5) * f64::from(count)) as u32;
            let mut cells: Vec<u32> = offsets.iter().map(cell).collect();
            cells.sort_unstable();
            assert_eq!(cells, (0..count).collect::<Vec<u32>>());
            assert_eq!(offsets.iter().map(|o| o[axis]).sum::<f64>(), 0.0);
        }
    }
}

#[test]
fn a_moving_scene_ends_where_the_truth_is() {
    let moving = |speed| {
        let wire = AntiAliasingWire {
            speed: Some(speed),
            ..wire(AntiAliasingScene::WireTorus, AntiAliasingMethod::Jittered4)
        };
        make(&wire).expect("the speed is in range")
    };
    let (still, fast) = (moving(0.0), moving(2.0));
    assert_eq!(still.truth, fast.truth);
    // Clip space is 2 wide. Each frame takes two passes; the first six vertices are the background.
    let texel = 2.0 / SIZE[0] as f32;
    for (frame, behind) in [6.0, 4.0, 2.0, 0.0].into_iter().enumerate() {
        let place = |made: &crate::method_scene::MethodScene| {
            made.scene.passes[2 * frame].draws[0].mesh.vertices[6].position[0]
        };
        let distance = (place(&still) - place(&fast)) / texel;
        assert!((distance - behind).abs() < 1e-3, "{frame}: {distance}");
    }
}

fn area(polygon: &Polygon) -> f64 {
    let corners = &polygon.corners;
    let next = corners.iter().cycle().skip(1);
    let twice: f64 = corners
        .iter()
        .zip(next)
        .map(|(p, q)| p[0] * q[1] - q[0] * p[1])
        .sum();
    twice.abs() / 2.0
}

#[test]
fn pieces_in_front_and_behind_fill_the_picture_without_overlap() {
    for name in [
        AntiAliasingScene::HalfPlanes,
        AntiAliasingScene::ThinWedge,
        AntiAliasingScene::CheckerFan,
    ] {
        for angle in [0.0, 20.0, 45.0, 90.0] {
            let edges = edges(&AntiAliasingWire {
                angle: Some(angle),
                ..wire(name, AntiAliasingMethod::None)
            });
            let pieces = edges.front.iter().chain(&edges.back);
            let sum: f64 = pieces.filter_map(|p| p.polygon()).map(|p| area(&p)).sum();
            let expected = f64::from(SIZE[0] * SIZE[1]);
            // Nothing is missing. Each piece is inside the picture, so nothing overlaps either.
            assert!((sum - expected).abs() < 1e-6, "{name:?}: {sum}");
        }
    }
}

#[test]
fn a_smoothed_piece_knows_its_distance_from_the_nearest_edge() {
    let edges = edges(&wire(
        AntiAliasingScene::CheckerFan,
        AntiAliasingMethod::None,
    ));
    for piece in &edges.front {
        for part in piece.smooth(true) {
            let nearest = |[x, y, _]: [f64; 3]| {
                let distances = piece.lines.iter().map(|l| l.distance([x, y]));
                distances.fold(f64::INFINITY, f64::min)
            };
            for (corner, uv) in part.corners.iter().zip(&part.uv) {
                assert!((nearest(*corner) - uv[0]).abs() < 1e-9);
                assert!(uv[0] >= -1.0 - 1e-9);
            }
        }
    }
}

#[test]
fn parts_of_a_smoothed_piece_cover_the_whole_piece() {
    for name in SCENES {
        let edges = edges(&wire(name, AntiAliasingMethod::None));
        for piece in edges.front.iter().chain(&edges.back) {
            let Some(polygon) = piece.polygon() else {
                continue;
            };
            for overlap in [false, true] {
                let parts: f64 = piece.smooth(overlap).iter().map(area).sum();
                assert!(parts > area(&polygon) - 1e-9, "{name:?}");
            }
        }
    }
}

#[test]
fn ends_of_wires_are_smoothed_only_where_they_overlap() {
    let edges = edges(&wire(
        AntiAliasingScene::WireTorus,
        AntiAliasingMethod::None,
    ));
    for wire in &edges.front {
        assert_eq!(wire.smooth(false).len(), 2);
        assert!(wire.smooth(true).len() > 2);
    }
}

#[test]
fn a_half_plane_at_no_angle_covers_known_shares() {
    let edges = edges(&AntiAliasingWire {
        angle: Some(0.0),
        ..wire(AntiAliasingScene::HalfPlanes, AntiAliasingMethod::None)
    });
    for (i, piece) in edges.front.iter().enumerate() {
        let polygon = piece.polygon().expect("half of the cell is covered");
        // The edge is this far below the middle of the cell.
        let offset = (i as f64 + 0.5) / 16.0;
        assert!((area(&polygon) - 32.0 * (16.0 - offset)).abs() < 1e-9);
    }
}
