//! The shard of this process: from the flag, or from the environment variables of CI and batch systems.

use crate::failure::Failure;
use crate::output::say;
use etalon_case::Case;
use etalon_record::{Shard, shard_of};
use std::fs;
use std::path::PathBuf;

/// Parses the argument of `--shard`, such as `2/5`.
pub(crate) fn parse(text: &str) -> Result<Shard, String> {
    let wrong = || "expected M/N with 1 <= M <= N, such as 2/5".to_owned();
    let (index, count) = text.split_once('/').ok_or_else(wrong)?;
    let number = |t: &str| t.parse::<u32>().map_err(|_| wrong());
    let shard = Shard {
        index: number(index)?,
        count: number(count)?,
    };
    (1..=shard.count)
        .contains(&shard.index)
        .then_some(shard)
        .ok_or_else(wrong)
}

/// Returns the shard that the flag or the environment gives; `None` if it is all cases.
fn chosen(flag: Option<Shard>) -> Result<Option<Shard>, Failure> {
    if let Some(shard) = flag {
        return Ok((shard.count > 1).then_some(shard));
    }
    let given = from_environment(|name| std::env::var(name).ok())?;
    if let Some(path) = given.status_file {
        // The file tells Bazel that the process supports sharding.
        fs::write(&path, "").map_err(|e| {
            Failure::usage(format!(
                "cannot write {}, which TEST_SHARD_STATUS_FILE names: {e}",
                path.display()
            ))
        })?;
    }
    Ok(given.shard)
}

/// Keeps the cases of the shard that the flag or the environment gives, and prints their number.
pub(crate) fn keep(flag: Option<Shard>, cases: &mut Vec<Case>) -> Result<Option<Shard>, Failure> {
    let shard = chosen(flag)?;
    if let Some(shard) = shard {
        let selected = cases.len();
        cases.retain(|case| shard_of(&case.id, shard.count) == shard.index);
        say!("shard {shard}: {} of {selected} cases", cases.len());
    }
    Ok(shard)
}

/// The shard that the environment gives.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct FromEnvironment {
    /// The shard, if there are several.
    pub(crate) shard: Option<Shard>,
    /// A file to create, which tells Bazel that the process supports sharding.
    pub(crate) status_file: Option<PathBuf>,
}

