//! Refuses paths that a scene cannot take.
//!
//! Not every value of a path applies to every attachment and draw. A scene to which a value does not apply at
//! all is refused, since its case would claim to test something that no driver executes.

use crate::error::At;
use etalon_frame::{
    ChannelEncoding, PathArea, PathClears, PathDraws, PathEnd, PathLayers, PathStart, PathState,
    PathTarget, PathValue, PathViewport, PathViews, TextureFormat,
};
use etalon_scene::{
    Attachment, AttachmentContents, ClearTarget, ColorTarget, Draw, Multisample, Pass, Scene,
    Shader, Vertex,
};

/// Checks that every value of a scene's path applies to something.
pub(crate) fn check_path(scene: &Scene) -> Result<(), At> {
    for value in scene.path.values() {
        if let Some(reason) = impossible(scene, value) {
            return Err(At::new(format!("{value}: {reason}")).key(value.key()));
        }
    }
    Ok(())
}

/// Returns the reason why a value applies to nothing in the scene. One arm per value.
fn impossible(scene: &Scene, value: PathValue) -> Option<&'static str> {
    let any = |holds: &dyn Fn(usize, &Attachment) -> bool| {
        let mut attachments = scene.attachments.iter().enumerate();
        attachments.any(|(index, attachment)| holds(index, attachment))
    };
    let read = |index: usize, a: &Attachment| a.samples == 1 && scene.read.contains(&index);
    // Formats whose values a blit might round.
    let normalized = |a: &Attachment| {
        let mut channels = a.format.color_channels().iter();
        channels.any(|e| !e.is_float() && !matches!(e, ChannelEncoding::Uint(_)))
    };
    let drawn = |index: usize| scene.passes.iter().any(|p| p.color.contains(&index));
    let draws = || scene.passes.iter().flat_map(|p| &p.draws);
    let made = || scene.on_path();
    let tessellated = draws().any(|d| d.tessellation.is_some());
    let layered = || scene.layers() != PathLayers::One;
    let (applies, reason) = match value {
        PathValue::Layers(_) => (
            layered() && draws().next().is_some(),
            "there is no draw, or a draw counts, stores or is tessellated",
        ),
        PathValue::Target(_) if layered() => (false, "passes have layers"),
        PathValue::Resolves(_) => (
            !layered()
                && scene.attachments.iter().all(has_two_values)
                && scene.passes.iter().all(clears_to_two_values)
                && draws().all(|d| writes_two_values(d) && fills_texels(d))
                && scene
                    .passes
                    .iter()
                    .any(|p| p.moved_resolves(&scene.path).next().is_some()),
            "no color is resolved, passes have layers, or a color is not 0 or 1 over whole texels",
        ),
        // Only the last stage before rasterization can select a viewport, and patches cannot be restarted.
        PathValue::Viewport(PathViewport::Array) | PathValue::Draws(PathDraws::Restart)
            if tessellated =>
        {
            (false, "a draw is tessellated")
        }
        PathValue::State(PathState::DynamicOrigin) => (tessellated, "no draw is tessellated"),
        PathValue::Start(PathStart::Transfer) => return None,
        PathValue::Start(_) => (
            made().attachments != scene.attachments,
            "no attachment is first drawn to, with a clear value that is stored exactly",
        ),
        PathValue::Draws(
            PathDraws::Direct
            | PathDraws::Indirect
            | PathDraws::IndirectCount
            | PathDraws::IndirectBeside
            | PathDraws::AfterEmpty,
        )
        | PathValue::State(_) => (draws().next().is_some(), "there is no draw"),
        PathValue::Draws(PathDraws::RestartUnindexed) => (
            draws().any(Draw::is_unindexed_strip),
            "no strip or fan is drawn without indices",
        ),
        PathValue::Colors(_) => (
            any(&|i, _| drawn(i) && scene.is_gap(i)),
            "every colour attachment is read, or its pass has no other that is",
        ),
        PathValue::Tests(_) => (
            scene.passes.iter().any(|pass| {
                let format = pass.depth_stencil.map(|i| scene.attachments[i].format);
                let both = format.is_some_and(|f| f.has_depth() && f.has_stencil());
                !both && !pass.draws.is_empty()
            }),
            "every pass that draws has depth and stencil",
        ),
        PathValue::Draws(_) => {
            let called = |s: &Scene| -> Vec<_> {
                let draws = s.passes.iter().flat_map(|p| &p.draws);
                draws.map(|d| (d.mesh.clone(), d.fetch)).collect()
            };
            let mut without = scene.clone();
            without.path.draws = PathDraws::Direct;
            (
                called(&made()) != called(&without.on_path()),
                "every draw already has such a call, or cannot have one",
            )
        }
        PathValue::Target(PathTarget::MipLevel | PathTarget::LevelOfLayer) => (
            any(&|_, a| a.samples == 1),
            "no attachment has a single sample",
        ),
        PathValue::Target(PathTarget::CubeFace) => (
            any(&|_, a| a.samples == 1 && a.size[0] == a.size[1]),
            "no attachment is square, with a single sample",
        ),
        PathValue::Target(PathTarget::Slice3d) => (
            any(&|i, a| {
                a.samples == 1 && a.format.is_color() && !draws().any(|d| d.textures.contains(&i))
            }),
            "no single-sample colour attachment is without fetches",
        ),
        PathValue::End(PathEnd::Blit) => (
            any(&|i, a| read(i, a) && !normalized(a)),
            "no single-sample attachment of floats, integers, depth or stencil is read back",
        ),
        PathValue::End(PathEnd::BlitMirrored | PathEnd::BlitScaled | PathEnd::BlitPart) => (
            any(&|i, a| read(i, a) && !normalized(a) && a.size[0] > 1 && a.size[1] > 1),
            "no single-sample attachment with several rows and columns is read back, of floats, integers, depth \
             or stencil",
        ),
        PathValue::End(PathEnd::BlitLinear) => (
            scene.attachments.iter().all(has_two_values)
                && draws().all(writes_two_values)
                && scene.passes.iter().all(clears_to_two_values)
                && scene
                    .passes
                    .iter()
                    .all(|p| p.resolve.iter().all(Option::is_none))
                && any(&|i, a| read(i, a) && a.format.is_color()),
            "a colour is neither 0 nor 1, or no single-sample colour attachment is read back",
        ),
        PathValue::End(PathEnd::ReadBuffer) => (
            any(&|i, a| read(i, a) && a.format.is_color() && drawn(i)),
            "no single-sample colour attachment is drawn to and read back",
        ),
        PathValue::End(PathEnd::ShaderRead) => (
            any(&|i, a| read(i, a) && !a.format.is_snorm() && !a.format.is_srgb()),
            "no single-sample attachment is read back whose codes a shader sees",
        ),
        PathValue::End(PathEnd::Part) => (
            any(&|i, a| read(i, a) && a.size.iter().any(|side| *side > 11)),
            "no attachment that is read back has 12 columns or rows and a single sample",
        ),
        PathValue::Clears(PathClears::Together) => (
            made().passes.iter().any(|p| !p.clears.is_empty()),
            "no command clears",
        ),
        PathValue::Clears(PathClears::Undefined) => (
            made()
                .passes
                .iter()
                .any(|p| !p.cleared().is_empty() || p.clears.iter().any(|c| !c.target.is_masked())),
            "nothing is cleared without a mask",
        ),
        PathValue::Results(_) => (!made().queries().is_empty(), "no query counts"),
        PathValue::Area(PathArea::Part) => (
            scene.counters.is_empty() && any(&|_, a| a.size[0] > 1),
            "a draw in two parts counts twice, or nothing has two columns",
        ),
        PathValue::Area(PathArea::Quarters) => (
            scene.counters.is_empty() && any(&|_, a| a.size[0] > 1 && a.size[1] > 1),
            "a draw in several parts counts several times, or nothing has two columns and rows",
        ),
        PathValue::Views(PathViews::Srgb) => (
            any(&|_, a| {
                matches!(
                    a.format,
                    TextureFormat::Rgba8Unorm
                        | TextureFormat::Rgba8UnormSrgb
                        | TextureFormat::Bgra8Unorm
                        | TextureFormat::Bgra8UnormSrgb
                )
            }),
            "no attachment has a format with and without sRGB conversion",
        ),
        PathValue::Views(PathViews::Same | PathViews::Uint) => (
            any(&|_, a| a.format.is_color())
                && matches!(
                    scene.path.end,
                    PathEnd::Store | PathEnd::Copy | PathEnd::ShaderRead | PathEnd::Part
                ),
            "there is no colour attachment, or it is blitted, which converts integers only to integers",
        ),
        PathValue::Reads(_) => (
            scene.passes.iter().any(Pass::reads_itself),
            "no draw reads an attachment of its pass",
        ),
        PathValue::Pass(_)
        | PathValue::Target(_)
        | PathValue::Commands(_)
        | PathValue::End(_)
        | PathValue::Area(_)
        | PathValue::Clears(_)
        | PathValue::Clip(_)
        | PathValue::Viewport(_) => (!scene.passes.is_empty(), "there is no pass"),
    };
    (!applies).then_some(reason)
}

