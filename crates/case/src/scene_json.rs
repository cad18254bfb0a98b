//! Scenes written as the JSON of a case file.
//!
//! A scene that was read from a case file no longer has its meshes' descriptions, and a scene made by a
//! method never had any: meshes are written vertex by vertex. Defaults are left out, so that the keys of the
//! JSON are exactly the states of the scene.

use etalon_frame::ChannelEncoding;
use etalon_scene::{
    Attachment, AttachmentContents, Clear, ClearTarget, DepthBias, Draw, EarlyTests, Fetch,
    IndexFormat, Mesh, Multisample, Operations, Params, Pass, Path, PolygonMode, PrimitiveTopology,
    QueryScope, RESTART, ResolveMode, Scene, StencilFace, Viewport,
};
use etalon_scene::{CullMode, FrontFace, PassOperations};
use serde::Serialize;
use serde_json::{Map, Value, json};

/// Returns the scene as JSON for a case file, such that [`build()`](crate::build()) gives the same scene
/// again, with its attachments in ascending order of their names.
///
/// # Errors
/// If an attachment's clear value or texel is not finite, or if a texel's code is not the only one of its value.
/// All other numbers must be finite, as the scenes of case files are.
pub fn scene_json(scene: &Scene) -> Result<Value, &'static str> {
    let mut attachments = Map::new();
    for attachment in &scene.attachments {
        attachments.insert(attachment.name.clone(), self::attachment(attachment)?);
    }
    let passes: Vec<Value> = scene
        .passes
        .iter()
        .map(|p| pass(scene, p))
        .collect::<Result<_, _>>()?;
    let read: Vec<&str> = scene.read.iter().map(|i| name(scene, *i)).collect();
    let mut keys = Keys::default();
    keys.add("attachments", Value::Object(attachments));
    keys.add("passes", passes);
    keys.add("read", read);
    if !scene.counters.is_empty() {
        let counters = scene.counters.iter();
        let counters = counters.map(|c| (c.name.clone(), plain(&c.kind)));
        keys.add("counters", counters.collect::<Map<_, _>>());
    }
    keys.differing("queries", &scene.query_scope, &QueryScope::Draw);
    if let Some(pool) = &scene.pool {
        keys.add("pool", plain(pool));
    }
    keys.differing("path", &scene.path, &Path::default());
    Ok(keys.done())
}

/// The keys of an object.
#[derive(Default)]
struct Keys(Map<String, Value>);

impl Keys {
    fn add(&mut self, key: &str, value: impl Into<Value>) {
        self.0.insert(key.to_owned(), value.into());
    }

    /// Adds a value unless it is the default.
    fn differing<T: Serialize + PartialEq>(&mut self, key: &str, value: &T, default: &T) {
        if value != default {
            self.add(key, plain(value));
        }
    }

    fn done(self) -> Value {
        Value::Object(self.0)
    }
}

/// Returns plain data as JSON. Numbers are written as short as 32-bit floats allow.
fn plain(value: &impl Serialize) -> Value {
    shortened(serde_json::to_value(value).expect("states without maps are JSON"))
}

fn shortened(value: Value) -> Value {
    match value {
        Value::Number(number) if number.is_f64() => {
            number.as_f64().map_or(Value::Null, |v| short(v as f32))
        }
        Value::Array(list) => list.into_iter().map(shortened).collect(),
        Value::Object(map) => map.into_iter().map(|(k, v)| (k, shortened(v))).collect(),
        other => other,
    }
}

/// Returns the shortest JSON number that reads back as the same 32-bit float.
fn short(value: f32) -> Value {
    if value.fract() == 0.0 && value.abs() < 1e9 && !(value == 0.0 && value.is_sign_negative()) {
        return json!(value as i64);
    }
    let text = value.to_string();
    let parsed = text.parse::<f64>().ok();
    // A decimal between two floats can be rounded twice.
    let same = parsed.filter(|v| (*v as f32).to_bits() == value.to_bits());
    json!(same.unwrap_or(f64::from(value)))
}

