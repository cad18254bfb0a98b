//! Tests of the questions whose scenes are solid or flat.

use super::*;
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Questions, scenes and methods, with a parameter inside its range.
fn every_wire() -> Vec<Value> {
    let depth = depth_precision::MODEL_METHODS;
    let decal = [
        "depth24",
        "depth32float",
        "reversed-depth",
        "polygon-offset",
    ];
    let cost = [
        "no-test",
        "unsorted",
        "front-to-back",
        "depth-prepass",
        "forced-early-test",
        "discard",
        "written-depth",
    ];
    let ordered = [
        "ordered-8-bit",
        "ordered-10-bit",
        "ordered-half",
        "ordered-float",
    ];
    let volumes = ["shadow-volume-depth-pass", "shadow-volume-depth-fail"];
    let culls = ["none", "back", "front"];
    let sampling = [
        "nearest",
        "linear",
        "affine",
        "supersampling-2x2",
        "supersampling-4x4",
    ];
    let families: [(&str, &str, &[&str], Value); 18] = [
        ("depth-precision", "planes", &depth, json!({"gap": 0.1})),
        ("depth-precision", "slanted", &depth, json!({"gap": 0.1})),
        ("depth-precision", "decal", &decal, json!({"gap": 0.1})),
        ("visibility-cost", "rooms", &cost, json!({"layers": 5})),
        ("culling", "fly-through", &culls, json!({"eye": 1.4})),
        ("culling", "open-mesh", &culls, json!({"angle": 40})),
        ("culling", "mirrored", &culls, json!({"angle": 40})),
        (
            "culling",
            "mirrored",
            &["back-flipped"],
            json!({"angle": 40}),
        ),
        ("culling", "see-through", &culls, json!({"alpha": 0.5})),
        (
            "culling",
            "see-through",
            &["front-then-back"],
            json!({"alpha": 0.5}),
        ),
        ("culling", "closed-mesh", &culls, json!({"segments": 12})),
        (
            "culling",
            "field",
            &["none", "frustum"],
            json!({"objects": 81}),
        ),
        (
            "stencil-effects",
            "mirror",
            &["mirror", "mirror-unmasked"],
            json!({"shift": 1.0}),
        ),
        (
            "stencil-effects",
            "shadow-volume",
            &volumes,
            json!({"eye": 0.2}),
        ),
        (
            "accumulation",
            "columns",
            &ordered,
            json!({"layers": 3, "alpha": 0.5}),
        ),
        (
            "depth-shown",
            "slanted",
            &["grey", "linearized", "fog"],
            json!({"near": 0.1}),
        ),
        ("depth-shown", "pictures", &["dissolve"], json!({"t": 0.3})),
        ("texture-sampling", "ground", &sampling, json!({"tiles": 1})),
    ];
    let mut wires = Vec::new();
    for (question, scene, methods, parameters) in families {
        for method in methods {
            let mut wire = parameters.clone();
            wire["question"] = question.into();
            wire["scene"] = scene.into();
            wire["method"] = (*method).into();
            wires.push(wire);
        }
    }
    for method in ["outline-merged", "outline-separate"] {
        wires.push(json!({"question": "stencil-effects", "scene": "outlines", "method": method, "width": 3}));
    }
    wires
}

fn try_make(wire: &Value) -> Result<MethodScene, ParameterError> {
    let wire: MethodWire = serde_json::from_value(wire.clone()).expect("a wire of the right types");
    make(&wire)
}

fn made(wire: &Value) -> MethodScene {
    match try_make(wire) {
        Ok(made) => made,
        Err(error) => panic!("{wire}: {}", error.message),
    }
}

