//! Shared edges, corners on centres, degenerate polygons.

use crate::common::{assert_near, pane, rectangle, scene, triangle};
use etalon_methods::{FlatSurface, Paint, StraightTexture, TexelCoverage};
use etalon_scene::AddressMode;
use etalon_truth::truth;

#[test]
fn the_top_left_rule_decides_at_centres() {
    // All four edges run through centres, which belong to the top and left edges.
    let surface = rectangle([1.5, 1.5], [3.5, 3.5], 0.0, [1.0; 4]);
    let mut reversed = surface.clone();
    reversed.corners.reverse();
    for surface in [surface, reversed] {
        let picture = truth(&scene([5, 5], TexelCoverage::Center, vec![surface]));
        let covered: Vec<usize> = (0..25).filter(|&i| picture.rgb[i][0] > 0.0).collect();
        assert_eq!(covered, [6, 7, 11, 12]);
    }
}

#[test]
fn a_fan_around_a_centre_covers_it_once() {
    for spokes in [3_u32, 8, 100, 700] {
        let rim = |i: u32| {
            let (sin, cos) = (f64::from(i) / f64::from(spokes) * std::f64::consts::TAU).sin_cos();
            [2.5 + 9.0 * cos, 2.5 + 9.0 * sin]
        };
        let surfaces = (0..spokes).map(|i| {
            triangle(
                [[2.5, 2.5], rim(i), rim((i + 1) % spokes)],
                0.0,
                [0.5, 1.0, 0.25, 0.5],
            )
        });
        let surfaces: Vec<FlatSurface> = surfaces.collect();
        let picture = truth(&scene([5, 5], TexelCoverage::Center, surfaces.clone()));
        for texel in picture.rgb {
            assert_eq!(texel, [0.25, 0.5, 0.125]);
        }
        let picture = truth(&scene([5, 5], TexelCoverage::Area, surfaces));
        assert!(picture.error <= 0.01, "{spokes}: {}", picture.error);
        for texel in picture.rgb {
            assert_near(texel, [0.25, 0.5, 0.125], 1e-9 + picture.error);
        }
    }
}

/// Strips that all cross in one texel.
#[test]
fn too_many_pieces_are_sampled_and_the_error_is_stated() {
    let strips = (0..200_u32).map(|i| {
        let angle = f64::from(i) / 200.0 * std::f64::consts::PI;
        let (sin, cos) = angle.sin_cos();
        let middle = [0.5 + 0.2 * sin, 0.5 + 0.2 * cos];
        let corner = |along: f64, across: f64| {
            let x = middle[0] + along * cos - across * sin;
            [x, middle[1] + along * sin + across * cos, 0.0]
        };
        FlatSurface {
            corners: vec![
                corner(-3.0, -0.01),
                corner(3.0, -0.01),
                corner(3.0, 0.01),
                corner(-3.0, 0.01),
            ],
            paint: Paint::Flat([1.0, 0.0, 0.0, 0.05]),
        }
    });
    let what = scene([1, 1], TexelCoverage::Area, strips.collect());
    let picture = truth(&what);
    assert!(picture.error > 0.0 && picture.error <= 1.0);
    // The same in parts of the texel, which are exact.
    let larger = crate::common::enlarged(&what, 64);
    let exact = truth(&larger);
    let mean = crate::common::reduced(larger.size, &exact.rgb, 64);
    assert!(exact.error < picture.error);
    assert_near(picture.rgb[0], mean[0], picture.error + exact.error);
}

#[test]
fn degenerate_polygons_cover_nothing() {
    let nothing: Vec<Vec<[f64; 3]>> = vec![
        vec![],
        vec![[1.0, 1.0, 0.0]],
        vec![[0.0, 0.0, 0.0], [4.0, 4.0, 0.0]],
        vec![[1.0, 1.0, 0.0]; 4],
        vec![[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [4.0, 4.0, 0.0]],
        vec![[0.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0], [4.0, 4.0, 0.0]],
        vec![[0.0, 0.0, f64::NAN], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0]],
        vec![[0.0, 0.0, 0.0], [f64::INFINITY, 0.0, 0.0], [4.0, 4.0, 0.0]],
        vec![[0.0, 0.0, 0.0], [1e300, 0.0, 0.0], [4.0, 1e300, 0.0]],
        vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 1e-300, 0.0]],
        vec![[0.0, 0.0, f64::MAX], [4.0, 0.0, f64::MIN], [4.0, 4.0, 0.0]],
    ];
    for coverage in [TexelCoverage::Center, TexelCoverage::Area] {
        for corners in &nothing {
            let surface = FlatSurface {
                corners: corners.clone(),
                paint: Paint::Flat([1.0; 4]),
            };
            let picture = truth(&scene([4, 4], coverage, vec![surface]));
            assert_eq!(picture.rgb, vec![[0.0; 3]; 16], "{corners:?}");
            assert_eq!(picture.error, 0.0);
        }
    }
}

