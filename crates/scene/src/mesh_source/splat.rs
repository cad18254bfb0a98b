//! Four values that can be written as one.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Four values, written as a list of four or as one number for all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Splat(pub [f32; 4]);

impl<'de> Deserialize<'de> for Splat {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> serde::de::Visitor<'de> for Visitor {
            type Value = Splat;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a number or a list of four numbers")
            }
            fn visit_f64<E>(self, v: f64) -> Result<Splat, E> {
                Ok(Splat([v as f32; 4]))
            }
            fn visit_u64<E>(self, v: u64) -> Result<Splat, E> {
                Ok(Splat([v as f32; 4]))
            }
            fn visit_i64<E>(self, v: i64) -> Result<Splat, E> {
                Ok(Splat([v as f32; 4]))
            }
            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, seq: A) -> Result<Splat, A::Error> {
                let inner = serde::de::value::SeqAccessDeserializer::new(seq);
                <[f32; 4]>::deserialize(inner).map(Splat)
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}

impl JsonSchema for Splat {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Splat".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "description": "Four values, or one number for all four.",
            "anyOf": [
                { "type": "number" },
                { "type": "array", "items": { "type": "number" }, "minItems": 4, "maxItems": 4 }
            ]
        })
    }
}
