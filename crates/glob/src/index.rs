//! Many globs, looked up by a text.
//!
//! Each glob is filed under a part: a short text that occurs in everything that the glob matches. Of the possible
//! parts, it takes the one with the fewest globs so far. Only globs under parts of the text are compared with it.

use crate::glob::Glob;
use foldhash::HashMap;

/// The length in bytes of the longest part under which a glob is filed.
const LONGEST: usize = 4;

/// The approximate number of parts of a literal that are tried.
const TRIED: usize = 16;

/// Globs with their numbers.
#[derive(Clone, Debug, Default)]
pub struct GlobIndex {
    globs: Vec<(usize, Glob)>,
    /// The places in `globs` by the part under which they are filed.
    parts: HashMap<GlobPart, Vec<usize>>,
    /// The places of globs whose matches have no part in common.
    others: Vec<usize>,
    /// The numbers of globs that match exactly one text, by this text.
    plain: HashMap<String, Vec<usize>>,
    /// True for the lengths of parts that exist.
    lengths: [bool; LONGEST + 1],
}

/// At most [`LONGEST`] bytes, after a 1 that marks their beginning.
type GlobPart = u64;

fn part(bytes: &[u8]) -> GlobPart {
    let append = |part, byte: &u8| part << 8 | GlobPart::from(*byte);
    bytes.iter().fold(1, append)
}

impl GlobIndex {
    /// Adds a glob with a number.
    pub fn add(&mut self, number: usize, glob: &Glob) {
        if let Some(text) = glob.only_match() {
            self.plain.entry(text.to_owned()).or_default().push(number);
            return;
        }
        let literals = glob.literals();
        let windows = literals.iter().flat_map(|literal| {
            let length = literal.len().min(LONGEST);
            let windows = literal.as_bytes().windows(length);
            let step = windows.len().div_ceil(TRIED);
            windows.step_by(step)
        });
        let filed = |bytes: &&[u8]| self.parts.get(&part(bytes)).map_or(0, Vec::len);
        // Among parts with equally many globs, a longer part occurs in fewer texts.
        let best = windows.min_by_key(|bytes| (filed(bytes), LONGEST - bytes.len()));
        let place = self.globs.len();
        self.globs.push((number, glob.clone()));
        match best {
            Some(bytes) => {
                self.lengths[bytes.len()] = true;
                self.parts.entry(part(bytes)).or_default().push(place);
            }
            None => self.others.push(place),
        }
    }

    /// Returns the numbers of the globs that match a text, in ascending order.
    pub fn matches(&self, text: &str) -> Vec<usize> {
        let lengths = (1..=LONGEST).filter(|length| self.lengths[*length]);
        let parts = lengths.flat_map(|length| text.as_bytes().windows(length).map(part));
        let filed = parts.filter_map(|part| Some((part, self.parts.get(&part)?)));
        let mut filed: Vec<(GlobPart, &Vec<usize>)> = filed.collect();
        // A text can have a part twice.
        filed.sort_unstable_by_key(|(part, _)| *part);
        filed.dedup_by_key(|(part, _)| *part);
        let places = filed.iter().flat_map(|(_, places)| *places);
        let places = places.chain(&self.others);
        let globs = places.map(|place| &self.globs[*place]);
        let matching = globs.filter(|(_, glob)| glob.is_match(text));
        let mut numbers: Vec<usize> = matching.map(|(number, _)| *number).collect();
        numbers.extend(self.plain.get(text).into_iter().flatten());
        numbers.sort_unstable();
        numbers.dedup();
        numbers
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_finds_what_each_glob_alone_finds() {
        let globs = [
            "",
            "*",
            "a",
            "a/b",
            "a*",
            "*b",
            "*a*b*",
            "?",
            "??",
            "[ab]/b",
            "{a,b}/b",
            "**/b",
            "a/**",
            "x{a,bc}*",
            "*é*",
            "depth/compare/*x=1*",
            "a/b",
            "*",
            "*/a-literal-with-more-parts-than-are-tried/*",
        ];
        let mut index = GlobIndex::default();
        let parsed: Vec<Glob> = globs
            .iter()
            .map(|g| Glob::new(g).expect("a glob"))
            .collect();
        for (number, glob) in parsed.iter().enumerate() {
            index.add(number, glob);
        }
        for text in [
            "",
            "a",
            "b",
            "ab",
            "a/b",
            "b/b",
            "a/c/b",
            "xbc",
            "xa1",
            "é",
            "aéb",
            "depth/compare/y=2/x=1/z",
            "depth/compare/",
            "x/a-literal-with-more-parts-than-are-tried/y",
        ] {
            let matching = (0..parsed.len()).filter(|n| parsed[*n].is_match(text));
            let matching: Vec<usize> = matching.collect();
            assert_eq!(index.matches(text), matching, "{text}");
        }
    }
}
