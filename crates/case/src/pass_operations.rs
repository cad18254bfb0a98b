//! Load and store operations and clear commands of a pass: parses them and refuses impossible ones.

use crate::attachment::check_integer_value;
use crate::codes::beside;
use crate::draw::write_mask;
use crate::error::At;
use crate::wire::{ClearCommandWire, ClearMaskWire, PassWire};
use etalon_frame::TextureFormat;
use etalon_scene::{Clear, ClearTarget, LoadOperation, Operations, PassOperations, StoreOperation};

/// The parts of a pass that its operations and clears refer to.
pub(crate) struct PassTarget {
    pub(crate) size: [u32; 2],
    /// The formats of the colour attachments.
    pub(crate) color: Vec<TextureFormat>,
    pub(crate) depth_stencil: Option<TextureFormat>,
    pub(crate) draws: usize,
}

impl PassTarget {
    fn has_depth(&self) -> bool {
        self.depth_stencil.is_some_and(TextureFormat::has_depth)
    }

    fn has_stencil(&self) -> bool {
        self.depth_stencil.is_some_and(TextureFormat::has_stencil)
    }
}

/// Returns the load and store operations of a pass.
pub(crate) fn operations(wire: &PassWire, target: &PassTarget) -> Result<PassOperations, At> {
    let PassOperations {
        color,
        depth,
        stencil,
    } = &wire.operations;
    for (i, operations) in color.iter().enumerate() {
        let check = || -> Result<(), At> {
            let format = color_at(target, i)?;
            match operations.load {
                LoadOperation::Load => Ok(()),
                LoadOperation::Clear(value) => {
                    color_value(format, value).map_err(|e| e.key("clear").key("load"))
                }
            }
        };
        check().map_err(|e| e.index(i).key("color"))?;
    }
    if let Some(value) = depth.load.clear_value() {
        depth_value(value).map_err(|e| e.key("clear").key("load").key("depth"))?;
    }
    let aspects = [
        ("depth", target.has_depth(), is_default(depth)),
        ("stencil", target.has_stencil(), is_default(stencil)),
    ];
    for (name, has, same) in aspects {
        if same {
            continue;
        }
        if !has {
            return Err(At::new(format!("the pass has no {name}")).key(name));
        }
        if wire.depth_stencil_read_only {
            let message = "the pass declares that it writes neither depth nor stencil";
            return Err(At::new(message).key(name));
        }
    }
    Ok(wire.operations.clone())
}

fn is_default<V: PartialEq>(operations: &Operations<V>) -> bool {
    operations.load == LoadOperation::Load && operations.store == StoreOperation::Store
}

/// Returns the clear commands of a pass.
pub(crate) fn clears(wire: &PassWire, target: &PassTarget) -> Result<Vec<Clear>, At> {
    let mut clears: Vec<Clear> = Vec::new();
    for (i, listed) in wire.clears.iter().enumerate() {
        let made = || -> Result<Vec<Clear>, At> {
            if listed.before > target.draws {
                let message = format!("the pass has {} draws", target.draws);
                return Err(At::new(message).key("before"));
            }
            if clears
                .last()
                .is_some_and(|last| last.before > listed.before)
            {
                let message = "clears must be in the order of the draws that they precede";
                return Err(At::new(message).key("before"));
            }
            let clear = |listed: &ClearCommandWire| -> Result<Clear, At> {
                Ok(Clear {
                    before: listed.before,
                    target: clear_target(listed, wire.depth_stencil_read_only, target)?,
                    rect: rect(listed, target.size).map_err(|e| e.key("rect"))?,
                })
            };
            let Some(values) = &listed.values else {
                return Ok(vec![clear(listed)?]);
            };
            if listed.value.is_some() || listed.rect.is_some() {
                let message = "`values` gives each texel a value";
                return Err(At::new(message).key("values"));
            }
            let colors = beside(values.of, &values.by, target.size);
            let texels = colors.map_err(|e| e.key("values"))?.into_iter().zip(0..);
            let texels = texels.map(|(color, texel): (_, u32)| {
                let [x, y] = [texel % target.size[0], texel / target.size[0]];
                clear(&ClearCommandWire {
                    value: Some(color),
                    rect: Some([x, y, 1, 1]),
                    ..listed.clone()
                })
            });
            texels.collect()
        };
        let made = made().map_err(|e| e.index(i))?;
        clears.extend(made);
    }
    Ok(clears)
}

