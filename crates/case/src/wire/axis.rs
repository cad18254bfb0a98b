//! Axes, and values derived from them.

use crate::place::PathStep;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// The values of an axis: a list, or `count` consecutive integers.
#[derive(Clone, Debug)]
pub(crate) struct Axis(Vec<AxisValue>);

impl std::ops::Deref for Axis {
    type Target = [AxisValue];

    fn deref(&self) -> &[AxisValue] {
        &self.0
    }
}

/// `count` consecutive integers, starting at `from`.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct IntegerRange {
    from: u32,
    count: u16,
}

impl<'de> Deserialize<'de> for Axis {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
        use serde::de::{MapAccess, SeqAccess, Visitor};
        struct Values;
        impl<'de> Visitor<'de> for Values {
            type Value = Axis;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a list of values or {\"from\": …, \"count\": …}")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Axis, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(Axis)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Axis, A::Error> {
                let range = IntegerRange::deserialize(MapAccessDeserializer::new(map))?;
                let values = (0..u64::from(range.count)).map(|i| {
                    let number = u64::from(range.from) + i;
                    AxisValue {
                        name: number.to_string(),
                        value: number.into(),
                    }
                });
                Ok(Axis(values.collect()))
            }
        }
        deserializer.deserialize_any(Values)
    }
}

impl JsonSchema for Axis {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Axis".into()
    }
    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let value = generator.subschema_for::<AxisValue>();
        let range = generator.subschema_for::<IntegerRange>();
        schemars::json_schema!({
            "description": "The values of an axis: a list, or `count` consecutive integers starting at `from`.",
            "anyOf": [{ "type": "array", "items": value }, range]
        })
    }
}

/// One value of an axis: a string, number or boolean, or a named value of any kind.
#[derive(Clone, Debug)]
pub(crate) struct AxisValue {
    pub(crate) name: String,
    pub(crate) value: Value,
}

impl<'de> Deserialize<'de> for AxisValue {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Named {
            name: String,
            value: Value,
        }
        use serde::de::Error;
        let value = Value::deserialize(deserializer)?;
        let name = match &value {
            Value::String(text) => text.clone(),
            Value::Bool(flag) => flag.to_string(),
            Value::Number(number) => match number.as_f64() {
                // 1.0 is named `1` in ids.
                Some(float) if !number.is_i64() && !number.is_u64() => float.to_string(),
                _ => number.to_string(),
            },
            Value::Object(_) => {
                let named: Named = serde_json::from_value(value).map_err(D::Error::custom)?;
                return Ok(Self {
                    name: named.name,
                    value: named.value,
                });
            }
            Value::Null | Value::Array(_) => {
                return Err(D::Error::custom(
                    "an axis value is a string, number, boolean or {\"name\": …, \"value\": …}",
                ));
            }
        };
        Ok(Self { name, value })
    }
}

impl JsonSchema for AxisValue {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "AxisValue".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "description": "A value of an axis, or any value with a name for the id.",
            "anyOf": [
                { "type": ["string", "number", "boolean"] },
                {
                    "type": "object",
                    "properties": { "name": { "type": "string" }, "value": {} },
                    "required": ["name", "value"],
                    "additionalProperties": false
                }
            ]
        })
    }
}

/// A value derived from an axis: the axis's own value some positions further on, so that two states differ in
/// every case, or a value of its own for each value of the axis.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct DerivedWire {
    /// The name of the axis that the value follows.
    pub(crate) axis: String,
    /// The number of positions further on, wrapping at the end.
    #[serde(default)]
    pub(crate) shift: usize,
    /// One value for each value of the axis, used instead of it.
    pub(crate) values: Option<DerivedValues>,
}

impl DerivedWire {
    /// Returns the index of the axis's value that belongs to a case at a position of the axis.
    pub(crate) fn index(&self, axis: &[AxisValue], position: usize) -> usize {
        (position + self.shift % axis.len()) % axis.len()
    }
}

/// The key of the value for all values of an axis that are not named.
pub(crate) const OTHERS: &str = "*";

/// A value for each value of an axis.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(
    untagged,
    expecting = "a list of values, or an object with a value by name"
)]
pub(crate) enum DerivedValues {
    /// In the axis's order.
    Listed(Vec<Value>),
    /// By the names of the axis's values; the value of `*` is for all others.
    Named(BTreeMap<String, Value>),
}

impl DerivedValues {
    /// Returns the value for the axis's value at an index, and its place in the file; `None` if it has none.
    pub(crate) fn get(&self, axis: &[AxisValue], index: usize) -> Option<(&Value, PathStep)> {
        match self {
            Self::Listed(values) => Some((values.get(index)?, PathStep::Index(index))),
            Self::Named(values) => {
                let by_name = values.get_key_value(&axis.get(index)?.name);
                let (name, value) = by_name.or_else(|| values.get_key_value(OTHERS))?;
                Some((value, PathStep::Key(name.clone())))
            }
        }
    }

    /// Returns the reason why these values do not fit an axis, if there is one.
    pub(crate) fn mismatch(&self, name: &str, axis: &[AxisValue]) -> Option<String> {
        match self {
            Self::Listed(values) => (values.len() != axis.len())
                .then(|| format!("axis `{name}` has {} values", axis.len())),
            Self::Named(values) => {
                let is_known = |key: &str| key == OTHERS || axis.iter().any(|v| v.name == key);
                if let Some(unknown) = values.keys().find(|key| !is_known(key)) {
                    return Some(format!("no axis `{name}` has a value `{unknown}`"));
                }
                let missing = (0..axis.len()).find(|index| self.get(axis, *index).is_none())?;
                let value = &axis[missing].name;
                Some(format!(
                    "`values` has no entry for the value `{value}` of axis `{name}`, and no `*`"
                ))
            }
        }
    }
}
