//! Variants of a scene.

use crate::error::At;
use crate::resolve::parse_scene;
use crate::values::substitute;
use crate::wire::VariantWire;
use etalon_scene::Scene;
use serde_json::Value;
use std::collections::BTreeMap;

/// A scene with changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// Its name in records.
    pub name: String,
    /// The scene that adapters draw.
    pub scene: Scene,
}

/// The value of a scene at a JSON pointer.
fn value_at<'v>(scene: &'v mut Value, pointer: &str) -> Result<&'v mut Value, At> {
    let missing = || At::new("the scene has no value at this JSON pointer");
    scene.pointer_mut(pointer).ok_or_else(missing)
}

/// Changes a scene: JSON pointers and what stands there instead.
pub(crate) fn patch(
    scene: &mut Value,
    changes: &BTreeMap<String, Value>,
    values: &BTreeMap<&str, &Value>,
) -> Result<(), At> {
    for (pointer, value) in changes {
        let mut change = || -> Result<(), At> {
            let target = value_at(scene, pointer)?;
            *target = substitute(value, values)?;
            Ok(())
        };
        change().map_err(|e| e.key(pointer))?;
    }
    Ok(())
}

/// The scene with a variant's changes.
pub(crate) fn variant_scene(
    scene: &Value,
    wire: &VariantWire,
    values: &BTreeMap<&str, &Value>,
) -> Result<Variant, At> {
    let mut changed = scene.clone();
    patch(&mut changed, &wire.patch, values).map_err(|e| e.key("patch"))?;
    for (pointer, order) in &wire.permute {
        let mut permute = || -> Result<(), At> {
            let items = value_at(&mut changed, pointer)?
                .as_array_mut()
                .ok_or_else(|| At::new("this is no list"))?;
            let mut seen = order.clone();
            seen.sort_unstable();
            if !seen.into_iter().eq(0..items.len()) {
                return Err(At::new(format!(
                    "an order names each of the {} items once, from 0",
                    items.len()
                )));
            }
            *items = order.iter().map(|i| items[*i].clone()).collect();
            Ok(())
        };
        permute().map_err(|e| e.key(pointer).key("permute"))?;
    }
    Ok(Variant {
        name: wire.name.clone(),
        scene: parse_scene(&changed)?,
    })
}
