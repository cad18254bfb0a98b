//! Which method, at which price: the methods of each question on an adapter, at a size of frames.

mod answer;
mod section;
mod table;

pub(super) use section::{lines, section, tables};

use super::data::{DeviceKind, Methods, Question, SeriesPoint, ShownScene, usable};
use etalon_methods::{Order, order};
use etalon_record::{Measured, SizedFrame};
use std::collections::{BTreeMap, BTreeSet};

/// The largest difference of a channel in a picture that counts as exact: two codes of 255, plus a margin for
/// rounding.
const EXACT: f64 = 2.0 / 255.0 + 1e-9;

/// A size at which frames are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FrameSize {
    /// The size of each scene's picture.
    Picture,
    /// Width and height in texels.
    Sides([u32; 2]),
}

impl FrameSize {
    /// Returns the size as text.
    fn text(self) -> String {
        match self {
            Self::Picture => "the pictures' size".to_owned(),
            Self::Sides([width, height]) => format!("{width}\u{d7}{height}"),
        }
    }

    /// Returns the number of texels of a frame; `None` for pictures, whose sizes differ.
    fn texels(self) -> Option<f64> {
        match self {
            Self::Picture => None,
            Self::Sides([width, height]) => Some(f64::from(width) * f64::from(height)),
        }
    }
}

/// Returns the sizes at which frames of the run were timed: that of pictures, then from small to large.
fn sizes(methods: &Methods<'_>) -> Vec<FrameSize> {
    let points = methods
        .scenes()
        .flat_map(|s| &s.series)
        .flat_map(|s| &s.points);
    let timed = points.flat_map(|p| &p.measured.sizes);
    let mut sides: Vec<[u32; 2]> = timed.filter(|f| f.time.is_some()).map(|f| f.size).collect();
    sides.sort_by_key(|[width, height]| u64::from(*width) * u64::from(*height));
    sides.dedup();
    let sides = sides.into_iter().map(FrameSize::Sides);
    [FrameSize::Picture].into_iter().chain(sides).collect()
}

/// A low, a middle and a high value.
type Spread = [f64; 3];

/// A method on an adapter at a size, over the scenes of its question.
#[derive(Clone, Debug, PartialEq)]
struct Candidate<'a> {
    method: &'a str,
    /// The part that the order of draws plays; `None` for questions without transparent surfaces.
    order: Option<Order>,
    /// The frame time in seconds, with the ends of its interval: medians over scenes.
    time: Spread,
    /// The median of the RMSE over scenes, between the least and the largest.
    error: Spread,
    /// True if no texel of any scene is off by more than two codes of 255.
    is_exact: bool,
    /// The scenes by their indices in the question.
    scenes: Vec<usize>,
}

/// A method in one scene on one adapter.
struct ScenePoint<'a> {
    method: &'a str,
    adapter: usize,
    /// The index of the scene in its question.
    scene: usize,
    measured: &'a Measured,
}

/// The scenes of a question, each at the setting that represents it.
struct QuestionPoints<'s, 'a> {
    question: &'s Question<'a>,
    /// The scenes, by index.
    scenes: Vec<&'s ShownScene<'s, 'a>>,
    points: Vec<ScenePoint<'a>>,
}

impl<'s, 'a> QuestionPoints<'s, 'a> {
    fn new(question: &'s Question<'a>, shown: &'s [ShownScene<'s, 'a>]) -> Self {
        let of_question = || shown.iter().filter(|s| std::ptr::eq(s.question, question));
        // Where the parameter is that of the methods themselves, they are not drawn as people draw them.
        let usual = || of_question().filter(|s| !is_along(s, OWN));
        let scenes: Vec<&ShownScene<'_, '_>> = if usual().next().is_some() {
            usual().collect()
        } else {
            of_question().collect()
        };
        let mut points = Vec::new();
        for (scene, shown) in scenes.iter().enumerate() {
            let Some(setting) = shown.settings.get(shown.main) else {
                continue;
            };
            let here = shown.scene.at(setting);
            let timed = here.filter(|(_, p)| p.error().is_some() && p.wall().is_some());
            points.extend(
                timed.map(|(series, point): (_, &SeriesPoint<'a>)| ScenePoint {
                    method: series.method,
                    adapter: point.adapter,
                    scene,
                    measured: point.measured,
                }),
            );
        }
        Self {
            question,
            scenes,
            points,
        }
    }

    /// Returns the methods that were timed on an adapter at a size in at least half as many scenes as any other, over the
    /// scenes that all of them draw: errors of different scenes do not compare.
    fn candidates(&self, adapter: usize, size: FrameSize) -> Vec<Candidate<'a>> {
        let here = |method: &'a str| -> BTreeMap<usize, (Spread, [f64; 2])> {
            let of_method = |p: &&ScenePoint<'a>| p.method == method && p.adapter == adapter;
            let points = self.points.iter().filter(of_method);
            let timed = |p: &ScenePoint<'a>| {
                Some((p.scene, (time(p.measured, size)?, error(p.measured, size)?)))
            };
            points.filter_map(timed).collect()
        };
        let methods = self.question.methods.iter();
        let mut found: Vec<(&str, BTreeMap<_, _>)> =
            methods.map(|method| (*method, here(method))).collect();
        let most = found.iter().map(|(_, points)| points.len()).max();
        found.retain(|(_, p)| !p.is_empty() && 2 * p.len() >= most.unwrap_or(0));
        keep_common(&mut found);
        let candidate = |(method, points): (&'a str, BTreeMap<usize, (Spread, [f64; 2])>)| {
            let (scenes, points): (Vec<usize>, Vec<(Spread, [f64; 2])>) =
                points.into_iter().unzip();
            let times = [0, 1, 2].map(|end| middle(points.iter().map(|(time, _)| time[end])));
            let errors = || points.iter().map(|(_, [rmse, _])| *rmse);
            Candidate {
                method,
                order: order(self.question.name, method),
                time: times,
                error: [
                    errors().fold(f64::INFINITY, f64::min),
                    middle(errors()),
                    errors().fold(0.0, f64::max),
                ],
                is_exact: points.iter().all(|(_, [_, most])| *most <= EXACT),
                scenes,
            }
        };
        found.into_iter().map(candidate).collect()
    }
}

