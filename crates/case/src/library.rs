//! Sets of case files.

use crate::error::CaseError;
use crate::file::{CaseFile, CaseRef, Profile};
use crate::file_text::{text_of, unreadable};
use crate::redundant::Redundant;
use etalon_methods::Model;
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, OnceLock};

const BUILT_IN: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/case_files.rs"));

/// A file of a library.
#[derive(Debug)]
enum Entry {
    /// A file that was compiled in. It is parsed when its cases are first asked for.
    BuiltIn {
        name: &'static str,
        text: &'static str,
        parsed: OnceLock<CaseFile>,
    },
    Read(CaseFile),
}

impl Entry {
    fn stem(&self) -> &str {
        match self {
            Self::BuiltIn { name, .. } => name.strip_suffix(".json").unwrap_or(name),
            Self::Read(file) => file.stem(),
        }
    }

    fn file(&self) -> &CaseFile {
        match self {
            Self::BuiltIn { name, text, parsed } => parsed.get_or_init(|| {
                let file = CaseFile::parse(name, text).expect("tests parse all built-in files");
                Redundant::built_in().of(file)
            }),
            Self::Read(file) => file,
        }
    }
}

/// Case files, in ascending order of their paths. A clone is cheap.
#[derive(Clone, Debug)]
pub struct Library {
    entries: Arc<[Entry]>,
}

impl Library {
    /// Returns the case files that were compiled in. Each is parsed at most once per process.
    pub fn built_in() -> &'static Self {
        static LIBRARY: LazyLock<Library> = LazyLock::new(|| {
            let entries = BUILT_IN.iter().map(|(name, text)| Entry::BuiltIn {
                name,
                text,
                parsed: OnceLock::new(),
            });
            Library {
                entries: entries.collect(),
            }
        });
        &LIBRARY
    }

    /// Returns the cases of a scene of one's own: every question that it can answer, by every method.
    ///
    /// # Errors
    /// If the name is no part of an id.
    pub fn of_model(name: &str, model: Arc<Model>) -> Result<Self, CaseError> {
        let questions = model.questions();
        let file = |(question, methods): &(&str, Vec<&str>)| {
            CaseFile::of_model((*question, methods), name, Arc::clone(&model)).map(Entry::Read)
        };
        let mut entries = questions.iter().map(file).collect::<Result<Vec<_>, _>>()?;
        entries.sort_by(|a, b| a.stem().cmp(b.stem()));
        Ok(Self {
            entries: entries.into(),
        })
    }

    /// Returns all files ending in `.json` below a folder.
    ///
    /// # Errors
    /// If a folder or file cannot be read or a file is broken.
    pub fn from_folder(folder: &Path) -> Result<Self, CaseError> {
        let files = Self::read_each(folder).into_iter();
        let entries = files
            .map(|file| file.map(Entry::Read))
            .collect::<Result<_, _>>()?;
        Ok(Self { entries })
    }

    /// Returns all files ending in `.json` below a folder, each with its own result.
    pub fn read_each(folder: &Path) -> Vec<Result<CaseFile, CaseError>> {
        let mut names = Vec::new();
        if let Err(error) = collect(folder, "", &mut Vec::new(), &mut names) {
            return vec![Err(error)];
        }
        names.sort();
        let redundant = match Redundant::in_folder(folder) {
            Ok(redundant) => redundant,
            Err(error) => return vec![Err(error)],
        };
        let read = |name: String| {
            let text = text_of(&folder.join(&name)).map_err(|e| unreadable(&name, &e))?;
            CaseFile::parse(&name, &text).map(|file| redundant.of(file))
        };
        let mut files: Vec<_> = names.into_iter().map(read).collect();
        let parsed = files.iter().filter_map(|file| file.as_ref().ok());
        files.extend(redundant.check(parsed).err().map(Err));
        files
    }

    /// Returns the paths of the files, without `.json`. No file is parsed for it.
    pub fn stems(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(Entry::stem)
    }

    /// Returns the files.
    pub fn files(&self) -> impl Iterator<Item = &CaseFile> {
        self.files_where(|_| true)
    }

    /// Returns the files with such a path, which is given without `.json`. Other files are not parsed.
    pub fn files_where(&self, is_wanted: impl Fn(&str) -> bool) -> impl Iterator<Item = &CaseFile> {
        let wanted = self.entries.iter().filter(move |e| is_wanted(e.stem()));
        wanted.map(Entry::file)
    }

    /// Returns the cases of a profile, file by file.
    pub fn cases(&self, profile: Profile) -> impl Iterator<Item = CaseRef<'_>> {
        self.files().flat_map(move |file| file.cases(profile))
    }

    /// Returns all cases whose ids begin with a text. The cases of other files are not listed.
    pub fn cases_that_begin<'l>(&'l self, start: &str) -> impl Iterator<Item = CaseRef<'l>> {
        let can_begin = move |stem: &str| stem.starts_with(start) || start.starts_with(stem);
        let cases = self.files_where(can_begin);
        let cases = cases.flat_map(|file| file.cases(Profile::Full));
        cases.filter(move |case| case.id().starts_with(start))
    }

    /// Returns the cases with these ids, each with its id. The cases of other files are not listed.
    pub fn named<'l>(
        &'l self,
        ids: &BTreeSet<&str>,
    ) -> impl Iterator<Item = (String, CaseRef<'l>)> {
        let cases = self.files_where(|stem| any_begins(ids, stem));
        let cases = cases.flat_map(|file| file.cases(Profile::Full));
        let named = cases.map(|case| (case.id(), case));
        named.filter(move |(id, _)| ids.contains(id.as_str()))
    }
}

