//! Distances of pictures from the truth.

use crate::common::{pane, scene};
use etalon_frame::{Aspect, ChannelEncoding, Image, ReadPath, TextureFormat};
use etalon_methods::{Paint, TexelCoverage};
use etalon_truth::{Lattice, TruthPicture, distance, lattice_distance, truth, truth_on};

const SIZE: [u32; 2] = [16, 8];

fn image(format: TextureFormat, texel: impl Fn(u32, u32) -> Vec<f64>) -> Image {
    let channels = format.color_channels();
    let mut codes = Vec::new();
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let values = texel(x, y);
            codes.extend(channels.iter().zip(values).map(|(c, v)| c.nearest_code(v)));
        }
    }
    Image {
        attachment: "color".into(),
        aspect: Aspect::Color,
        size: SIZE,
        samples: 1,
        channels: channels.to_vec(),
        read: ReadPath::Copy,
        codes,
    }
}

fn plain(color: [f64; 3]) -> TruthPicture {
    let paint = Paint::Flat([color[0], color[1], color[2], 1.0]);
    truth(&scene(
        SIZE,
        TexelCoverage::Area,
        vec![pane(|_, _| 0.5, paint)],
    ))
}

#[test]
fn a_picture_has_no_distance_from_itself() {
    let ramp = pane(|x, y| (x + 2.0 * y) / 40.0, Paint::Depth);
    let expected = truth(&scene(SIZE, TexelCoverage::Area, vec![ramp]));
    let value_at = |x: u32, y: u32| {
        let [r, g, b] = expected.rgb[(y * SIZE[0] + x) as usize];
        vec![r, g, b, 0.3]
    };
    let measured = distance(&expected, &image(TextureFormat::Rgba32Float, value_at)).unwrap();
    assert!(measured.rmse < 1e-7 && measured.max < 1e-7, "{measured:?}");
    assert_eq!(
        (measured.flip, measured.wrong, measured.truth_error),
        (0.0, 0.0, 0.0)
    );
    // 8 bits: at most half a code, uniformly distributed.
    let measured = distance(&expected, &image(TextureFormat::Rgba8Unorm, value_at)).unwrap();
    assert!(
        measured.max <= 0.5 / 255.0 + 1e-12 && measured.rmse > 0.0,
        "{measured:?}"
    );
    assert_eq!((measured.flip, measured.wrong), (0.0, 0.0));
}

#[test]
fn black_is_as_far_from_white_as_can_be() {
    let measured = distance(
        &plain([1.0; 3]),
        &image(TextureFormat::Rgba8Unorm, |_, _| vec![0.0; 4]),
    );
    let measured = measured.unwrap();
    assert_eq!(
        (measured.rmse, measured.max, measured.wrong),
        (1.0, 1.0, 1.0)
    );
    assert!(measured.flip > 0.9 && measured.flip <= 1.0, "{measured:?}");
}

#[test]
fn differences_are_counted_texel_by_texel() {
    // One of 128 texels is wrong by 0.4 in one channel, one is off by 2 codes, which is not wrong.
    let picture = image(TextureFormat::Rgba8Unorm, |x, y| match (x, y) {
        (3, 2) => vec![0.6, 0.2, 0.2, 1.0],
        (4, 2) => vec![0.2, 0.2 + 2.0 / 255.0, 0.2, 1.0],
        _ => vec![0.2, 0.2, 0.2, 0.0],
    });
    let measured = distance(&plain([0.2; 3]), &picture).unwrap();
    let squares: f64 = 0.4 * 0.4 + (2.0 / 255.0_f64).powi(2);
    assert!(
        (measured.rmse - (squares / 384.0).sqrt()).abs() < 1e-12,
        "{measured:?}"
    );
    assert!((measured.max - 0.4).abs() < 1e-12);
    assert_eq!(measured.wrong, 1.0 / 128.0);
    assert!(measured.flip > 0.0 && measured.flip < 0.1, "{measured:?}");
}

#[test]
fn codes_are_compared_as_linear_values_and_missing_channels_as_zero() {
    let srgb = image(TextureFormat::Rgba8UnormSrgb, |_, _| {
        vec![0.5, 0.25, 0.125, 1.0]
    });
    let measured = distance(&plain([0.5, 0.25, 0.125]), &srgb).unwrap();
    assert!(measured.max < 0.005, "{measured:?}");
    let red = image(TextureFormat::R8Unorm, |_, _| vec![1.0]);
    let measured = distance(&plain([1.0, 0.0, 0.0]), &red).unwrap();
    assert_eq!(
        (measured.rmse, measured.max, measured.flip, measured.wrong),
        (0.0, 0.0, 0.0, 0.0)
    );
    let measured = distance(&plain([1.0, 0.5, 0.0]), &red).unwrap();
    assert_eq!((measured.max, measured.wrong), (0.5, 1.0));
    // Values beyond 1 are not clamped, except for FLIP.
    let bright = image(TextureFormat::Rgba16Float, |_, _| vec![3.0, 1.0, 1.0, 1.0]);
    let measured = distance(&plain([1.0; 3]), &bright).unwrap();
    assert_eq!(
        (measured.max, measured.flip, measured.wrong),
        (2.0, 0.0, 1.0)
    );
}