fn is_zero_or_one(value: &f32) -> bool {
    *value == 0.0 || *value == 1.0
}

/// Returns true if the initial contents of an attachment are only zeros and ones, or not colors.
fn has_two_values(attachment: &Attachment) -> bool {
    match &attachment.contents {
        AttachmentContents::Color(value) => value.iter().all(is_zero_or_one),
        AttachmentContents::DepthStencil { .. } => true,
        AttachmentContents::Texels(_) => false,
    }
}

/// Returns true if a draw stores only zeros and ones as colors.
fn writes_two_values(draw: &Draw) -> bool {
    let replaces = |target: &ColorTarget| target.blend.is_none() && target.advanced.is_none();
    draw.shader == Shader::UniformColor
        && draw.params.color.iter().all(is_zero_or_one)
        && draw.logic.is_none()
        && draw.targets.iter().all(replaces)
}

/// Returns true if a draw fills all samples of whole texels, by a triangle far beyond its viewport.
fn fills_texels(draw: &Draw) -> bool {
    let corner = |vertex: &Vertex| {
        let [x, y, _, w] = vertex.position;
        [x / w, y / w]
    };
    let corners: Vec<[f32; 2]> = draw.mesh.vertices.iter().map(corner).collect();
    let [a, b, c] = corners[..] else {
        return false;
    };
    let side = |[from, to]: [[f32; 2]; 2], [x, y]: [f32; 2]| {
        (to[0] - from[0]) * (y - from[1]) - (to[1] - from[1]) * (x - from[0])
    };
    let far = [[-1.5, -1.5], [1.5, -1.5], [-1.5, 1.5], [1.5, 1.5]];
    let edges = [[a, b], [b, c], [c, a]];
    let within = |turn: f32| {
        let mut pairs = edges
            .iter()
            .flat_map(|edge| far.map(|point| (*edge, point)));
        pairs.all(|(edge, point)| turn * side(edge, point) > 0.0)
    };
    (within(1.0) || within(-1.0))
        && draw.viewport.rect.iter().all(|side| side.fract() == 0.0)
        && draw.multisample == Multisample::default()
        && draw.depth.is_none()
        && draw.stencil.is_none()
}

