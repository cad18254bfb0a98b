//! The shortest condition on axes that separates the failing cases of a file from the other drawn cases.

use etalon_frame::CaseId;
use etalon_glob::Glob;
use std::collections::{BTreeMap, BTreeSet};

/// The maximum number of globs with which a condition is written.
const GLOBS: usize = 12;

/// A condition on axes: the values of each axis that matters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Condition {
    /// The axes in alphabetical order, each with its values; empty if every drawn case failed.
    pub axes: Vec<(String, Vec<String>)>,
    /// The number of failing cases.
    pub failing: usize,
    /// The number of drawn cases that meet the condition, including the failing ones.
    pub matching: usize,
}

impl Condition {
    /// Finds the condition for some failing cases of one case file, given the drawn cases.
    pub fn of(failing: &[&str], drawn: &[&str]) -> Self {
        let bad: BTreeSet<&str> = failing.iter().copied().collect();
        let drawn: Vec<(bool, BTreeMap<&str, &str>)> = drawn
            .iter()
            .map(|id| (bad.contains(id), axes(id)))
            .collect();
        // The values of each axis in the failing cases, and in all cases.
        let mut values: BTreeMap<&str, [BTreeSet<&str>; 2]> = BTreeMap::new();
        for (fails, axes) in &drawn {
            for (axis, value) in axes {
                let [of_bad, of_all] = values.entry(axis).or_default();
                of_all.insert(value);
                if *fails {
                    of_bad.insert(value);
                }
            }
        }
        let mut chosen: Vec<(&str, BTreeSet<&str>)> = values
            .into_iter()
            .filter(|(_, [of_bad, of_all])| of_bad.len() < of_all.len())
            .map(|(axis, [of_bad, _])| (axis, of_bad))
            .collect();
        let meets = |chosen: &[(&str, BTreeSet<&str>)], axes: &BTreeMap<&str, &str>| {
            chosen
                .iter()
                .all(|(axis, set)| axes.get(axis).is_none_or(|value| set.contains(value)))
        };
        let count = |chosen: &[(&str, BTreeSet<&str>)]| {
            drawn.iter().filter(|(_, axes)| meets(chosen, axes)).count()
        };
        let matching = count(&chosen);
        // Drops the least informative axes first, which have the most values.
        let mut order: Vec<&str> = chosen.iter().map(|(axis, _)| *axis).collect();
        order.sort_by_key(|axis| {
            std::cmp::Reverse(
                chosen
                    .iter()
                    .find(|(a, _)| a == axis)
                    .map_or(0, |(_, s)| s.len()),
            )
        });
        for axis in order {
            let without: Vec<_> = chosen.iter().filter(|(a, _)| *a != axis).cloned().collect();
            if count(&without) == matching {
                chosen = without;
            }
        }
        Self {
            axes: chosen
                .into_iter()
                .map(|(axis, set)| {
                    (
                        axis.to_owned(),
                        set.into_iter().map(str::to_owned).collect(),
                    )
                })
                .collect(),
            failing: bad.len(),
            matching,
        }
    }

    /// Returns true if every drawn case that meets the condition fails.
    pub fn is_exact(&self) -> bool {
        self.failing == self.matching
    }

    /// Returns the condition in words: `all of format=rgba8snorm: 41 of 41, none else`.
    pub fn text(&self) -> String {
        let axes: Vec<String> = self
            .axes
            .iter()
            .map(|(axis, values)| format!("{axis}={}", values.join("|")))
            .collect();
        let (failing, matching) = (self.failing, self.matching);
        if axes.is_empty() {
            return if self.is_exact() {
                format!("all that were drawn: {failing}")
            } else {
                format!("{failing} of the {matching} that were drawn")
            };
        }
        let which = if self.is_exact() { "all" } else { "some" };
        let axes = axes.join(", ");
        format!("{which} of {axes}: {failing} of {matching}, none else")
    }