fn numbers(values: &[f32]) -> Value {
    values.iter().copied().map(short).collect()
}

/// Returns four values, as one number if they are equal.
fn splat(values: [f32; 4]) -> Value {
    let bits = values.map(f32::to_bits);
    if bits.iter().all(|b| *b == bits[0]) {
        short(values[0])
    } else {
        numbers(&values)
    }
}

fn name(scene: &Scene, index: usize) -> &str {
    &scene.attachments[index].name
}

fn attachment(attachment: &Attachment) -> Result<Value, &'static str> {
    let mut keys = Keys::default();
    keys.add("format", plain(&attachment.format));
    keys.add("size", attachment.size.to_vec());
    if attachment.samples != 1 {
        keys.add("samples", attachment.samples);
    }
    let format = attachment.format;
    match &attachment.contents {
        AttachmentContents::Color(color) if color.map(f32::to_bits) == [0; 4] => {}
        AttachmentContents::Color(color) if !color.iter().all(|v| v.is_finite()) => {
            return Err("a clear value is not finite");
        }
        AttachmentContents::Color(color) => keys.add("clear", numbers(color)),
        // A part that the format lacks keeps its default, which cannot be written.
        AttachmentContents::DepthStencil { depth, stencil } => {
            if !depth.is_finite() {
                return Err("a clear value is not finite");
            }
            if (depth.to_bits(), *stencil) != (1.0_f32.to_bits(), 0) {
                let clear = match (format.has_depth(), format.has_stencil()) {
                    (true, true) => json!({ "depth": short(*depth), "stencil": stencil }),
                    (false, _) => json!(stencil),
                    (true, false) => short(*depth),
                };
                keys.add("clear", clear);
            }
        }
        AttachmentContents::Texels(codes) => keys.add("texels", texels(attachment, codes)?),
    }
    Ok(keys.done())
}

/// Returns uploaded codes as the values of a case file: as columns or rows if all rows or columns are equal.
fn texels(attachment: &Attachment, codes: &[u32]) -> Result<Value, &'static str> {
    let encodings = attachment.format.color_channels();
    let value = |(encoding, code): (&ChannelEncoding, &u32)| {
        let order = encoding.order_of_code(*code);
        if encoding.is_nan(*code) {
            return Err("a texel is not finite");
        }
        if encoding.code_of_order(order) != *code {
            return Err("two codes decode to the same value");
        }
        Ok(match encoding {
            ChannelEncoding::Float16 | ChannelEncoding::Float32 | ChannelEncoding::Ufloat(_) => {
                let value = encoding.value_of_order(order);
                if !value.is_finite() {
                    return Err("a texel is not finite");
                }
                short(value as f32)
            }
            _ => json!(order),
        })
    };
    let texel = |codes: &[u32]| -> Result<Value, &'static str> {
        let mut values: Vec<Value> = encodings
            .iter()
            .zip(codes)
            .map(value)
            .collect::<Result<_, _>>()?;
        values.resize(4, json!(0));
        Ok(Value::Array(values))
    };
    let [width, _] = attachment.size.map(|side| side as usize);
    let channels = encodings.len();
    let rows: Vec<&[u32]> = codes.chunks_exact(width * channels).collect();
    let line = |codes: &[u32]| -> Result<Vec<Value>, &'static str> {
        codes.chunks_exact(channels).map(texel).collect()
    };
    let same_rows = rows.iter().all(|row| *row == rows[0]);
    let level = |row: &&[u32]| row.chunks_exact(channels).all(|t| *t == row[..channels]);
    Ok(if same_rows {
        json!({ "kind": "columns", "values": line(rows[0])? })
    } else if rows.iter().all(level) {
        let values: Vec<Value> = rows
            .iter()
            .map(|row| texel(&row[..channels]))
            .collect::<Result<_, _>>()?;
        json!({ "kind": "rows", "values": values })
    } else {
        let values: Vec<Vec<Value>> = rows.into_iter().map(line).collect::<Result<_, _>>()?;
        json!({ "kind": "grid", "values": values })
    })
}