/// Returns true if any of the ids begins like this.
pub(crate) fn any_begins(ids: &BTreeSet<&str>, start: &str) -> bool {
    let mut from = ids.range(start..);
    from.next().is_some_and(|id| id.starts_with(start))
}

/// Files that mark folders into which a command recorded; their other files are not cases.
const RECORDED: [&str; 2] = ["run.jsonl", "bench.jsonl"];

/// Collects the names of the files below a folder. `above` is the chain of enclosing folders, with links
/// resolved.
fn collect(
    folder: &Path,
    prefix: &str,
    above: &mut Vec<PathBuf>,
    names: &mut Vec<String>,
) -> Result<(), CaseError> {
    let label = folder.display().to_string();
    let real = fs::canonicalize(folder).map_err(|e| unreadable(&label, &e))?;
    if above.contains(&real) {
        let back = "it is a link to one of its own parent folders; remove it";
        return Err(unreadable(&label, &io::Error::other(back)));
    }
    above.push(real);
    let entries = fs::read_dir(folder).map_err(|e| unreadable(&label, &e))?;
    for entry in entries {
        let entry = entry.map_err(|e| unreadable(&label, &e))?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        let path = entry.path();
        if RECORDED.iter().any(|file| entry.file_name() == *file) {
            let why = "it belongs to a run or a bench, not to cases; move its folder elsewhere";
            return Err(unreadable(&name, &io::Error::other(why)));
        }
        if path.is_dir() {
            collect(&path, &format!("{name}/"), above, names)?;
        } else if name.ends_with(".json") {
            names.push(name);
        }
    }
    above.pop();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn cases_are_found_without_listing_all_files() {
        let library = Library::built_in();
        let all: Vec<String> = library.cases(Profile::Full).map(|c| c.id()).collect();
        for start in [
            "",
            "depth/c",
            "depth/compare/",
            "capabilities/round-trip/f",
            "nothing",
        ] {
            let found: Vec<String> = library.cases_that_begin(start).map(|c| c.id()).collect();
            let expected = all.iter().filter(|id| id.starts_with(start));
            assert!(found.iter().eq(expected), "{start}");
        }
        for every in [1, 7, 10_007] {
            let ids = all.iter().step_by(every).map(String::as_str);
            let ids: BTreeSet<&str> = ids.chain(["depth", "nothing/a=1"]).collect();
            let found = library
                .named(&ids)
                .inspect(|(id, case)| assert_eq!(*id, case.id()));
            let found: Vec<String> = found.map(|(id, _)| id).collect();
            let expected = all.iter().filter(|id| ids.contains(id.as_str()));
            assert!(found.iter().eq(expected), "{every}");
        }
    }

    #[test]
    fn the_quick_cases_are_some_of_all_and_have_their_ids() {
        let axes = r#""axes":{"a":[1,2,3],"b":[1,2,3],"c":[1,2,3]}"#;
        let file = |quick: &str| {
            let text = format!(r#"{{"about":"t","spec":["t"],{quick}{axes},"scene":{{}}}}"#);
            CaseFile::parse("t.json", &text).expect("parses")
        };
        let ids = |file: &CaseFile, profile| -> Vec<String> {
            file.cases(profile).map(|c| c.id()).collect()
        };
        let plain = file("");
        let full = ids(&plain, Profile::Full);
        assert_eq!(full.len(), 27);
        assert_eq!(ids(&plain, Profile::Quick), full);
        let pairwise = file(r#""quick":"pairwise","#);
        assert_eq!(ids(&pairwise, Profile::Full), full);
        let some = ids(&pairwise, Profile::Quick);
        assert_eq!(some, ids(&pairwise, Profile::Quick));
        assert!((9..20).contains(&some.len()), "{}", some.len());
        assert!(some.iter().all(|id| full.contains(id)));
        for (x, y) in [("a", "b"), ("a", "c"), ("b", "c")] {
            for (i, j) in (1..=3).flat_map(|i| (1..=3).map(move |j| (i, j))) {
                let (x, y) = (format!("/{x}={i}"), format!("/{y}={j}"));
                assert!(some.iter().any(|id| id.contains(&x) && id.contains(&y)));
            }
        }
    }

    #[test]
    fn derived_values_and_quick_filters_must_fit_their_axis() {
        let file = |more: &str| {
            let text = format!(
                r#"{{"about":"t","spec":["t"],{more},
                "axes":{{"a":[1,2],"side":[{{"name":"small","value":4}},{{"name":"large","value":8}}]}},
                "scene":{{"attachments":{{"c":{{"format":"rgba8unorm","size":["$side",16]}}}},
                "passes":[{{"color":["c"],"draws":[{{"mesh":{{"kind":"full"}},"shader":"uniform_color",
                "scissor":"$rect"}}]}}],"read":["c"]}}}}"#
            );
            CaseFile::parse("t.json", &text)
        };
        let good = r#""quick":{"where":{"side":"large"}},
            "derived":{"rect":{"axis":"side","values":[[0,0,2,2],[0,0,4,4]]}}"#;
        let good = file(good).expect("parses");
        let quick: Vec<String> = good.cases(Profile::Quick).map(|c| c.id()).collect();
        assert_eq!(quick, ["t/a=1/side=large", "t/a=2/side=large"]);
        let rows = r#""quick":{"any":[{"a":"1","side":"large"},{"a":"2","side":"small"}]},
            "derived":{"rect":{"axis":"side","values":[[0,0,2,2],[0,0,4,4]]}}"#;
        let rows = file(rows).expect("parses");
        let quick: Vec<String> = rows.cases(Profile::Quick).map(|c| c.id()).collect();
        assert_eq!(quick, ["t/a=1/side=large", "t/a=2/side=small"]);
        let named = file(
            r#""derived":{"rect":{"axis":"side","values":{"large":[0,0,4,4],"*":[0,0,2,2]}}}"#,
        );
        let named = named.expect("parses");
        for case in [&good, &named]
            .iter()
            .flat_map(|file| file.cases(Profile::Full))
        {
            let scene = case.build().expect("builds").scene;
            let expected = scene.attachments[0].size[0] / 2;
            assert_eq!(
                scene.passes[0].draws[0].scissor,
                Some([0, 0, expected, expected]),
                "{}",
                case.id()
            );
        }
        for (bad, key, message) in [
            (
                r#""derived":{"rect":{"axis":"side","values":[[0,0,2,2]]}}"#,
                "derived.rect.values",
                "axis `side` has 2 values",
            ),
            (
                r#""derived":{"rect":{"axis":"side","values":{"large":[0,0,2,2]}}}"#,
                "derived.rect.values",
                "`values` has no entry for the value `small` of axis `side`, and no `*`",
            ),
            (
                r#""derived":{"rect":{"axis":"side","values":{"tiny":[0,0,2,2],"*":null}}}"#,
                "derived.rect.values",
                "no axis `side` has a value `tiny`",
            ),
            (
                r#""derived":{"rect":{"axis":"side","values":7}}"#,
                "derived.rect.values",
                "a list of values, or an object with a value by name",
            ),
            (
                r#""quick":{"where":{"side":"tiny"}}"#,
                "quick.where.side",
                "no axis `side` has a value `tiny`",
            ),
            (
                r#""quick":{"any":[{"a":"1"},{"side":"tiny"}]}"#,
                "quick.any[1].side",
                "no axis `side` has a value `tiny`",
            ),
            (
                r#""quick":{"where":{"b":"large"}}"#,
                "quick.where.b",
                "no axis `b` has a value `large`",
            ),
        ] {
            let error = file(bad).expect_err("is refused");
            assert_eq!(error.key, key);
            assert_eq!(error.message, message);
        }
    }

    #[test]
    fn every_built_in_case_builds_and_no_id_repeats() {
        let library = Library::built_in();
        let mut ids = HashSet::new();
        for case in library.cases(Profile::Full) {
            let built = case.build().expect("built-in cases build");
            assert_eq!(built.id, case.id());
            assert!(!built.id.contains([' ', ',']), "{}", built.id);
            assert!(ids.insert(built.id.clone()), "{} occurs twice", built.id);
            let selftest = built.parts().area() == "selftest";
            assert_eq!(built.judged_as.is_some(), selftest, "{}", built.id);
        }
    }
}
