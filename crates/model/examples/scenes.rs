//! Writes the scenes of `cases/gltf`: `cargo run -p etalon-model --example scenes`.
//!
//! `greenhouse.glb` has glass in front of, behind and around other things, a texture, vertex colours and a mirrored node.
//! `avenue.gltf` has posters on walls, from a few steps to a kilometre away, which 16 bits of depth do not tell apart.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::path::Path;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let folder = env::args().nth(1);
    let folder = folder.as_deref().map_or(Path::new("cases/gltf"), Path::new);
    fs::create_dir_all(folder)?;
    fs::write(folder.join("greenhouse.glb"), greenhouse()?.binary())?;
    fs::write(folder.join("avenue.gltf"), avenue().text())
}

/// A document that is being built, with one buffer.
#[derive(Default)]
struct Scene {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    materials: Vec<Value>,
    images: Vec<Value>,
    cameras: Vec<Value>,
    nodes: Vec<Value>,
}

/// Points, each with a colour or with texture coordinates, and triangles between them.
#[derive(Default)]
struct Shape {
    positions: Vec<[f32; 3]>,
    colors: Vec<[f32; 4]>,
    uv: Vec<[f32; 2]>,
    indices: Vec<u16>,
}

impl Scene {
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view =
            json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        self.bytes.extend(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    fn floats<const N: usize>(&mut self, items: &[[f32; N]]) -> usize {
        let bytes = items.iter().flatten().flat_map(|v| v.to_le_bytes());
        let view = self.view(&bytes.collect::<Vec<u8>>());
        let bounds = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            let bound = |c: usize| items.iter().map(|item| item[c]).reduce(pick);
            (0..N).filter_map(bound).collect()
        };
        self.accessors.push(json!({
            "bufferView": view, "componentType": 5126, "count": items.len(), "type": format!("VEC{N}"),
            "min": bounds(f32::min), "max": bounds(f32::max),
        }));
        self.accessors.len() - 1
    }

    fn mesh(&mut self, shape: &Shape, material: usize) -> usize {
        let bytes = shape.indices.iter().flat_map(|i| i.to_le_bytes());
        let view = self.view(&bytes.collect::<Vec<u8>>());
        self.accessors.push(json!({
            "bufferView": view, "componentType": 5123, "count": shape.indices.len(), "type": "SCALAR",
        }));
        let indices = self.accessors.len() - 1;
        let mut attributes = json!({ "POSITION": self.floats(&shape.positions) });
        if !shape.colors.is_empty() {
            attributes["COLOR_0"] = json!(self.floats(&shape.colors));
        }
        if !shape.uv.is_empty() {
            attributes["TEXCOORD_0"] = json!(self.floats(&shape.uv));
        }
        self.meshes.push(json!({ "primitives": [
            { "attributes": attributes, "indices": indices, "material": material } ] }));
        self.meshes.len() - 1
    }

    fn material(&mut self, color: [f64; 4]) -> usize {
        self.materials
            .push(json!({ "pbrMetallicRoughness": { "baseColorFactor": color } }));
        self.materials.len() - 1
    }

    fn glass(&mut self, color: [f64; 4]) -> usize {
        let index = self.material(color);
        self.materials[index]["alphaMode"] = json!("BLEND");
        self.materials[index]["doubleSided"] = json!(true);
        index
    }

    /// Adds a node at a point.
    fn node(&mut self, name: &str, mesh: usize, at: [f64; 3]) -> &mut Value {
        self.nodes
            .push(json!({ "name": name, "mesh": mesh, "translation": at }));
        let last = self.nodes.len() - 1;
        &mut self.nodes[last]
    }

    /// Adds a camera at a point, turned down by an angle in degrees.
    fn camera(&mut self, at: [f64; 3], down: f64, [near, far]: [f64; 2]) {
        self.cameras
            .push(json!({ "type": "perspective", "perspective": {
            "yfov": 0.8, "znear": near, "zfar": far } }));
        let (sin, cos) = (-down.to_radians() / 2.0).sin_cos();
        let rotation = [sin, 0.0, 0.0, cos];
        self.nodes.push(
            json!({ "name": "camera", "camera": 0, "translation": at, "rotation": rotation }),
        );
    }

