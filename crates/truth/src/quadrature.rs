//! Integrals over triangles, by Gauss-Legendre rules, which are exact for polynomials.

use super::cell::{PicturePoint, area_of};
use std::f64::consts::PI;
use std::sync::LazyLock;

/// The maximum number of points along one side.
pub(super) const MOST: usize = 14;

/// Gauss-Legendre points and weights on 0 to 1, by the number of points.
static RULES: LazyLock<Vec<Vec<(f64, f64)>>> = LazyLock::new(|| (0..=MOST).map(gauss).collect());

/// Returns the points and weights of the rule with `n` points on 0 to 1: roots of the Legendre polynomial by
/// Newton's method from the usual guess (Press and others, Numerical Recipes, 4.6).
fn gauss(n: usize) -> Vec<(f64, f64)> {
    let rule = (0..n).map(|i| {
        let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (mut last, mut value) = (0.0, 1.0);
            for k in 0..n {
                let k = k as f64;
                let next = ((2.0 * k + 1.0) * x * value - k * last) / (k + 1.0);
                (last, value) = (value, next);
            }
            slope = n as f64 * (x * value - last) / (x * x - 1.0);
            let step = value / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        ((x + 1.0) / 2.0, 1.0 / ((1.0 - x * x) * slope * slope))
    });
    rule.collect()
}

/// Returns the integral of a function over a triangle from `points`² points, at most [`MOST`]²: exact for
/// polynomials of degree `2 * points - 2`, because the map from the square to the triangle, collapsed at its
/// first corner (Duffy 1982), adds one degree.
pub(super) fn integral(
    triangle: [PicturePoint; 3],
    points: usize,
    mut function: impl FnMut(PicturePoint) -> [f64; 3],
) -> [f64; 3] {
    let [a, b, c] = triangle;
    let twice = 2.0 * area_of(triangle);
    let rule = &RULES[points.min(MOST)];
    let mut sum = [0.0; 3];
    for &(s, along) in rule {
        for &(t, across) in rule {
            let p =
                std::array::from_fn(|i| a[i] + s * ((b[i] - a[i]) * (1.0 - t) + (c[i] - a[i]) * t));
            let weight = along * across * s * twice;
            for (sum, value) in sum.iter_mut().zip(function(p)) {
                *sum += weight * value;
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_up_to_the_degree_are_integrated_exactly() {
        // The integral of x^i y^j over the triangle (0,0) (1,0) (0,1) is i! j! / (i + j + 2)!.
        let factorial = |n: u32| (1..=n).map(f64::from).product::<f64>();
        for points in 1..=MOST {
            let degree = 2 * points as u32 - 2;
            for i in 0..=degree {
                let j = degree - i;
                let [found, ..] = integral([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], points, |p| {
                    [p[0].powi(i as i32) * p[1].powi(j as i32); 3]
                });
                let exact = factorial(i) * factorial(j) / factorial(i + j + 2);
                assert!(
                    (found - exact).abs() <= 1e-13,
                    "{points} points, x^{i} y^{j}"
                );
            }
        }
    }
}
