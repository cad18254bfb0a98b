//! Relations between several frames, or between several attachments of one frame.

use crate::attachment::read_back;
use crate::draw::write_mask;
use crate::error::At;
use crate::values::{substitute, typed};
use crate::variants::Variant;
use crate::wire::RelationWire;
use etalon_scene::{Invariance, Scene};
use serde_json::Value;
use std::collections::BTreeMap;

/// Pictures that must be the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Relation {
    /// The reason why they must be the same.
    pub invariance: Invariance,
    /// Left, top, width and height of the texels that are compared; `None` for all.
    pub within: Option<[u32; 4]>,
    /// The mask of the colour channels that are compared: bit 0 is red, bit 3 alpha.
    pub channels: u8,
    /// The offset of the variants' pictures in texels, to the right and down.
    pub offset: [i32; 2],
    /// Indices of the attachments of each frame that are compared with each other; empty if the variants'
    /// frames are compared with the scene's own.
    pub attachments: Vec<usize>,
}

/// The relation between the frames of a scene that is submitted several times.
const REPEATED: Relation = Relation {
    invariance: Invariance::Repeat,
    within: None,
    channels: 0b1111,
    offset: [0, 0],
    attachments: Vec::new(),
};

/// Parses a relation and checks it against the scenes.
pub(crate) fn relation(
    value: &Value,
    values: &BTreeMap<&str, &Value>,
    scene: &Scene,
    variants: &[Variant],
) -> Result<Option<Relation>, At> {
    if value.is_null() {
        // A scene that is submitted again must give the same frame, even without a relation.
        let is_again = |variant: &Variant| variant.submissions.is_some();
        return match variants {
            [] => Ok(None),
            again if again.iter().all(is_again) => Ok(Some(REPEATED)),
            _ => Err(At::new(
                "variants need a relation, or nothing is asserted about them",
            )),
        };
    }
    let wire: RelationWire = typed(&substitute(value, values)?)?;
    if wire.same != Invariance::Repeat && variants.iter().any(|v| v.submissions.is_some()) {
        let message = "a scene that is submitted again needs the relation `repeat`";
        return Err(At::new(message).key("same"));
    }
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
        return Err(At::new(
            "a relation needs variants or at least two attachments",
        ));
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
