//! The FLIP difference of two pictures (Andersson and others 2020, for low dynamic range).
//!
//! A test compares it with its authors' code. The page of methods has the same arithmetic in JavaScript.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Texels per degree of the field of view: a monitor 0.7 metres away.
const TEXELS_PER_DEGREE: f64 = 67.0;

/// The contrast sensitivity of the eye: luminance, red against green, blue against yellow. Each is a sum of Gaussians
/// with an amplitude and a width.
const SENSITIVITY: [&[(f64, f64)]; 3] = [
    &[(1.0, 0.0047)],
    &[(1.0, 0.0053)],
    &[(34.1, 0.04), (13.5, 0.025)],
];
/// The largest width.
const WIDEST: f64 = 0.04;
/// The width of edges and points that an eye detects, in degrees.
const FEATURE: f64 = 0.082;

const COLOR_EXPONENT: f64 = 0.7;
/// The share of the largest difference of colours from which differences are compressed, and what remains below.
const KNEE: [f64; 2] = [0.4, 0.95];

/// A quantity of each texel, row by row.
type PixelPlane = Vec<f64>;
/// A colour in XYZ, Lab, or linear red, green and blue.
type Color = [f64; 3];

/// Returns the mean difference of two pictures, from 0 to 1. Each texel has three codes in sRGB.
pub(super) fn mean_flip(size: [u32; 2], truth: &[u8], picture: &[u8]) -> f64 {
    let size = size.map(|length| length as usize);
    let [truth, picture] = [truth, picture].map(|codes| PerceivedPicture::of(size, codes));
    let largest = difference([0.0, 1.0, 0.0].lab().hunt(), [0.0, 0.0, 1.0].lab().hunt());
    let [share, below] = KNEE;
    let knee = share * largest;
    let texels = truth.colors.len();
    let mut sum = 0.0;
    for texel in 0..texels {
        let color = difference(truth.colors[texel], picture.colors[texel]);
        let color = if color < knee {
            below / knee * color
        } else {
            below + (color - knee) / (largest - knee) * (1.0 - below)
        };
        let differ = |of: fn(&PerceivedPicture) -> &PixelPlane| {
            (of(&truth)[texel] - of(&picture)[texel]).abs()
        };
        let feature = differ(|seen| &seen.edges).max(differ(|seen| &seen.points));
        sum += color.powf(1.0 - (FRAC_1_SQRT_2 * feature).sqrt()).min(1.0);
    }
    sum / texels as f64
}

/// A picture as an eye sees it.
struct PerceivedPicture {
    /// The filtered colours in Lab, with Hunt's adjustment.
    colors: Vec<Color>,
    /// The strengths of edges and points.
    edges: PixelPlane,
    points: PixelPlane,
}

impl PerceivedPicture {
    fn of(size: [usize; 2], codes: &[u8]) -> Self {
        let opponents: Vec<Color> = codes
            .chunks_exact(3)
            .map(|code| {
                let linear = [0, 1, 2].map(|c| linear(code[c]));
                opponent(relative(linear))
            })
            .collect();
        let planes = [0, 1, 2].map(|c| {
            opponents
                .iter()
                .map(|color| color[c])
                .collect::<PixelPlane>()
        });
        let luminance: PixelPlane = planes[0].iter().map(|l| (l + 16.0) / 116.0).collect();
        let [edges, points] = features(size, &luminance);
        let filtered = [0, 1, 2].map(|c| blurred(size, &planes[c], SENSITIVITY[c]));
        let white = [1.0; 3].xyz();
        let colors = (0..opponents.len()).map(|texel| {
            let y = (filtered[0][texel] + 16.0) / 116.0;
            let x = y + filtered[1][texel] / 500.0;
            let z = y - filtered[2][texel] / 200.0;
            let color = [x * white[0], y * white[1], z * white[2]].rgb();
            color.map(|value| value.clamp(0.0, 1.0)).lab().hunt()
        });
        Self {
            colors: colors.collect(),
            edges,
            points,
        }
    }
}

/// Conversions of a colour.
trait Convert {
    fn xyz(self) -> Color;
    fn rgb(self) -> Color;
    fn lab(self) -> Color;
    fn hunt(self) -> Color;
}

impl Convert for Color {
    /// Returns linear red, green and blue as XYZ, with the primaries of sRGB and the white D65.
    fn xyz(self) -> Color {
        const DIVISORS: [f64; 3] = [24_577_794.0, 12_288_897.0, 73_733_382.0];
        const FACTORS: [Color; 3] = [
            [10_135_552.0, 8_788_810.0, 4_435_075.0],
            [2_613_072.0, 8_788_810.0, 887_015.0],
            [1_425_312.0, 8_788_810.0, 70_074_185.0],
        ];
        [0, 1, 2].map(|row| {
            let terms = (0..3).map(|c| FACTORS[row][c] / DIVISORS[row] * self[c]);
            terms.sum()
        })
    }

    /// Returns XYZ as linear red, green and blue.
    fn rgb(self) -> Color {
        const FACTORS: [Color; 3] = [
            [3.241_003_275, -1.537_398_934, -0.498_615_861],
            [-0.969_224_334, 1.875_930_071, 0.041_554_224],
            [0.055_639_423, -0.204_011_202, 1.057_148_933],
        ];
        FACTORS.map(|row| (0..3).map(|c| row[c] * self[c]).sum())
    }

