//! Tests of the methods' scenes. Other tests draw and measure the pictures.

use super::ordered::{by_object, by_triangle};
use super::scenes::GlassScene;
use super::wire::{TransparencyMethod, TransparencyScene, TransparencyWire};
use super::{hashed, make, many_samples};
use crate::polygon::Polygon;
use crate::stage::SIZE;
use crate::truth::TexelCoverage;
use crate::validity::assert_valid;
use etalon_scene::{AttachmentContents, Scene, Shader};

const SCENES: [TransparencyScene; 6] = [
    TransparencyScene::Windows,
    TransparencyScene::IntersectingPanes,
    TransparencyScene::NestedGlass,
    TransparencyScene::ThinLayers,
    TransparencyScene::Hair,
    TransparencyScene::Smoke,
];

const METHODS: [TransparencyMethod; 15] = [
    TransparencyMethod::Unsorted,
    TransparencyMethod::Sorted,
    TransparencyMethod::SortedTriangles,
    TransparencyMethod::DepthWriteOff,
    TransparencyMethod::AlphaTest,
    TransparencyMethod::AlphaToCoverage,
    TransparencyMethod::Stochastic,
    TransparencyMethod::Hashed,
    TransparencyMethod::DepthPeeling,
    TransparencyMethod::DualDepthPeeling,
    TransparencyMethod::WeightedBlended,
    TransparencyMethod::MomentBased,
    TransparencyMethod::LinkedLists,
    TransparencyMethod::NearestLayers,
    TransparencyMethod::FrontToBack,
];

fn wire(scene: TransparencyScene, method: TransparencyMethod) -> TransparencyWire {
    TransparencyWire {
        scene,
        method,
        alpha: None,
        layers: None,
        angle: None,
        k: None,
    }
}

fn scene(wire: &TransparencyWire) -> Scene {
    make(wire).expect("the parameters are in range").scene
}

fn glass(name: TransparencyScene) -> GlassScene {
    GlassScene::new(&wire(name, TransparencyMethod::Sorted)).expect("the parameters are in range")
}

#[test]
fn every_method_draws_every_scene_over_the_same_truth() {
    for name in SCENES {
        let truth = glass(name).truth();
        assert!(truth.surfaces.iter().all(|s| s.corners.len() > 2));
        for method in METHODS {
            let made = make(&wire(name, method)).expect("the parameters are in range");
            assert_valid(&made.scene);
            assert_eq!(made.truth, truth, "{name:?} {method:?}");
            let picture = &made.scene.attachments[made.scene.read[0]];
            assert_eq!((picture.size, picture.samples), (truth.size, 1));
        }
    }
}

