//! JSON as people write it: with comments. Duplicate keys, and numbers that overflow a 32-bit float, are errors.

use crate::comments::without_comments;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};
use std::fmt;

/// Parses a JSON text, which can begin with a byte order mark and have comments after `//`.
///
/// # Errors
/// If it is not JSON, an object has a duplicate key, or a number overflows a 32-bit float; the error names
/// the line.
pub fn parse_json(text: &str) -> Result<Value, serde_json::Error> {
    let text = without_comments(etalon_frame::without_mark(text));
    let strict: Strict = serde_json::from_str(&text)?;
    Ok(strict.0)
}

struct Strict(Value);

impl<'de> Deserialize<'de> for Strict {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(StrictVisitor).map(Self)
    }
}

struct StrictVisitor;

impl<'de> Visitor<'de> for StrictVisitor {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Value, E> {
        if (value as f32).is_infinite() {
            return Err(E::custom(format!("{value:e} overflows a 32-bit float")));
        }
        Ok(value.into())
    }

    fn visit_str<E>(self, text: &str) -> Result<Value, E> {
        Ok(text.into())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Value, A::Error> {
        let mut values = Vec::new();
        while let Some(Strict(value)) = list.next_element()? {
            values.push(value);
        }
        Ok(Value::Array(values))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Value, A::Error> {
        let mut values = Map::new();
        while let Some(key) = map.next_key::<String>()? {
            if values.contains_key(&key) {
                return Err(A::Error::custom(format!("duplicate key `{key}`")));
            }
            let Strict(value) = map.next_value()?;
            values.insert(key, value);
        }
        Ok(Value::Object(values))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unambiguous_json_parses_as_serde_json_parses_it() {
        let text = r#"{ "a": [1, -2, 0.5, true, null, "x", {}], "b": { "a": 3.4028235e38 }, "c": 18446744073709551615 }"#;
        let plain: Value = serde_json::from_str(text).expect("parses");
        assert_eq!(parse_json(text).expect("parses"), plain);
        assert_eq!(
            parse_json(&format!("\u{feff}{text}")).expect("parses"),
            plain
        );
    }

    #[test]
    fn a_repeated_key_and_a_number_too_large_are_refused_with_their_line() {
        for (text, message) in [
            (
                "{ \"a\": 1,\n \"b\": { \"a\": 1,\n \"a\": 2 } }",
                "duplicate key `a` at line 3 column 4",
            ),
            (
                "[1,\n1e39]",
                "1e39 overflows a 32-bit float at line 2 column 4",
            ),
            (
                "[-1e39]",
                "-1e39 overflows a 32-bit float at line 1 column 6",
            ),
            ("[1e999]", "number out of range at line 1 column 6"),
        ] {
            let error = parse_json(text).expect_err("is refused").to_string();
            assert_eq!(error, message);
        }
    }
}