/// Returns true if a pass clears colors only to zeros and ones.
fn clears_to_two_values(pass: &Pass) -> bool {
    let loads = (0..pass.color.len())
        .filter_map(|location| pass.color_operations(location).load.clear_value());
    let clears = pass.clears.iter().filter_map(|clear| match clear.target {
        ClearTarget::Color { value, .. } => Some(value),
        ClearTarget::DepthStencil { .. } => None,
    });
    loads
        .chain(clears)
        .flatten()
        .all(|value| is_zero_or_one(&value))
}

#[cfg(test)]
mod tests {
    use crate::resolve::parse_scene;
    use etalon_frame::{PathStart, PathValue};
    use serde_json::{Value, json};

    fn scene(attachment: Value, path: Value) -> Value {
        json!({
            "attachments": { "color": attachment },
            "passes": [{ "color": ["color"], "draws": [{
                "mesh": { "kind": "full" }, "shader": "flat_color"
            }] }],
            "read": ["color"], "path": path
        })
    }

    #[test]
    fn a_path_is_a_key_of_a_scene() {
        let attachment = json!({ "format": "rgba8unorm" });
        let scene = scene(attachment, json!({ "start": "load-operation" }));
        let parsed = parse_scene(&scene).expect("it is valid");
        assert_eq!(parsed.path.start, PathStart::LoadOperation);
        let names: Vec<_> = parsed
            .requirements()
            .iter()
            .map(|r| r.to_string())
            .collect();
        assert!(names.contains(&"path start=load-operation".to_owned()));
        let text = serde_json::to_string(&parsed).expect("it is plain data");
        assert_eq!(serde_json::from_str(&text).ok(), Some(parsed));
    }

