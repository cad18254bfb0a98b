//! Simplifies numbers: to 0, 1, a half, or fewer digits.

use super::words::walk;
use crate::edit::{Edit, EditStep, Pointer, pointer, value_at};
use serde_json::{Value, json};

/// The keys of numbers that have their own pass, or are not values.
const NOT_VALUES: [&str; 6] = ["size", "samples", "before", "indices", "positions", "cells"];
/// The longest list whose numbers are tried one by one.
const LONGEST: usize = 16;

/// Simplifies all numbers of a scene: lists as a whole, then each number.
pub(crate) fn numbers(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let mut lists: Vec<Pointer> = Vec::new();
    let mut singles: Vec<(Pointer, f64)> = Vec::new();
    walk(
        &document["scene"],
        pointer!["scene"],
        &mut |pointer, value| {
            let named = |step: &EditStep| matches!(step, EditStep::Key(key) if NOT_VALUES.contains(&key.as_str()));
            let Some(number) = value.as_f64().filter(|_| !pointer.iter().any(named)) else {
                return;
            };
            singles.push((pointer.clone(), number));
            if let Some((EditStep::Item(_), list)) = pointer.split_last()
                && lists.last().is_none_or(|last| last != list)
            {
                lists.push(list.to_vec());
            }
        },
    );
    let mut edits = Vec::new();
    for list in &lists {
        let Some(Value::Array(items)) = value_at(document, list) else {
            continue;
        };
        if !items.iter().all(Value::is_number) {
            continue;
        }
        // Four equal numbers are written as one, in keys that accept this.
        if items.len() == 4 && items.iter().all(|item| *item == items[0]) {
            edits.push(Edit::replacement(list.clone(), items[0].clone()));
        }
        let rank = |items: &[Value]| {
            items
                .iter()
                .filter_map(Value::as_f64)
                .map(cost)
                .sum::<u32>()
        };
        for simple in [0, 1] {
            let alike = vec![json!(simple); items.len()];
            if rank(&alike) < rank(items) {
                edits.push(Edit::replacement(list.clone(), alike));
            }
        }
    }
    for (pointer, number) in singles {
        let length = pointer.split_last().map_or(0, |(_, parent)| {
            value_at(document, parent)
                .and_then(Value::as_array)
                .map_or(0, Vec::len)
        });
        if length <= LONGEST {
            let simple = simpler(number).into_iter();
            edits.extend(simple.map(|n| Edit::replacement(pointer.clone(), n)));
        }
    }
    // Drops edits that change nothing or do not apply.
    edits.retain(|edit| edit.apply(document).is_some());
    edits
}

/// The simplest numbers, in order.
const SIMPLEST: [f64; 5] = [0.0, 1.0, 0.5, -1.0, 255.0];

/// Returns the cost of a number: small for simple ones.
fn cost(number: f64) -> u32 {
    let known = SIMPLEST.iter().position(|s| *s == number);
    known.map_or_else(
        || 10 + number.to_string().len() as u32,
        |position| position as u32,
    )
}

/// Returns the numbers that may replace a number, the simplest first.
fn simpler(number: f64) -> Vec<Value> {
    let rounded = [1.0, 10.0, 100.0].map(|digits| (number * digits).round() / digits);
    let mut numbers: Vec<f64> = Vec::new();
    for other in SIMPLEST.into_iter().chain(rounded) {
        // An integer may have to stay an integer.
        let fits = number.fract() != 0.0 || other.fract() == 0.0 || number == 1.0;
        if fits && cost(other) < cost(number) && !numbers.contains(&other) {
            numbers.push(other);
        }
    }
    let value = |number: f64| {
        if number.fract() == 0.0 {
            json!(number as i64)
        } else {
            json!(number)
        }
    };
    numbers.into_iter().map(value).collect()
}

/// Returns a pointer to a key of the scene.
#[cfg(test)]
fn scene_pointer(key: &str) -> Pointer {
    pointer!["scene", key]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_lose_digits_and_become_common() {
        assert_eq!(simpler(0.0), Vec::<Value>::new());
        assert_eq!(simpler(1.0), [json!(0)]);
        assert_eq!(simpler(37.0), [json!(0), json!(1), json!(-1), json!(255)]);
        let expected = [0.0, 1.0, 0.5, -1.0, 255.0, 0.6, 0.62].map(|n: f64| {
            if n.fract() == 0.0 {
                json!(n as i64)
            } else {
                json!(n)
            }
        });
        assert_eq!(simpler(0.6215), expected);
    }

    #[test]
    fn lists_are_tried_as_a_whole_and_sizes_never() {
        let document =
            json!({ "scene": { "size": [3, 3], "color": [1, 1, 1, 1], "rect": [2, 7] } });
        let edits = numbers(&document, None);
        assert!(edits.contains(&Edit::replacement(scene_pointer("color"), 1)));
        assert!(edits.contains(&Edit::replacement(scene_pointer("rect"), json!([0, 0]))));
        let touches = |edit: &Edit| {
            edit.replace
                .iter()
                .any(|(p, _)| p.starts_with(&scene_pointer("size")))
        };
        assert!(!edits.iter().any(touches));
    }
}
