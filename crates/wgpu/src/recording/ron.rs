//! wgpu's traces, which are RON, as values.

use etalon_backend::Tree;

/// The deepest nesting.
const DEEPEST: usize = 100;

/// Returns the values of a trace, which may lack the bracket at its end.
pub(super) fn values(text: &str) -> Result<Vec<Tree>, String> {
    let mut reader = Reader { text, at: 0 };
    let mut values = Vec::new();
    if !reader.takes('[') {
        return Err("a trace begins with `[`".to_owned());
    }
    loop {
        match reader.peek() {
            None | Some(']') => return Ok(values),
            _ => values.push(reader.value(0)?),
        }
        reader.takes(',');
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Reader<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    /// Returns the next character that is no space.
    fn peek(&mut self) -> Option<char> {
        let rest = self.rest();
        self.at += rest.len() - rest.trim_start().len();
        self.rest().chars().next()
    }

    /// Reads a character, if it is the next.
    fn takes(&mut self, c: char) -> bool {
        let is = self.peek() == Some(c);
        self.at += if is { c.len_utf8() } else { 0 };
        is
    }

    fn fails<T>(&self, what: &str) -> Result<T, String> {
        Err(format!("{what} at byte {} of a trace", self.at))
    }

    /// Reads the longest text of such characters.
    fn word(&mut self, is: impl Fn(char) -> bool) -> &'a str {
        let rest = self.rest();
        let end = rest.find(|c| !is(c)).unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }

    fn value(&mut self, depth: usize) -> Result<Tree, String> {
        if depth > DEEPEST {
            return self.fails("too deep");
        }
        let Some(first) = self.peek() else {
            return self.fails("no value");
        };
        match first {
            '[' => self.list(depth),
            '{' => self.map(depth),
            '"' => Ok(Tree::Text(self.text()?)),
            '(' => self.parts(String::new(), depth),
            '0'..='9' | '-' | '+' => {
                let number = self.word(|c| c.is_ascii_alphanumeric() || "+-._".contains(c));
                Ok(Tree::Number(number.to_owned()))
            }
            c if c.is_ascii_alphabetic() || c == '_' => {
                let raw = self.rest().starts_with("r#");
                self.at += if raw { 2 } else { 0 };
                let more = if raw { "_-.+" } else { "_" };
                let name = self.word(|c| c.is_ascii_alphanumeric() || more.contains(c));
                if name == "NaN" || name == "inf" {
                    return Ok(Tree::Number(name.to_owned()));
                }
                if self.rest().starts_with('(') {
                    self.parts(name.to_owned(), depth)
                } else {
                    Ok(Tree::Name(name.to_owned()))
                }
            }
            _ => self.fails("no value"),
        }
    }

    fn list(&mut self, depth: usize) -> Result<Tree, String> {
        self.takes('[');
        let mut values = Vec::new();
        while !self.takes(']') {
            values.push(self.value(depth + 1)?);
            if !self.takes(',') && self.peek() != Some(']') {
                return self.fails("no end of a list");
            }
        }
        Ok(Tree::List(values))
    }

    /// Reads a map as a list of pairs.
    fn map(&mut self, depth: usize) -> Result<Tree, String> {
        self.takes('{');
        let mut pairs = Vec::new();
        while !self.takes('}') {
            let key = self.value(depth + 1)?;
            if !self.takes(':') {
                return self.fails("no value of a key");
            }
            let value = self.value(depth + 1)?;
            pairs.push(Tree::Tuple(String::new(), vec![key, value]));
            if !self.takes(',') && self.peek() != Some('}') {
                return self.fails("no end of a map");
            }
        }
        Ok(Tree::List(pairs))
    }

    /// Reads what stands in parentheses: fields or parts.
    fn parts(&mut self, name: String, depth: usize) -> Result<Tree, String> {
        self.takes('(');
        let (mut fields, mut parts) = (Vec::new(), Vec::new());
        while !self.takes(')') {
            let value = self.value(depth + 1)?;
            match value {
                Tree::Name(field) if self.takes(':') => {
                    fields.push((field, self.value(depth + 1)?));
                }
                value => parts.push(value),
            }
            if !self.takes(',') && self.peek() != Some(')') {
                return self.fails("no end of parts");
            }
        }
        Ok(if fields.is_empty() {
            Tree::Tuple(name, parts)
        } else {
            Tree::Structure(name, fields)
        })
    }

    /// Reads a text in quotes.
    fn text(&mut self) -> Result<String, String> {
        self.takes('"');
        let mut text = String::new();
        let mut characters = self.rest().char_indices();
        while let Some((place, c)) = characters.next() {
            match c {
                '"' => {
                    self.at += place + 1;
                    return Ok(text);
                }
                '\\' => match characters.next().map(|(_, c)| c) {
                    Some('n') => text.push('\n'),
                    Some('r') => text.push('\r'),
                    Some('t') => text.push('\t'),
                    Some('0') => text.push('\0'),
                    Some(c @ ('"' | '\\' | '\'')) => text.push(c),
                    _ => return self.fails("an unknown escape"),
                },
                c => text.push(c),
            }
        }
        self.fails("no end of a text")
    }
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test that panics has failed")]
mod tests {
    use super::*;

    fn name(name: &str) -> Tree {
        Tree::Name(name.to_owned())
    }

    #[test]
    fn a_trace_becomes_values() {
        let text = "[\nCreateBuffer(PointerId(94, ()), (\n    label: None,\n    size: 256,\n    usage: \"COPY_DST\",\n)),\n\
                    A(f: r#one-minus-src, g: [1.5, -2], h: {\"a\\n\": true}, i: ()),\n";
        let id = Tree::Tuple(
            "PointerId".to_owned(),
            vec![
                Tree::Number("94".to_owned()),
                Tree::Tuple(String::new(), Vec::new()),
            ],
        );
        let read = values(text).unwrap();
        assert_eq!(read.len(), 2);
        assert_eq!(
            (read[0].name(), read[0].part(0)),
            ("CreateBuffer", Some(&id))
        );
        let descriptor = read[0].part(1).unwrap();
        assert_eq!(descriptor.field("label").unwrap().some(), None);
        assert_eq!(
            descriptor.field("usage"),
            Some(&Tree::Text("COPY_DST".to_owned()))
        );
        assert_eq!(read[1].field("f"), Some(&name("one-minus-src")));
        assert_eq!(read[1].field("g").unwrap().list().len(), 2);
        let pair = Tree::Tuple(
            String::new(),
            vec![Tree::Text("a\n".to_owned()), name("true")],
        );
        assert_eq!(read[1].field("h"), Some(&Tree::List(vec![pair])));
    }

    #[test]
    fn what_is_no_trace_is_refused() {
        for text in [
            "", "A", "[A(", "[(a: )", "[[1 2]", "[\"a", "[\"\\q\"", "[{1}", "[)",
        ] {
            assert!(values(text).is_err(), "{text}");
        }
        assert!(values(&"[".repeat(100_000)).is_err());
    }
}
