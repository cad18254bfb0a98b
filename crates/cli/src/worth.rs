//! The order of cases by what they find per second, for runs with a time limit.

use etalon_case::Case;
use std::collections::HashMap;
#[cfg(feature = "mutants")]
use {
    crate::named_files::ORDER_HEAD, etalon_runner::Hunted, std::collections::HashSet,
    std::time::Duration,
};

/// The ids of the cases that together catch every planted bug. Each is the case with the most new bugs per second.
/// `etalon mutants --full --order cases/order.txt` writes it.
const ORDER: &str = include_str!("../data/order.txt");

/// The time that a driver takes for a case beyond what the rasterizer takes.
#[cfg(feature = "mutants")]
const OVERHEAD: Duration = Duration::from_millis(1);

/// Returns the ids of the order.
fn ids() -> impl Iterator<Item = &'static str> {
    ORDER.lines().filter(|line| !line.starts_with('#'))
}

/// Sorts cases: those of the order first, then the first case of each file, the second of each, and so on.
pub(crate) fn sort_by_worth(cases: &mut [Case]) {
    let ranks: HashMap<&str, usize> = (0..).zip(ids()).map(|(rank, id)| (id, rank)).collect();
    let mut counts: HashMap<&str, usize> = HashMap::new();
    let places: HashMap<String, (bool, usize)> = cases
        .iter()
        .map(|case| {
            let place = match ranks.get(&*case.id) {
                Some(rank) => (false, *rank),
                None => {
                    let count = counts.entry(case.parts().file()).or_default();
                    *count += 1;
                    (true, *count)
                }
            };
            (case.id.clone(), place)
        })
        .collect();
    cases.sort_by_key(|case| places.get(&case.id).copied());
}

/// Returns the file with the order that a hunt gives of its quick cases. It must have drawn every case with every bug.
#[cfg(feature = "mutants")]
pub(crate) fn order(cases: &[Case], is_quick: &[bool], hunted: &Hunted) -> String {
    let mut left: HashSet<usize> = (0..hunted.records.len()).collect();
    let quick: Vec<usize> = (0..cases.len()).filter(|n| is_quick[*n]).collect();
    let mut text =
        format!("{ORDER_HEAD}# Written by: etalon mutants --full --order cases/order.txt\n");
    loop {
        let worth = |number: usize| {
            let catches = &hunted.catches[number];
            let caught = catches.bugs.iter().filter(|bug| left.contains(bug)).count();
            caught as f64 / (OVERHEAD + catches.cost).as_secs_f64()
        };
        let best = quick.iter().map(|number| (*number, worth(*number)));
        let best = best.reduce(|best, other| if other.1 > best.1 { other } else { best });
        let Some((best, worth)) = best else { break };
        if worth == 0.0 {
            break;
        }
        for bug in &hunted.catches[best].bugs {
            left.remove(bug);
        }
        text.push_str(&cases[best].id);
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_of_the_order_exists() {
        let library = crate::cases::library(None).expect("the built-in cases");
        let known = crate::cases::ids_of(&library);
        for id in ids() {
            assert!(
                known.iter().any(|k| k == id),
                "{id} is no case: write cases/order.txt again with `etalon mutants --full --order cases/order.txt`"
            );
        }
        assert!(ids().count() > 100);
    }
}
