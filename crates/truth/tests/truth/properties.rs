//! Properties of any scene.

use crate::common::{assert_near, enlarged, largest_difference, reduced, scene, triangle};
use etalon_methods::{FlatSurface, Paint, StraightTexture, TexelCoverage, Truth};
use etalon_scene::AddressMode;
use etalon_truth::truth;
use proptest::array::{uniform2, uniform3, uniform4};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

/// Coordinates in and around a picture of 4 by 4 texels, often on centres and corners of texels.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        2 => (-4_i32..=12).prop_map(|i| f64::from(i) / 2.0),
        3 => -2.0..6.0,
    ]
}

fn unit() -> impl Strategy<Value = f64> {
    prop_oneof![1 => select(vec![0.0, 1.0]), 4 => 0.0..1.0]
}

fn texture() -> impl Strategy<Value = StraightTexture> {
    let address = select(vec![
        AddressMode::ClampToEdge,
        AddressMode::Repeat,
        AddressMode::MirrorRepeat,
    ]);
    (1_u32..4, 1_u32..4, uniform2(address)).prop_flat_map(|(width, height, address)| {
        vec(uniform4(unit()), (width * height) as usize).prop_map(move |texels| StraightTexture {
            size: [width, height],
            texels,
            address,
        })
    })
}

fn paint() -> impl Strategy<Value = Paint> {
    let planes = (0.01..1.0, 1.0..100.0);
    let colors = uniform2(uniform3(unit()));
    prop_oneof![
        4 => uniform4(unit()).prop_map(Paint::Flat),
        1 => Just(Paint::Depth),
        1 => planes.clone().prop_map(|(near, far)| Paint::Distance { near, far }),
        1 => (colors, planes).prop_map(|([color, fog], (near, far))| {
            Paint::Fog { color, fog, near, far }
        }),
        2 => (texture(), vec(uniform2(-1.0..2.0), 3)).prop_map(|(texture, uv)| {
            Paint::Texture { texture, uv }
        }),
    ]
}

fn surface(paint: impl Strategy<Value = Paint>) -> impl Strategy<Value = FlatSurface> {
    (vec((coordinate(), coordinate(), unit()), 3), paint).prop_map(|(corners, paint)| FlatSurface {
        corners: corners.into_iter().map(|(x, y, z)| [x, y, z]).collect(),
        paint,
    })
}

fn scenes(
    size: [u32; 2],
    coverage: TexelCoverage,
    surface: impl Strategy<Value = FlatSurface>,
) -> impl Strategy<Value = Truth> {
    (uniform3(unit()), vec(surface, 0..6)).prop_map(move |(background, surfaces)| Truth {
        background,
        ..scene(size, coverage, surfaces)
    })
}

/// Returns the colour at a point of triangles in flat colours, by barycentric coordinates; `None` if an
/// edge or another surface is too near to tell.
fn seen(what: &Truth, p: [f64; 2]) -> Option<[f64; 3]> {
    let mut layers: Vec<(f64, [f64; 4])> = Vec::new();
    for surface in &what.surfaces {
        let [a, b, c] = [0, 1, 2].map(|i| surface.corners[i]);
        let cross = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let flat = |p: [f64; 3]| [p[0], p[1]];
        let area = cross(flat(a), flat(b), flat(c));
        if area == 0.0 {
            continue;
        }
        let weights = [
            cross(p, flat(b), flat(c)) / area,
            cross(flat(a), p, flat(c)) / area,
            cross(flat(a), flat(b), p) / area,
        ];
        if area.abs() < 1e-6 || weights.iter().any(|w| w.abs() < 1e-9) {
            return None;
        }
        if weights.iter().all(|w| *w > 0.0) {
            let depth = weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2];
            let Paint::Flat(color) = surface.paint else {
                return None;
            };
            layers.push((depth, color));
        }
    }
    layers.sort_by(|a, b| a.0.total_cmp(&b.0));
    if layers.windows(2).any(|pair| pair[1].0 - pair[0].0 < 1e-9) {
        return None;
    }
    // Front to back, with the remaining light.
    let (mut color, mut left) = ([0.0; 3], 1.0);
    let background = (
        0.0,
        [
            what.background[0],
            what.background[1],
            what.background[2],
            1.0,
        ],
    );
    for (_, [r, g, b, alpha]) in layers.into_iter().chain([background]) {
        for (color, channel) in color.iter_mut().zip([r, g, b]) {
            *color += left * alpha * channel;
        }
        left *= 1.0 - alpha;
    }
    Some(color)
}

