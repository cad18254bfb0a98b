//! Labels of ticks, which keep apart on narrow screens too.

/// The size of texts on narrow screens, relative to their usual size (`chart.css`).
const NARROW: f64 = 16.0 / 14.0;

/// The least distance between labels of ticks, in chart units.
const TICK_GAP: f64 = 6.0;

/// Returns the labels of ticks on a horizontal axis with their middles. Leaves out a label that touches the one before
/// it, or that begins left of `start`.
pub(crate) fn tick_labels(
    start: f64,
    ticks: impl IntoIterator<Item = (f64, String)>,
) -> Vec<(f64, String)> {
    let mut free = start;
    let has_room = |(middle, text): &(f64, String)| {
        let half = tick_width(text) / 2.0;
        let fits = middle - half >= free;
        if fits {
            free = middle + half + TICK_GAP;
        }
        fits
    };
    ticks.into_iter().filter(has_room).collect()
}

/// Returns an upper bound of the width of a tick's label on narrow screens, where texts are larger.
pub(crate) fn tick_width(text: &str) -> f64 {
    text.chars().map(advance).sum::<f64>() * NARROW
}

/// Returns an upper bound of a letter's width, in sans-serif fonts of the size of labels.
pub(super) fn advance(letter: char) -> f64 {
    match letter {
        'm' | 'w' => 12.5,
        _ => 7.7,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_ticks_do_not_touch() {
        let ticks = || [(10.0, "0.01"), (40.0, "0.02"), (90.0, "0.05"), (130.0, "1")];
        let ticks = || ticks().map(|(middle, text)| (middle, text.to_owned()));
        let kept = |start| {
            tick_labels(start, ticks())
                .into_iter()
                .map(|(_, text)| text)
        };
        assert_eq!(kept(-20.0).collect::<Vec<_>>(), ["0.01", "0.05", "1"]);
        assert_eq!(kept(20.0).collect::<Vec<_>>(), ["0.02", "0.05", "1"]);
    }
}