/// Reads the variables of GitLab, Bazel, Slurm arrays and Kubernetes indexed jobs. `variable` looks up a
/// variable.
///
/// # Errors
/// If the variables contradict each other.
pub(crate) fn from_environment(
    variable: impl Fn(&str) -> Option<String>,
) -> Result<FromEnvironment, Failure> {
    let number = |name: &str| -> Result<Option<u32>, Failure> {
        match variable(name).filter(|v| !v.is_empty()) {
            None => Ok(None),
            Some(text) => text.parse().map(Some).map_err(|_| {
                Failure::usage(format!(
                    "the variable {name} is `{text}`, not a whole number; give --shard M/N, or 1/1 for all"
                ))
            }),
        }
    };
    let mut found: Vec<(&str, Shard)> = Vec::new();
    let mut add = |system: &'static str,
                   index: Option<u32>,
                   count: Option<u32>,
                   count_name: &str| {
        let (Some(index), Some(count)) = (index, count) else {
            return Err(Failure::usage(format!(
                "{system} sets a shard, but {count_name} is not set; set it, or give --shard M/N"
            )));
        };
        if !(1..=count).contains(&index) {
            return Err(Failure::usage(format!(
                "{system} sets shard {index} of {count}; give --shard M/N"
            )));
        }
        found.push((system, Shard { index, count }));
        Ok(())
    };
    // GitLab sets the total for every job, but the index only for parallel jobs.
    if let Some(index) = number("CI_NODE_INDEX")? {
        add(
            "GitLab",
            Some(index),
            number("CI_NODE_TOTAL")?,
            "CI_NODE_TOTAL",
        )?;
    }
    let mut status_file = None;
    if let Some(index) = number("TEST_SHARD_INDEX")? {
        let index = index.checked_add(1);
        add(
            "Bazel",
            index,
            number("TEST_TOTAL_SHARDS")?,
            "TEST_TOTAL_SHARDS",
        )?;
        status_file = variable("TEST_SHARD_STATUS_FILE").map(PathBuf::from);
    }
    if let Some(id) = number("SLURM_ARRAY_TASK_ID")? {
        let first = number("SLURM_ARRAY_TASK_MIN")?.unwrap_or(0);
        let step = number("SLURM_ARRAY_TASK_STEP")?.unwrap_or(1).max(1);
        let count = number("SLURM_ARRAY_TASK_COUNT")?;
        let index = id.checked_sub(first).map(|n| n / step + 1);
        let is_exact = id >= first && (id - first).is_multiple_of(step);
        add(
            "Slurm",
            index.filter(|_| is_exact),
            count,
            "SLURM_ARRAY_TASK_COUNT",
        )?;
    }
    if let Some(index) = number("JOB_COMPLETION_INDEX")? {
        // Kubernetes sets only the index; the job file sets the total.
        let index = index.checked_add(1);
        add(
            "Kubernetes",
            index,
            number("JOB_COMPLETIONS")?,
            "JOB_COMPLETIONS",
        )?;
    }
    if let [(first, a), (other, b), ..] = found.as_slice()
        && a != b
    {
        return Err(Failure::usage(format!(
            "{first} sets shard {a}, {other} shard {b}; give --shard M/N, or 1/1 for all"
        )));
    }
    Ok(FromEnvironment {
        shard: found.first().map(|(_, s)| *s).filter(|s| s.count > 1),
        status_file,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given_by(variables: &[(&str, &str)]) -> Result<Option<Shard>, String> {
        let find = |name: &str| {
            let found = variables.iter().find(|(n, _)| *n == name);
            found.map(|(_, value)| (*value).to_owned())
        };
        from_environment(find)
            .map(|a| a.shard)
            .map_err(|e| format!("{e:?}"))
    }

    #[test]
    fn shard_variables_of_each_system_are_understood() {
        let two_of_five = Some(Shard { index: 2, count: 5 });
        for variables in [
            &[("CI_NODE_INDEX", "2"), ("CI_NODE_TOTAL", "5")][..],
            &[("TEST_SHARD_INDEX", "1"), ("TEST_TOTAL_SHARDS", "5")],
            &[
                ("SLURM_ARRAY_TASK_ID", "13"),
                ("SLURM_ARRAY_TASK_MIN", "10"),
                ("SLURM_ARRAY_TASK_STEP", "3"),
                ("SLURM_ARRAY_TASK_COUNT", "5"),
            ],
            &[
                ("SLURM_ARRAY_TASK_ID", "1"),
                ("SLURM_ARRAY_TASK_MIN", "0"),
                ("SLURM_ARRAY_TASK_COUNT", "5"),
            ],
            &[("JOB_COMPLETION_INDEX", "1"), ("JOB_COMPLETIONS", "5")],
        ] {
            assert_eq!(given_by(variables), Ok(two_of_five), "{variables:?}");
        }
        assert_eq!(given_by(&[]), Ok(None));
        // A GitLab job without `parallel`.
        assert_eq!(given_by(&[("CI_NODE_TOTAL", "1")]), Ok(None));
    }

    #[test]
    fn contradictory_shard_variables_are_refused() {
        for variables in [
            &[("CI_NODE_INDEX", "6"), ("CI_NODE_TOTAL", "5")][..],
            &[("CI_NODE_INDEX", "0"), ("CI_NODE_TOTAL", "5")],
            &[("TEST_SHARD_INDEX", "x"), ("TEST_TOTAL_SHARDS", "5")],
            &[
                ("TEST_SHARD_INDEX", "4294967295"),
                ("TEST_TOTAL_SHARDS", "5"),
            ],
            &[("JOB_COMPLETION_INDEX", "1")],
            &[
                ("SLURM_ARRAY_TASK_ID", "2"),
                ("SLURM_ARRAY_TASK_MIN", "10"),
                ("SLURM_ARRAY_TASK_COUNT", "5"),
            ],
            &[
                ("CI_NODE_INDEX", "1"),
                ("CI_NODE_TOTAL", "5"),
                ("JOB_COMPLETION_INDEX", "1"),
                ("JOB_COMPLETIONS", "5"),
            ],
        ] {
            assert!(given_by(variables).is_err(), "{variables:?}");
        }
    }

    #[test]
    fn the_shard_flag_counts_from_one() {
        assert_eq!(parse("2/5"), Ok(Shard { index: 2, count: 5 }));
        for text in ["0/5", "6/5", "1", "1/0", "-1/5", "1/5/6", "a/b"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }
}
