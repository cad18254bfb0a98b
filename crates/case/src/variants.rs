//! Variants of a scene, and what their frames have to do with each other.

use crate::draw::write_mask;
use crate::error::At;
use crate::file::{Variant, parse_scene, substitute, typed};
use crate::relation::Relation;
use crate::wire::{RelationWire, VariantWire};
use etalon_scene::Scene;
use serde_json::Value;
use std::collections::BTreeMap;

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

/// The attachment of a name that is read back.
pub(crate) fn read_back(scene: &Scene, name: &str) -> Result<usize, At> {
    let mut read = scene.read.iter().copied();
    read.find(|index| scene.attachments[*index].name == name)
        .ok_or_else(|| At::new(format!("`{name}` is not read back")))
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

/// What the frames have to do with each other, checked against the scenes.
pub(crate) fn relation(
    value: &Value,
    values: &BTreeMap<&str, &Value>,
    scene: &Scene,
    variants: &[Variant],
) -> Result<Option<Relation>, At> {
    if value.is_null() {
        return match variants {
            [] => Ok(None),
            _ => Err(At::new(
                "variants need a relation, or nothing is asserted of them",
            )),
        };
    }
    let wire: RelationWire = typed(&substitute(value, values)?)?;
    let mut attachments = Vec::new();
    for (i, name) in wire.attachments.iter().enumerate() {
        let index = read_back(scene, name).map_err(|e| e.index(i).key("attachments"))?;
        attachments.push(index);
    }
    let key = |index: &usize| {
        let a = &scene.attachments[*index];
        (a.format, a.size, a.samples)
    };
    if attachments
        .windows(2)
        .any(|pair| key(&pair[0]) != key(&pair[1]))
    {
        let message = "the attachments differ in format, size or samples";
        return Err(At::new(message).key("attachments"));
    }
    if attachments.len() < 2 && variants.is_empty() {
        return Err(At::new("a relation needs variants or two attachments"));
    }
    let shape = |scene: &Scene| -> Vec<_> {
        let read = scene.read.iter().map(|i| &scene.attachments[*i]);
        read.map(|a| (a.name.clone(), a.format, a.size, a.samples))
            .collect()
    };
    if let Some(other) = variants.iter().find(|v| shape(&v.scene) != shape(scene)) {
        return Err(At::new(format!(
            "variant `{}` reads other images back than the scene",
            other.name
        )));
    }
    Ok(Some(Relation {
        invariance: wire.same,
        within: wire.within,
        channels: write_mask(&wire.channels).map_err(|e| e.key("channels"))?,
        offset: wire.offset,
        attachments,
    }))
}