/// Inserts points into a square of two triangles. Each point splits one triangle into three.
fn triangulated(points: &[(usize, f64, f64)]) -> Vec<[[f64; 2]; 3]> {
    let corners = [[-1.0, -1.0], [5.0, -1.0], [5.0, 5.0], [-1.0, 5.0]];
    let mut triangles = vec![
        [corners[0], corners[1], corners[2]],
        [corners[0], corners[2], corners[3]],
    ];
    for &(which, s, t) in points {
        let which = which % triangles.len();
        let [a, b, c] = triangles.swap_remove(which);
        let (s, t) = if s + t > 1.0 {
            (1.0 - s, 1.0 - t)
        } else {
            (s, t)
        };
        let mut p = [0, 1].map(|i| a[i] + s * (b[i] - a[i]) + t * (c[i] - a[i]));
        // On a texel centre, if one is inside.
        let snapped = p.map(|v| v.floor() + 0.5);
        let cross = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        if [
            cross(a, b, snapped),
            cross(b, c, snapped),
            cross(c, a, snapped),
        ]
        .iter()
        .all(|v| *v > 1e-3)
        {
            p = snapped;
        }
        triangles.extend([[a, b, p], [p, b, c], [a, p, c]]);
    }
    triangles
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn a_centre_shows_what_barycentric_coordinates_say(
        what in scenes([4, 4], TexelCoverage::Center, surface(uniform4(unit()).prop_map(Paint::Flat))),
    ) {
        let picture = truth(&what);
        prop_assert_eq!(picture.error, 0.0);
        for (i, texel) in picture.rgb.iter().enumerate() {
            if let Some(expected) = seen(&what, [(i % 4) as f64 + 0.5, (i / 4) as f64 + 0.5]) {
                assert_near(*texel, expected, 1e-9);
            }
        }
    }

    #[test]
    fn triangles_that_share_edges_cover_every_centre_once(
        points in vec((0_usize..1000, 0.05..0.95, 0.05..0.95), 0..24),
    ) {
        let surfaces = triangulated(&points).into_iter();
        let surfaces = surfaces.map(|corners| triangle(corners, 0.5, [1.0, 0.5, 0.0, 0.5]));
        let mut what = scene([4, 4], TexelCoverage::Center, surfaces.collect());
        for texel in truth(&what).rgb {
            prop_assert_eq!(texel, [0.5, 0.25, 0.0]);
        }
        what.coverage = TexelCoverage::Area;
        let picture = truth(&what);
        for texel in picture.rgb {
            assert_near(texel, [0.5, 0.25, 0.0], 1e-8 + picture.error);
        }
    }

    #[test]
    fn areas_agree_with_dense_sampling(
        what in scenes([4, 4], TexelCoverage::Area, surface(paint())),
    ) {
        let exact = truth(&what);
        let mut dense = enlarged(&what, 64);
        dense.coverage = TexelCoverage::Center;
        let sampled = reduced(dense.size, &truth(&dense).rgb, 64);
        // An edge or a crossing of two surfaces misplaces at most 2 of 64 samples in a row or column;
        // most of it cancels.
        let difference = largest_difference(&exact.rgb, &sampled);
        prop_assert!(difference <= 0.03 + exact.error, "{} apart", difference);
    }

    #[test]
    fn a_picture_is_the_mean_of_a_larger_one(
        what in scenes([4, 4], TexelCoverage::Area, surface(paint())),
    ) {
        let small = truth(&what);
        let large = enlarged(&what, 3);
        let picture = truth(&large);
        let mean = reduced(large.size, &picture.rgb, 3);
        let difference = largest_difference(&small.rgb, &mean);
        let stated = small.error + picture.error;
        prop_assert!(difference <= 1e-8 + stated, "{} apart, {} stated", difference, stated);
    }

    #[test]
    fn many_textured_pictures_are_within_the_stated_error(
        surfaces in vec(
            (texture(), vec(uniform2(-1.0..2.0), 4), 0.0..1.0_f64),
            4..9,
        ),
    ) {
        let surfaces = surfaces.into_iter().map(|(texture, mut uv, depth)| {
            // Linear over the rectangle.
            uv[3] = [0, 1].map(|c| uv[0][c] + uv[2][c] - uv[1][c]);
            let mut surface = crate::common::rectangle([-0.3, -0.4], [1.2, 1.3], depth, [0.0; 4]);
            surface.paint = Paint::Texture { texture, uv };
            surface
        });
        let what = scene([1, 1], TexelCoverage::Area, surfaces.collect());
        let picture = truth(&what);
        let mut dense = enlarged(&what, 96);
        dense.coverage = TexelCoverage::Center;
        let sampled = reduced(dense.size, &truth(&dense).rgb, 96);
        let difference = largest_difference(&picture.rgb, &sampled);
        // The midpoint rule on 96 by 96 squares integrates functions with such slopes to this precision.
        prop_assert!(
            difference <= 1e-3 + picture.error,
            "{} apart, {} stated", difference, picture.error
        );
    }

    #[test]
    fn arbitrary_corners_and_paints_cause_no_panic(
        corners in vec(uniform3(prop_oneof![
            -1e3..1e3_f64,
            select(vec![0.0, -0.0, 1e-308, 1e308, -1e308, f64::NAN, f64::INFINITY, 0.5, 1.0]),
        ]), 0..7),
        paint in paint(),
    ) {
        for coverage in [TexelCoverage::Center, TexelCoverage::Area] {
            let surface = FlatSurface { corners: corners.clone(), paint: paint.clone() };
            let picture = truth(&scene([3, 3], coverage, vec![surface.clone(), surface]));
            prop_assert!(picture.error >= 0.0);
        }
    }
}