#[test]
fn every_method_draws_every_scene() {
    for wire in every_wire() {
        let MethodScene { scene, truth } = made(&wire);
        let picture = &scene.attachments[scene.read[0]];
        assert_eq!(picture.size, truth.size, "{wire}");
        assert!(!truth.surfaces.is_empty(), "{wire}");
        assert!(truth.surfaces.iter().all(|s| s.corners.len() >= 3));
        let draws = scene.passes.iter().flat_map(|p| &p.draws);
        for vertex in draws.clone().flat_map(|d| &d.mesh.vertices) {
            let [x, y, z, w] = vertex.position;
            assert!([x, y, z, w].iter().all(|v| v.is_finite()), "{wire}");
            // For other questions vertices are exact, and only their positions matter.
            let projects = ["depth-precision", "texture-sampling"].map(Value::from);
            assert!(w == 1.0 || projects.contains(&wire["question"]), "{wire}");
            assert!(
                vertex.color.iter().all(|c| (0.0..=1.0).contains(c)),
                "{wire}"
            );
        }
        assert!(draws.clone().all(|d| d.mesh.vertices.len() >= 3), "{wire}");
        let states: BTreeSet<String> = draws
            .map(|d| format!("{:?}{:?}", d.shader, d.depth))
            .collect();
        assert!(states.len() <= 5, "{wire} asks for many pipelines");
    }
}

#[test]
fn methods_share_the_truth_unless_they_answer_other_questions() {
    let wires = every_wire();
    for a in &wires {
        for b in wires
            .iter()
            .filter(|b| b["scene"] == a["scene"] && b["question"] == a["question"])
        {
            let shown = ["outlines", "slanted"].iter().any(|s| a["scene"] == *s);
            if a["question"] == "depth-precision" || !shown {
                assert_eq!(made(a).truth, made(b).truth, "{a} {b}");
            }
        }
    }
}

#[test]
fn parameters_out_of_range_are_refused_by_name() {
    let ends = [
        ("gap", json!(0), json!(1000)),
        ("layers", json!(0), json!(2000)),
        ("eye", json!(-2), json!(9)),
        ("angle", json!(-200), json!(200)),
        ("alpha", json!(-0.5), json!(1.5)),
        ("segments", json!(3), json!(257)),
        ("objects", json!(0), json!(2000)),
        ("width", json!(0), json!(30)),
        ("shift", json!(-1), json!(4)),
        ("near", json!(0), json!(100)),
        ("t", json!(-0.1), json!(1.1)),
        ("tiles", json!(0.1), json!(5)),
    ];
    let mut refused = BTreeSet::new();
    for wire in every_wire() {
        for (key, low, high) in &ends {
            if wire.get(*key).is_none() {
                continue;
            }
            for bad in [low, high] {
                let mut wire = wire.clone();
                wire[*key] = bad.clone();
                let error = try_make(&wire)
                    .err()
                    .unwrap_or_else(|| panic!("{wire} is drawn"));
                assert_eq!(error.key, *key, "{wire}");
                refused.insert(*key);
            }
        }
    }
    assert_eq!(refused.len(), ends.len());
}

#[test]
fn methods_that_do_not_know_a_scene_are_refused() {
    for wire in [
        json!({"question": "depth-precision", "scene": "planes", "method": "polygon-offset", "gap": 1}),
        json!({"question": "culling", "scene": "fly-through", "method": "frustum", "eye": 1}),
        json!({"question": "culling", "scene": "field", "method": "front-then-back", "objects": 9}),
        json!({"question": "culling", "scene": "see-through", "method": "back-flipped", "alpha": 1}),
    ] {
        let error = try_make(&wire)
            .err()
            .unwrap_or_else(|| panic!("{wire} is drawn"));
        assert_eq!(error.key, "method", "{wire}");
    }
}

