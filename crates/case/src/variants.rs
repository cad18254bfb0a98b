//! Variants of a scene.

use crate::error::At;
use crate::resolve::parse_scene;
use crate::values::substitute;
use crate::wire::VariantWire;
use etalon_scene::Scene;
use serde_json::Value;
use std::collections::BTreeMap;
use std::num::NonZeroU32;

/// A changed scene, or the case's own scene read again.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// The variant's name in records.
    pub name: String,
    /// The scene that adapters draw.
    pub scene: Scene,
    /// The number of further submissions of the case's own prepared scene after which this frame is read;
    /// `None` for a scene that is prepared separately.
    pub submissions: Option<NonZeroU32>,
}

/// Returns the frames of a scene that is submitted several times.
pub(crate) fn read_again(scene: &Scene, submissions: &[NonZeroU32]) -> Result<Vec<Variant>, At> {
    let mut variants: Vec<Variant> = Vec::new();
    for (i, number) in submissions.iter().enumerate() {
        let name = format!("{number}-more");
        if variants.iter().any(|v| v.name == name) {
            return Err(At::new(format!("{number} occurs twice")).index(i));
        }
        if number.get() > MOST_SUBMISSIONS {
            let message =
                format!("a scene can be submitted at most {MOST_SUBMISSIONS} further times");
            return Err(At::new(message).index(i));
        }
        variants.push(Variant {
            name,
            scene: scene.clone(),
            submissions: Some(*number),
        });
    }
    Ok(variants)
}

/// The maximum number of submissions between two read-backs.
const MOST_SUBMISSIONS: u32 = 1024;

/// Returns the value of a scene at a JSON pointer.
fn value_at<'v>(scene: &'v mut Value, pointer: &str) -> Result<&'v mut Value, At> {
    let missing = || At::new("the scene has no value at this JSON pointer");
    scene.pointer_mut(pointer).ok_or_else(missing)
}

/// Changes a scene: each value at a JSON pointer is replaced.
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

/// Returns the scene with a variant's changes.
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
                .ok_or_else(|| At::new("this is not a list"))?;
            let mut seen = order.clone();
            seen.sort_unstable();
            if !seen.into_iter().eq(0..items.len()) {
                return Err(At::new(format!(
                    "an order must list each of the {} items once, counted from 0",
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
        submissions: None,
    })
}

#[cfg(test)]
mod tests {
    use crate::{Case, CaseError, CaseFile, Profile};
    use etalon_scene::Invariance;

    fn case(more: &str) -> Result<Case, CaseError> {
        let text = format!(
            r#"{{"about":"t","spec":["t"],"scene":{{"attachments":{{"c":{{"format":"rgba8unorm"}}}},
            "passes":[{{"color":["c"],"draws":[]}}],"read":["c"]}},{more}}}"#
        );
        let file = CaseFile::parse("t.json", &text)?;
        file.cases(Profile::Full).next().expect("a case").build()
    }

    #[test]
    fn submissions_read_the_same_prepared_scene_again() {
        let again = case(
            r#""submissions":[1,64],"variants":[{"name":"anew"}],"relation":{"same":"repeat"}"#,
        )
        .expect("builds");
        let names: Vec<_> = again.variants.iter().map(|v| v.name.as_str()).collect();
        assert_eq!(names, ["1-more", "64-more", "anew"]);
        let readings: Vec<_> = again.preparations().map(|(_, times)| times).collect();
        assert_eq!(readings, [vec![1, 1, 64], vec![1]]);
        let judged: Vec<_> = (0..4).map(|frame| again.judged_index(frame)).collect();
        assert_eq!(judged, [0, 0, 0, 3]);
        let alone = case(r#""submissions":[2]"#).expect("builds");
        let relation = alone.relation.expect("the frames are compared");
        assert_eq!(relation.invariance, Invariance::Repeat);
    }

    #[test]
    fn submissions_that_make_no_sense_are_refused() {
        for (more, message) in [
            (r#""submissions":[1,1]"#, "1 occurs twice"),
            (
                r#""submissions":[5000]"#,
                "a scene can be submitted at most 1024 further times",
            ),
            (
                r#""submissions":[0]"#,
                "invalid value: integer `0`, expected a nonzero u32",
            ),
            (
                r#""submissions":[1],"relation":{"same":"contents"}"#,
                "a scene that is submitted again needs the relation `repeat`",
            ),
        ] {
            let error = case(more).expect_err(more);
            assert_eq!(error.message, message);
        }
    }
}