fn clear_target(
    wire: &ClearCommandWire,
    read_only: bool,
    target: &PassTarget,
) -> Result<ClearTarget, At> {
    let Some(location) = wire.color else {
        return clear_depth_stencil(wire, read_only, target);
    };
    if wire.depth.is_some() || wire.stencil.is_some() {
        let message = "colour is cleared separately from depth and stencil";
        return Err(At::new(message).key("color"));
    }
    let format = color_at(target, location).map_err(|e| e.key("color"))?;
    let value = wire
        .value
        .ok_or_else(|| At::new("a cleared colour needs a `value`").key("color"))?;
    color_value(format, value).map_err(|e| e.key("value"))?;
    let write_mask = match &wire.write_mask {
        None => Ok(0b1111),
        Some(ClearMaskWire::Channels(letters)) => write_mask(letters),
        Some(_) => Err(At::new("the mask of colours consists of letters of rgba")),
    };
    Ok(ClearTarget::Color {
        location,
        value,
        write_mask: write_mask.map_err(|e| e.key("write_mask"))?,
    })
}

fn clear_depth_stencil(
    wire: &ClearCommandWire,
    read_only: bool,
    target: &PassTarget,
) -> Result<ClearTarget, At> {
    if wire.value.is_some() {
        return Err(At::new("`value` belongs to `color`").key("value"));
    }
    let (depth, stencil) = (wire.depth, wire.stencil);
    let aspects = [
        ("depth", depth.is_some(), target.has_depth()),
        ("stencil", stencil.is_some(), target.has_stencil()),
    ];
    for (name, cleared, has) in aspects {
        if cleared && !has {
            return Err(At::new(format!("the pass has no {name}")).key(name));
        }
        if cleared && read_only {
            let message = "the pass declares that it writes neither depth nor stencil";
            return Err(At::new(message).key(name));
        }
    }
    if let Some(value) = depth {
        depth_value(value).map_err(|e| e.key("depth"))?;
    }
    let (depth_write, stencil_write_mask) = match (&wire.write_mask, depth, stencil) {
        (_, None, None) => {
            return Err(At::new("a clear needs a `color`, `depth` or `stencil`"));
        }
        (None, ..) => (true, 0xff),
        (Some(ClearMaskWire::Depth(write)), Some(_), None) => (*write, 0xff),
        (Some(ClearMaskWire::Stencil(bits)), None, Some(_)) => (true, *bits),
        (Some(ClearMaskWire::Both { depth, stencil }), Some(_), Some(_)) => (*depth, *stencil),
        _ => {
            let message = "the mask of depth is true or false, and of stencil an 8-bit number, \
                           that of both {\"depth\": …, \"stencil\": …}";
            return Err(At::new(message).key("write_mask"));
        }
    };
    Ok(ClearTarget::DepthStencil {
        depth,
        stencil,
        depth_write,
        stencil_write_mask,
    })
}

fn color_at(target: &PassTarget, location: usize) -> Result<TextureFormat, At> {
    let missing = || At::new("there is no colour attachment at this location");
    target.color.get(location).copied().ok_or_else(missing)
}

fn color_value(format: TextureFormat, value: [f32; 4]) -> Result<(), At> {
    check_integer_value(format, value)?;
    if !value.iter().all(|v| v.is_finite()) {
        return Err(At::new("a cleared colour must be finite"));
    }
    Ok(())
}

fn depth_value(value: f32) -> Result<(), At> {
    if (0.0..=1.0).contains(&value) {
        return Ok(());
    }
    Err(At::new("a cleared depth must be between 0 and 1"))
}