    /// Returns linear red, green and blue as Lab.
    fn lab(self) -> Color {
        const BEND: f64 = 6.0 / 29.0;
        opponent(relative(self).map(|value| {
            if value > BEND.powi(3) {
                value.cbrt()
            } else {
                value / (3.0 * BEND * BEND) + 4.0 / 29.0
            }
        }))
    }

    /// Returns Lab with less chroma in the dark.
    fn hunt(self) -> Color {
        let [l, a, b] = self;
        [l, 0.01 * l * a, 0.01 * l * b]
    }
}

/// Returns linear red, green and blue as XYZ relative to white.
fn relative(linear: Color) -> Color {
    let (color, white) = (linear.xyz(), [1.0; 3].xyz());
    [0, 1, 2].map(|c| color[c] / white[c])
}

/// Returns luminance, red against green, and blue against yellow, on the scales of Lab.
fn opponent([x, y, z]: Color) -> Color {
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Returns the linear value of an sRGB code.
fn linear(code: u8) -> f64 {
    let value = f64::from(code) / 255.0;
    if value <= 0.04045 {
        value / 12.92
    } else {
        ((value + 0.055) / 1.055).powf(2.4)
    }
}

/// Returns the difference of two colours in Lab (HyAB), to the power of the metric.
fn difference(a: Color, b: Color) -> f64 {
    let chroma = (a[1] - b[1]).hypot(a[2] - b[2]);
    ((a[0] - b[0]).abs() + chroma).powf(COLOR_EXPONENT)
}

/// Returns the values of a function from `-radius` to `radius`.
fn kernel(radius: i32, function: impl Fn(f64) -> f64) -> Vec<f64> {
    (-radius..=radius).map(|x| function(f64::from(x))).collect()
}

/// Convolves a plane with one kernel along rows and another along columns. The texels at the border repeat.
fn convolve(
    [width, height]: [usize; 2],
    plane: &[f64],
    across: &[f64],
    down: &[f64],
) -> PixelPlane {
    let neighbour = |place: usize, offset: usize, radius: usize, length: usize| {
        (place + offset).saturating_sub(radius).min(length - 1)
    };
    let (radius, mut rows) = (across.len() / 2, Vec::with_capacity(plane.len()));
    for row in plane.chunks_exact(width) {
        rows.extend((0..width).map(|x| {
            let terms = across.iter().enumerate();
            let terms = terms.map(|(i, weight)| weight * row[neighbour(x, i, radius, width)]);
            terms.sum::<f64>()
        }));
    }
    let (radius, mut result) = (down.len() / 2, Vec::with_capacity(plane.len()));
    for y in 0..height {
        let mut sums = vec![0.0; width];
        for (i, weight) in down.iter().enumerate() {
            let start = neighbour(y, i, radius, height) * width;
            for (sum, value) in sums.iter_mut().zip(&rows[start..]) {
                *sum += weight * value;
            }
        }
        result.append(&mut sums);
    }
    result
}

/// Returns a plane as the eye resolves it.
fn blurred(size: [usize; 2], plane: &[f64], sensitivity: &[(f64, f64)]) -> PixelPlane {
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * TEXELS_PER_DEGREE).ceil() as i32;
    let gauss = |width: f64| {
        kernel(radius, |x| {
            let degrees = x / TEXELS_PER_DEGREE;
            (-PI * PI * degrees * degrees / width).exp()
        })
    };
    let parts = sensitivity.iter().map(|&(amplitude, width)| {
        let kernel = gauss(width);
        let sum: f64 = kernel.iter().sum();
        (kernel, amplitude * (PI / width).sqrt(), sum * sum)
    });
    let parts: Vec<_> = parts.collect();
    let total: f64 = parts.iter().map(|(_, weight, sum)| weight * sum).sum();
    let mut result = vec![0.0; plane.len()];
    for (kernel, weight, _) in &parts {
        let filtered = convolve(size, plane, kernel, kernel);
        for (sum, value) in result.iter_mut().zip(filtered) {
            *sum += value * weight / total;
        }
    }
    result
}

/// Returns the strengths of edges and of points in luminance: the first and the second derivative of a Gaussian.
fn features(size: [usize; 2], luminance: &[f64]) -> [PixelPlane; 2] {
    let deviation = 0.5 * FEATURE * TEXELS_PER_DEGREE;
    let radius = (3.0 * deviation).ceil() as i32;
    let gauss = |x: f64| (-x * x / (2.0 * deviation * deviation)).exp();
    let mut smooth = kernel(radius, gauss);
    let sum: f64 = smooth.iter().sum();
    smooth.iter_mut().for_each(|weight| *weight /= sum);
    let edge = kernel(radius, |x| -x * gauss(x));
    let point = kernel(radius, |x| {
        (x * x / (deviation * deviation) - 1.0) * gauss(x)
    });
    [edge, point].map(|mut derivative| {
        // Positive and negative weights have the sums 1 and -1.
        let sum = |sign: f64| derivative.iter().map(|w| (w * sign).max(0.0)).sum::<f64>();
        let (positive, negative) = (sum(1.0), sum(-1.0));
        for weight in &mut derivative {
            *weight /= if *weight > 0.0 { positive } else { negative };
        }
        let across = convolve(size, luminance, &derivative, &smooth);
        let down = convolve(size, luminance, &smooth, &derivative);
        across.iter().zip(down).map(|(x, y)| x.hypot(y)).collect()
    })
}