#[test]
fn parameters_at_their_ends_are_drawn_and_those_beyond_are_refused_by_name() {
    let near = TransparencyWire {
        angle: Some(65.0),
        ..wire(
            TransparencyScene::IntersectingPanes,
            TransparencyMethod::Sorted,
        )
    };
    let single_layer = TransparencyWire {
        layers: Some(1),
        ..wire(
            TransparencyScene::ThinLayers,
            TransparencyMethod::Stochastic,
        )
    };
    let most = TransparencyWire {
        layers: Some(256),
        ..single_layer.clone()
    };
    let once = TransparencyWire {
        k: Some(1),
        ..wire(TransparencyScene::Windows, TransparencyMethod::DepthPeeling)
    };
    let dual = TransparencyWire {
        method: TransparencyMethod::DualDepthPeeling,
        ..once.clone()
    };
    for wire in [near, single_layer, most, once, dual] {
        assert_valid(&scene(&wire));
    }
    let panes = wire(
        TransparencyScene::IntersectingPanes,
        TransparencyMethod::Sorted,
    );
    let thin = wire(TransparencyScene::ThinLayers, TransparencyMethod::Sorted);
    let bad = [
        (
            "angle",
            TransparencyWire {
                angle: Some(66.0),
                ..panes.clone()
            },
        ),
        (
            "angle",
            TransparencyWire {
                angle: Some(-1.0),
                ..panes
            },
        ),
        (
            "layers",
            TransparencyWire {
                layers: Some(0),
                ..thin.clone()
            },
        ),
        (
            "layers",
            TransparencyWire {
                layers: Some(257),
                ..thin.clone()
            },
        ),
        (
            "layers",
            TransparencyWire {
                layers: Some(65),
                alpha: Some(0.26),
                ..thin.clone()
            },
        ),
        (
            "alpha",
            TransparencyWire {
                alpha: Some(1.0),
                ..thin.clone()
            },
        ),
        (
            "alpha",
            TransparencyWire {
                alpha: Some(f64::NAN),
                ..thin.clone()
            },
        ),
        (
            "k",
            TransparencyWire {
                method: TransparencyMethod::LinkedLists,
                k: Some(33),
                ..thin.clone()
            },
        ),
        (
            "k",
            TransparencyWire {
                method: TransparencyMethod::NearestLayers,
                k: Some(33),
                ..thin.clone()
            },
        ),
        (
            "k",
            TransparencyWire {
                k: Some(0),
                ..thin.clone()
            },
        ),
        (
            "k",
            TransparencyWire {
                k: Some(65),
                ..thin
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

fn depth(polygon: &Polygon) -> f64 {
    polygon.corners.iter().map(|c| c[2]).sum::<f64>() / polygon.corners.len() as f64
}

#[test]
fn sorted_orders_go_from_far_to_near_and_the_list_has_another_order() {
    for name in SCENES {
        let glass = glass(name);
        let sorted = by_object(&glass);
        assert_eq!(sorted.len(), glass.polygons().count());
        let triangles = by_triangle(&glass);
        let corners: usize = glass.polygons().map(|p| p.corners.len() - 2).sum();
        assert_eq!(triangles.len(), corners);
        assert!(
            triangles
                .windows(2)
                .all(|t| depth(&t[0]) >= depth(&t[1]) - 1e-12)
        );
        let flat = glass.objects.iter().all(|o| o.polygons.len() == 1);
        if flat {
            assert!(
                sorted
                    .windows(2)
                    .all(|p| depth(&p[0]) >= depth(&p[1]) - 1e-12)
            );
        }
        let listed: Vec<f64> = glass
            .objects
            .iter()
            .map(super::scenes::Object::depth)
            .collect();
        assert!(listed.windows(2).any(|d| d[0] < d[1]), "{name:?} is sorted");
        assert!(listed.windows(2).any(|d| d[0] > d[1]), "{name:?} is sorted");
    }
}

#[test]
fn passes_grow_with_what_is_peeled_and_with_nothing_else() {
    let passes = |method, layers, k| {
        let wire = TransparencyWire {
            layers: Some(layers),
            k,
            ..wire(TransparencyScene::ThinLayers, method)
        };
        scene(&wire).passes.len()
    };
    for layers in [2, 16, 256] {
        assert_eq!(passes(TransparencyMethod::WeightedBlended, layers, None), 2);
        assert_eq!(passes(TransparencyMethod::MomentBased, layers, None), 3);
        assert_eq!(passes(TransparencyMethod::LinkedLists, layers, None), 2);
        assert_eq!(passes(TransparencyMethod::NearestLayers, layers, None), 3);
        assert_eq!(passes(TransparencyMethod::Sorted, layers, None), 1);
        // Each layer, or two of them, takes a pass and a blending pass.
        assert_eq!(
            passes(TransparencyMethod::DepthPeeling, layers, Some(8)),
            17
        );
        assert_eq!(
            passes(TransparencyMethod::DualDepthPeeling, layers, Some(4)),
            9
        );
        assert_eq!(passes(TransparencyMethod::DepthPeeling, layers, None), 17);
        assert_eq!(
            passes(TransparencyMethod::DualDepthPeeling, layers, None),
            9
        );
    }
}

#[test]
fn the_share_of_thresholds_below_alpha_is_alpha_and_none_is_close_to_it() {
    let alphas = [0.1, 0.4, 0.41, 0.6];
    let codes = many_samples::thresholds(SIZE, 3, &alphas);
    assert_eq!(codes.len(), (SIZE[0] * SIZE[1] * 4) as usize);
    assert_ne!(codes, many_samples::thresholds(SIZE, 4, &alphas));
    for alpha in alphas {
        let values = || codes.iter().map(|c| f64::from(*c) / 255.0);
        assert!(values().all(|v| (0.0..=1.0).contains(&v) && (v - alpha).abs() > 0.09 / 255.0));
        let share = values().filter(|v| *v <= alpha).count() as f64 / codes.len() as f64;
        // Six standard deviations of the mean of this many samples.
        assert!(
            (share - alpha).abs() < 6.0 * 0.5 / 256.0,
            "{share} of {alpha}"
        );
    }
}

#[test]
fn hashed_places_move_with_a_surface_and_no_two_surfaces_share_one() {
    let square =
        |left: f64, top: f64| Polygon::rect([left, top, left + 9.0, top + 5.0], 0.5, [1.0; 4]);
    let still = hashed::placed(SIZE, 3, &square(7.0, 20.0));
    assert_eq!(still.uv, hashed::placed(SIZE, 3, &square(64.0, 21.0)).uv);
    let mut places = Vec::new();
    for (number, strip) in glass(TransparencyScene::Hair).polygons().enumerate() {
        let [u, v] = hashed::placed(SIZE, number, strip).uv[0];
        places.push([u, v].map(|place| (place / 2.0) as u32));
    }
    let surfaces = places.len();
    places.sort_unstable();
    places.dedup();
    assert_eq!(places.len(), surfaces);
}

#[test]
fn layers_that_overlap_have_thresholds_of_their_own() {
    let wire = wire(
        TransparencyScene::ThinLayers,
        TransparencyMethod::Stochastic,
    );
    let scene = scene(&wire);
    let textures: Vec<&AttachmentContents> = scene
        .attachments
        .iter()
        .map(|a| &a.contents)
        .filter(|c| matches!(c, AttachmentContents::Texels(_)))
        .collect();
    assert_eq!(textures.len(), 16);
    for (i, texture) in textures.iter().enumerate() {
        assert!(!textures[..i].contains(texture));
    }
    let hair = glass(TransparencyScene::Hair);
    let strips: Vec<Polygon> = hair.polygons().cloned().collect();
    let layers = many_samples::layers(&strips);
    assert_eq!(layers.concat().len(), strips.len());
    assert!(layers.len() < strips.len() / 2, "{}", layers.len());
    // Neighbouring strips share a layer only if their boxes or their slants separate them.
    let apart = |a: &Polygon, b: &Polygon| {
        let side = |p: &Polygon, y: f64| {
            let [from, to] = [p.corners[0], p.corners[1]];
            from[0] + (to[0] - from[0]) * (y - from[1]) / (to[1] - from[1])
        };
        let top = a.corners[0][1].max(b.corners[0][1]);
        let bottom = a.corners[1][1].min(b.corners[1][1]);
        let gap = |y: f64| side(a, y) - side(b, y);
        gap(top) * gap(bottom) > 0.0
    };
    for layer in &layers {
        for (i, a) in layer.iter().enumerate() {
            assert!(layer[..i].iter().all(|b| apart(a, b)));
        }
    }
}

#[test]
fn no_edge_comes_near_a_centre_unless_coverage_is_by_area() {
    let off = |value: f64| (value.fract() - 0.5).abs();
    for name in SCENES {
        let glass = glass(name);
        if glass.coverage == TexelCoverage::Area {
            continue;
        }
        for polygon in glass.polygons().chain(&glass.opaque) {
            let corners = &polygon.corners;
            let next = corners.iter().cycle().skip(1);
            for (p, q) in corners.iter().zip(next) {
                // A grid that every driver keeps.
                assert!(
                    [p[0], p[1]].iter().all(|c| (c * 16.0).fract() == 0.0),
                    "{p:?}"
                );
                let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
                if dx == 0.0 || dy == 0.0 {
                    continue;
                }
                let (low, high) = (p[0].min(q[0]), p[0].max(q[0]));
                let centers = (0..128).map(|x| f64::from(x) + 0.5);
                for x in centers.filter(|x| (low..=high).contains(x)) {
                    let y = p[1] + (x - p[0]) * dy / dx;
                    assert!(off(y) > 1e-6, "{name:?} {p:?} {q:?} at {x}");
                }
            }
        }
    }
}

#[test]
fn panes_pass_through_each_other_from_a_third_of_a_right_angle_on() {
    let nearest = |angle: f64, x: f64| {
        let glass = GlassScene::new(&TransparencyWire {
            angle: Some(angle),
            ..wire(
                TransparencyScene::IntersectingPanes,
                TransparencyMethod::Sorted,
            )
        })
        .expect("the angle is in range");
        let depth_at = |p: &Polygon| {
            let [from, to] = [p.corners[0], p.corners[2]];
            from[2] + (to[2] - from[2]) * (x - from[0]) / (to[0] - from[0])
        };
        let depths: Vec<f64> = glass.polygons().map(depth_at).collect();
        (0..3).min_by(|a, b| depths[*a].total_cmp(&depths[*b]))
    };
    // At the right end of the area that all of them cover.
    assert_eq!(nearest(30.0, 103.0), Some(1));
    assert_eq!(nearest(45.0, 103.0), Some(2));
    assert_eq!(nearest(45.0, 64.0), Some(1));
}

#[test]
fn no_shader_writes_what_half_floats_do_not_hold() {
    let cases = SCENES.map(|name| (name, 0.99, 64));
    for (name, alpha, layers) in
        cases
            .into_iter()
            .chain([(TransparencyScene::ThinLayers, 0.25, 256)])
    {
        let made = scene(&TransparencyWire {
            alpha: Some(alpha),
            layers: Some(layers),
            ..wire(name, TransparencyMethod::WeightedBlended)
        });
        let draws = made.passes.iter().flat_map(|p| &p.draws);
        let sum: f32 = draws
            .filter(|d| d.shader == Shader::WeightedAccumulate && d.targets[0].write_mask != 0)
            .flat_map(|d| d.mesh.vertices.chunks_exact(3))
            .map(|t| 3000.0 * (1.0 - t[0].position[2]).powi(3) * t[0].color[3].powi(2))
            .sum();
        // The sum over all triangles exceeds the sum at any texel.
        assert!(
            sum / 2.0 < 65504.0 || name == TransparencyScene::Hair,
            "{name:?}: {sum}"
        );
    }
}
