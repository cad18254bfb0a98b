//! Pictures with a closed form.

use crate::common::{assert_near, pane, rectangle, scene, triangle};
use etalon_methods::{FlatSurface, Paint, StraightTexture, TexelCoverage};
use etalon_scene::AddressMode;
use etalon_truth::truth;

const COVERAGES: [TexelCoverage; 2] = [TexelCoverage::Center, TexelCoverage::Area];
const RED: [f64; 4] = [1.0, 0.0, 0.0, 0.5];
const BLUE: [f64; 4] = [0.0, 0.0, 1.0, 0.25];
const GREEN: [f64; 4] = [0.0, 0.5, 0.0, 0.75];

fn flat(depth: f64, color: [f64; 4]) -> FlatSurface {
    pane(|_, _| depth, Paint::Flat(color))
}

#[test]
fn two_panes_come_in_the_order_of_their_depths() {
    for coverage in COVERAGES {
        for surfaces in [
            vec![flat(0.2, BLUE), flat(0.6, RED)],
            vec![flat(0.6, RED), flat(0.2, BLUE)],
        ] {
            let mut geometry = scene([16, 16], coverage, surfaces);
            geometry.background = [0.0, 1.0, 0.0];
            let picture = truth(&geometry);
            assert_eq!((picture.size, picture.rgb.len()), ([16, 16], 256));
            assert_eq!(picture.error, 0.0);
            for texel in picture.rgb {
                // Red over green: 0.5, 0.5, 0. Blue over that.
                assert_near(texel, [0.375, 0.375, 0.25], 1e-12);
            }
        }
    }
}

#[test]
fn three_panes_blend_only_in_the_part_that_they_cover() {
    for coverage in COVERAGES {
        let part = |depth, color| rectangle([1.0, 1.0], [3.0, 2.0], depth, color);
        let surfaces = vec![part(0.5, GREEN), part(-0.25, RED), part(0.75, BLUE)];
        let mut geometry = scene([4, 3], coverage, surfaces);
        geometry.background = [1.0; 3];
        let picture = truth(&geometry);
        // Blue over white: 0.75, 0.75, 1. Green over that: 0.1875, 0.5625, 0.25. Red over that.
        let inside = [0.59375, 0.28125, 0.125];
        for (i, texel) in picture.rgb.into_iter().enumerate() {
            let expected = if matches!(i, 5 | 6) { inside } else { [1.0; 3] };
            assert_near(texel, expected, 1e-12);
        }
    }
}

#[test]
fn of_two_surfaces_at_the_same_depth_the_later_is_in_front() {
    let slanted = |x: f64, y: f64| 0.1 * x + 0.03 * y;
    for coverage in COVERAGES {
        for tie in [
            [
                flat(0.3, [1.0, 0.0, 0.0, 1.0]),
                flat(0.3, [0.0, 1.0, 0.0, 1.0]),
            ],
            [
                pane(slanted, Paint::Flat([1.0, 0.0, 0.0, 1.0])),
                // Other corners on the same plane, which rounding moves apart.
                FlatSurface {
                    corners: [[-7.0, -9.0], [39.0, -9.0], [-7.0, 50.3]]
                        .map(|[x, y]| [x, y, slanted(x, y)])
                        .to_vec(),
                    paint: Paint::Flat([0.0, 1.0, 0.0, 1.0]),
                },
            ],
        ] {
            let picture = truth(&scene([8, 8], coverage, tie.to_vec()));
            for texel in picture.rgb {
                assert_near(texel, [0.0, 1.0, 0.0], 1e-12);
            }
        }
    }
}

#[test]
fn panes_a_hair_apart_keep_their_order() {
    // Window depths of planes at distances 9999 and 9999.1 between planes at 0.1 and 10000.
    let depth = |distance: f64| (10_000.0 - 0.1 * 10_000.0 / distance) / (10_000.0 - 0.1);
    let near = flat(depth(9999.0), [1.0, 0.0, 0.0, 1.0]);
    let far = flat(depth(9999.1), [0.0, 1.0, 0.0, 1.0]);
    for coverage in COVERAGES {
        let picture = truth(&scene([4, 4], coverage, vec![near.clone(), far.clone()]));
        assert_near(picture.rgb[5], [1.0, 0.0, 0.0], 0.0);
    }
}

#[test]
fn the_coverage_of_equal_layers_is_a_power() {
    for (alpha, layers) in [(0.01, 500), (0.25, 16), (0.5, 64)] {
        let surfaces = (0..layers).map(|i| flat(f64::from(i), [1.0, 1.0, 1.0, alpha]));
        let geometry = scene([4, 4], TexelCoverage::Area, surfaces.collect());
        let expected = 1.0 - (1.0 - alpha).powi(layers);
        assert_near(truth(&geometry).rgb[9], [expected; 3], 1e-12);
    }
}

