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
fn shard_of_process(flag: Option<Shard>) -> Result<Option<Shard>, Failure> {
    if let Some(shard) = flag {
        return Ok((shard.count > 1).then_some(shard));
    }
    let environment = from_environment(|name| std::env::var(name).ok())?;
    if let Some(path) = environment.status_file {
        // The file tells Bazel that the process supports sharding.
        fs::write(&path, "").map_err(|e| {
            Failure::usage(format!(
                "cannot write {}, which TEST_SHARD_STATUS_FILE names: {e}",
                path.display()
            ))
        })?;
    }
    Ok(environment.shard)
}

/// Keeps the cases of the shard that the flag or the environment gives, and prints their number.
pub(crate) fn retain_shard(
    flag: Option<Shard>,
    cases: &mut Vec<Case>,
) -> Result<Option<Shard>, Failure> {
    let shard = shard_of_process(flag)?;
    if let Some(shard) = shard {
        let selected = cases.len();
        cases.retain(|case| shard_of(&case.id, shard.count) == shard.index);
        say!("shard {shard}: {} of {selected} cases", cases.len());
    }
    Ok(shard)
}

/// The shard that the environment gives.
#[derive(Debug, Default, PartialEq, Eq)]
struct EnvironmentShard {
    /// The shard, if there are several.
    shard: Option<Shard>,
    /// A file to create, which tells Bazel that the process supports sharding.
    status_file: Option<PathBuf>,
}

/// Reads the variables of GitLab, Bazel, Slurm arrays and Kubernetes indexed jobs. `variable` looks up a
/// variable.
///
/// # Errors
/// If a variable is missing or wrong, or if two systems contradict each other.
fn from_environment(
    variable: impl Fn(&str) -> Option<String>,
) -> Result<EnvironmentShard, Failure> {
    let variables = Variables(&variable);
    let (gitlab, bazel) = (variables.gitlab()?, variables.bazel()?);
    let status_file = bazel.and_then(|_| variable("TEST_SHARD_STATUS_FILE").map(PathBuf::from));
    let systems = [
        ("GitLab", gitlab),
        ("Bazel", bazel),
        ("Slurm", variables.slurm()?),
        ("Kubernetes", variables.kubernetes()?),
    ];
    let systems = systems.into_iter();
    let shards: Vec<(&str, Shard)> = systems
        .filter_map(|(system, shard)| Some((system, shard?)))
        .collect();
    if let [(first, a), (other, b), ..] = shards.as_slice()
        && a != b
    {
        return Err(Failure::usage(format!(
            "{first} sets shard {a}, {other} shard {b}; give --shard M/N, or 1/1 for all"
        )));
    }
    Ok(EnvironmentShard {
        shard: shards.first().map(|(_, s)| *s).filter(|s| s.count > 1),
        status_file,
    })
}

/// The variables of CI and batch systems, which number shards in different ways.
struct Variables<'a>(&'a dyn Fn(&str) -> Option<String>);

