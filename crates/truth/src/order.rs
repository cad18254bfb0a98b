//! The depth order of surfaces.

use super::cell::PicturePoint;
use super::surface::PreparedSurface;
use smallvec::SmallVec;

/// Surfaces, by their index in the scene.
pub(super) type Members = SmallVec<[usize; 16]>;

/// The order of two surfaces over all of some points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Relation {
    /// The first one is in front.
    Front,
    /// The second one is in front.
    Behind,
    /// The first one is in front at some points, the second one at others.
    Crossing,
}

/// Returns the depth of surface `a` minus that of `b` at a point.
pub(super) fn gap(surfaces: &[PreparedSurface<'_>], a: usize, b: usize, p: PicturePoint) -> f64 {
    surfaces[a].depth.at(p) - surfaces[b].depth.at(p)
}

/// Returns the largest gap that can be due to rounding.
pub(super) fn slack(surfaces: &[PreparedSurface<'_>], a: usize, b: usize) -> f64 {
    surfaces[a].slack + surfaces[b].slack
}

/// Returns the order of surfaces `a` and `b` at points; at equal depth, the later surface is in front.
pub(super) fn relation(
    surfaces: &[PreparedSurface<'_>],
    a: usize,
    b: usize,
    points: &[PicturePoint],
) -> Relation {
    let slack = slack(surfaces, a, b);
    let (mut nearer, mut farther) = (false, false);
    for &p in points {
        let gap = gap(surfaces, a, b, p);
        nearer |= gap < -slack;
        farther |= gap > slack;
    }
    match (nearer, farther) {
        (true, true) => Relation::Crossing,
        (true, false) => Relation::Front,
        (false, true) => Relation::Behind,
        (false, false) if a > b => Relation::Front,
        (false, false) => Relation::Behind,
    }
}

/// Sorts surfaces front to back at points. If two cross, the nearer one on average comes first.
pub(super) fn sort(
    surfaces: &[PreparedSurface<'_>],
    members: &mut [usize],
    points: &[PicturePoint],
) {
    let before = |a: usize, b: usize| match relation(surfaces, a, b, points) {
        Relation::Front => true,
        Relation::Behind => false,
        Relation::Crossing => points.iter().map(|&p| gap(surfaces, a, b, p)).sum::<f64>() < 0.0,
    };
    // Insertion sort: the input is mostly sorted, and the standard sort can panic if rounding makes equality
    // of depths intransitive.
    for i in 1..members.len() {
        let mut j = i;
        while j > 0 && before(members[j], members[j - 1]) {
            members.swap(j, j - 1);
            j -= 1;
        }
    }
}

/// Returns the colour at a point of surfaces sorted front to back, over the background.
pub(super) fn compose(
    surfaces: &[PreparedSurface<'_>],
    members: &[usize],
    background: [f64; 3],
    p: PicturePoint,
) -> [f64; 3] {
    let mut seen = background;
    for &member in members.iter().rev() {
        let [r, g, b, alpha] = surfaces[member].color(p);
        for (seen, channel) in seen.iter_mut().zip([r, g, b]) {
            *seen = channel * alpha + *seen * (1.0 - alpha);
        }
    }
    seen
}
