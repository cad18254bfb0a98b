//! Samples on edges and at vertices: covered exactly once, or open; and an open sample never fails.

use crate::common::{APIS, config, draw, limits, scene};
use etalon_frame::{Api, TexelSet, compare};
use etalon_reference::{Rules, judgements, legal_set};
use etalon_scene::Scene;
use proptest::prelude::*;

/// Side of the attachment in texels.
const SIZE: u32 = 8;

/// A scene of 8 by 8 texels that counts in the stencil how often each sample is covered. Positions are in
/// texels from the top left corner.
fn counting(triangles: &[[[f64; 2]; 3]]) -> Scene {
    let ndc = |v: f64| v / f64::from(SIZE) * 2.0 - 1.0;
    let positions: Vec<String> = triangles
        .iter()
        .flatten()
        .map(|[x, y]| format!("[{:?},{:?},0]", ndc(*x) as f32, -ndc(*y) as f32))
        .collect();
    scene(&format!(
        r#"{{"attachments":{{"count":{{"format":"stencil8","size":[{SIZE},{SIZE}],"clear":0}}}},
           "passes":[{{"depth_stencil":"count","draws":[{{"mesh":{{"kind":"vertices","positions":[{}]}},
           "shader":"uniform_color","stencil":{{"front":{{"compare":"always","pass_op":"increment-wrap"}}}}}}]}}],
           "read":["count"]}}"#,
        positions.join(",")
    ))
}

/// Two triangles for each cell of a grid of vertices; `flip` chooses diagonal and windings.
fn triangulate(
    vertices: &[Vec<[f64; 2]>],
    flip: impl Fn(usize, usize) -> u8,
) -> Vec<[[f64; 2]; 3]> {
    let mut triangles = Vec::new();
    for j in 0..vertices.len() - 1 {
        for i in 0..vertices[j].len() - 1 {
            let (a, b) = (vertices[j][i], vertices[j][i + 1]);
            let (d, c) = (vertices[j + 1][i], vertices[j + 1][i + 1]);
            let bits = flip(i, j);
            let mut pair = if bits & 1 == 0 {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            };
            for (t, triangle) in pair.iter_mut().enumerate() {
                if bits & (2 << t) != 0 {
                    triangle.swap(0, 1);
                }
            }
            triangles.extend(pair);
        }
    }
    triangles
}

fn grid(step: f64, from: f64, n: usize) -> Vec<Vec<[f64; 2]>> {
    let coordinate = |i: usize| from + step * i as f64;
    (0..n)
        .map(|j| (0..n).map(|i| [coordinate(i), coordinate(j)]).collect())
        .collect()
}

fn counts(set: &TexelSet) -> Vec<i64> {
    (0..256).filter(|n| set.allows(&[*n])).collect()
}

#[test]
fn samples_on_edges_count_exactly_once_where_the_rules_say_so() {
    // Vertices at every second texel centre: even texels are on vertices, the others on edges.
    let vertices = grid(2.0, 0.5, 4);
    for bits in 0..8 {
        let scene = counting(&triangulate(&vertices, |_, _| bits));
        let frame = draw(&scene);
        for api in APIS {
            let judgement = judgements(&scene, &limits(api)).remove(0);
            let found = compare(&frame, &judgement.legal, &judgement.yardstick, 4).expect("images");
            assert_eq!(
                (found.texels.wrong, found.texels.imprecise),
                (0, 0),
                "{api} {found:?}"
            );
            for y in 0..SIZE {
                for x in 0..SIZE {
                    let legal = judgement.legal.groups[0].sample(x, y, 0);
                    let tight = judgement.yardstick.groups[0].sample(x, y, 0);
                    let inside = x < 6 && y < 6;
                    let reached = x <= 6 && y <= 6;
                    let on_vertex = x % 2 == 0 && y % 2 == 0;
                    if api != Api::WebGpu {
                        // Left and top borders are covered, right and bottom ones are not.
                        let expected = vec![i64::from(inside)];
                        assert_eq!(counts(tight), expected, "{api} ({x}, {y})");
                    }
                    let legal = counts(legal);
                    if !reached {
                        assert_eq!(legal, [0], "{api} ({x}, {y})");
                    } else if api == Api::WebGpu || on_vertex {
                        assert!(legal.contains(&0) && legal.contains(&1), "{api} ({x}, {y})");
                    } else if inside && x > 0 && y > 0 {
                        assert_eq!(legal, [1], "{api} ({x}, {y})");
                    } else {
                        assert_eq!(legal, [0, 1], "{api} ({x}, {y}), on the border");
                    }
                }
            }
        }
    }
}