#[test]
fn panes_that_pass_through_each_other_swap_along_the_line() {
    // The part of the texel's area in which the second pane's depth is below 0.5.
    type Depth = fn(f64, f64) -> f64;
    let cases: [(Depth, f64); 4] = [
        (|x, _| x + 0.2, 0.3),
        (|x, y| 0.5 * x + 0.5 * y, 0.5),
        (|x, y| x + y + 0.25, 0.03125),
        (|x, y| 2.0 * x + y - 0.5, 0.25),
    ];
    for (depth, share) in cases {
        let surfaces = vec![flat(0.5, RED), pane(depth, Paint::Flat(BLUE))];
        let picture = truth(&scene([1, 1], TexelCoverage::Area, surfaces));
        let [front, behind] = [[0.375, 0.0, 0.25], [0.5, 0.0, 0.125]];
        let expected = [0, 1, 2].map(|c| share * front[c] + (1.0 - share) * behind[c]);
        assert_near(picture.rgb[0], expected, 1e-9);
        assert_eq!(picture.error, 0.0);
    }
}

#[test]
fn three_panes_through_one_point_have_six_orders() {
    // At 60 degrees to each other through the middle, each the nearest in a third of all directions.
    let turned = |degrees: f64, color: [f64; 4]| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        pane(
            move |x, y| (x - 0.5) * cos + (y - 0.5) * sin,
            Paint::Flat(color),
        )
    };
    let opaque = |c: usize| {
        let mut color = [0.0, 0.0, 0.0, 1.0];
        color[c] = 1.0;
        color
    };
    let surfaces = vec![
        turned(0.0, opaque(0)),
        turned(120.0, opaque(1)),
        turned(240.0, opaque(2)),
    ];
    let picture = truth(&scene([1, 1], TexelCoverage::Area, surfaces));
    // Red is nearest within 60 degrees of the direction to the left: the left half of the square
    // without two triangles at the middle line, whose legs are 0.5 and 0.5 tan 30 degrees.
    let red = 0.5 - 0.25 * 30_f64.to_radians().tan();
    assert_near(
        picture.rgb[0],
        [red, (1.0 - red) / 2.0, (1.0 - red) / 2.0],
        1e-9,
    );
    assert_eq!(picture.error, 0.0);
}

/// The area of the unit square on which `a x + b y <= d`, for positive `a` and `b`.
fn half_plane(a: f64, b: f64, d: f64) -> f64 {
    let ramp = |v: f64| v.max(0.0).powi(2);
    (ramp(d) - ramp(d - a) - ramp(d - b) + ramp(d - a - b)) / (2.0 * a * b)
}

#[test]
fn half_planes_cover_the_share_of_the_formula() {
    for degrees in (0..360).step_by(7).chain([1, 89, 91, 181, 269]) {
        for offset in [-0.6, -0.31, 0.0, 0.1, 0.45] {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            // All points of a 3 by 3 picture with (p - middle) . normal <= offset.
            let corner = |along: f64, across: f64| {
                [
                    1.5 + across * cos - along * sin,
                    1.5 + across * sin + along * cos,
                    0.5,
                ]
            };
            let corners = vec![
                corner(-9.0, offset),
                corner(9.0, offset),
                corner(9.0, -9.0),
                corner(-9.0, -9.0),
            ];
            let paint = Paint::Flat([1.0; 4]);
            let surfaces = vec![FlatSurface { corners, paint }];
            let picture = truth(&scene([3, 3], TexelCoverage::Area, surfaces));
            assert_eq!(picture.error, 0.0);
            for (i, texel) in picture.rgb.iter().enumerate() {
                let (x, y) = ((i % 3) as f64 - 1.5, (i / 3) as f64 - 1.5);
                // Mirrored so that both components of the normal are positive.
                let corner = |low: f64, n: f64| if n < 0.0 { low + 1.0 } else { low };
                let d = offset - corner(x, cos) * cos - corner(y, sin) * sin;
                let expected = match (cos.abs(), sin.abs()) {
                    (a, b) if a < 1e-9 => (d / b).clamp(0.0, 1.0),
                    (a, b) if b < 1e-9 => (d / a).clamp(0.0, 1.0),
                    (a, b) => half_plane(a, b, d),
                };
                assert_near(*texel, [expected; 3], 1e-9);
            }
        }
    }
}

#[test]
fn a_thin_wedge_covers_its_area() {
    for thickness in [1e-6, 0.003, 0.2, 0.9] {
        let corners = [
            [0.0, 1.5],
            [16.0, 1.5 - thickness / 2.0],
            [16.0, 1.5 + thickness / 2.0],
        ];
        let surfaces = vec![triangle(corners, 0.0, [1.0; 4])];
        let picture = truth(&scene([16, 3], TexelCoverage::Area, surfaces));
        for (i, texel) in picture.rgb.iter().enumerate() {
            let expected = match i / 16 {
                1 => thickness * ((i % 16) as f64 + 0.5) / 16.0,
                _ => 0.0,
            };
            assert_near(*texel, [expected; 3], 1e-9);
        }
    }
}