    fn document(&self, uri: Option<String>) -> Value {
        let mut buffer = json!({ "byteLength": self.bytes.len() });
        if let Some(uri) = uri {
            buffer["uri"] = json!(uri);
        }
        let mut document = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": (0..self.nodes.len()).collect::<Vec<_>>() }],
            "nodes": self.nodes, "cameras": self.cameras, "meshes": self.meshes, "materials": self.materials,
            "accessors": self.accessors, "bufferViews": self.views, "buffers": [buffer],
        });
        if !self.images.is_empty() {
            document["images"] = json!(self.images);
            document["textures"] = json!([{ "source": 0 }]);
        }
        document
    }

    fn text(&self) -> Vec<u8> {
        let coded = STANDARD.encode(&self.bytes);
        let uri = format!("data:application/octet-stream;base64,{coded}");
        format!("{}\n", self.document(Some(uri))).into_bytes()
    }

    /// Returns the document as binary glTF (section 4.4 of the specification).
    fn binary(&self) -> Vec<u8> {
        let mut json = self.document(None).to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut binary = self.bytes.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        let length = 12 + 8 + json.len() + 8 + binary.len();
        let word = |value: usize| u32::try_from(value).unwrap_or(u32::MAX).to_le_bytes();
        let mut file = [&b"glTF"[..], &word(2), &word(length)].concat();
        for (kind, bytes) in [(b"JSON", &json), (b"BIN\0", &binary)] {
            file.extend([&word(bytes.len())[..], kind, bytes].concat());
        }
        file
    }
}

/// Returns a rectangle that faces the viewer, around the origin.
fn pane(width: f32, height: f32) -> Shape {
    let [x, y] = [width / 2.0, height / 2.0];
    Shape {
        positions: vec![[-x, -y, 0.0], [x, -y, 0.0], [x, y, 0.0], [-x, y, 0.0]],
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Shape::default()
    }
}

/// Returns a level grid, in whose cells a texture repeats.
fn ground(cells: u16, side: f32) -> Shape {
    let mut shape = Shape::default();
    for (row, column) in (0..=cells).flat_map(|r| (0..=cells).map(move |c| (r, c))) {
        let place = |k: u16| (f32::from(k) / f32::from(cells) - 0.5) * side;
        shape.positions.push([place(column), 0.0, place(row)]);
        shape.uv.push([f32::from(column), f32::from(row)]);
    }
    shape.indices = quads(cells, cells);
    shape
}

/// Returns a sphere whose colour changes from its top to its bottom.
fn sphere(radius: f64, steps: u16) -> Shape {
    let mut shape = Shape::default();
    for (row, column) in (0..=steps).flat_map(|r| (0..=2 * steps).map(move |c| (r, c))) {
        let (sin, cos) = (f64::from(row) / f64::from(steps) * TAU / 2.0).sin_cos();
        let (x, z) = (f64::from(column) / f64::from(2 * steps) * TAU).sin_cos();
        let point = [x * sin, cos, z * sin].map(|v| (v * radius) as f32);
        shape.positions.push(point);
        let light = f32::from(steps - row) / f32::from(steps);
        let color = [0.4 + 0.6 * light, 0.5 + 0.5 * light, 1.0, 1.0];
        shape.colors.push(color);
    }
    shape.indices = quads(steps, 2 * steps);
    shape
}

/// Returns the triangles of a grid of rows and columns, whose points come row by row.
fn quads(rows: u16, columns: u16) -> Vec<u16> {
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    cells
        .flat_map(|(row, column)| {
            let a = row * (columns + 1) + column;
            let b = a + columns + 1;
            [a, b, a + 1, a + 1, b, b + 1]
        })
        .collect()
}