/// Returns the depth of a triangle at a position that it covers.
fn depth_at(corners: &[[f64; 3]], [x, y]: [f64; 2]) -> Option<f64> {
    let [a, b, c] = [corners[0], corners[1], corners[2]];
    let side = |p: [f64; 3], q: [f64; 3]| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
    let [u, v, w] = [side(b, c), side(c, a), side(a, b)];
    let inside = (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
    inside.then(|| (a[2] * u + b[2] * v + c[2] * w) / (u + v + w))
}

#[test]
fn without_a_depth_test_the_nearest_is_drawn_last() {
    let scene =
        json!({"question": "visibility-cost", "scene": "rooms", "method": "no-test", "layers": 7});
    // The truth's surfaces are in the order of the draw without a test.
    let truth = made(&scene).truth;
    let mut overdraw = 0;
    for (x, y) in (0..128).flat_map(|y| (0..128).map(move |x| (x, y))) {
        let center = [f64::from(x) + 0.5, f64::from(y) + 0.5];
        let depths = truth
            .surfaces
            .iter()
            .filter_map(|s| depth_at(&s.corners, center));
        let depths: Vec<f64> = depths.collect();
        let last = depths.last().copied().unwrap_or(1.0);
        assert!(depths.iter().all(|d| last <= *d), "{center:?}: {depths:?}");
        overdraw += depths.len();
    }
    // Each wall covers most of the picture.
    assert!(overdraw > 5 * 128 * 128, "{overdraw}");
}

/// Returns the corners of a draw's polygons in the picture, with minus 1 over w: fans of two triangles.
fn projected(draw: &etalon_scene::Draw) -> Vec<[f64; 3]> {
    let fans = draw.mesh.vertices.chunks(6);
    let corners = fans.flat_map(|fan| [0, 1, 2, 5].map(|i| fan[i].position.map(f64::from)));
    let project = |[x, y, _, w]: [f64; 4]| [64.0 * (1.0 + x / w), 64.0 * (1.0 - y / w), -1.0 / w];
    corners.map(project).collect()
}

#[test]
fn the_driver_projects_to_the_surfaces_of_the_truth() {
    for wire in every_wire() {
        if wire["question"] != "depth-precision" {
            continue;
        }
        let MethodScene { scene, truth } = made(&wire);
        let drawn = scene.passes[0].draws.iter().flat_map(projected);
        let drawn: Vec<[f64; 3]> = drawn.collect();
        let meant = truth.surfaces.iter().flat_map(|s| &s.corners);
        assert_eq!(drawn.len(), meant.clone().count(), "{wire}");
        for (vertex, meant) in drawn.iter().zip(meant) {
            // The bound covers rounding x or y and w to 32 bits, but not the quotient.
            let place = (vertex[0] - meant[0])
                .abs()
                .max((vertex[1] - meant[1]).abs());
            let nearness = (vertex[2] / meant[2] - 1.0).abs();
            assert!(
                place < 2e-5 && nearness < 1e-7,
                "{wire}: {vertex:?} {meant:?}"
            );
        }
        // Clip-space z is that of the projection: nothing is in front of the near plane or beyond the far
        // plane.
        let vertices = scene.passes[0].draws.iter().flat_map(|d| &d.mesh.vertices);
        for [.., z, w] in vertices.map(|v| v.position) {
            assert!((0.0..=w).contains(&z), "{wire}: {z} {w}");
        }
    }
}

#[test]
fn culling_a_closed_mesh_leaves_half_of_its_area() {
    let wire =
        json!({"question": "culling", "scene": "closed-mesh", "method": "none", "segments": 24});
    let [mut front, mut back] = [0.0; 2];
    for surface in made(&wire).truth.surfaces {
        let [a, b, c] = [0, 1, 2].map(|i| surface.corners[i]);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area < 0.0 {
            front -= area;
        } else {
            back += area;
        }
    }
    assert!(front > 4000.0);
    assert!((front - back).abs() < 1e-6, "{front} {back}");
}

#[test]
fn whole_objects_are_left_out() {
    let draws = |method: &str| {
        let wire =
            json!({"question": "culling", "scene": "field", "method": method, "objects": 144});
        made(&wire).scene.passes[0].draws.len()
    };
    assert_eq!(draws("none"), 144);
    assert!(
        (16..=36).contains(&draws("frustum")),
        "{}",
        draws("frustum")
    );
}