/// Keeps the scenes that all methods draw, if there are any: methods for different effects have none.
fn keep_common<P>(methods: &mut [(&str, BTreeMap<usize, P>)]) {
    let scenes = methods.iter().map(|(_, p)| p.keys().copied().collect());
    let common: Option<BTreeSet<usize>> = scenes.reduce(|a, b| &a & &b);
    let Some(common) = common.filter(|common| !common.is_empty()) else {
        return;
    };
    for (_, points) in methods {
        points.retain(|scene, _| common.contains(scene));
    }
}

/// The parameter of the methods themselves: the number of peels, layers or nodes.
const OWN: &str = "k";

/// Returns true if a scene is drawn along a parameter.
fn is_along(shown: &ShownScene<'_, '_>, parameter: &str) -> bool {
    let main = shown.settings.get(shown.main).and_then(|s| s.parameter);
    main.is_some_and(|(name, _)| name == parameter)
}

/// Returns the median of one or more numbers.
fn middle(values: impl Iterator<Item = f64>) -> f64 {
    crate::numbers::median(values).unwrap_or(f64::NAN)
}

/// Returns the time of a frame of a size with its interval: from the cost of a frame, or measured where a line does not
/// describe the times.
fn time(measured: &Measured, size: FrameSize) -> Option<Spread> {
    let spread = |time: f64, interval: Option<[f64; 2]>| {
        let [low, high] = interval.unwrap_or([time; 2]);
        let all = [low.min(time), time, high.max(time)];
        all.iter().all(|t| usable(*t) && *t > 0.0).then_some(all)
    };
    let of_times = |times: &etalon_record::Times| spread(times.wall, times.interval);
    let Some(texels) = size.texels() else {
        return of_times(measured.time.as_ref()?);
    };
    if let Some(cost) = measured.cost.filter(|cost| !cost.is_crooked()) {
        let (time, interval) = cost.at(texels);
        return spread(time, interval);
    }
    let here = measured
        .sizes
        .iter()
        .find(|f| FrameSize::Sides(f.size) == size)?;
    of_times(here.time.as_ref()?)
}

/// Returns the RMSE and the largest difference of a frame of a size: that of the nearest size at which they were
/// measured.
fn error(measured: &Measured, size: FrameSize) -> Option<[f64; 2]> {
    let found = match size.texels() {
        None => [measured.distance.rmse, measured.distance.max],
        Some(texels) => {
            let away = |frame: &&SizedFrame| {
                let of_frame = FrameSize::Sides(frame.size).texels().unwrap_or(1.0);
                (of_frame / texels).ln().abs()
            };
            let frames = measured.sizes.iter().filter(|f| f.distance.is_some());
            let nearest = frames.min_by(|a, b| away(a).total_cmp(&away(b)))?;
            let distance = nearest.distance?;
            [distance.rmse, distance.max]
        }
    };
    found
        .iter()
        .all(|e| usable(*e) && *e >= 0.0)
        .then_some(found)
}

/// Returns a limit of the frame time that some method can keep: a part of a frame on hardware, a whole one where the
/// processor draws.
fn default_budget(kind: DeviceKind) -> f64 {
    match kind {
        DeviceKind::Software => 0.02,
        DeviceKind::Hardware | DeviceKind::Unknown => 0.002,
    }
}

/// Returns the index of the size with which the page begins: the largest one up to 1920 by 1080 texels.
fn default_size(sizes: &[FrameSize]) -> usize {
    const FULL: f64 = 1920.0 * 1080.0;
    let fits = |size: &FrameSize| size.texels().is_none_or(|texels| texels <= FULL);
    sizes.iter().rposition(fits).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_are_compared_over_the_scenes_that_all_of_them_draw_if_there_are_any() {
        let drawn = |scenes: &[usize]| scenes.iter().map(|s| (*s, ())).collect();
        let kept = |methods: Vec<(&'static str, &[usize])>| -> Vec<(&str, Vec<usize>)> {
            let drawn = methods
                .into_iter()
                .map(|(name, scenes)| (name, drawn(scenes)));
            let mut methods: Vec<(&str, BTreeMap<usize, ()>)> = drawn.collect();
            keep_common(&mut methods);
            let scenes = methods.into_iter();
            scenes
                .map(|(name, p)| (name, p.into_keys().collect()))
                .collect()
        };
        let common = kept(vec![("a", &[0, 1, 2]), ("b", &[1, 2])]);
        assert_eq!(common, [("a", vec![1, 2]), ("b", vec![1, 2])]);
        let none = kept(vec![("a", &[0, 1]), ("b", &[2])]);
        assert_eq!(none, [("a", vec![0, 1]), ("b", vec![2])]);
    }
}
