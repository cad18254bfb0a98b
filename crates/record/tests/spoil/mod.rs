//! Ways to spoil a text, for the tests of every reader of files.

use proptest::prelude::*;
use proptest::sample::Index;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, TestRunner};
use std::io::{self, Write};
use std::time::{Duration, Instant};

/// Replacements of a token.
const WORDS: [&str; 40] = [
    "",
    "0",
    "-1",
    "1e308",
    "1e999",
    "-0.0",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "99999999999999999999999",
    "0.1",
    "NaN",
    "null",
    "true",
    "\"\"",
    "\"\\u0000\"",
    "\"\\ud800\"",
    "\"<script>\"",
    "\"../../x\"",
    "\"/etc/passwd\"",
    "{}",
    "[]",
    "[[]]",
    "[null]",
    "{\"\":{}}",
    ",",
    ":",
    "\"",
    "\\",
    "\n",
    "\r\n",
    "\u{0}",
    "\u{feff}",
    "}",
    "]",
    "{",
    "[",
    "$x",
    "\"$x\"",
    "//",
];

/// One change of a text.
#[derive(Clone, Debug)]
enum Change {
    /// A number, word or string is replaced.
    Token(Index, Index),
    /// A word is put in.
    Insert(Index, Index),
    /// A byte is replaced.
    Byte(Index, u8),
    /// A piece is removed.
    Cut(Index, Index),
    /// A piece is copied to another place.
    Copy(Index, Index, Index),
    /// Many nested brackets are put in.
    Nest(Index, u16),
    /// The rest is removed.
    Truncate(Index),
}

/// Some changes, one after the other; or noise.
#[derive(Clone, Debug)]
pub(crate) struct Spoiling {
    changes: Vec<Change>,
    noise: Option<Vec<u8>>,
}

/// Any spoiling.
pub(crate) fn spoilings() -> impl Strategy<Value = Spoiling> {
    let any_index = any::<Index>;
    let change = prop_oneof![
        6 => (any_index(), any_index()).prop_map(|(a, b)| Change::Token(a, b)),
        2 => (any_index(), any_index()).prop_map(|(a, b)| Change::Insert(a, b)),
        2 => (any_index(), any::<u8>()).prop_map(|(a, b)| Change::Byte(a, b)),
        1 => (any_index(), any_index()).prop_map(|(a, b)| Change::Cut(a, b)),
        1 => (any_index(), any_index(), any_index()).prop_map(|(a, b, c)| Change::Copy(a, b, c)),
        1 => (any_index(), 1..2000_u16).prop_map(|(a, n)| Change::Nest(a, n)),
        1 => any_index().prop_map(Change::Truncate),
    ];
    let noise = prop::option::weighted(0.05, prop::collection::vec(any::<u8>(), 0..200));
    (prop::collection::vec(change, 0..5), noise)
        .prop_map(|(changes, noise)| Spoiling { changes, noise })
}

/// The ranges of tokens: numbers, words, strings.
fn tokens(text: &[u8]) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut position = 0;
    while position < text.len() {
        let start = position;
        if text[position] == b'"' {
            position += 1;
            while position < text.len() && text[position] != b'"' {
                position += 1 + usize::from(text[position] == b'\\');
            }
            position = (position + 1).min(text.len());
        } else if text[position].is_ascii_alphanumeric() || text[position] == b'-' {
            let inside = |b: u8| b.is_ascii_alphanumeric() || b"+-.".contains(&b);
            while position < text.len() && inside(text[position]) {
                position += 1;
            }
        } else {
            position += 1;
            continue;
        }
        found.push((start, position));
    }
    found
}

impl Spoiling {
    /// The spoilt text.
    pub(crate) fn of(&self, text: impl AsRef<[u8]>) -> Vec<u8> {
        if let Some(noise) = &self.noise {
            return noise.clone();
        }
        let mut bytes = text.as_ref().to_vec();
        for change in &self.changes {
            change.apply(&mut bytes);
        }
        bytes
    }
}

impl Change {
    fn apply(&self, bytes: &mut Vec<u8>) {
        let place = |index: &Index, bytes: &[u8]| index.index(bytes.len() + 1);
        // Pieces are short: a text that loses half of itself has little left that can be wrong.
        let piece = |from: &Index, length: &Index, bytes: &[u8]| {
            let from = place(from, bytes);
            (from, (from + length.index(64)).min(bytes.len()))
        };
        match self {
            Self::Token(index, word) => {
                let ranges = tokens(bytes);
                if !ranges.is_empty() {
                    let (from, to) = *index.get(&ranges);
                    bytes.splice(from..to, word.get(&WORDS).bytes());
                }
            }
            Self::Insert(index, word) => {
                let offset = place(index, bytes);
                bytes.splice(offset..offset, word.get(&WORDS).bytes());
            }
            Self::Byte(index, byte) => {
                if !bytes.is_empty() {
                    let offset = index.index(bytes.len());
                    bytes[offset] = *byte;
                }
            }
            Self::Cut(from, length) => {
                let (from, to) = piece(from, length, bytes);
                bytes.drain(from..to);
            }
            Self::Copy(from, length, index) => {
                let (from, to) = piece(from, length, bytes);
                let copy = bytes[from..to].to_vec();
                let offset = place(index, bytes);
                bytes.splice(offset..offset, copy);
            }
            Self::Nest(index, depth) => {
                let depth = usize::from(*depth);
                let offset = place(index, bytes);
                let nest = "[".repeat(depth) + &"]".repeat(depth);
                bytes.splice(offset..offset, nest.bytes());
            }
            Self::Truncate(index) => {
                let offset = place(index, bytes);
                bytes.truncate(offset);
            }
        }
    }
}

/// The seconds for which [`keep_trying`] tries, and with `ETALON_TESTS=all`: six formats take ten minutes.
const SECONDS: [u64; 2] = [4, 100];
/// The time after which an input counts as a hang.
const HANG: Duration = Duration::from_secs(20);
/// The memory that a reader of small files may take.
const MOST_KIB: u64 = 1 << 20;

/// Tries spoiled copies of a corpus for some seconds, and prints their number. A panic, a hang or more than 1 GiB
/// fails the test.
pub(crate) fn keep_trying(format: &str, corpus: &[&[u8]], read: impl Fn(&[u8])) {
    let is_all = std::env::var("ETALON_TESTS").is_ok_and(|value| value == "all");
    let until = Instant::now() + Duration::from_secs(SECONDS[usize::from(is_all)]);
    let mut runner = TestRunner::new(Config::default());
    let spoilings = spoilings();
    let mut inputs = 0;
    while Instant::now() < until {
        let spoiling = spoilings
            .new_tree(&mut runner)
            .expect("any spoiling")
            .current();
        let input = spoiling.of(corpus[inputs % corpus.len()]);
        let begun = Instant::now();
        read(&input);
        assert!(begun.elapsed() < HANG, "{spoiling:?}");
        inputs += 1;
    }
    // Linux only; other systems do not have the file.
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let peak = peak.and_then(|text| text.trim().trim_end_matches(" kB").parse::<u64>().ok());
    assert!(peak.is_none_or(|peak| peak < MOST_KIB), "{peak:?} KiB");
    let _ = writeln!(io::stdout(), "{format}: {inputs} inputs");
}