#[test]
fn an_invalid_paint_covers_nothing() {
    let texture = |size: [u32; 2], texels: usize| StraightTexture {
        size,
        texels: vec![[1.0; 4]; texels],
        address: [AddressMode::Repeat; 2],
    };
    let painted = |texture: StraightTexture, uv: Vec<[f64; 2]>| Paint::Texture { texture, uv };
    let uv = vec![[0.0; 2]; 4];
    let (color, fog) = ([1.0; 3], [1.0; 3]);
    let paints = [
        Paint::Flat([1.0, 1.0, f64::NAN, 1.0]),
        Paint::Flat([1.0, 1.0, 1.0, f64::INFINITY]),
        Paint::Distance {
            near: 1.0,
            far: 1.0,
        },
        Paint::Distance {
            near: 0.0,
            far: 1.0,
        },
        Paint::Distance {
            near: 1.0,
            far: f64::INFINITY,
        },
        Paint::Fog {
            color,
            fog,
            near: f64::NAN,
            far: 1.0,
        },
        Paint::Fog {
            color: [f64::NAN; 3],
            fog,
            near: 1.0,
            far: 2.0,
        },
        painted(texture([2, 2], 3), uv.clone()),
        painted(texture([0, 0], 0), uv.clone()),
        painted(texture([u32::MAX; 2], 4), uv.clone()),
        painted(texture([2, 2], 4), uv[1..].to_vec()),
        painted(texture([2, 2], 4), vec![[f64::NAN; 2]; 4]),
    ];
    for paint in paints {
        let picture = truth(&scene(
            [2, 2],
            TexelCoverage::Area,
            vec![pane(|_, _| 0.5, paint.clone())],
        ));
        assert_eq!(picture.rgb, vec![[0.0; 3]; 4], "{paint:?}");
    }
}

#[test]
fn repeated_corners_and_corners_on_edges_change_nothing() {
    let plain = triangle(
        [[0.3, 0.2], [5.1, 1.0], [2.0, 4.4]],
        0.5,
        [1.0, 0.5, 0.0, 1.0],
    );
    let mut odd = plain.clone();
    odd.corners.insert(1, [0.3, 0.2, 0.5]);
    odd.corners.push([0.3, 0.2, 0.5]);
    odd.corners.insert(2, [2.7, 0.6, 0.5]);
    let [a, b] = [plain, odd].map(|s| truth(&scene([6, 6], TexelCoverage::Area, vec![s])));
    assert!(crate::common::largest_difference(&a.rgb, &b.rgb) < 1e-9);
}

#[test]
fn a_picture_without_texels_is_empty() {
    for size in [[0, 4], [4, 0], [0, 0]] {
        let what = scene(
            size,
            TexelCoverage::Area,
            vec![pane(|_, _| 0.0, Paint::Depth)],
        );
        assert!(truth(&what).rgb.is_empty());
    }
}

#[test]
fn huge_texture_coordinates_end_with_a_finite_error() {
    let texture = StraightTexture {
        size: [3, 5],
        texels: (0..15).map(|i| [f64::from(i) / 15.0; 4]).collect(),
        address: [AddressMode::MirrorRepeat, AddressMode::Repeat],
    };
    for scale in [1e3, 1e12, 1e300] {
        let uv = vec![[0.0, 0.0], [scale, 0.0], [scale, -scale], [0.0, -scale]];
        let paint = Paint::Texture {
            texture: texture.clone(),
            uv,
        };
        let picture = truth(&scene(
            [2, 2],
            TexelCoverage::Area,
            vec![pane(|_, _| 0.5, paint)],
        ));
        assert!(picture.error > 0.0 && picture.error <= 1.0);
        for texel in picture.rgb.iter().flatten() {
            assert!((0.0..=1.0).contains(texel));
        }
    }
}