#[test]
fn values_that_are_not_finite_differ_by_one() {
    for (bits, flips) in [
        (f32::NAN.to_bits(), true),
        (f32::INFINITY.to_bits(), false),
        (f32::NEG_INFINITY.to_bits(), true),
    ] {
        let mut picture = image(TextureFormat::Rgba32Float, |_, _| vec![1.0; 4]);
        picture.codes[4 * 40 + 1] = bits;
        let measured = distance(&plain([1.0; 3]), &picture).unwrap();
        assert_eq!((measured.max, measured.wrong), (1.0, 1.0 / 128.0));
        assert!((measured.rmse - (1.0 / 384.0_f64).sqrt()).abs() < 1e-12);
        assert_eq!(measured.flip > 0.0, flips, "{measured:?}");
    }
}

#[test]
fn incomparable_pictures_have_no_distance() {
    let expected = plain([0.5; 3]);
    let good = image(TextureFormat::Rgba8Unorm, |_, _| vec![0.5; 4]);
    assert!(distance(&expected, &good).is_some());
    type Spoil = fn(&mut Image);
    let spoils: [Spoil; 8] = [
        |image| image.aspect = Aspect::Depth,
        |image| image.samples = 4,
        |image| image.size = [8, 16],
        |image| image.size = [u32::MAX; 2],
        |image| image.channels.clear(),
        |image| image.channels[3] = ChannelEncoding::Uint(8),
        |image| image.codes.truncate(500),
        |image| image.size = [0, 0],
    ];
    for spoil in spoils {
        let mut image = good.clone();
        spoil(&mut image);
        assert_eq!(distance(&expected, &image), None);
    }
    let empty = truth(&scene([0, 0], TexelCoverage::Area, Vec::new()));
    let mut image = good;
    image.size = [0, 0];
    image.codes.clear();
    assert_eq!(distance(&empty, &image), None);
}

/// The codes of two pictures of 16 by 8 texels. The page of methods compares them too:
/// `crates/report/tests/it/browser/methods.rs` checks its own FLIP against this number.
#[test]
fn two_known_pictures_have_the_flip_that_pages_must_find() {
    let truth = |x: u32, y: u32| [(x * 16) as u8, (y * 32) as u8, (x * y * 2) as u8];
    let picture = |x: u32, y: u32| {
        let [r, g, b] = truth(x, y);
        if x >= 8 {
            [255 - r, g, b]
        } else {
            [r, g / 2, b]
        }
    };
    let texels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
    let expected = TruthPicture {
        size: SIZE,
        rgb: texels
            .map(|(x, y)| truth(x, y).map(|c| f64::from(c) / 255.0))
            .collect(),
        error: 0.0,
    };
    let drawn = image(TextureFormat::Rgba8Unorm, |x, y| {
        let [r, g, b] = picture(x, y).map(|c| f64::from(c) / 255.0);
        vec![r, g, b, 1.0]
    });
    let measured = distance(&expected, &drawn).unwrap();
    assert!((measured.flip - 0.7392).abs() < 5e-5, "{}", measured.flip);
}

#[test]
fn flip_agrees_with_the_code_of_its_authors() {
    let mut state = 1_u32;
    let mut byte = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    for size @ [width, height] in [[1, 1], [7, 3], [40, 64]] {
        let length = 3 * (width * height) as usize;
        let truth: Vec<u8> = (0..length).map(|_| byte()).collect();
        // Small and large differences, and none.
        let picture = truth
            .iter()
            .enumerate()
            .map(|(place, code)| match place / 3 % 3 {
                0 => *code,
                1 => code.saturating_add(9),
                _ => byte(),
            });
        let picture: Vec<u8> = picture.collect();
        let [expected, drawn] =
            [&truth, &picture].map(|codes| nv_flip::FlipImageRgb8::with_data(width, height, codes));
        let map = nv_flip::flip(expected, drawn, nv_flip::DEFAULT_PIXELS_PER_DEGREE).to_vec();
        let expected = map.iter().map(|v| f64::from(*v)).sum::<f64>() / map.len() as f64;
        let value = |codes: &[u8], place: usize| f64::from(codes[place]) / 255.0;
        let texels = 0..length / 3;
        let truth = TruthPicture {
            size,
            rgb: texels
                .map(|t| [0, 1, 2].map(|c| value(&truth, 3 * t + c)))
                .collect(),
            error: 0.0,
        };
        let channels = TextureFormat::Rgba8Unorm.color_channels();
        let drawn = Image {
            size,
            channels: channels[..3].to_vec(),
            codes: picture.iter().map(|code| u32::from(*code)).collect(),
            ..image(TextureFormat::Rgba8Unorm, |_, _| vec![0.0; 4])
        };
        let measured = distance(&truth, &drawn).unwrap().flip;
        assert!(
            (measured - expected).abs() < 1e-5,
            "{size:?}: {measured}, {expected}"
        );
    }
}