    /// Returns globs that name the failing cases of a file and no other drawn case. Each glob names at least
    /// one case; `None` if too many would be needed.
    pub fn globs(&self, file: &str, failing: &[&str]) -> Option<Vec<String>> {
        if !self.is_exact() {
            return None;
        }
        if self.axes.is_empty() {
            return Some(vec![format!("{file}/*")]);
        }
        let mut globs = vec![etalon_glob::escape(file)];
        for (axis, values) in &self.axes {
            let parts = values.iter().map(|value| {
                format!(
                    "{}={}",
                    etalon_glob::escape(axis),
                    etalon_glob::escape(value)
                )
            });
            let parts: Vec<String> = parts.collect();
            // An axis can come directly after the prefix or after other axes, and is always a whole part of
            // the id.
            globs = globs
                .iter()
                .flat_map(|glob| {
                    let parts = parts.iter();
                    parts.flat_map(move |part| {
                        [format!("{glob}/{part}"), format!("{glob}/*/{part}")]
                    })
                })
                .filter(|glob| {
                    let longer = format!("{glob}/*");
                    failing
                        .iter()
                        .any(|id| names(glob, id) || names(&longer, id))
                })
                .collect();
            if globs.len() > GLOBS {
                return None;
            }
        }
        let ends = globs
            .iter()
            .flat_map(|glob| [glob.clone(), format!("{glob}/*")]);
        let ends = ends.filter(|glob| failing.iter().any(|id| names(glob, id)));
        Some(ends.collect())
    }
}

/// Returns true if a glob, in which `*` also matches `/`, matches an id.
fn names(glob: &str, id: &str) -> bool {
    Glob::new(glob).is_ok_and(|glob| glob.is_match(id))
}

fn axes(id: &str) -> BTreeMap<&str, &str> {
    CaseId::new(id).axes().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ids() -> Vec<String> {
        let mut ids = Vec::new();
        for dst in ["one", "one-minus-dst", "one-minus-src", "zero"] {
            for format in ["rgba8snorm", "rgba8unorm"] {
                for src in ["one", "zero"] {
                    ids.push(format!("blend/f/dst={dst}/format={format}/src={src}"));
                }
            }
        }
        ids
    }

    #[test]
    fn the_shortest_condition_is_found() {
        let ids = ids();
        let drawn: Vec<&str> = ids.iter().map(String::as_str).collect();
        let failing = |keep: &dyn Fn(&str) -> bool| -> Vec<&str> {
            drawn.iter().copied().filter(|id| keep(id)).collect()
        };
        let failed = failing(&|id| id.contains("snorm") && id.contains("one-minus"));
        let found = Condition::of(&failed, &drawn);
        assert_eq!(
            found.text(),
            "all of dst=one-minus-dst|one-minus-src, format=rgba8snorm: 4 of 4, none else"
        );
        let globs = found.globs("blend/f", &failed).unwrap();
        for glob in &globs {
            assert!(
                failed.iter().any(|id| names(glob, id)),
                "{glob} names nothing"
            );
        }
        for id in &drawn {
            assert_eq!(
                globs.iter().any(|glob| names(glob, id)),
                id.contains("snorm") && id.contains("one-minus"),
                "{id}: {globs:?}"
            );
        }
        let complete = Condition::of(&drawn, &drawn);
        assert_eq!(
            (complete.text(), complete.globs("blend/f", &drawn)),
            (
                "all that were drawn: 16".to_owned(),
                Some(vec!["blend/f/*".to_owned()])
            )
        );
        let some = Condition::of(&[drawn[0], drawn[7]], &drawn);
        assert!(!some.is_exact());
        assert_eq!(some.globs("blend/f", &drawn), None);
    }
    #[test]
    fn globs_of_a_condition_match_whole_axes_and_end_with_the_id() {
        let ids: Vec<String> = ["a", "b"]
            .into_iter()
            .flat_map(|x| ["a", "b"].map(|y| format!("f/back-mode={x}/mode={y}")))
            .collect();
        let drawn: Vec<&str> = ids.iter().map(String::as_str).collect();
        let globs = |failing: &[&str]| Condition::of(failing, &drawn).globs("f", failing);
        let back = globs(&[drawn[0], drawn[1]]);
        assert_eq!(back, Some(vec!["f/back-mode=a/*".to_owned()]));
        let front = globs(&[drawn[0], drawn[2]]);
        assert_eq!(front, Some(vec!["f/*/mode=a".to_owned()]));
    }
}
