//! Vertex positions in case files: three numbers, or four with w.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;

/// A position x, y, z and w; in files w is optional and defaults to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position(pub [f32; 4]);

impl From<[f32; 3]> for Position {
    fn from([x, y, z]: [f32; 3]) -> Self {
        Self([x, y, z, 1.0])
    }
}

impl Serialize for Position {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let [x, y, z, w] = self.0;
        if w.to_bits() == 1.0_f32.to_bits() {
            [x, y, z].serialize(serializer)
        } else {
            self.0.serialize(serializer)
        }
    }
}

impl<'de> Deserialize<'de> for Position {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use serde::de::Error;
        match Vec::<f32>::deserialize(deserializer)?[..] {
            [x, y, z] => Ok(Self([x, y, z, 1.0])),
            [x, y, z, w] => Ok(Self([x, y, z, w])),
            _ => Err(D::Error::custom(
                "a position is three numbers, or four with w",
            )),
        }
    }
}

impl JsonSchema for Position {
    fn schema_name() -> Cow<'static, str> {
        "Position".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 4
        })
    }
}
