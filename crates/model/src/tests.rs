//! Tests of whole files: our own, broken ones, and damaged ones.

use crate::color::{displayed, linear};
use crate::document::parse;
use crate::read;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use etalon_methods::{Model, TexelCoverage};
use proptest::prelude::*;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn scene(name: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/gltf");
    root.join(name)
}

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(scene(name)).expect("the scene is in the repository")
}

fn model(name: &str) -> Model {
    read(&scene(name)).expect("the scene is valid").model
}

/// The avenue as JSON, with a change.
fn changed(change: impl FnOnce(&mut Value)) -> Result<Model, String> {
    let mut document: Value = serde_json::from_slice(&bytes("avenue.gltf")).expect("it is JSON");
    change(&mut document);
    let bytes = serde_json::to_vec(&document).expect("it is JSON");
    parse(&bytes, Path::new("")).map_err(|error| error.to_string())
}

#[test]
fn a_scene_answers_the_questions_that_its_surfaces_raise() {
    let questions = |name: &str| -> Vec<&str> {
        let questions = model(name).questions();
        questions
            .into_iter()
            .map(|(question, _)| question)
            .collect()
    };
    let all = ["transparency", "anti-aliasing", "depth-precision"];
    assert_eq!(questions("greenhouse.glb"), all);
    assert_eq!(questions("avenue.gltf"), all[1..]);
}

#[test]
fn every_method_draws_a_scene_over_the_same_truth() {
    for name in ["greenhouse.glb", "avenue.gltf"] {
        let model = model(name);
        for (question, methods) in model.questions() {
            let truths = methods.iter().map(|method| {
                let made = model.draw(question, method).expect("the method draws it");
                let picture = &made.scene.attachments[made.scene.read[0]];
                assert_eq!((picture.size, picture.samples), (made.truth.size, 1));
                made.truth
            });
            let truths: Vec<_> = truths.collect();
            assert!(truths.windows(2).all(|t| t[0] == t[1]), "{name} {question}");
            let is_area = truths[0].coverage == TexelCoverage::Area;
            assert_eq!(is_area, question == "anti-aliasing");
        }
        assert!(model.draw("transparency", "magic").is_err());
        assert!(model.draw("anti-aliasing", "coverage-to-alpha").is_err());
        assert!(model.draw("culling", "none").is_err());
    }
}

#[test]
fn a_camera_of_the_file_or_one_that_sees_everything() {
    let own = changed(|_| ()).expect("it is valid");
    let fitted = changed(|d| {
        d["cameras"] = json!([]);
        d["nodes"].as_array_mut().expect("a list").pop();
        d["scenes"][0]["nodes"]
            .as_array_mut()
            .expect("a list")
            .pop();
    })
    .expect("a camera is fitted");
    assert_eq!(own.triangles(), fitted.triangles());
    let surfaces = |model: &Model| {
        let made = model.draw("anti-aliasing", "none").expect("it draws");
        made.truth.surfaces.len()
    };
    assert!(surfaces(&fitted) > surfaces(&own) / 2);
}

