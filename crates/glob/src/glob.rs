//! A parsed glob.

use crate::matching;
use crate::parsing::{self, GlobError};
use crate::step::MatchStep;
use std::sync::Arc;

/// A parsed glob. Clones share its parts.
#[derive(Clone, Debug)]
pub struct Glob {
    /// The text with which everything that matches begins.
    prefix: Arc<str>,
    /// The steps between prefix and suffix.
    steps: Arc<[MatchStep]>,
    /// The text with which everything that matches ends.
    suffix: Arc<str>,
    /// True if a step is a jump.
    has_jumps: bool,
}

impl Glob {
    /// Parses a glob.
    ///
    /// # Errors
    /// If a bracket or a brace has no partner, a range is reversed, or a backslash ends the glob.
    pub fn new(glob: &str) -> Result<Self, GlobError> {
        // Most globs of a long list are plain.
        if !glob.contains(['*', '?', '[', ']', '{', '}', ',', '!', '^', '\\']) {
            return Ok(Self {
                prefix: Arc::from(glob),
                steps: Arc::default(),
                suffix: Arc::default(),
                has_jumps: false,
            });
        }
        let mut steps = parsing::steps(glob)?;
        let plain = |step: &MatchStep| match step {
            MatchStep::Char(c) => Some(*c),
            _ => None,
        };
        let prefix: String = steps.iter().map_while(plain).collect();
        let removed = prefix.chars().count();
        steps.drain(..removed);
        // After the last target of a jump, every match takes the same steps.
        let mut joined = 0;
        for step in &mut steps {
            if let MatchStep::Jump(targets) = step {
                targets.iter_mut().for_each(|target| *target -= removed);
                joined = targets
                    .iter()
                    .fold(joined, |joined, target| joined.max(*target));
            }
        }
        let suffix = steps[joined..].iter().rev().map_while(plain);
        let suffix: Vec<char> = suffix.collect();
        steps.truncate(steps.len() - suffix.len());
        Ok(Self {
            prefix: prefix.into(),
            has_jumps: steps.iter().any(|step| matches!(step, MatchStep::Jump(_))),
            steps: steps.into(),
            suffix: suffix.into_iter().rev().collect::<String>().into(),
        })
    }

    /// Returns true if a text that begins like this can match, by the glob's plain beginning: a quick test
    /// that rejects no match.
    pub fn can_begin_with(&self, start: &str) -> bool {
        self.prefix.starts_with(start) || start.starts_with(&*self.prefix)
    }

    /// Returns true if the whole text matches.
    pub fn is_match(&self, text: &str) -> bool {
        let rest = text.strip_prefix(&*self.prefix);
        let middle = rest.and_then(|rest| rest.strip_suffix(&*self.suffix));
        middle.is_some_and(|middle| {
            if self.has_jumps {
                matching::is_match(&self.steps, middle)
            } else {
                matching::is_match_without_jumps(&self.steps, middle)
            }
        })
    }

    /// Returns the only text that matches, if the glob has no wildcard.
    pub fn only_match(&self) -> Option<&str> {
        // Without a wildcard, all of the text is the prefix.
        (self.steps.is_empty() && self.suffix.is_empty()).then_some(&*self.prefix)
    }

    /// Returns the text with which everything that matches begins.
    pub fn prefix(&self) -> &str {
        &self.prefix
    }

    /// Returns texts that are in everything that matches.
    pub fn literals(&self) -> Vec<String> {
        let mut literals = vec![self.prefix.to_string()];
        let mut run = String::new();
        // Steps before the last target of a jump can be left out.
        let mut joined = 0;
        for (number, step) in self.steps.iter().enumerate() {
            if let MatchStep::Jump(targets) = step {
                joined = targets
                    .iter()
                    .fold(joined, |last, target| last.max(*target));
            }
            match step {
                MatchStep::Char(c) if number >= joined => run.push(*c),
                _ => literals.push(std::mem::take(&mut run)),
            }
        }
        literals.push(run + &self.suffix);
        literals.retain(|literal| !literal.is_empty());
        literals
    }
}