/// Threads take parts of a picture: no texel may depend on how it is divided.
#[test]
fn a_part_of_a_picture_equals_the_picture_of_that_part() {
    let ramp = |shift: f64| FlatSurface {
        corners: vec![
            [-9.0 - shift, 3.0, 0.2],
            [131.0 - shift, 17.0, 0.9],
            [40.0 - shift, 140.0, 0.4],
        ],
        paint: Paint::Depth,
    };
    let pane = |shift: f64| FlatSurface {
        corners: vec![
            [10.0 - shift, -5.0, 0.3],
            [90.0 - shift, 60.0, 0.5],
            [20.0 - shift, 120.0, 0.8],
        ],
        paint: Paint::Flat([0.9, 0.2, 0.1, 0.4]),
    };
    let rendered = |width: u32, shift: f64| {
        truth(&Truth {
            size: [width, 128],
            background: [0.1, 0.2, 0.3],
            coverage: TexelCoverage::Area,
            surfaces: vec![ramp(shift), pane(shift)],
        })
    };
    let full = rendered(128, 0.0);
    // Small enough for one part, and at another place in it.
    let strip = rendered(8, 60.0);
    for (y, x) in (0..128).flat_map(|y| (0..8).map(move |x| (y, x))) {
        let (expected, found) = (full.rgb[y * 128 + 60 + x], strip.rgb[y * 8 + x]);
        for c in 0..3 {
            assert!(
                (expected[c] - found[c]).abs() < 1e-12,
                "{x},{y}: {expected:?} {found:?}"
            );
        }
    }
}