/// Returns a PNG of two by two tiles.
fn tiles() -> io::Result<Vec<u8>> {
    let tile = |x: u32, y: u32| {
        let is_light = (x / 4 + y / 4).is_multiple_of(2);
        image::Luma([if is_light { 230_u8 } else { 150 }])
    };
    let mut png = io::Cursor::new(Vec::new());
    let written = image::GrayImage::from_fn(8, 8, tile).write_to(&mut png, image::ImageFormat::Png);
    written.map_err(io::Error::other)?;
    Ok(png.into_inner())
}

fn greenhouse() -> io::Result<Scene> {
    let mut scene = Scene::default();
    let view = scene.view(&tiles()?);
    scene
        .images
        .push(json!({ "bufferView": view, "mimeType": "image/png" }));
    let floor = scene.material([0.9, 0.85, 0.8, 1.0]);
    scene.materials[floor]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    let floor = scene.mesh(&ground(12, 12.0), floor);
    scene.node("floor", floor, [0.0; 3]);
    let clay = scene.material([0.7, 0.25, 0.1, 1.0]);
    let ball = scene.mesh(&sphere(0.7, 16), clay);
    for (i, [x, z]) in [[-2.4, -2.0], [2.2, -3.0], [0.3, -0.6]]
        .into_iter()
        .enumerate()
    {
        scene.node(&format!("ball {i}"), ball, [x, 0.7, z]);
    }
    let blue = scene.glass([0.3, 0.55, 0.9, 0.35]);
    let bubble = scene.mesh(&sphere(1.3, 16), blue);
    scene.node("bubble", bubble, [0.3, 1.3, -0.6]);
    let green = scene.glass([0.3, 0.8, 0.45, 0.3]);
    let wall = scene.mesh(&pane(5.0, 3.0), green);
    for (i, z) in [-3.6, 1.2, -1.8].into_iter().enumerate() {
        scene.node(&format!("wall {i}"), wall, [0.0, 1.5, z]);
    }
    let amber = scene.glass([0.95, 0.6, 0.15, 0.4]);
    let side = scene.mesh(&pane(4.8, 3.0), amber);
    let half = 0.5_f64.sqrt();
    // The right side is the left one, mirrored.
    for (name, x, mirror) in [("left", -2.5, 1.0), ("right", 2.5, -1.0)] {
        let node = scene.node(name, side, [x, 1.5, -1.2]);
        node["rotation"] = json!([0.0, half, 0.0, half]);
        node["scale"] = json!([mirror, 1.0, 1.0]);
    }
    scene.camera([0.0, 2.6, 7.0], 12.0, [0.1, 100.0]);
    Ok(scene)
}

fn avenue() -> Scene {
    let mut scene = Scene::default();
    let paving = scene.material([0.35, 0.33, 0.3, 1.0]);
    let paving = scene.mesh(&ground(8, 2400.0), paving);
    scene.node("ground", paving, [0.0; 3]);
    let brick = scene.material([0.6, 0.2, 0.12, 1.0]);
    let paper = scene.material([0.9, 0.85, 0.5, 1.0]);
    // Each wall is half as far again as the one before it and larger in proportion, with a poster in front of it.
    for i in 0..14 {
        let distance = 5.0 * 1.5_f64.powi(i);
        let size = distance as f32 * 0.3;
        let wall = scene.mesh(&pane(size, size), brick);
        let poster = scene.mesh(&pane(size * 0.7, size * 0.7), paper);
        let side = if i % 2 == 0 { -0.3 } else { 0.3 };
        let place = |nearer: f64| [distance * side, f64::from(size) / 2.0, nearer - distance];
        scene.node(&format!("wall {i}"), wall, place(0.0));
        scene.node(&format!("poster {i}"), poster, place(distance * 0.0005));
    }
    scene.camera([0.0, 1.7, 0.0], 0.0, [0.05, 2500.0]);
    scene
}
