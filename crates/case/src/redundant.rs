//! `redundant.txt`: the candidates that the quick profile leaves out, because others have their power.

use crate::error::CaseError;
use crate::file::{CaseFile, Profile};
use crate::file_text::{text_of, unreadable};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::LazyLock;

/// The file, beside the case files.
const NAME: &str = "redundant.txt";

/// Ids of cases, each with its line from 1.
#[derive(Debug, Default)]
pub(crate) struct Redundant(BTreeMap<String, usize>);

impl Redundant {
    /// Returns the list that was compiled in.
    pub(crate) fn built_in() -> &'static Self {
        static LIST: LazyLock<Redundant> =
            LazyLock::new(|| Redundant::parse(include_str!("../data/redundant.txt")));
        &LIST
    }

    /// Returns the list of a folder of case files, which is empty without the file.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub(crate) fn in_folder(folder: &Path) -> Result<Self, CaseError> {
        let path = folder.join(NAME);
        if !path.exists() {
            return Ok(Self::default());
        }
        let text = text_of(&path).map_err(|error| unreadable(NAME, &error))?;
        Ok(Self::parse(&text))
    }

    fn parse(text: &str) -> Self {
        let lines = text.lines().zip(1..);
        let ids = lines.filter(|(line, _)| !line.is_empty() && !line.starts_with('#'));
        Self(ids.map(|(id, line)| (id.to_owned(), line)).collect())
    }

    /// Tells a file which of its cases are listed.
    pub(crate) fn of(&self, mut file: CaseFile) -> CaseFile {
        let from = self.0.range(file.stem().to_owned()..);
        let ids = from.map(|(id, _)| id);
        let own = ids.take_while(|id| id.starts_with(file.stem()));
        file.redundant = own.cloned().collect();
        file
    }

    /// Checks that each id is a candidate of one of these files.
    ///
    /// # Errors
    /// Names the first id of another case.
    pub(crate) fn check<'f>(
        &self,
        files: impl Iterator<Item = &'f CaseFile>,
    ) -> Result<(), CaseError> {
        let listing = files.filter(|file| !file.redundant.is_empty());
        let candidates: BTreeSet<String> = listing
            .flat_map(|file| file.cases(Profile::Candidates))
            .map(|case| case.id())
            .collect();
        let unknown = self.0.iter().find(|(id, _)| !candidates.contains(*id));
        unknown.map_or(Ok(()), |(id, line)| {
            Err(CaseError {
                file: NAME.to_owned(),
                line: *line,
                key: String::new(),
                message: format!(
                    "no file selects `{id}` for the quick profile; remove the line, or write the file again with \
                     `etalon mutants --full --redundant {NAME}`"
                ),
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Library;

    #[test]
    fn quick_is_the_candidates_without_those_that_are_listed() {
        let text = r#"{"about":"t","spec":["t"],"quick":{"first":3},"axes":{"a":["1","2","3","4"]},"scene":{}}"#;
        let file = CaseFile::parse("t.json", text).expect("is a file");
        let list = Redundant::parse("# Why.\nt/a=2\nt/b=1\n");
        let file = list.of(file);
        let ids = |profile| {
            file.cases(profile)
                .map(|case| case.id())
                .collect::<Vec<_>>()
        };
        assert_eq!(ids(Profile::Quick), ["t/a=1", "t/a=3"]);
        assert_eq!(ids(Profile::Candidates), ["t/a=1", "t/a=2", "t/a=3"]);
        assert_eq!(ids(Profile::Full).len(), 4);
        let error = list.check([&file].into_iter()).expect_err("b is no axis");
        assert_eq!((error.line, error.file.as_str()), (3, NAME));
        assert!(error.message.contains("`t/b=1`"), "{error}");
    }

    #[test]
    fn every_built_in_line_is_a_candidate() {
        let checked = Redundant::built_in().check(Library::built_in().files());
        assert_eq!(checked.map_err(|error| error.to_string()), Ok(()));
    }
}