fn pass(scene: &Scene, pass: &Pass) -> Result<Value, &'static str> {
    let mut keys = Keys::default();
    let names = |attachments: &[usize]| -> Vec<&str> {
        attachments.iter().map(|i| name(scene, *i)).collect()
    };
    if !pass.color.is_empty() {
        keys.add("color", names(&pass.color));
    }
    if pass.resolve.iter().any(Option::is_some) {
        let targets = pass.resolve.iter();
        let target_names: Vec<Option<&str>> = targets.map(|r| r.map(|i| name(scene, i))).collect();
        keys.add("resolve", json!(target_names));
    }
    if let Some(index) = pass.depth_stencil {
        keys.add("depth_stencil", name(scene, index));
    }
    if pass.depth_stencil_read_only {
        keys.add("depth_stencil_read_only", true);
    }
    if let Some(resolve) = pass.depth_stencil_resolve {
        let mut resolve_keys = Keys::default();
        resolve_keys.add("to", name(scene, resolve.to));
        resolve_keys.differing("depth", &resolve.depth, &ResolveMode::None);
        resolve_keys.differing("stencil", &resolve.stencil, &ResolveMode::None);
        keys.add("depth_stencil_resolve", resolve_keys.done());
    }
    if pass.operations != PassOperations::default() {
        keys.add("operations", operations(&pass.operations));
    }
    if !pass.clears.is_empty() {
        let clears: Vec<Value> = pass.clears.iter().map(clear).collect();
        keys.add("clears", clears);
    }
    let draws: Vec<Value> = pass
        .draws
        .iter()
        .map(|d| draw(scene, pass, d))
        .collect::<Result<_, _>>()?;
    keys.add("draws", draws);
    Ok(keys.done())
}

fn operations(operations: &PassOperations) -> Value {
    let mut keys = Keys::default();
    keys.differing("color", &operations.color, &Vec::new());
    keys.differing("depth", &operations.depth, &Operations::default());
    keys.differing("stencil", &operations.stencil, &Operations::default());
    keys.done()
}

fn clear(clear: &Clear) -> Value {
    let mut keys = Keys::default();
    keys.add("before", clear.before);
    match clear.target {
        ClearTarget::Color {
            location,
            value,
            write_mask,
        } => {
            keys.add("color", location);
            keys.add("value", numbers(&value));
            if write_mask != 0b1111 {
                keys.add("write_mask", letters(write_mask));
            }
        }
        ClearTarget::DepthStencil {
            depth,
            stencil,
            depth_write,
            stencil_write_mask,
        } => {
            if let Some(depth) = depth {
                keys.add("depth", short(depth));
            }
            if let Some(stencil) = stencil {
                keys.add("stencil", stencil);
            }
            match (depth, stencil) {
                _ if depth_write && stencil_write_mask == 0xff => {}
                (Some(_), Some(_)) => keys.add(
                    "write_mask",
                    json!({ "depth": depth_write, "stencil": stencil_write_mask }),
                ),
                (Some(_), None) => keys.add("write_mask", depth_write),
                (None, _) => keys.add("write_mask", stencil_write_mask),
            }
        }
    }
    if let Some(rect) = clear.rect {
        keys.add("rect", rect.to_vec());
    }
    keys.done()
}

fn letters(mask: u8) -> String {
    let letters = "rgba".chars().enumerate();
    letters
        .filter(|(bit, _)| mask >> bit & 1 == 1)
        .map(|(_, letter)| letter)
        .collect()
}

