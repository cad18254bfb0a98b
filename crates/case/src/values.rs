//! Values of case files: typed parsing, and substitution of names.

use crate::error::At;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::BTreeMap;

/// Returns true if a text is a word: ASCII letters, digits and `-_.+`, which need no escape in an id.
pub(crate) fn is_word(text: &str) -> bool {
    !text.is_empty()
        && text
            .bytes()
            .all(|b| b.is_ascii_alphanumeric() || b"-_.+".contains(&b))
}

/// Parses a value. An error names its place within the value.
pub(crate) fn typed<T: DeserializeOwned>(value: &Value) -> Result<T, At> {
    // Tracking the path of an error takes as long as parsing, so it is tracked only if there is one.
    T::deserialize(value)
        .or_else(|_| serde_path_to_error::deserialize(value).map_err(At::from_typed))
}

/// Replaces every string `"$name"` by the value of that name.
pub(crate) fn substitute(value: &Value, values: &BTreeMap<&str, &Value>) -> Result<Value, At> {
    replace(value, &mut |name| match values.get(name) {
        Some(value) => Ok((*value).clone()),
        None => {
            let known: Vec<&str> = values.keys().copied().collect();
            Err(At::new(format!(
                "there is no axis or derived value `{name}`; there are: {}",
                known.join(", ")
            )))
        }
    })
}

/// Replaces every string `"$name"` by the result of a function.
pub(crate) fn replace(
    value: &Value,
    lookup: &mut dyn FnMut(&str) -> Result<Value, At>,
) -> Result<Value, At> {
    Ok(match value {
        Value::String(text) => match text.strip_prefix('$') {
            None => value.clone(),
            Some(name) => lookup(name)?,
        },
        // A list of numbers contains no name. Texels are such lists, and long.
        Value::Array(list) if list.iter().all(Value::is_number) => value.clone(),
        Value::Array(list) => Value::Array(
            list.iter()
                .enumerate()
                .map(|(i, v)| replace(v, lookup).map_err(|e| e.index(i)))
                .collect::<Result<_, _>>()?,
        ),
        Value::Object(map) => Value::Object(
            map.iter()
                .map(|(k, v)| {
                    let v = replace(v, lookup).map_err(|e| e.key(k))?;
                    Ok((k.clone(), v))
                })
                .collect::<Result<_, At>>()?,
        ),
        Value::Null | Value::Bool(_) | Value::Number(_) => value.clone(),
    })
}
