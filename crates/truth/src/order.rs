//! Which surface lies in front of which.

use super::cell::Point;
use super::surface::PreparedSurface;
use smallvec::SmallVec;

/// Surfaces by their position in the scene.
pub(super) type Members = SmallVec<[usize; 16]>;

/// How two surfaces lie at all of some points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Relation {
    /// The first one is in front.
    Front,
    /// The second one is in front.
    Behind,
    /// Here the one, there the other.
    Crossing,
}

/// How much farther surface `a` lies than `b` at a point.
pub(super) fn gap(surfaces: &[PreparedSurface<'_>], a: usize, b: usize, p: Point) -> f64 {
    surfaces[a].depth.at(p) - surfaces[b].depth.at(p)
}

/// Gaps up to this are rounding.
pub(super) fn slack(surfaces: &[PreparedSurface<'_>], a: usize, b: usize) -> f64 {
    surfaces[a].slack + surfaces[b].slack
}

/// How surface `a` lies to `b` at points; where they lie together, the later one is in front.
pub(super) fn relation(
    surfaces: &[PreparedSurface<'_>],
    a: usize,
    b: usize,
    points: &[Point],
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

/// Sorts surfaces front to back as seen at points. Of two that cross, the one that is nearer in the
/// mean comes first.
pub(super) fn sort(surfaces: &[PreparedSurface<'_>], members: &mut [usize], points: &[Point]) {
    let before = |a: usize, b: usize| match relation(surfaces, a, b, points) {
        Relation::Front => true,
        Relation::Behind => false,
        Relation::Crossing => points.iter().map(|&p| gap(surfaces, a, b, p)).sum::<f64>() < 0.0,
    };
    // By insertion: mostly they come sorted, and a library's sort may panic where rounding makes
    // equality of depths intransitive.
    for i in 1..members.len() {
        let mut j = i;
        while j > 0 && before(members[j], members[j - 1]) {
            members.swap(j, j - 1);
            j -= 1;
        }
    }
}

/// The picture at a point: surfaces that are sorted front to back, over the background.
pub(super) fn compose(
    surfaces: &[PreparedSurface<'_>],
    members: &[usize],
    background: [f64; 3],
    p: Point,
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