/// Returns an image of a frame of any size, with a grey for each texel.
fn grey(size: [u32; 2], value: impl Fn(u32, u32) -> u32) -> Image {
    let texels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
    Image {
        size,
        codes: texels.flat_map(|[x, y]| [value(x, y); 4]).collect(),
        ..image(TextureFormat::Rgba8Unorm, |_, _| vec![0.0; 4])
    }
}

#[test]
fn a_lattice_has_the_colours_of_the_whole_picture() {
    use crate::common::{enlarged, triangle};
    let shapes = vec![
        triangle(
            [[1.3, 0.2], [7.7, 3.1], [2.1, 6.9]],
            0.5,
            [1.0, 0.5, 0.25, 0.5],
        ),
        triangle(
            [[0.1, 5.0], [6.2, 0.4], [7.9, 7.3]],
            0.25,
            [0.25, 0.5, 1.0, 0.75],
        ),
    ];
    for coverage in [TexelCoverage::Center, TexelCoverage::Area] {
        let large = enlarged(&scene([8, 8], coverage, shapes.clone()), 25);
        let whole = truth(&large);
        for step in [1, 3, 7] {
            let lattice = Lattice {
                size: large.size,
                step,
            };
            let on_lattice = truth_on(&large, lattice);
            let [columns, rows] = lattice.count();
            assert_eq!(on_lattice.picture.rgb.len(), (columns * rows) as usize);
            for (index, color) in on_lattice.picture.rgb.iter().enumerate() {
                let index = index as u32;
                let [x, y] = [index % columns, index / columns].map(|i| lattice.place(i));
                assert_eq!(
                    *color,
                    whole.rgb[(y * large.size[0] + x) as usize],
                    "{x} {y}"
                );
            }
            let sure = on_lattice.compared.iter().filter(|sure| **sure).count();
            match coverage {
                TexelCoverage::Area => assert_eq!(sure, on_lattice.compared.len()),
                TexelCoverage::Center => {
                    // Texels along the six edges are not compared, which are few.
                    assert!(sure < on_lattice.compared.len(), "step {step}");
                    assert!(10 * sure > 9 * on_lattice.compared.len(), "step {step}");
                }
            }
        }
    }
}

#[test]
fn frames_of_usual_sizes_are_compared_at_thousands_of_texels() {
    for size in [
        [1280, 720],
        [1920, 1080],
        [3840, 2160],
        [2560, 1440],
        [1000, 1000],
    ] {
        let lattice = Lattice::over(size);
        let [columns, rows] = lattice.count();
        assert!(columns * rows >= 4096, "{size:?}: {columns} by {rows}");
        assert!(lattice.place(columns - 1) < size[0] && lattice.place(rows - 1) < size[1]);
    }
    assert_eq!(Lattice::over([128, 64]).count(), [128, 64]);
}

#[test]
fn a_frame_is_compared_at_the_texels_of_its_lattice_alone() {
    let size = [200, 100];
    let even = scene(size, TexelCoverage::Center, Vec::new());
    let truth = truth_on(&even, Lattice { size, step: 3 });
    // Only texels between those of the lattice are wrong.
    let beside = grey(size, |x, y| if x % 3 == 1 && y % 3 == 1 { 0 } else { 255 });
    let distance = lattice_distance(&truth, &beside).expect("comparable");
    assert_eq!(
        (distance.texels, distance.rmse, distance.max),
        (67 * 33, 0.0, 0.0)
    );
    let wrong = grey(size, |_, _| 51);
    let distance = lattice_distance(&truth, &wrong).expect("comparable");
    assert!((distance.rmse - 0.2).abs() < 1e-12 && (distance.max - 0.2).abs() < 1e-12);
    assert_eq!(lattice_distance(&truth, &grey([100, 200], |_, _| 0)), None);
}
