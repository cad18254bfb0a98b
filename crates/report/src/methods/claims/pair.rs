//! Pairs of methods that are compared.

use super::claim::Place;
use crate::methods::data::{Methods, Point, SceneSeries};

/// Two methods on the same scene, adapter, settings and parameter value.
pub(super) struct Pair<'s, 'a> {
    pub(super) scene: &'s SceneSeries<'a>,
    pub(super) adapter: &'a str,
    pub(super) one: &'s Point<'a>,
    pub(super) other: &'s Point<'a>,
}

/// Every place where two methods of a question can be compared.
pub(super) fn pairs<'s, 'a>(
    methods: &'s Methods<'a>,
    question: &str,
    one: &str,
    other: &str,
) -> Vec<Pair<'s, 'a>> {
    let mut result = Vec::new();
    for scene in methods.scenes().filter(|s| s.question == question) {
        for a in scene.series.iter().filter(|s| s.method == one) {
            for b in scene
                .series
                .iter()
                .filter(|s| s.method == other && s.variant == a.variant)
            {
                for p in &a.points {
                    let same = |o: &&Point<'_>| o.adapter == p.adapter && o.value == p.value;
                    if let Some(o) = b.points.iter().find(same) {
                        result.push(Pair {
                            scene,
                            adapter: methods.adapters[p.adapter].name,
                            one: p,
                            other: o,
                        });
                    }
                }
            }
        }
    }
    result
}

/// The median of a ratio over all pairs of a place, where it is known.
pub(super) fn medians<'s, 'a>(
    pairs: &[Pair<'s, 'a>],
    place: impl Fn(&Pair<'s, 'a>) -> Place<'a>,
    ratio: impl Fn(&Pair<'s, 'a>) -> Option<f64>,
) -> Vec<(Place<'a>, f64)> {
    let mut groups: Vec<(Place<'a>, Vec<f64>)> = Vec::new();
    for pair in pairs {
        let Some(value) = ratio(pair).filter(|v| v.is_finite()) else {
            continue;
        };
        let place = place(pair);
        match groups.iter_mut().find(|g| g.0 == place) {
            Some(group) => group.1.push(value),
            None => groups.push((place, vec![value])),
        }
    }
    let middle = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        let last = values.len() - 1;
        f64::midpoint(values[last / 2], values[last.div_ceil(2)])
    };
    groups.into_iter().map(|(p, v)| (p, middle(v))).collect()
}

/// The fragments of the other method over those of the one.
pub(super) fn fragments(pair: &Pair<'_, '_>) -> Option<f64> {
    let (one, other) = (pair.one.measured.fragments?, pair.other.measured.fragments?);
    (one > 0).then(|| other as f64 / one as f64)
}

/// The frame time of the other method over that of the one.
pub(super) fn time(pair: &Pair<'_, '_>) -> Option<f64> {
    Some(pair.other.wall()? / pair.one.wall()?)
}

impl<'a> Pair<'_, 'a> {
    pub(super) fn place(&self) -> Place<'a> {
        (self.scene.name, self.adapter)
    }
}
