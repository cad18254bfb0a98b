//! Small curves of a score over runs.

use crate::chart::n;
use crate::numbers::percent;
use etalon_stats::Score;
use maud::{Markup, html};

const WIDTH: usize = 120;
const HEIGHT: f64 = 18.0;
/// The maximum number of points of a curve. A point that stands for several runs shows the worst.
const POINTS: usize = 60;

/// Returns true if the score differs between runs.
pub(super) fn moves(scores: &[Score]) -> bool {
    scores.windows(2).any(|pair| pair[0].good != pair[1].good)
}

/// Returns the curve of scores with the same denominator, oldest first. Its height spans the lowest to the
/// highest score.
pub(super) fn sparkline(scores: &[Score]) -> Markup {
    let good = |score: &Score| score.good;
    let (low, high) = (
        scores.iter().map(good).min().unwrap_or(0),
        scores.iter().map(good).max().unwrap_or(0),
    );
    let span = (high - low).max(1) as f64;
    let points: Vec<usize> = match scores.len() {
        0..=POINTS => scores.iter().map(good).collect(),
        count => (0..POINTS)
            .map(|i| &scores[i * count / POINTS..(i + 1) * count / POINTS])
            .map(|part| part.iter().map(good).min().unwrap_or(0))
            .collect(),
    };
    let step = WIDTH as f64 / points.len().max(2).saturating_sub(1) as f64;
    let y = |good: usize| 2.0 + (high - good) as f64 / span * (HEIGHT - 4.0);
    let mut path = String::new();
    let mut before = None;
    for (i, good) in points.iter().enumerate() {
        let (x, y) = (n(i as f64 * step), n(y(*good)));
        match before {
            None => path.push_str(&format!("M{x} {y}")),
            // The curve has steps, because a score is valid until the next run. A constant score needs no
            // further point.
            Some(last) if last == *good => {}
            Some(_) => path.push_str(&format!("H{x}V{y}")),
        }
        before = Some(*good);
    }
    path += &format!("H{WIDTH}");
    let view = format!("0 0 {WIDTH} {HEIGHT}");
    html! {
        svg.spark viewBox=(view) width=(WIDTH) height=(HEIGHT) role="img" {
            title { (words(scores)) }
            path d=(path) {}
        }
    }
}

/// Returns the curve in words.
fn words(scores: &[Score]) -> String {
    let share = |score: Option<&Score>| {
        let share = score.and_then(|score| score.share());
        share.map_or_else(|| "nothing".to_owned(), |share| percent(share, 1))
    };
    let least = scores.iter().min_by_key(|score| score.good);
    let (first, last, least) = (share(scores.first()), share(scores.last()), share(least));
    if moves(scores) {
        format!("from {first} to {last} good, at least {least}")
    } else {
        format!("{last} good in all runs")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(good: &[usize]) -> String {
        let scores: Vec<Score> = good
            .iter()
            .map(|good| Score {
                good: *good,
                of: 10,
            })
            .collect();
        sparkline(&scores).into_string()
    }

    #[test]
    fn a_curve_has_steps_and_says_what_it_shows() {
        let text = curve(&[10, 10, 8, 9, 10]);
        assert!(text.contains("M0 2H60V16H90V9H120V2H120"), "{text}");
        assert!(
            text.contains("from 100 % to 100 % good, at least 80.0 %"),
            "{text}"
        );
        assert!(curve(&[5, 5]).contains("50.0 % good in all runs"));
        for short in [&[][..], &[3]] {
            assert!(curve(short).contains("<svg"));
        }
    }

    #[test]
    fn a_dip_of_one_run_of_many_is_seen() {
        let mut good = vec![10; 1000];
        good[500] = 0;
        assert!(curve(&good).contains("V16H"), "{}", curve(&good));
    }
}