#[test]
fn depth_shown_as_grey_is_its_mean_over_what_is_covered() {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| [x, y, x]);
    let surfaces = vec![FlatSurface {
        corners: corners.to_vec(),
        paint: Paint::Depth,
    }];
    let picture = truth(&scene([1, 1], TexelCoverage::Area, surfaces));
    assert_near(picture.rgb[0], [1.0 / 6.0; 3], 1e-9);

    let behind = pane(|x, y| 0.01 * x + 0.02 * y, Paint::Depth);
    let surfaces = vec![flat(-1.0, RED), behind];
    for coverage in COVERAGES {
        let picture = truth(&scene([2, 2], coverage, surfaces.clone()));
        // The depth at the centre of texel (1, 0) is 0.025.
        assert_near(picture.rgb[1], [0.5125, 0.0125, 0.0125], 1e-12);
    }
}

#[test]
fn distances_and_fog_are_integrated_to_the_logarithm() {
    for (near, far) in [(1.0, 2.0), (0.1, 100.0), (0.01, 10_000.0)] {
        // Depth runs from 0 to 1 across one texel.
        let mean = (near * far * f64::ln(far / near) / (far - near) - near) / (far - near);
        let shown = pane(|x, _| x, Paint::Distance { near, far });
        let picture = truth(&scene([1, 1], TexelCoverage::Area, vec![shown]));
        assert_near(picture.rgb[0], [mean; 3], 1e-9);
        assert_eq!(picture.error, 0.0);

        let (color, fog) = ([0.25, 0.5, 1.0], [1.0, 0.5, 0.0]);
        let paint = Paint::Fog {
            color,
            fog,
            near,
            far,
        };
        let picture = truth(&scene(
            [1, 1],
            TexelCoverage::Area,
            vec![pane(|x, _| x, paint)],
        ));
        let expected = [0, 1, 2].map(|c| color[c] + (fog[c] - color[c]) * mean);
        assert_near(picture.rgb[0], expected, 1e-9);
    }
}

#[test]
fn a_distance_beyond_the_planes_is_clamped_to_them() {
    let (near, far) = (1.0, 3.0);
    // From -1 to 3 across four texels: 0 in the first one, 1 in the last two.
    let shown = pane(|x, _| x - 1.0, Paint::Distance { near, far });
    let picture = truth(&scene([4, 1], TexelCoverage::Area, vec![shown]));
    let mean = (1.5 * 3_f64.ln() - 1.0) / 2.0;
    for (texel, expected) in picture.rgb.iter().zip([0.0, mean, 1.0, 1.0]) {
        assert_near(*texel, [expected; 3], 1e-9);
    }
}

fn textured(
    size: [u32; 2],
    texels: Vec<[f64; 4]>,
    address: AddressMode,
    repeats: f64,
) -> FlatSurface {
    let texture = StraightTexture {
        size,
        texels,
        address: [address; 2],
    };
    let uv = vec![
        [0.0, 0.0],
        [repeats, 0.0],
        [repeats, repeats],
        [0.0, repeats],
    ];
    let mut surface = rectangle([0.0; 2], [1.0; 2], 0.5, [0.0; 4]);
    surface.paint = Paint::Texture { texture, uv };
    surface
}

#[test]
fn a_texture_is_filtered_linearly_before_its_mean_is_taken() {
    let texels = vec![[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.5]];
    // Two texels across, seen in one texel: the left and the right quarter are constant, between
    // them t runs from 0 to 1, and colour times alpha is (1 - t) (1 - t / 2) and t (1 - t / 2).
    let surface = textured([2, 1], texels.clone(), AddressMode::ClampToEdge, 1.0);
    let expected = [0.25 + 0.5 * 5.0 / 12.0, 0.125 + 0.5 / 3.0, 0.0];
    let picture = truth(&scene([1, 1], TexelCoverage::Area, vec![surface]));
    assert_near(picture.rgb[0], expected, 1e-9);
    assert_eq!(picture.error, 0.0);
    // Mirrored, the second copy is the first one reversed. Repeated, no part is constant: t also runs from the last
    // texel to the first.
    for address in [AddressMode::Repeat, AddressMode::MirrorRepeat] {
        let surface = textured([2, 1], texels.clone(), address, 2.0);
        let picture = truth(&scene([1, 1], TexelCoverage::Area, vec![surface]));
        let expected = match address {
            AddressMode::Repeat => [5.0 / 12.0, 1.0 / 3.0, 0.0],
            _ => expected,
        };
        assert_near(picture.rgb[0], expected, 1e-9);
    }
    // At the centre: halfway between the two.
    let surface = textured([2, 1], texels, AddressMode::ClampToEdge, 1.0);
    let picture = truth(&scene([1, 1], TexelCoverage::Center, vec![surface]));
    assert_near(picture.rgb[0], [0.375, 0.375, 0.0], 1e-12);
}