fn draw(scene: &Scene, pass: &Pass, draw: &Draw) -> Result<Value, &'static str> {
    let mut keys = Keys::default();
    mesh(draw, &mut keys);
    keys.differing("topology", &draw.topology, &PrimitiveTopology::TriangleList);
    keys.differing("tessellation", &draw.tessellation, &None);
    keys.differing("provoking", &draw.provoking, &None);
    keys.add("shader", plain(&draw.shader));
    let mut params = Keys::default();
    let none = Params::default();
    if draw.params.color.map(f32::to_bits) != none.color.map(f32::to_bits) {
        params.add("color", splat(draw.params.color));
    }
    if draw.params.back_color.map(f32::to_bits) != none.back_color.map(f32::to_bits) {
        params.add("back_color", splat(draw.params.back_color));
    }
    if !params.0.is_empty() {
        keys.add("params", params.done());
    }
    keys.differing("early_tests", &draw.early_tests, &EarlyTests::Implicit);
    if !draw.textures.is_empty() {
        let textures: Vec<&str> = draw.textures.iter().map(|i| name(scene, *i)).collect();
        keys.add("textures", textures);
    }
    keys.differing("sampler", &draw.sampler, &None);
    if !draw.counters.is_empty() {
        let names = draw.counters.iter();
        let names: Vec<&str> = names.map(|i| scene.counters[*i].name.as_str()).collect();
        keys.add("counters", names);
    }
    keys.differing("cull", &draw.cull, &CullMode::None);
    keys.differing("front_face", &draw.front_face, &FrontFace::Ccw);
    keys.differing("polygon_mode", &draw.polygon_mode, &PolygonMode::Fill);
    keys.differing("rasterizer_discard", &draw.rasterizer_discard, &false);
    let full_viewport = Viewport::whole(scene.pass_size(pass));
    keys.differing("viewport", &draw.viewport, &full_viewport);
    keys.differing("scissor", &draw.scissor, &None);
    keys.differing("clip_distances", &draw.clip_distances, &u8::MAX);
    if draw.depth_bias != DepthBias::default() {
        let mut bias = Keys::default();
        bias.differing("constant", &draw.depth_bias.constant, &0);
        bias.differing("slope", &draw.depth_bias.slope, &0.0);
        bias.differing("clamp", &draw.depth_bias.clamp, &0.0);
        keys.add("depth_bias", bias.done());
    }
    keys.differing("depth_clamp", &draw.depth_clamp, &false);
    keys.differing("depth_bounds", &draw.depth_bounds, &None);
    keys.differing("depth", &draw.depth, &None);
    if let Some(stencil) = &draw.stencil {
        let mut stencil_keys = Keys::default();
        stencil_keys.add("front", face(&stencil.front));
        if stencil.back != stencil.front {
            stencil_keys.add("back", face(&stencil.back));
        }
        keys.add("stencil", stencil_keys.done());
    }
    targets(draw, &mut keys);
    keys.differing("logic", &draw.logic, &None);
    if draw.multisample != Multisample::default() {
        let Multisample {
            mask,
            alpha_to_coverage,
            alpha_to_one,
            min_sample_shading,
            sample_coverage,
        } = draw.multisample;
        let mut multisample_keys = Keys::default();
        multisample_keys.differing("mask", &mask, &u32::MAX);
        multisample_keys.differing("alpha_to_coverage", &alpha_to_coverage, &false);
        multisample_keys.differing("alpha_to_one", &alpha_to_one, &false);
        multisample_keys.differing("min_sample_shading", &min_sample_shading, &None);
        multisample_keys.differing("sample_coverage", &sample_coverage, &None);
        keys.add("multisample", multisample_keys.done());
    }
    if draw.blend_constant.map(f32::to_bits) != [0; 4] {
        keys.add("blend_constant", splat(draw.blend_constant));
    }
    Ok(keys.done())
}

fn face(face: &StencilFace) -> Value {
    use etalon_scene::StencilOperation::Keep;
    let mut keys = Keys::default();
    keys.add("compare", plain(&face.compare));
    keys.differing("fail_op", &face.fail_op, &Keep);
    keys.differing("depth_fail_op", &face.depth_fail_op, &Keep);
    keys.differing("pass_op", &face.pass_op, &Keep);
    keys.differing("read_mask", &face.read_mask, &0xff);
    keys.differing("write_mask", &face.write_mask, &0xff);
    keys.differing("reference", &face.reference, &0);
    keys.done()
}