/// Returns a glob that matches exactly this text.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        if "?*[]{}".contains(c) {
            escaped.extend(['[', c, ']']);
        } else {
            escaped.push(c);
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(glob: &str, matching: &[&str], others: &[&str]) {
        let parsed = Glob::new(glob).expect("a glob");
        for text in matching {
            assert!(parsed.is_match(text), "{glob}: {text}");
        }
        for text in others {
            assert!(!parsed.is_match(text), "{glob}: {text}");
        }
    }

    #[test]
    fn the_whole_text_must_match() {
        check("depth", &["depth"], &["", "dept", "depths", "a/depth"]);
        check("", &[""], &["a"]);
    }

    #[test]
    fn a_beginning_is_rejected_only_if_nothing_matches() {
        let can_begin = |glob: &str, start| Glob::new(glob).expect("a glob").can_begin_with(start);
        for start in ["", "de", "depth", "depth/compare"] {
            assert!(can_begin("depth/*", start), "{start}");
        }
        assert!(!can_begin("depth/*", "depths"));
        assert!(!can_begin("depth/*", "blend"));
        assert!(can_begin("{depth,blend}/*", "blend"));
        assert!(can_begin("[bc]*", "blend"));
    }

    #[test]
    fn a_star_also_matches_slashes() {
        check("depth/*", &["depth/", "depth/a/b=1"], &["depth"]);
        check("*b=1", &["b=1", "depth/a/b=1"], &["b=10"]);
        check("a*b*c", &["abc", "a/b/b/c", "abbcc"], &["acb", "ab"]);
        check("a?c", &["abc", "a/c", "aéc"], &["ac", "abbc"]);
    }

    #[test]
    fn two_stars_match_whole_parts_or_nothing() {
        check("**/b", &["b", "a/b", "a/a/b"], &["ab"]);
        check("a/**/b", &["a/b", "a/c/b", "a/c/c/b"], &["a/cb", "ab"]);
        check("a/**", &["a/", "a/b/c"], &["a", "ab"]);
        check("{**/b,c}", &["b", "a/b", "c"], &["ab"]);
    }

    #[test]
    fn classes_have_ranges_and_their_opposite() {
        check("[a-c1]", &["a", "b", "1"], &["d", "-", "", "ab"]);
        check("x[!a-c]", &["xd", "x/"], &["xa", "x"]);
        check("[]-]", &["]", "-"], &["["]);
        check("[a-]", &["a", "-"], &["b"]);
    }

    #[test]
    fn braces_hold_globs() {
        check("x={a,b?}/y", &["x=a/y", "x=bc/y"], &["x=b/y", "x=a,b?/y"]);
        check(
            "{a{b,c},d*}e",
            &["abe", "ace", "de", "dxe"],
            &["ae", "abce"],
        );
        check("a{,b}", &["a", "ab"], &["b"]);
        check("x{a,bc}d", &["xad", "xbcd"], &["xcd", "xd"]);
        check("a,b", &["a,b"], &["a"]);
        check("[{]a[}]", &["{a}"], &["a"]);
    }

    #[test]
    fn an_escaped_text_matches_itself() {
        for text in ["a*b?[c]{d,e}!", "x={0x1}/y=[1]"] {
            check(&escape(text), &[text], &["a", "abc"]);
        }
        check(r"\*\{", &["*{"], &["a{"]);
    }

    #[test]
    fn an_invalid_glob_has_an_error() {
        let error = |glob| Glob::new(glob).expect_err("an error");
        assert_eq!(error("a["), GlobError::OpenClass);
        assert_eq!(error("[]"), GlobError::OpenClass);
        assert_eq!(error("[b-a]"), GlobError::ReversedRange('b', 'a'));
        assert_eq!(error("{a,{b}"), GlobError::OpenBrace);
        assert_eq!(error("a}"), GlobError::ClosedBrace);
        assert_eq!(error("a\\"), GlobError::Backslash);
    }

    #[test]
    fn every_matching_text_contains_the_literals() {
        let literals = |glob: &str| Glob::new(glob).expect("a glob").literals();
        assert_eq!(literals("a/b*cd?e*f"), ["a/b", "cd", "e", "f"]);
        assert_eq!(literals("x{a,bc}yz"), ["x", "yz"]);
        assert_eq!(literals("**/a"), ["a"]);
        assert_eq!(literals("*[ab]c{d{e,f},g}h*i"), ["c", "h", "i"]);
        assert_eq!(literals("{a,b}*"), [""; 0]);
    }

    #[test]
    fn jumps_do_not_change_what_matches() {
        let mut random = 1_u32;
        let mut below = |most: u32| {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 16) % most
        };
        for _ in 0..20_000 {
            let mut word = |letters: &[u8], most: u32| -> String {
                let length = below(most);
                let letters = (0..length).map(|_| letters[below(letters.len() as u32) as usize]);
                letters.map(char::from).collect()
            };
            let (glob, text) = (word(b"ab*?*", 8), word(b"ab", 10));
            let (before, after) = (Glob::new(&glob), Glob::new(&format!("{glob}{{,x}}")));
            let matches = [before, after].map(|glob| glob.expect("a glob").is_match(&text));
            assert_eq!(matches[0], matches[1], "{glob}: {text}");
        }
    }

    #[test]
    fn no_glob_takes_long() {
        let glob = format!("{}c", "{*a,*a}".repeat(100));
        check(&glob, &[], &["a".repeat(1000).as_str()]);
    }
}
