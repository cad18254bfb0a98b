//! The grid of vertex positions that every driver represents exactly.
//!
//! A polygon with rounded vertices is a different polygon. Vertices are therefore moved to the grid before
//! the truth is computed, so that truth and drivers use the same triangles.

#[cfg(test)]
mod tests;

use crate::polygon::Polygon;
use glam::DVec3;
use std::collections::HashMap;

/// The number of grid steps per texel. Every driver represents vertices on this grid exactly: Vulkan and
/// OpenGL require 4 sub-pixel bits.
const GRID: f64 = 16.0;

/// Splits the polygons into triangles whose vertices are on a grid that every driver represents exactly, and
/// whose edges pass through no texel's centre, so that the texels they cover are certain. Vertices at the
/// same position stay together, vertices keep their depths, and triangles without area are left out.
///
/// A polygon with more than three corners becomes a fan around its middle.
pub(crate) fn settle(size: [u32; 2], polygons: &[Polygon]) -> Vec<Polygon> {
    let settled = settle_each(size, polygons).into_iter();
    settled.map(|(_, triangle)| triangle).collect()
}

/// Returns the triangles of [`settle`], each with the index of its polygon.
pub(crate) fn settle_each(size: [u32; 2], polygons: &[Polygon]) -> Vec<(usize, Polygon)> {
    let mut places: HashMap<[u64; 2], usize> = HashMap::new();
    let mut points: Vec<[i64; 2]> = Vec::new();
    let mut triangles = Vec::new();
    for (index, polygon) in polygons.iter().enumerate() {
        let mut place = |[x, y, depth]: [f64; 3]| {
            let key = [x.to_bits(), y.to_bits()];
            let index = *places.entry(key).or_insert_with(|| {
                points.push([x, y].map(|c| (c * GRID).round() as i64));
                points.len() - 1
            });
            (index, depth)
        };
        let corners: Vec<(usize, f64)> = polygon.corners.iter().map(|c| place(*c)).collect();
        let mut triangle = |corners: [(usize, f64); 3]| triangles.push((corners, index));
        if let [a, b, c] = corners[..] {
            triangle([a, b, c]);
            continue;
        }
        let sum: DVec3 = polygon.corners.iter().map(|c| DVec3::from(*c)).sum();
        let middle = place((sum / corners.len() as f64).to_array());
        for (i, corner) in corners.iter().enumerate() {
            triangle([middle, *corner, corners[(i + 1) % corners.len()]]);
        }
    }
    let edges: Vec<[usize; 2]> = triangles
        .iter()
        .flat_map(|(c, _)| [[c[0].0, c[1].0], [c[1].0, c[2].0], [c[2].0, c[0].0]])
        .collect();
    untie(size, &mut points, &edges);
    let polygon = |(corners, index): ([(usize, f64); 3], usize)| {
        let [a, b, c] = corners.map(|(index, _)| points[index]);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        let corner = |(index, depth): (usize, f64)| {
            let [x, y] = points[index].map(|c| c as f64 / GRID);
            [x, y, depth]
        };
        let color = polygons[index].color;
        (area != 0).then(|| (index, Polygon::new(corners.map(corner).to_vec(), color)))
    };
    triangles.into_iter().filter_map(polygon).collect()
}

/// Moves the corners of a convex polygon to the same grid, so that none of its edges passes through a texel's centre. The
/// polygon stays whole: it must stay convex, and flat, when a corner moves by a step or two.
pub(crate) fn settle_whole(size: [u32; 2], polygon: &Polygon) -> Polygon {
    let rounded = polygon
        .corners
        .iter()
        .map(|[x, y, _]| [x, y].map(|c| (c * GRID).round() as i64));
    let mut points: Vec<[i64; 2]> = rounded.collect();
    let edges: Vec<[usize; 2]> = (0..points.len())
        .map(|i| [i, (i + 1) % points.len()])
        .collect();
    untie(size, &mut points, &edges);
    let mut settled = polygon.clone();
    for (corner, point) in settled.corners.iter_mut().zip(points) {
        [corner[0], corner[1]] = point.map(|c| c as f64 / GRID);
    }
    settled
}

/// Moves points by single steps of the grid until no edge passes through a centre. Points on the edges of
/// the picture stay there.
fn untie(size: [u32; 2], points: &mut [[i64; 2]], edges: &[[usize; 2]]) {
    let ends = size.map(|s| i64::from(s) * GRID as i64);
    // Far more passes than needed: a step frees most edges, and each pass takes a step per tied edge.
    for pass in 0..64_usize {
        let mut tied = false;
        for (i, [a, b]) in edges.iter().copied().enumerate() {
            if !touches_centre(size, points[a], points[b]) {
                continue;
            }
            tied = true;
            let free = |index: usize, axis: usize| {
                let coordinate = points[index][axis];
                coordinate != 0 && coordinate != ends[axis]
            };
            // Alternates between ends and axes, because otherwise two edges could push a point to and fro.
            let ways = [(a, 0), (b, 1), (a, 1), (b, 0)];
            let turn = pass + i;
            let way = (0..4).map(|k| ways[(turn + k) % 4]);
            if let Some((index, axis)) = way.into_iter().find(|(index, axis)| free(*index, *axis)) {
                let step = if (turn / 4).is_multiple_of(2) { 1 } else { -1 };
                let moved = points[index][axis] + step;
                points[index][axis] = if moved == ends[axis] || moved == 0 {
                    moved - 2 * step
                } else {
                    moved
                };
            }
        }
        if !tied {
            break;
        }
    }
}

/// Returns true if an edge passes through the centre of a texel of the picture.
fn touches_centre(size: [u32; 2], a: [i64; 2], b: [i64; 2]) -> bool {
    let step = GRID as i64;
    let half = step / 2;
    let is_centre = |x: i64| x.rem_euclid(step) == half;
    let within = |c: i64, axis: usize| (0..i64::from(size[axis]) * step).contains(&c);
    // Moves along the axis on which the edge is longer, so that the divisor is never 0.
    let long = usize::from((b[1] - a[1]).abs() > (b[0] - a[0]).abs());
    let short = 1 - long;
    let (from, to) = if a[long] <= b[long] { (a, b) } else { (b, a) };
    let length = to[long] - from[long];
    if length == 0 {
        return is_centre(a[0]) && is_centre(a[1]) && within(a[0], 0) && within(a[1], 1);
    }
    let first = from[long] + (half - from[long]).rem_euclid(step);
    let mut center = first.max(half);
    while center <= to[long] && within(center, long) {
        let run = (to[short] - from[short]) * (center - from[long]);
        if run % length == 0 {
            let other = from[short] + run / length;
            if is_centre(other) && within(other, short) {
                return true;
            }
        }
        center += step;
    }
    false
}