#[test]
fn what_is_wrong_is_named_with_its_part_and_a_remedy() {
    let refused = |change: fn(&mut Value)| changed(change).expect_err("it is refused");
    assert_eq!(
        refused(|d| d["accessors"][0]["byteOffset"] = json!(4)),
        "node 0 (ground), mesh 0, accessor 0: it reaches beyond its buffer; export the file again"
    );
    assert_eq!(
        refused(|d| d["bufferViews"][0]["byteLength"] = json!(99_999)),
        "node 0 (ground), mesh 0, accessor 0: it reaches beyond its buffer; export the file again"
    );
    assert_eq!(
        refused(|d| d["buffers"][0]["byteLength"] = json!(99_999)),
        "buffer 0: it has 4068 bytes and should have 99999; export the file again"
    );
    assert_eq!(
        refused(|d| d["buffers"][0]["uri"] = json!("../secret.bin")),
        "buffer 0: it names `../secret.bin`, and only files beside the scene or in folders there are read; move the \
         file there"
    );
    assert_eq!(
        refused(|d| d["nodes"][3]["children"] = json!([3])),
        "node 3 (wall 1): nodes are nested too deeply or too often; a node must not be its own child"
    );
    assert_eq!(
        refused(|d| d["nodes"][1]["rotation"] = json!([1e30, 0, 0, 1])),
        "node 1 (wall 0): its transform is no finite number; export the file again"
    );
    assert_eq!(
        refused(|d| d["cameras"][0]["perspective"]["znear"] = json!(9999)),
        "node 29 (camera), camera 0: its field of view or its planes are impossible; it needs a positive angle below \
         180 degrees, and 0 < near < far"
    );
    assert_eq!(
        refused(|d| d["nodes"][29]["translation"] = json!([0, 0, -9000])),
        "camera: the camera sees no triangle"
    );
    assert_eq!(
        refused(|d| d["scenes"][0]["nodes"] = json!([29])),
        "the scene: it has no triangle; export a scene with meshes"
    );
    let compressed = refused(|d| d["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]));
    assert!(compressed.starts_with("the file: it is not valid glTF 2.0, or needs an extension"));
    let missing = read(Path::new("/nowhere/scene.glb")).expect_err("there is no such file");
    assert!(
        missing
            .to_string()
            .starts_with("/nowhere/scene.glb: cannot be read: ")
    );
}

/// Returns the colours of a scene's surfaces, without alpha.
fn colors(model: &Model) -> Vec<[f64; 3]> {
    let made = model.draw("anti-aliasing", "none").expect("it draws");
    let surfaces = made.truth.surfaces.iter();
    let colors = surfaces.filter_map(|surface| match surface.paint {
        etalon_methods::Paint::Flat([r, g, b, _]) => Some([r, g, b]),
        _ => None,
    });
    colors.collect()
}

#[test]
fn triangles_are_cut_where_a_texture_changes() {
    let all = colors(&model("greenhouse.glb"));
    let floor = &all[..500];
    // The floor comes first. Its tiles are 230 and 150 times 0.9, in light from above that multiplies by 0.92.
    let near = |value: f64| {
        floor
            .iter()
            .filter(|[r, ..]| (r - value).abs() < 0.01)
            .count()
    };
    let shown = |code: f64| displayed(linear(code / 255.0) * 0.9) * 0.92;
    let [light, dark] = [230.0, 150.0].map(|code| near(shown(code)));
    // Each of 288 triangles has two pieces of each, less what the camera does not see.
    assert!(
        light > 200 && dark > 200,
        "{light} light, {dark} dark, {:?}",
        &floor[..4]
    );
    assert_eq!(near(shown(190.0)), 0);
}

/// A square that faces the camera, with a texture of four by four texels: each is a hole or red.
fn card(holes: &[bool; 16]) -> String {
    let mut png = std::io::Cursor::new(Vec::new());
    let texel = |x: u32, y: u32| {
        image::Rgba([255, 0, 0, if holes[(4 * y + x) as usize] { 0 } else { 255 }])
    };
    let picture = image::RgbaImage::from_fn(4, 4, texel);
    picture
        .write_to(&mut png, image::ImageFormat::Png)
        .expect("it is written");
    let positions = [
        [-1.0_f32, -1.0, 0.0],
        [1.0, -1.0, 0.0],
        [1.0, 1.0, 0.0],
        [-1.0, 1.0, 0.0],
    ];
    let uv = [[0.0_f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let mut bytes: Vec<u8> = positions
        .iter()
        .flatten()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    bytes.extend(uv.iter().flatten().flat_map(|v| v.to_le_bytes()));
    bytes.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
    let png = png.into_inner();
    let (view, length) = (bytes.len(), png.len());
    bytes.extend(png);
    let data = STANDARD.encode(&bytes);
    json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": 0 }] }],
        "materials": [{ "alphaMode": "MASK", "doubleSided": true,
            "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
        "textures": [{ "source": 0 }], "images": [{ "bufferView": 3, "mimeType": "image/png" }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR" }],
        "bufferViews": [{ "buffer": 0, "byteOffset": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 32 },
            { "buffer": 0, "byteOffset": 80, "byteLength": 12 }, { "buffer": 0, "byteOffset": view, "byteLength": length }],
        "buffers": [{ "byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{data}") }],
    })
    .to_string()
}

#[test]
fn an_alpha_mask_cuts_the_holes_of_its_texture() {
    let red = |holes: &[bool; 16]| {
        let made = parse(card(holes).as_bytes(), Path::new("")).expect("it is valid");
        colors(&made).len()
    };
    let mut holes = [false; 16];
    // A whole card needs no cut; with holes in it, each texel has two pieces.
    assert_eq!(red(&holes), 2);
    holes[5] = true;
    assert_eq!(red(&holes), 30);
    holes[0] = true;
    assert_eq!(red(&holes), 28);
}

/// Bytes of `.glb` before its JSON: the header, and the length and kind of the chunk.
const BEFORE_JSON: usize = 20;

/// Parses a `.glb` with other JSON.
fn with_json(bytes: &[u8], document: &Value) -> Result<Model, String> {
    let length = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"));
    let binary = &bytes[BEFORE_JSON + length(12) as usize..];
    let mut json = serde_json::to_vec(document).expect("it is JSON");
    json.resize(json.len().next_multiple_of(4), b' ');
    let total = (BEFORE_JSON + json.len() + binary.len()) as u32;
    let mut file = bytes[..8].to_vec();
    file.extend(total.to_le_bytes());
    file.extend((json.len() as u32).to_le_bytes());
    file.extend(&bytes[16..BEFORE_JSON]);
    file.extend(json);
    file.extend(binary);
    parse(&file, Path::new("")).map_err(|error| error.to_string())
}

/// What damage of single bytes reaches by chance only: each member missing, or of another name.
#[test]
fn no_missing_member_panics() {
    let glb = bytes("greenhouse.glb");
    let mut stream = serde_json::Deserializer::from_slice(&glb[BEFORE_JSON..]).into_iter();
    let greenhouse: Value = stream.next().expect("a document").expect("it is JSON");
    let avenue: Value = serde_json::from_slice(&bytes("avenue.gltf")).expect("it is JSON");
    assert!(with_json(&glb, &greenhouse).is_ok());
    for (document, is_binary) in [(&greenhouse, true), (&avenue, false)] {
        let mut members = Vec::new();
        paths(document, &mut String::new(), &mut members, Value::is_object);
        let mut refused = 0;
        for path in members {
            let object = document.pointer(&path).and_then(Value::as_object);
            for key in object.into_iter().flat_map(|object| object.keys()) {
                let mut changed = document.clone();
                let object = changed.pointer_mut(&path).and_then(Value::as_object_mut);
                object.expect("it was found").remove(key);
                let result = if is_binary {
                    with_json(&glb, &changed)
                } else {
                    let bytes = serde_json::to_vec(&changed).expect("it is JSON");
                    parse(&bytes, Path::new("")).map_err(|error| error.to_string())
                };
                refused += usize::from(result.is_err());
            }
        }
        assert!(refused > 10, "{refused} of the files were refused");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_damaged_file_panics(name in prop::sample::select(vec!["greenhouse.glb", "avenue.gltf"]),
        damages in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12), cut in any::<prop::sample::Index>(),
        is_cut in prop::bool::weighted(0.2)) {
        let mut bytes = bytes(name);
        // Most of a file is numbers; what describes them is more fragile.
        let described = if name == "greenhouse.glb" { 12_000.min(bytes.len()) } else { bytes.len() };
        for (place, byte) in damages {
            let place = place.index(described);
            bytes[place] = byte;
        }
        if is_cut {
            let cut = cut.index(bytes.len());
            bytes.truncate(cut);
        }
        let _result = parse(&bytes, Path::new(""));
    }

    #[test]
    fn no_changed_number_panics(place in any::<prop::sample::Index>(), number in prop::sample::select(vec![
        json!(0), json!(1), json!(2), json!(5121), json!(5125), json!(4_294_967_295_u32), json!(u64::MAX), json!(-1), json!(1e38), json!(0.5),
    ])) {
        let _result = changed(|document| {
            let mut numbers = Vec::new();
            paths(document, &mut String::new(), &mut numbers, Value::is_number);
            let path = &numbers[place.index(numbers.len())];
            *document.pointer_mut(path).expect("it was found") = number;
        });
    }
}

/// Collects the JSON pointers of all values of a kind.
fn paths(value: &Value, path: &mut String, chosen: &mut Vec<String>, is_kind: fn(&Value) -> bool) {
    if is_kind(value) {
        chosen.push(path.clone());
    }
    let length = path.len();
    let mut child = |key: &str, value: &Value| {
        path.push('/');
        path.push_str(key);
        paths(value, path, chosen, is_kind);
        path.truncate(length);
    };
    match value {
        Value::Array(items) => (0..)
            .zip(items)
            .for_each(|(i, v)| child(&format!("{i}"), v)),
        Value::Object(entries) => entries.iter().for_each(|(key, v)| child(key, v)),
        _ => {}
    }
}
