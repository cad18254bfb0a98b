//! Scenes made by hand.

use etalon_methods::{FlatSurface, Paint, TexelCoverage, Truth};

/// A rectangle between two corners at one depth.
pub(crate) fn rectangle(low: [f64; 2], high: [f64; 2], depth: f64, color: [f64; 4]) -> FlatSurface {
    FlatSurface {
        corners: vec![
            [low[0], low[1], depth],
            [high[0], low[1], depth],
            [high[0], high[1], depth],
            [low[0], high[1], depth],
        ],
        paint: Paint::Flat(color),
    }
}

/// A rectangle larger than a picture of 16 by 16 texels, with depth as a function of the position.
pub(crate) fn pane(depth: impl Fn(f64, f64) -> f64, paint: Paint) -> FlatSurface {
    let corners = [[-4.0, -4.0], [20.0, -4.0], [20.0, 20.0], [-4.0, 20.0]];
    FlatSurface {
        corners: corners.map(|[x, y]| [x, y, depth(x, y)]).to_vec(),
        paint,
    }
}

pub(crate) fn triangle(corners: [[f64; 2]; 3], depth: f64, color: [f64; 4]) -> FlatSurface {
    FlatSurface {
        corners: corners.map(|[x, y]| [x, y, depth]).to_vec(),
        paint: Paint::Flat(color),
    }
}

pub(crate) fn scene(size: [u32; 2], coverage: TexelCoverage, surfaces: Vec<FlatSurface>) -> Truth {
    Truth {
        size,
        background: [0.0; 3],
        coverage,
        surfaces,
    }
}

/// Returns a scene enlarged by a factor.
pub(crate) fn enlarged(what: &Truth, times: u32) -> Truth {
    let mut what = what.clone();
    what.size = what.size.map(|n| n * times);
    for corner in what.surfaces.iter_mut().flat_map(|s| &mut s.corners) {
        corner[0] *= f64::from(times);
        corner[1] *= f64::from(times);
    }
    what
}

/// Returns the means of square blocks of texels.
pub(crate) fn reduced(size: [u32; 2], rgb: &[[f64; 3]], times: u32) -> Vec<[f64; 3]> {
    let [width, height] = size.map(|n| n / times);
    let mut result = vec![[0.0; 3]; width as usize * height as usize];
    let share = f64::from(times * times);
    for (i, texel) in rgb.iter().enumerate() {
        let (x, y) = (i as u32 % size[0] / times, i as u32 / size[0] / times);
        let sum = &mut result[(y * width + x) as usize];
        for (sum, value) in sum.iter_mut().zip(texel) {
            *sum += value / share;
        }
    }
    result
}

/// Returns the largest difference of any channel.
pub(crate) fn largest_difference(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    // `max` would skip a NaN.
    pairs.fold(0.0, |worst: f64, (a, b)| {
        let difference = (a - b).abs();
        if difference <= worst {
            worst
        } else {
            difference
        }
    })
}

#[track_caller]
pub(crate) fn assert_near(found: [f64; 3], expected: [f64; 3], tolerance: f64) {
    let difference = largest_difference(&[found], &[expected]);
    assert!(
        difference <= tolerance,
        "{found:?} is not {expected:?}, by {difference:e}"
    );
}