impl Variables<'_> {
    fn number(&self, name: &str) -> Result<Option<u32>, Failure> {
        match (self.0)(name).filter(|v| !v.is_empty()) {
            None => Ok(None),
            Some(text) => text.parse().map(Some).map_err(|_| {
                Failure::usage(format!(
                    "the variable {name} is `{text}`, not a whole number; give --shard M/N, or 1/1 for all"
                ))
            }),
        }
    }

    /// Returns a system's shard. `index` counts from one, and is `None` if the variable `index_name` is no index.
    fn shard(
        &self,
        system: &str,
        index_name: &str,
        index: Option<u32>,
        count_name: &str,
    ) -> Result<Option<Shard>, Failure> {
        let Some(count) = self.number(count_name)? else {
            return Err(Failure::usage(format!(
                "{system} sets a shard, but {count_name} is not set; set it, or give --shard M/N"
            )));
        };
        let Some(index) = index.filter(|index| (1..=count).contains(index)) else {
            let text = (self.0)(index_name).unwrap_or_default();
            return Err(Failure::usage(format!(
                "{system} sets {index_name} to {text}, which is none of {count} shards; give --shard M/N"
            )));
        };
        Ok(Some(Shard { index, count }))
    }

    /// GitLab sets the total for every job, but the index only for parallel jobs.
    fn gitlab(&self) -> Result<Option<Shard>, Failure> {
        let name = "CI_NODE_INDEX";
        match self.number(name)? {
            Some(index) => self.shard("GitLab", name, Some(index), "CI_NODE_TOTAL"),
            None => Ok(None),
        }
    }

    fn bazel(&self) -> Result<Option<Shard>, Failure> {
        let name = "TEST_SHARD_INDEX";
        match self.number(name)? {
            Some(index) => self.shard("Bazel", name, index.checked_add(1), "TEST_TOTAL_SHARDS"),
            None => Ok(None),
        }
    }

    fn slurm(&self) -> Result<Option<Shard>, Failure> {
        let name = "SLURM_ARRAY_TASK_ID";
        let Some(id) = self.number(name)? else {
            return Ok(None);
        };
        let first = self.number("SLURM_ARRAY_TASK_MIN")?.unwrap_or(0);
        let step = self.number("SLURM_ARRAY_TASK_STEP")?.unwrap_or(1).max(1);
        let offset = id.checked_sub(first).filter(|n| n.is_multiple_of(step));
        let index = offset.and_then(|n| (n / step).checked_add(1));
        self.shard("Slurm", name, index, "SLURM_ARRAY_TASK_COUNT")
    }

    /// Kubernetes sets only the index; the job file sets the total.
    fn kubernetes(&self) -> Result<Option<Shard>, Failure> {
        let name = "JOB_COMPLETION_INDEX";
        match self.number(name)? {
            Some(index) => self.shard("Kubernetes", name, index.checked_add(1), "JOB_COMPLETIONS"),
            None => Ok(None),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn environment_shard(variables: &[(&str, &str)]) -> Result<Option<Shard>, String> {
        let find = |name: &str| {
            let value = variables.iter().find(|(n, _)| *n == name);
            value.map(|(_, value)| (*value).to_owned())
        };
        from_environment(find)
            .map(|a| a.shard)
            .map_err(|e| format!("{e:?}"))
    }

    #[test]
    fn every_system_gives_the_second_of_five_shards() {
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
            assert_eq!(
                environment_shard(variables),
                Ok(two_of_five),
                "{variables:?}"
            );
        }
        assert_eq!(environment_shard(&[]), Ok(None));
        // A GitLab job without `parallel`.
        assert_eq!(environment_shard(&[("CI_NODE_TOTAL", "1")]), Ok(None));
    }

    #[test]
    fn wrong_variables_are_refused_by_name() {
        for (variables, names) in [
            (
                &[("CI_NODE_INDEX", "6"), ("CI_NODE_TOTAL", "5")][..],
                "CI_NODE_INDEX to 6,",
            ),
            (
                &[("CI_NODE_INDEX", "0"), ("CI_NODE_TOTAL", "5")],
                "CI_NODE_INDEX to 0,",
            ),
            (&[("CI_NODE_INDEX", "1")], "CI_NODE_TOTAL is not set"),
            (
                &[("TEST_SHARD_INDEX", "x"), ("TEST_TOTAL_SHARDS", "5")],
                "the variable TEST_SHARD_INDEX is `x`",
            ),
            (
                &[
                    ("TEST_SHARD_INDEX", "4294967295"),
                    ("TEST_TOTAL_SHARDS", "5"),
                ],
                "TEST_SHARD_INDEX to 4294967295,",
            ),
            (
                &[("JOB_COMPLETION_INDEX", "1")],
                "JOB_COMPLETIONS is not set",
            ),
            (
                &[
                    ("SLURM_ARRAY_TASK_ID", "2"),
                    ("SLURM_ARRAY_TASK_MIN", "10"),
                    ("SLURM_ARRAY_TASK_COUNT", "5"),
                ],
                "SLURM_ARRAY_TASK_ID to 2,",
            ),
            (
                &[
                    ("SLURM_ARRAY_TASK_ID", "11"),
                    ("SLURM_ARRAY_TASK_MIN", "10"),
                    ("SLURM_ARRAY_TASK_STEP", "3"),
                    ("SLURM_ARRAY_TASK_COUNT", "5"),
                ],
                "SLURM_ARRAY_TASK_ID to 11,",
            ),
            (
                &[
                    ("CI_NODE_INDEX", "1"),
                    ("CI_NODE_TOTAL", "5"),
                    ("JOB_COMPLETION_INDEX", "1"),
                    ("JOB_COMPLETIONS", "5"),
                ],
                "GitLab sets shard 1/5, Kubernetes shard 2/5",
            ),
        ] {
            let error = environment_shard(variables).expect_err("the variables are wrong");
            assert!(error.contains(names), "{variables:?}: {error}");
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
