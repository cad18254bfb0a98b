//! The bounds of viewports, which an implementation may round.

use crate::rules::Rules;
use etalon_scene::Viewport;

/// The viewports, by the bounds of one axis, to which an implementation can round a viewport.
///
/// Each bound is rounded by itself, to either side (Vulkan, Limits: viewportSubPixelBits).
pub(crate) fn rounded(
    viewport: &Viewport,
    axis: usize,
    rules: &Rules,
) -> impl Iterator<Item = Viewport> {
    let [start, length] = [axis, axis + 2].map(|i| f64::from(viewport.rect[i]));
    let [starts, ends] = [start, start + length].map(|bound| neighbours(bound, rules));
    let viewport = *viewport;
    let is_exact = starts == [start; 2] && ends == [start + length; 2];
    let pairs = starts.into_iter().flat_map(move |a| ends.map(|b| (a, b)));
    pairs.take(if is_exact { 1 } else { 4 }).map(move |(a, b)| {
        let mut moved = viewport;
        if !is_exact {
            (moved.rect[axis], moved.rect[axis + 2]) = (a as f32, (b - a) as f32);
        }
        moved
    })
}

/// Returns the number of texels by which rounding can move an edge of a viewport.
pub(crate) fn slack(viewport: &Viewport, rules: &Rules) -> f64 {
    let step = rules.viewport_step.value();
    let [x, y, w, h] = viewport.rect.map(f64::from);
    let is_exact = |bound: &f64| neighbours(*bound, rules) == [*bound; 2];
    if [x, y, x + w, y + h].iter().all(is_exact) {
        0.0
    } else {
        step
    }
}

/// Returns the values on either side to which a bound can be rounded.
fn neighbours(bound: f64, rules: &Rules) -> [f64; 2] {
    let step = rules.viewport_step.value();
    if step == 0.0 {
        return [bound; 2];
    }
    [(bound / step).floor(), (bound / step).ceil()].map(|steps| steps * step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_limits::limits;
    use etalon_frame::Api;

    fn widths(rect: [f32; 4], bits: u8) -> Vec<[f32; 2]> {
        let [vulkan, gl] = [Api::Vulkan, Api::OpenGl].map(|api| widths_by(api, rect, bits));
        assert_eq!(vulkan, gl);
        vulkan
    }

    fn widths_by(api: Api, rect: [f32; 4], bits: u8) -> Vec<[f32; 2]> {
        let mut limits = limits(api);
        limits.viewport_bits = Some(bits);
        let rules = Rules::of(&limits);
        let viewport = Viewport {
            rect,
            depth: [0.0, 1.0],
        };
        let each = rounded(&viewport, 0, &rules);
        each.map(|v| [v.rect[0], v.rect[2]]).collect()
    }

    #[test]
    fn a_bound_between_two_steps_becomes_either_and_one_on_a_step_stays() {
        assert_eq!(widths([1.0, 0.0, 3.0, 4.0], 0), [[1.0, 3.0]]);
        assert_eq!(widths([1.5, 0.0, 3.0, 4.0], 1), [[1.5, 3.0]]);
        let either = [[1.0, 3.0], [1.0, 4.0], [2.0, 2.0], [2.0, 3.0]];
        assert_eq!(widths([1.5, 0.0, 3.0, 4.0], 0), either);
    }
}