/// Adds blending and write masks: only once if all targets have the same.
fn targets(draw: &Draw, keys: &mut Keys) {
    let Some(first) = draw.targets.first() else {
        return;
    };
    if let Some(advanced) = first.advanced {
        keys.add("advanced_blend", plain(&advanced));
    }
    let add_target = |keys: &mut Keys, target: &etalon_scene::ColorTarget| {
        keys.differing("blend", &target.blend, &None);
        if target.write_mask != 0b1111 {
            keys.add("write_mask", letters(target.write_mask));
        }
    };
    if draw.targets.iter().all(|t| t == first) {
        add_target(keys, first);
        return;
    }
    let targets = draw.targets.iter().map(|target| {
        let mut target_keys = Keys::default();
        add_target(&mut target_keys, target);
        target_keys.done()
    });
    keys.add("targets", targets.collect::<Vec<_>>());
}

/// Adds the mesh, which consists of one equal part per instance, and its fetch.
fn mesh(draw: &Draw, keys: &mut Keys) {
    let Fetch {
        index,
        base_vertex,
        first_index,
        first_vertex,
        instances,
        first_instance,
    } = draw.fetch;
    let Mesh { vertices, indices } = &*draw.mesh;
    let parts = instances.max(1) as usize;
    let count = vertices.len() / parts;
    let one_instance = &vertices[..count];
    let mut mesh = Keys::default();
    mesh.add("kind", "vertices");
    let positions = one_instance.iter().map(|v| {
        let flat = v.position[3].to_bits() == 1.0_f32.to_bits();
        numbers(&v.position[..if flat { 3 } else { 4 }])
    });
    mesh.add("positions", positions.collect::<Vec<_>>());
    let color = one_instance.first().map_or([0.0; 4], |v| v.color);
    let alike = one_instance
        .iter()
        .all(|v| v.color.map(f32::to_bits) == color.map(f32::to_bits));
    if instances > 0 {
        // Instances have colours of their own.
    } else if !alike {
        let colors = one_instance.iter().map(|v| splat(v.color));
        mesh.add("values", colors.collect::<Vec<_>>());
    } else if color.map(f32::to_bits) != [0; 4] {
        mesh.add("values", vec![splat(color)]);
    }
    if one_instance
        .iter()
        .any(|v| v.uv.map(f32::to_bits) != [0; 2])
    {
        let uv = one_instance.iter().map(|v| numbers(&v.uv));
        mesh.add("uv", uv.collect::<Vec<_>>());
    }
    if let Some(all_indices) = indices {
        // Between two instances is one restart index.
        let length = if instances == 0 {
            all_indices.len()
        } else {
            (all_indices.len() + 1) / parts - 1
        };
        let indices = all_indices[..length].iter().map(|i| match *i {
            RESTART => Value::Null,
            i => json!(i),
        });
        mesh.add("indices", indices.collect::<Vec<_>>());
    }
    keys.add("mesh", mesh.done());
    let mut fetch = Keys::default();
    fetch.differing("index", &index, &IndexFormat::Uint32);
    fetch.differing("base_vertex", &base_vertex, &0);
    fetch.differing("first_index", &first_index, &0);
    fetch.differing("first_vertex", &first_vertex, &0);
    if !fetch.0.is_empty() {
        keys.add("fetch", fetch.done());
    }
    if instances > 0 {
        let firsts = vertices.iter().step_by(count.max(1));
        let mut instance_keys = Keys::default();
        let colors = firsts.map(|v| splat(v.color));
        instance_keys.add("colors", colors.collect::<Vec<_>>());
        instance_keys.differing("first", &first_instance, &0);
        keys.add("instances", instance_keys.done());
    }
}
