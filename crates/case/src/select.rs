//! Selecting cases by globs.

use crate::file::{CaseRef, Profile};
use crate::library::{Library, any_begins};
use etalon_frame::CaseId;
use etalon_glob::{Glob, GlobError};
use std::collections::BTreeSet;
use thiserror::Error;

/// Cases chosen from a library.
#[derive(Debug)]
pub struct Selection<'a> {
    /// The cases, in the library's order.
    pub cases: Vec<CaseRef<'a>>,
}

/// The reason why a selection failed.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SelectError {
    /// A glob does not parse.
    #[error("`{glob}` is not a glob: {error}")]
    Glob {
        /// The glob.
        glob: String,
        /// The error.
        error: GlobError,
    },
}

/// Globs over ids or names, in which `*` also matches `/`. A glob without special characters also matches
/// everything below it: `depth` includes `depth/*`. An empty list matches everything.
#[derive(Clone, Debug)]
pub struct Globs(Vec<Glob>);

impl Globs {
    /// Parses globs.
    ///
    /// # Errors
    /// If a glob does not parse.
    pub fn new(globs: &[String]) -> Result<Self, SelectError> {
        let mut parsed = Vec::new();
        for glob in globs {
            let mut add = |text: &str| -> Result<(), SelectError> {
                let error = |error| SelectError::Glob {
                    glob: glob.clone(),
                    error,
                };
                parsed.push(Glob::new(text).map_err(error)?);
                Ok(())
            };
            add(glob)?;
            if !glob.contains(['*', '?', '[', '{']) {
                add(&format!("{}/*", glob.trim_end_matches('/')))?;
            }
        }
        Ok(Self(parsed))
    }

    /// Returns false if none of the globs matches a name that begins like this.
    fn can_begin_with(&self, start: &str) -> bool {
        self.0.is_empty() || self.0.iter().any(|glob| glob.can_begin_with(start))
    }

    /// Returns true if any of the globs matches.
    pub fn matches(&self, name: &str) -> bool {
        self.0.is_empty() || self.0.iter().any(|glob| glob.is_match(name))
    }
}

/// Returns the cases of a profile whose ids match any of the globs; all cases if the list is empty. A glob that is an
/// id selects its case from any profile. See [`Globs`].
///
/// # Errors
/// If a glob does not parse.
pub fn select<'a>(
    library: &'a Library,
    profile: Profile,
    globs: &[String],
) -> Result<Selection<'a>, SelectError> {
    let named: BTreeSet<&str> = globs.iter().map(String::as_str).collect();
    let globs = Globs::new(globs)?;
    let mut cases = Vec::new();
    for file in library.files_where(|stem| globs.can_begin_with(stem)) {
        let matching = |c: &CaseRef<'_>| globs.matches(&c.id());
        let mut selected: Vec<CaseRef<'_>> = file.cases(profile).filter(matching).collect();
        if any_begins(&named, file.stem()) {
            let ids: BTreeSet<String> = selected.iter().map(CaseRef::id).collect();
            let is_one = |id: &String| ids.contains(id) || named.contains(id.as_str());
            selected = file
                .cases(Profile::Full)
                .filter(|c| is_one(&c.id()))
                .collect();
        }
        cases.extend(selected);
    }
    Ok(Selection { cases })
}

/// Returns the number of matching cases that the full profile has and a profile leaves out, given the ids
/// that it selects. Areas without a selected case are not counted.
///
/// # Errors
/// If a glob does not parse.
pub fn left_out(
    library: &Library,
    profile: Profile,
    globs: &[String],
    selected: &[String],
) -> Result<u64, SelectError> {
    if profile == Profile::Full {
        return Ok(0);
    }
    let area = |id: &str| CaseId::new(id).area().to_owned();
    let areas: BTreeSet<String> = selected.iter().map(|id| area(id)).collect();
    let matching = select(library, Profile::Full, globs)?.cases;
    let in_areas = matching.iter().filter(|c| areas.contains(&area(&c.id())));
    Ok(in_areas.count().saturating_sub(selected.len()) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::slice;

    #[test]
    fn a_star_matches_slashes_and_a_plain_name_matches_all_below_it() {
        let globs = |globs: &[&str]| {
            let globs: Vec<String> = globs.iter().map(|g| (*g).to_owned()).collect();
            Globs::new(&globs).expect("globs")
        };
        assert!(globs(&["depth/*"]).matches("depth/compare/compare=less/write=true"));
        assert!(globs(&["*write=true"]).matches("depth/compare/compare=less/write=true"));
        assert!(globs(&["depth"]).matches("depth/compare/compare=less"));
        assert!(!globs(&["depth"]).matches("depths/compare"));
    }

    #[test]
    fn an_id_selects_its_case_from_any_profile() {
        let library = Library::built_in();
        let full: Vec<String> = library.cases_that_begin("depth/").map(|c| c.id()).collect();
        let quick = |globs: &[String]| -> Vec<String> {
            let selection = select(library, Profile::Quick, globs).expect("globs");
            selection.cases.iter().map(CaseRef::id).collect()
        };
        let area = quick(&["depth".to_owned()]);
        let other = full
            .iter()
            .find(|id| !area.contains(id))
            .expect("quick is a part");
        assert_eq!(&quick(slice::from_ref(other)), slice::from_ref(other));
        let both = quick(&["depth".to_owned(), other.clone()]);
        let expected = full.iter().filter(|id| area.contains(id) || *id == other);
        assert!(both.iter().eq(expected), "{other}");
        assert_eq!(quick(&[format!("{other}/*")]), [""; 0]);
    }

    #[test]
    fn a_glob_that_does_not_parse_is_an_error() {
        assert!(Globs::new(&["a[".to_owned()]).is_err());
    }
}
