//! The method to choose within a budget, as a sentence. The page's script says the same for other budgets.

use super::Candidate;
use crate::methods::name::in_words;
use crate::methods::scatter::ROUNDING;
use crate::numbers::{between, round_duration, share};
use etalon_methods::Order;

/// The limits of a choice.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MethodBudget {
    /// The longest frame time in seconds.
    pub(super) time: Option<f64>,
    /// The largest RMSE.
    pub(super) error: Option<f64>,
}

/// Two errors are equal if they differ by less than this factor, or if both are below what rounding to 8 bits costs.
const ALIKE: f64 = 1.05;

fn worst_alike(error: f64) -> f64 {
    (error * ALIKE).max(ROUNDING)
}

/// A choice among candidates, by their indices.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Choice {
    /// No candidate was timed.
    Unknown,
    /// No candidate keeps the budget; this one is the fastest with the right error, or of all.
    Nothing(usize),
    /// The best one; several if their times cannot tell which.
    Best(Vec<usize>),
}

/// Returns the best methods within a budget: the fastest ones if an error is given, else the most accurate ones, and of
/// equally accurate ones the fastest.
pub(super) fn choose(candidates: &[Candidate<'_>], budget: MethodBudget) -> Choice {
    let every = || {
        (0..candidates.len()).filter(|i| {
            budget
                .error
                .is_none_or(|most| candidates[*i].error[1] <= most)
        })
    };
    let fastest = |of: &mut dyn Iterator<Item = usize>| {
        of.min_by(|a, b| candidates[*a].time[1].total_cmp(&candidates[*b].time[1]))
    };
    let most = budget.time.unwrap_or(f64::INFINITY);
    let within = |latest: fn(&Candidate<'_>) -> f64| {
        every().filter(move |i| latest(&candidates[*i]) <= most)
    };
    let sure: Vec<usize> = within(slowest).collect();
    let possible: Vec<usize> = within(quickest).collect();
    if possible.is_empty() {
        let first = fastest(&mut every()).or_else(|| fastest(&mut (0..candidates.len())));
        return first.map_or(Choice::Unknown, Choice::Nothing);
    }
    let error = |i: usize| candidates[i].error[1];
    let base = if sure.is_empty() { &possible } else { &sure };
    let least = base.iter().map(|i| error(*i)).fold(f64::INFINITY, f64::min);
    let alike: Vec<usize> = match budget.error {
        Some(_) => base.clone(),
        None => base
            .iter()
            .copied()
            .filter(|i| error(*i) <= worst_alike(least))
            .collect(),
    };
    let Some(best) = fastest(&mut alike.iter().copied()) else {
        return Choice::Unknown;
    };
    // Others can be faster, or would be better if they kept the budget.
    let can_be_faster = |i: &usize| quickest(&candidates[*i]) <= slowest(&candidates[best]);
    let is_better = |i: &usize| match budget.error {
        Some(_) => can_be_faster(i),
        None => worst_alike(error(*i)) < least,
    };
    let unsure = possible
        .iter()
        .filter(|i| !sure.contains(i))
        .filter(|i| is_better(i));
    let mut chosen = vec![best];
    chosen.extend(
        alike
            .iter()
            .filter(|i| **i != best)
            .filter(|i| can_be_faster(i)),
    );
    chosen.extend(unsure.filter(|i| !alike.contains(i)));
    Choice::Best(chosen)
}

/// The factor between the times of a method in two runs of one machine that the interval of one run does not show: three
/// quarters of 360 times of ten runs lie within it.
const ANOTHER_RUN: f64 = 1.06;

/// Returns the shortest time that another run could find.
fn quickest(candidate: &Candidate<'_>) -> f64 {
    candidate.time[0] / ANOTHER_RUN
}

/// Returns the longest time that another run could find.
fn slowest(candidate: &Candidate<'_>) -> f64 {
    candidate.time[2] * ANOTHER_RUN
}

/// Returns the sentence of a question: within the budget, `place` being the frame's size and the adapter, this method.
pub(super) fn sentence(candidates: &[Candidate<'_>], budget: MethodBudget, place: &str) -> String {
    let limits: Vec<String> = [budget.time.map(round_duration), budget.error.map(share)]
        .into_iter()
        .flatten()
        .collect();
    let head = match limits.as_slice() {
        [] => format!("At {place}"),
        limits => format!("Within {} at {place}", limits.join(" and ")),
    };
    let (best, first) = match choose(candidates, budget) {
        Choice::Unknown => return format!("{head}: not timed."),
        Choice::Nothing(fastest) => {
            let text = figures(&candidates[fastest]);
            return format!("{head}: nothing. The fastest is {text}.");
        }
        Choice::Best(best) => {
            let text = either(candidates, &best);
            (best, text)
        }
    };
    let any_order = any_order(candidates, &best, budget);
    let free = match any_order.as_slice() {
        [] => String::new(),
        some => format!("; in any order: {}", either(candidates, some)),
    };
    let named: Vec<usize> = best.into_iter().chain(any_order).collect();
    let exact = exact(candidates, &named);
    format!("{head}: {first}{free}{exact}.")
}

/// Returns a method with its error and its time.
fn figures(candidate: &Candidate<'_>) -> String {
    let [low, error, high] = candidate.error;
    let range = if candidate.scenes.len() > 1 && low < high {
        format!(
            " ({} over {} scenes)",
            between([low, high], share),
            candidate.scenes.len()
        )
    } else {
        String::new()
    };
    let error = match error {
        0.0 => "no error".to_owned(),
        error if candidate.scenes.len() > 1 => format!("median error {}", share(error)),
        error => format!("error {}", share(error)),
    };
    format!(
        "{}, {error}{range}, {}",
        in_words(candidate.method),
        round_duration(candidate.time[1])
    )
}

/// Returns the figures of one method, or of two if times cannot tell which is the best; of more, how many they
/// are and the figures of the first.
fn either(candidates: &[Candidate<'_>], some: &[usize]) -> String {
    let one = |i: usize| figures(&candidates[i]);
    match *some {
        [only] => one(only),
        [first, second] => format!("either {}; or {}", one(first), one(second)),
        _ => format!(
            "one of {} that cannot be told apart, such as {}",
            some.len(),
            one(some[0])
        ),
    }
}

/// Returns the best methods within the budget that need no order; none if one was named.
fn any_order(candidates: &[Candidate<'_>], named: &[usize], budget: MethodBudget) -> Vec<usize> {
    let is_free = |c: &Candidate<'_>| c.order.is_none_or(|order| order == Order::Independent);
    if named.iter().any(|i| is_free(&candidates[*i])) {
        return Vec::new();
    }
    let places: Vec<usize> = (0..candidates.len())
        .filter(|i| is_free(&candidates[*i]))
        .collect();
    let free: Vec<Candidate<'_>> = places.iter().map(|i| candidates[*i].clone()).collect();
    match choose(&free, budget) {
        Choice::Best(best) => best.into_iter().map(|i| places[i]).collect(),
        Choice::Unknown | Choice::Nothing(_) => Vec::new(),
    }
}

/// Returns the end of a sentence: the fastest exact method that needs no sorting, unless it was named.
fn exact(candidates: &[Candidate<'_>], named: &[usize]) -> String {
    let has_order = candidates.iter().any(|c| c.order.is_some());
    let fits =
        |c: &Candidate<'_>| c.is_exact && (!has_order || c.order == Some(Order::Independent));
    if named.iter().any(|i| fits(&candidates[*i])) {
        return String::new();
    }
    let exact = candidates.iter().filter(|c| fits(c));
    let fastest = exact.min_by(|a, b| a.time[1].total_cmp(&b.time[1]));
    let name = if has_order {
        "exact and order-independent"
    } else {
        "exact"
    };
    fastest.map_or_else(String::new, |c| {
        format!(
            "; {name}: {}, {}",
            in_words(c.method),
            round_duration(c.time[1])
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(method: &'static str, time: [f64; 3], error: f64) -> Candidate<'static> {
        Candidate {
            method,
            order: None,
            time,
            error: [error; 3],
            is_exact: error < 0.001,
            scenes: vec![0],
        }
    }

    fn at(method: &'static str, time: f64, error: f64) -> Candidate<'static> {
        candidate(method, [time; 3], error)
    }

    fn within(time: f64) -> MethodBudget {
        MethodBudget {
            time: Some(time),
            error: None,
        }
    }

    #[test]
    fn the_sentence_keeps_the_budget() {
        let candidates = [
            at("rough", 0.0002, 0.2),
            Candidate {
                error: [0.004, 0.018, 0.061],
                scenes: (0..7).collect(),
                ..at("weighted", 0.0003, 0.018)
            },
            at("slow", 0.02, 0.1),
            at("lists", 0.0025, 0.0),
        ];
        let say = |budget| sentence(&candidates, budget, "1920\u{d7}1080 on gpu");
        assert_eq!(
            say(within(0.002)),
            "Within 2 ms at 1920\u{d7}1080 on gpu: weighted, median error 1.8\u{a0}% (0.4\u{a0}% to 6.1\u{a0}% over 7 scenes), 300 µs; \
             exact: lists, 2.5 ms."
        );
        assert!(say(within(0.01)).ends_with("gpu: lists, no error, 2.5 ms."));
        assert_eq!(
            say(within(0.0001)),
            "Within 100 µs at 1920\u{d7}1080 on gpu: nothing. The fastest is rough, error 20\u{a0}%, 200 µs."
        );
        let cheap = MethodBudget {
            time: None,
            error: Some(0.1),
        };
        assert!(say(cheap).starts_with("Within 10\u{a0}% at 1920\u{d7}1080 on gpu: weighted"));
        assert_eq!(
            sentence(&[], within(1.0), "p"),
            "Within 1 s at p: not timed."
        );
    }

    #[test]
    fn of_equally_accurate_methods_the_fastest_is_chosen() {
        let close = [
            at("a", 0.003, 0.0100),
            at("b", 0.001, 0.0102),
            at("c", 0.0005, 0.02),
        ];
        assert_eq!(choose(&close, within(0.01)), Choice::Best(vec![1]));
        // Both are below what rounding costs.
        let exact = [at("a", 0.003, 0.0), at("b", 0.001, 0.001)];
        assert_eq!(choose(&exact, within(0.01)), Choice::Best(vec![1]));
    }

    #[test]
    fn what_times_cannot_tell_is_said() {
        let unsure = [
            candidate("a", [0.0018, 0.0019, 0.0021], 0.001),
            at("b", 0.001, 0.1),
            candidate("c", [0.0009, 0.0011, 0.0012], 0.1),
        ];
        // The first keeps the budget or not; the other two are equally accurate, and one may be faster.
        assert_eq!(choose(&unsure, within(0.002)), Choice::Best(vec![1, 2, 0]));
        assert_eq!(choose(&unsure, within(0.0023)), Choice::Best(vec![0]));
        assert_eq!(choose(&unsure, within(0.0011)), Choice::Best(vec![1]));
        let text = sentence(&unsure[1..], within(0.002), "p");
        assert!(
            text.contains("either b, error 10\u{a0}%, 1 ms; or c, error 10\u{a0}%, 1.1 ms"),
            "{text}"
        );
        let text = sentence(&unsure, within(0.002), "p");
        assert!(
            text.contains("one of 3 that cannot be told apart, such as b, error 10\u{a0}%, 1 ms."),
            "{text}"
        );
    }

    #[test]
    fn an_exact_method_that_needs_sorting_is_not_the_exact_one_to_name() {
        let with = |order, c: Candidate<'static>| Candidate {
            order: Some(order),
            ..c
        };
        let candidates = [
            with(Order::Sorted, at("sorted", 0.001, 0.0)),
            with(Order::Independent, at("lists", 0.004, 0.0)),
            with(Order::Independent, at("weighted", 0.0015, 0.02)),
        ];
        let text = sentence(&candidates, within(0.002), "p");
        assert_eq!(
            text,
            "Within 2 ms at p: sorted, no error, 1 ms; in any order: weighted, error 2\u{a0}%, 1.5 ms; exact and \
             order-independent: lists, 4 ms."
        );
    }
}
