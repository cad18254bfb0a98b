//! Scenes of draws that alternate between two states, to test what one draw leaves behind for the next.
//!
//! The states are changes to one common draw, so a file contains only the difference between them. Every way
//! to separate the draws (in one pass, in passes, on two framebuffers) is made from the same steps, so a
//! difference between the pictures can only come from the separation.

use crate::error::At;
use crate::wire::{Across, SequenceWire};
use serde_json::{Map, Value, json};
use std::slice::from_ref;

/// The suffix of the names of the second framebuffer's attachments.
const OTHER: &str = "-other";

/// Returns the scene of a sequence.
pub(crate) fn scene(wire: &SequenceWire) -> Result<Value, At> {
    if wire.steps.len() < 2 {
        return Err(At::new("a sequence needs at least two steps").key("steps"));
    }
    let steps: Vec<Value> = wire
        .steps
        .iter()
        .enumerate()
        .map(|(i, step)| {
            let state = [&wire.first, &wire.then][i % 2];
            let mut draw = wire.draw.clone();
            merge(&mut draw, step);
            merge(&mut draw, state);
            draw
        })
        .collect();
    let pass = |draws: &[Value], other: bool| -> Result<Value, At> {
        let mut pass = wire.pass.clone();
        if other {
            rename(&mut pass);
        }
        let object = pass.as_object_mut();
        let object = object.ok_or_else(|| At::new("a pass must be an object").key("pass"))?;
        object.insert("draws".to_owned(), json!(draws));
        Ok(pass)
    };
    let mut attachments = wire.attachments.clone();
    let mut read = wire.read.clone();
    let mut passes = Vec::new();
    match wire.across {
        Across::Draw => passes.push(pass(&[&wire.prepare[..], &steps].concat(), false)?),
        Across::Pass => {
            for (i, step) in steps.iter().enumerate() {
                let before = if i == 0 { &wire.prepare[..] } else { &[] };
                passes.push(pass(&[before, from_ref(step)].concat(), false)?);
            }
        }
        Across::Framebuffer => {
            for name in bound(&wire.pass) {
                let other = format!("{name}{OTHER}");
                if let Some(attachment) = attachments.get(&name).cloned() {
                    attachments.insert(other.clone(), attachment);
                }
                if read.contains(&name) {
                    read.push(other);
                }
            }
            // Both framebuffers are prepared first, so that nothing else sets state between the steps.
            if !wire.prepare.is_empty() {
                passes.push(pass(&wire.prepare, false)?);
                passes.push(pass(&wire.prepare, true)?);
            }
            for (i, step) in steps.iter().enumerate() {
                passes.push(pass(from_ref(step), i % 2 == 1)?);
            }
        }
    }
    Ok(json!({
        "attachments": attachments,
        "passes": passes,
        "read": read,
        "counters": wire.counters,
        "path": wire.path,
    }))
}

/// Changes a value by a JSON merge patch: objects member by member, `null` removes a member, anything else
/// replaces the value (RFC 7396).
fn merge(value: &mut Value, change: &Value) {
    let Value::Object(change) = change else {
        *value = change.clone();
        return;
    };
    if !value.is_object() {
        *value = Value::Object(Map::new());
    }
    let Value::Object(object) = value else { return };
    for (key, change) in change {
        if change.is_null() {
            object.remove(key);
        } else {
            merge(object.entry(key).or_insert(Value::Null), change);
        }
    }
}

/// Returns the names of the attachments that a pass draws or resolves to.
fn bound(pass: &Value) -> Vec<String> {
    let lists = ["color", "resolve"].map(|key| pass[key].as_array());
    let listed = lists.into_iter().flatten().flatten();
    let names = listed.chain([&pass["depth_stencil"]]);
    names.filter_map(Value::as_str).map(str::to_owned).collect()
}

/// Moves a pass to the second framebuffer.
fn rename(pass: &mut Value) {
    let other = |value: &mut Value| {
        if let Some(name) = value.as_str() {
            *value = json!(format!("{name}{OTHER}"));
        }
    };
    for key in ["color", "resolve", "depth_stencil"] {
        match pass.get_mut(key) {
            Some(Value::Array(list)) => list.iter_mut().for_each(other),
            Some(value) => other(value),
            None => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::place::PathStep;
    use crate::resolve::parse_scene;
    use crate::values::typed;
    use etalon_scene::{CompareFunction, Pass, Scene};

    fn made(across: &str) -> Scene {
        let wire = json!({
            "attachments": {
                "color": { "format": "rgba8unorm" },
                "depth": { "format": "depth32float" },
            },
            "pass": { "color": ["color"], "depth_stencil": "depth" },
            "prepare": [{
                "mesh": { "kind": "full" }, "shader": "uniform_color",
                "depth": { "compare": "always", "write": true },
            }],
            "draw": {
                "mesh": { "kind": "full" }, "shader": "uniform_color",
                "depth": { "compare": "never", "write": false },
            },
            "steps": [{}, { "mesh": { "z": 0.25 } }, {}],
            "first": { "depth": { "compare": "less" } },
            "then": { "depth": null },
            "across": across,
            "read": ["color"],
        });
        let wire = typed(&wire).expect("a sequence");
        parse_scene(&scene(&wire).expect("makes a scene")).expect("valid")
    }

    fn compares(pass: &Pass) -> Vec<Option<CompareFunction>> {
        let draws = pass.draws.iter();
        draws.map(|d| d.depth.map(|depth| depth.compare)).collect()
    }

    #[test]
    fn steps_take_turns_in_a_pass_in_passes_and_on_framebuffers() {
        use CompareFunction::{Always, Less};
        let expected = [Some(Always), Some(Less), None, Some(Less)];
        let draw = made("draw");
        assert_eq!(draw.passes.len(), 1);
        assert_eq!(compares(&draw.passes[0]), expected);
        let z = |i: usize| draw.passes[0].draws[i].mesh.vertices[0].position[2];
        assert_eq!([z(1), z(2), z(3)], [0.0, 0.25, 0.0]);
        // Keys that a step leaves out come from the common draw.
        assert!(draw.passes[0].draws[1].depth.is_some_and(|d| !d.write));

        let pass = made("pass");
        let compared: Vec<_> = pass.passes.iter().map(compares).collect();
        assert_eq!(compared, [&expected[..2], &expected[2..3], &expected[3..]]);

        let framebuffer = made("framebuffer");
        let compared: Vec<_> = framebuffer.passes.iter().map(compares).collect();
        assert_eq!(
            compared,
            [
                &expected[..1],
                &expected[..1],
                &expected[1..2],
                &expected[2..3],
                &expected[3..]
            ]
        );
        let name = |i: usize| framebuffer.attachments[i].name.as_str();
        let drawn: Vec<_> = framebuffer
            .passes
            .iter()
            .map(|p| name(p.color[0]))
            .collect();
        let (color, color_other) = ("color", "color-other");
        assert_eq!(drawn, [color, color_other, color, color_other, color]);
        let read: Vec<_> = framebuffer.read.iter().map(|i| name(*i)).collect();
        assert_eq!(read, [color, color_other]);
    }

    #[test]
    fn one_step_is_no_sequence() {
        let wire = json!({
            "attachments": {}, "pass": {}, "draw": {}, "steps": [{}], "first": {}, "then": {},
            "across": "draw", "read": [],
        });
        let wire: SequenceWire = typed(&wire).expect("a sequence");
        let error = scene(&wire).expect_err("is refused");
        assert_eq!(error.path, [PathStep::Key("steps".to_owned())]);
    }
}