    #[test]
    fn every_path_value_is_accepted_by_some_scene() {
        for value in PathValue::all() {
            let attachment = json!({ "format": "rgba16float" });
            let path = json!({ value.key(): value.name() });
            let mut scene = scene(attachment, path);
            if value.to_string() == "views=srgb" {
                scene["attachments"]["color"]["format"] = json!("rgba8unorm");
            }
            // The shader reads its values from parameters, as one of the paths requires.
            scene["passes"][0]["draws"][0]["shader"] = json!("uniform_color");
            scene["passes"][0]["clears"] =
                json!([{ "before": 0, "color": 0, "value": [0, 0, 0, 0] }]);
            if value.name() == "restart-unindexed" {
                scene["passes"][0]["draws"][0]["topology"] = json!("triangle-strip");
            }
            if value.name() == "dynamic-origin" {
                scene["passes"][0]["draws"][0]["tessellation"] =
                    json!({ "order": "ccw", "origin": "lower-left" });
            }
            if value.key() == "results" {
                scene["counters"] = json!({ "passed": "any-samples-passed" });
                scene["passes"][0]["draws"][0]["counters"] = json!(["passed"]);
            }
            if let PathValue::Reads(_) = value {
                let reading = json!({
                    "mesh": { "kind": "full" }, "shader": "texel_color", "textures": ["color"]
                });
                scene["passes"][0]["draws"] = json!([reading]);
            }
            if let PathValue::Resolves(_) = value {
                scene["attachments"]["color"]["samples"] = json!(4);
                scene["attachments"]["one"] = json!({ "format": "rgba16float" });
                scene["passes"][0]["resolve"] = json!(["one"]);
                scene["passes"][0]["draws"][0]["mesh"] = json!({ "kind": "cover" });
            }
            if let PathValue::Colors(_) = value {
                scene["attachments"]["unread"] = json!({ "format": "rgba16float" });
                scene["passes"][0]["color"] = json!(["color", "unread"]);
                scene["attachments"]["source"] =
                    json!({ "format": "rgba8unorm", "texels": { "kind": "codes" } });
                let draw = &mut scene["passes"][0]["draws"][0];
                draw["shader"] = json!("texel_color_all");
                draw["textures"] = json!(["source"]);
            }
            let parsed = parse_scene(&scene);
            assert!(parsed.is_ok(), "{value}: {parsed:?}");
        }
    }

    #[test]
    fn a_value_that_applies_to_nothing_is_refused() {
        let several = json!({ "format": "rgba8unorm", "samples": 4 });
        let texels = json!({ "format": "rgba8unorm", "texels": { "kind": "codes" } });
        let float = json!({ "format": "rgba16float" });
        let grey = json!({ "format": "rgba8unorm", "clear": [0.5, 0.5, 0.5, 0.5] });
        for (attachment, path, message) in [
            (
                &texels,
                json!({ "start": "load-operation" }),
                "start=load-operation: no attachment is first drawn to, with a clear value that is stored exactly",
            ),
            (
                &grey,
                json!({ "start": "draw" }),
                "start=draw: no attachment is first drawn to, with a clear value that is stored exactly",
            ),
            (
                &several,
                json!({ "target": "mip-level" }),
                "target=mip-level: no attachment has a single sample",
            ),
            (
                &several,
                json!({ "end": "blit" }),
                "end=blit: no single-sample attachment of floats, integers, depth or stencil is read back",
            ),
            (
                &float,
                json!({ "views": "srgb" }),
                "views=srgb: no attachment has a format with and without sRGB conversion",
            ),
            (
                &float,
                json!({ "views": "uint", "end": "blit" }),
                "views=uint: there is no colour attachment, or it is blitted, which converts integers only to integers",
            ),
            (
                &grey,
                json!({ "draws": "restart-unindexed" }),
                "draws=restart-unindexed: no strip or fan is drawn without indices",
            ),
            (
                &grey,
                json!({ "colors": "gaps" }),
                "colors=gaps: every colour attachment is read, or its pass has no other that is",
            ),
        ] {
            let error = parse_scene(&scene(attachment.clone(), path)).expect_err(message);
            assert_eq!(error.message, message);
        }
    }
}
