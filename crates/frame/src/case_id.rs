//! Ids of cases.

/// The id of a case: the path of its case file, then its values of the file's axes, such as
/// `depth/compare/compare=less/write=true`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CaseId<'a>(&'a str);

impl<'a> CaseId<'a> {
    /// Takes an id apart. Any text has parts, also if no case has this id.
    pub fn new(id: &'a str) -> Self {
        Self(id)
    }

    /// Returns the area: the first part.
    pub fn area(self) -> &'a str {
        self.0.split('/').next().unwrap_or_default()
    }

    /// Returns the path of the case file, which is the same for all its cases. An id that begins with an axis is
    /// returned whole.
    pub fn file(self) -> &'a str {
        self.before_axes().unwrap_or(self.0)
    }

    /// Returns the family: the parts before the first axis; without axes, all parts except the last.
    pub fn family(self) -> &'a str {
        match self.before_axes() {
            None | Some("") => self.area(),
            Some(file) if file == self.0 => {
                self.0.rsplit_once('/').map_or(self.0, |(family, _)| family)
            }
            Some(file) => file,
        }
    }

    /// Returns the axes with their values, in the order of the id.
    pub fn axes(self) -> impl Iterator<Item = (&'a str, &'a str)> {
        self.0.split('/').filter_map(|part| part.split_once('='))
    }

    /// Returns the parts before the first axis; `None` if the first part is one.
    fn before_axes(self) -> Option<&'a str> {
        let mut end = 0;
        for part in self.0.split('/') {
            if part.contains('=') {
                break;
            }
            end += part.len() + 1;
        }
        self.0.get(..end.checked_sub(1)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_is_an_area_a_file_and_axes() {
        for (id, area, file, family) in [
            (
                "depth/compare/compare=less/write=true",
                "depth",
                "depth/compare",
                "depth/compare",
            ),
            ("blend/a=b/c=d", "blend", "blend", "blend"),
            (
                "methods/oit/glass",
                "methods",
                "methods/oit/glass",
                "methods/oit",
            ),
            ("depth", "depth", "depth", "depth"),
            ("a=b/c", "a=b", "a=b/c", "a=b"),
            ("found/softpipe", "found", "found/softpipe", "found"),
            (
                "perf/matrix/fill/blend=off",
                "perf",
                "perf/matrix/fill",
                "perf/matrix/fill",
            ),
            ("ä/ö=1", "ä", "ä", "ä"),
            ("", "", "", ""),
            ("/", "", "/", ""),
            ("/a=b", "", "", ""),
        ] {
            let parsed = CaseId::new(id);
            assert_eq!(
                (parsed.area(), parsed.file(), parsed.family()),
                (area, file, family),
                "{id}"
            );
        }
        let axes = CaseId::new("depth/compare/compare=less/odd/write=a=b").axes();
        assert_eq!(
            axes.collect::<Vec<_>>(),
            [("compare", "less"), ("write", "a=b")]
        );
    }
}