/// Returns the rectangle of a clear, which must be inside the attachments.
fn rect(wire: &ClearCommandWire, size: [u32; 2]) -> Result<Option<[u32; 4]>, At> {
    let Some([x, y, w, h]) = wire.rect else {
        return Ok(None);
    };
    if w == 0 || h == 0 {
        return Err(At::new("an empty rectangle clears nothing"));
    }
    if x.saturating_add(w) > size[0] || y.saturating_add(h) > size[1] {
        return Err(At::new("the rectangle reaches beyond the attachments"));
    }
    Ok(wire.rect)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CaseError, CaseFile, Profile};
    use etalon_scene::{ResolveMode, Scene};

    fn build(pass: &str) -> Result<Scene, CaseError> {
        let text = format!(
            r#"{{"about":"t","spec":["t"],"scene":{{
            "attachments":{{"color":{{"format":"rgba8unorm","size":[4,4]}},
                "integer":{{"format":"rgba8uint"}},
                "depth":{{"format":"depth24plus-stencil8"}},"d16":{{"format":"depth16unorm"}},
                "many":{{"format":"depth24plus-stencil8","samples":4}},
                "many16":{{"format":"depth16unorm","samples":4}}}},
            "passes":[{{{pass}}}],"read":["color"]}}}}"#
        );
        let file = CaseFile::parse("t.json", &text).expect("it builds");
        let case = file.cases(Profile::Full).next().expect("it builds");
        case.build().map(|case| case.scene)
    }

    /// Returns a pass without draws, with these keys.
    fn with(keys: &str) -> String {
        format!(r#""color":["color","integer"],"depth_stencil":"depth","draws":[],{keys}"#)
    }

    #[track_caller]
    fn refused(pass: &str, expected: &str) {
        let error = build(pass).expect_err("it is refused");
        assert_eq!(
            format!("{}: {}", error.key, error.message),
            format!("scene.passes[0].{expected}")
        );
    }

    #[test]
    fn operations_are_read_in_the_words_of_webgpu() {
        let scene = build(&with(
            r#""operations":{"color":[{"load":{"clear":[0,1,0,1]},"store":"discard"},{"load":"load"}],
               "stencil":{"load":{"clear":7}}}"#,
        ))
        .expect("it builds");
        let pass = &scene.passes[0];
        let first = pass.color_operations(0);
        assert_eq!(first.load.clear_value(), Some([0.0, 1.0, 0.0, 1.0]));
        assert_eq!(first.store, StoreOperation::Discard);
        assert_eq!(pass.color_operations(1), Operations::default());
        assert_eq!(pass.operations.stencil.load, LoadOperation::Clear(7));
        assert_eq!(pass.operations.depth, Operations::default());
    }

    #[test]
    fn clears_are_read_with_their_masks() {
        let scene = build(&with(
            r#""clears":[{"before":0,"color":0,"value":[0,1,0,1],"write_mask":"ra","rect":[1,2,3,2]},
               {"before":0,"depth":0.5,"stencil":3,"write_mask":{"depth":false,"stencil":15}},
               {"before":0,"depth":0.5}]"#,
        ))
        .expect("it builds");
        let [color, both, depth] = &scene.passes[0].clears[..] else {
            panic!("{:?}", scene.passes[0].clears);
        };
        let expected = ClearTarget::Color {
            location: 0,
            value: [0.0, 1.0, 0.0, 1.0],
            write_mask: 0b1001,
        };
        assert_eq!((color.target, color.rect), (expected, Some([1, 2, 3, 2])));
        let expected = ClearTarget::DepthStencil {
            depth: Some(0.5),
            stencil: Some(3),
            depth_write: false,
            stencil_write_mask: 15,
        };
        assert_eq!((both.target, both.rect), (expected, None));
        assert!(!depth.target.is_masked());
    }

    #[test]
    fn clearing_or_discarding_an_aspect_that_the_pass_lacks_is_refused() {
        let stencil_less = |keys: &str| format!(r#""depth_stencil":"d16","draws":[],{keys}"#);
        let discard = r#""operations":{"stencil":{"store":"discard"}}"#;
        refused(
            &stencil_less(discard),
            "operations.stencil: the pass has no stencil",
        );
        let clear = r#""clears":[{"before":0,"depth":1,"stencil":1}]"#;
        refused(
            &stencil_less(clear),
            "clears[0].stencil: the pass has no stencil",
        );
        let color = r#""clears":[{"before":0,"color":2,"value":[0,0,0,0]}]"#;
        refused(
            &with(color),
            "clears[0].color: there is no colour attachment at this location",
        );
        let color = r#""operations":{"color":[{},{},{}]}"#;
        refused(
            &with(color),
            "operations.color[2]: there is no colour attachment at this location",
        );
    }

    #[test]
    fn a_read_only_pass_neither_clears_nor_discards() {
        let read_only = |keys: &str| with(&format!(r#""depth_stencil_read_only":true,{keys}"#));
        let expected =
            |key| format!("{key}: the pass declares that it writes neither depth nor stencil");
        refused(
            &read_only(r#""operations":{"depth":{"load":{"clear":1}}}"#),
            &expected("operations.depth"),
        );
        refused(
            &read_only(r#""operations":{"depth":{"store":"discard"}}"#),
            &expected("operations.depth"),
        );
        refused(
            &read_only(r#""clears":[{"before":0,"depth":1}]"#),
            &expected("clears[0].depth"),
        );
        let color = r#""clears":[{"before":0,"color":0,"value":[0,0,0,0]}]"#;
        assert!(build(&read_only(color)).is_ok());
    }

    #[test]
    fn a_resolve_of_depth_and_stencil_fits_its_attachment() {
        let resolve = |from: &str, keys: &str| {
            format!(r#""depth_stencil":"{from}","draws":[],"depth_stencil_resolve":{{{keys}}}"#)
        };
        let scene = build(&resolve("many", r#""to":"depth","depth":"min""#)).expect("it builds");
        let made = scene.passes[0].depth_stencil_resolve.expect("it builds");
        assert_eq!(scene.attachments[made.to].name, "depth");
        assert_eq!(
            (made.depth, made.stencil),
            (ResolveMode::Min, ResolveMode::None)
        );
        for (from, keys, expected) in [
            (
                "many",
                r#""to":"d16","depth":"min""#,
                "depth_stencil_resolve.to: `d16` differs in format or size from `many`",
            ),
            (
                "many",
                r#""to":"many","depth":"min""#,
                "depth_stencil_resolve.to: a resolve goes from several samples to one",
            ),
            (
                "depth",
                r#""to":"depth","depth":"min""#,
                "depth_stencil_resolve.to: a resolve goes from several samples to one",
            ),
            (
                "many",
                r#""to":"depth","stencil":"average""#,
                "depth_stencil_resolve.stencil: stencil cannot be averaged",
            ),
            (
                "many",
                r#""to":"depth""#,
                "depth_stencil_resolve: a resolve needs a mode for `depth` or `stencil`",
            ),
            (
                "many16",
                r#""to":"d16","stencil":"min""#,
                "depth_stencil_resolve.stencil: the pass has no stencil",
            ),
        ] {
            refused(&resolve(from, keys), expected);
        }
        let none =
            r#""color":["color"],"draws":[],"depth_stencil_resolve":{"to":"depth","depth":"min"}"#;
        refused(
            none,
            "depth_stencil_resolve: the pass has neither depth nor stencil",
        );
    }

    #[test]
    fn values_places_and_order_of_clears_are_checked() {
        let clears = |clears: &str| with(&format!(r#""clears":[{clears}]"#));
        let mask = "clears[0].write_mask: the mask of depth is true or false, and of stencil an 8-bit number, \
                    that of both {\"depth\": …, \"stencil\": …}";
        for (list, expected) in [
            (
                r#"{"before":1,"depth":1}"#,
                "clears[0].before: the pass has 0 draws",
            ),
            (
                r#"{"before":0}"#,
                "clears[0]: a clear needs a `color`, `depth` or `stencil`",
            ),
            (
                r#"{"before":0,"color":0}"#,
                "clears[0].color: a cleared colour needs a `value`",
            ),
            (
                r#"{"before":0,"depth":1,"value":[0,0,0,0]}"#,
                "clears[0].value: `value` belongs to `color`",
            ),
            (
                r#"{"before":0,"depth":2}"#,
                "clears[0].depth: a cleared depth must be between 0 and 1",
            ),
            (
                r#"{"before":0,"color":1,"value":[0,0,0.5,0]}"#,
                "clears[0].value: integers must be from 0 to 255",
            ),
            (
                r#"{"before":0,"color":0,"value":[0,0,0,0],"depth":1}"#,
                "clears[0].color: colour is cleared separately from depth and stencil",
            ),
            (
                r#"{"before":0,"depth":1,"rect":[1,1,4,1]}"#,
                "clears[0].rect: the rectangle reaches beyond the attachments",
            ),
            (
                r#"{"before":0,"depth":1,"rect":[1,1,0,1]}"#,
                "clears[0].rect: an empty rectangle clears nothing",
            ),
            (r#"{"before":0,"depth":1,"write_mask":3}"#, mask),
            (r#"{"before":0,"stencil":1,"write_mask":false}"#, mask),
            (
                r#"{"before":0,"color":0,"value":[0,0,0,0],"write_mask":1}"#,
                "clears[0].write_mask: the mask of colours consists of letters of rgba",
            ),
            (
                r#"{"before":0,"color":0,"value":[0,0,0,0],"write_mask":"rx"}"#,
                "clears[0].write_mask: a write mask consists of the letters r, g, b, a, each at most once",
            ),
        ] {
            refused(&clears(list), expected);
        }
        let draw = r#"{"mesh":{"kind":"full"},"shader":"uniform_color"}"#;
        let turned = format!(
            r#""color":["color"],"draws":[{draw}],"clears":[
               {{"before":1,"color":0,"value":[0,0,0,0]}},{{"before":0,"color":0,"value":[0,0,0,0]}}]"#
        );
        refused(
            &turned,
            "clears[1].before: clears must be in the order of the draws that they precede",
        );
        let operations = r#""operations":{"color":[{},{"load":{"clear":[0,0,256,0]}}]}"#;
        refused(
            &with(operations),
            "operations.color[1].load.clear: integers must be from 0 to 255",
        );
        let operations = r#""operations":{"depth":{"load":{"clear":-1}}}"#;
        refused(
            &with(operations),
            "operations.depth.load.clear: a cleared depth must be between 0 and 1",
        );
    }
}