#[test]
fn only_a_sample_at_the_hub_of_many_triangles_is_open() {
    let hub = [3.5, 3.5];
    let rim: Vec<[f64; 2]> = (0..24)
        .map(|i| {
            let angle = std::f64::consts::TAU * (f64::from(i) + 0.3) / 24.0;
            [3.5 + 9.0 * angle.cos(), 3.5 + 9.0 * angle.sin()]
        })
        .collect();
    let fan: Vec<[[f64; 2]; 3]> = (0..24).map(|i| [hub, rim[i], rim[(i + 1) % 24]]).collect();
    let scene = counting(&fan);
    let drawn = draw(&scene);
    for api in APIS {
        let limits = limits(api);
        let legal = legal_set(&scene, &limits, &Rules::of(&limits));
        for y in 0..SIZE {
            for x in 0..SIZE {
                let set = legal.groups[0].sample(x, y, 0);
                assert_eq!(set.is_open(), (x, y) == (3, 3), "{api} ({x}, {y})");
            }
        }
        // Any value at the hub is legal; elsewhere it is a failure.
        for value in [0, 1, 2, 24, 77, 255] {
            let mut frame = drawn.clone();
            frame.images[0].codes[(3 * SIZE + 3) as usize] = value;
            let found = compare(&frame, &legal, &legal, 1).expect("images");
            assert_eq!(
                (found.texels.wrong, found.texels.open),
                (0, 1),
                "{api} {value}"
            );
            frame.images[0].codes[0] = 77;
            let found = compare(&frame, &legal, &legal, 1).expect("images");
            assert_eq!(found.texels.wrong, 1, "{api} {value}");
        }
    }
}

#[test]
fn a_later_draw_does_not_close_an_open_sample() {
    let mut scene = counting(&triangulate(&grid(1.0, 0.5, 8), |_, _| 0));
    let open = |scene: &Scene| {
        let set = legal_set(
            scene,
            &limits(Api::WebGpu),
            &Rules::of(&limits(Api::WebGpu)),
        );
        let open = (0..SIZE * SIZE).map(|i| set.groups[0].sample(i % SIZE, i / SIZE, 0).is_open());
        open.collect::<Vec<bool>>()
    };
    let before = open(&scene);
    assert!(
        before.contains(&true),
        "six independent triangles meet at a vertex"
    );
    let again = scene.passes[0].draws[0].clone();
    scene.passes[0].draws.push(again);
    let after = open(&scene);
    assert!(before.iter().zip(&after).all(|(b, a)| !b || *a));
}

proptest! {
    #![proptest_config(config(300))]

    /// A plane divided into random triangles: every sample is covered once, whatever the snapping.
    #[test]
    fn a_random_tiling_covers_every_sample_once(
        jitter in proptest::collection::vec((-0.3_f64..0.3, -0.3_f64..0.3, 0_u8..8), 36),
        step in prop_oneof![Just(2.0_f64), Just(2.5)],
    ) {
        let mut vertices = grid(step, -1.0, 6);
        for (i, (dx, dy, _)) in jitter.iter().enumerate() {
            let v = &mut vertices[i / 6][i % 6];
            // Every few vertices are on the quarter-texel grid, so that edges and vertices hit samples.
            let snap = |v: f64| if i % 3 == 0 { (v * 2.0).round() / 2.0 } else { v };
            *v = [snap(v[0] + dx * step), snap(v[1] + dy * step)];
        }
        let triangles = triangulate(&vertices, |i, j| jitter[j * 6 + i].2);
        // Folded tilings are skipped.
        let area = |[a, b, c]: &[[f64; 2]; 3]| {
            ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
        };
        let cell = |k: usize| area(&triangles[2 * k]) + area(&triangles[2 * k + 1]);
        let quad = |k: usize| {
            let (i, j) = (k % 5, k / 5);
            let (a, b) = (vertices[j][i], vertices[j][i + 1]);
            let (d, c) = (vertices[j + 1][i], vertices[j + 1][i + 1]);
            (c[0] - a[0]) * (d[1] - b[1]) - (c[1] - a[1]) * (d[0] - b[0])
        };
        prop_assume!((0..25).all(|k| (quad(k) - cell(k)).abs() < 1e-9));
        prop_assume!(triangles.iter().all(|t| area(t) > 0.2));
        let scene = counting(&triangles);
        let frame = draw(&scene);
        // The tiling's border is ragged; texels well inside are covered.
        let inside = |x: u32, y: u32| x < 6 && y < 6;
        for api in APIS {
            let judgement = judgements(&scene, &limits(api)).remove(0);
            let found = compare(&frame, &judgement.legal, &judgement.yardstick, 4).expect("images");
            prop_assert_eq!((found.texels.wrong, found.texels.imprecise), (0, 0), "{} {:?}", api, found.wrong);
            for y in 0..SIZE {
                for x in 0..SIZE {
                    if !inside(x, y) {
                        continue;
                    }
                    let legal = judgement.legal.groups[0].sample(x, y, 0);
                    prop_assert!(legal.allows(&[1]), "{} ({}, {}): {:?}", api, x, y, legal);
                    let center = [f64::from(x) + 0.5, f64::from(y) + 0.5];
                    let at_vertex = vertices.iter().flatten().any(|v| {
                        (v[0] - center[0]).abs() < 0.05 && (v[1] - center[1]).abs() < 0.05
                    });
                    if api != Api::WebGpu && !at_vertex {
                        prop_assert_eq!(counts(legal), vec![1], "{} ({}, {})", api, x, y);
                    }
                    prop_assert_eq!(frame.images[0].sample(x, y, 0), &[1], "({}, {})", x, y);
                }
            }
        }
    }
}
