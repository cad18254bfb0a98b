//! The nodes of a scene: where its meshes and its camera are.

use crate::error::{ModelError, part};
use crate::files::Buffers;
use crate::mesh::PaintedMesh;
use crate::texture::Texture;
use etalon_methods::{Camera, Lens, MOST_TRIANGLES, ModelTriangle};
use glam::{DMat4, DVec3, Mat4};
use gltf::camera::Projection;
use gltf::{Node, Primitive, Scene};

/// The deepest node, and the largest number of nodes, counted each time that one is reached.
const DEEPEST: usize = 256;
const MOST_NODES: usize = 1 << 20;

/// The most pieces of triangles whose colours vary, and the most parts of a side: a power of two.
const MOST_PIECES: usize = 1 << 15;
const MOST_PARTS: usize = 32;

/// What the nodes of a scene bring.
#[derive(Debug)]
pub(crate) struct Nodes<'a> {
    buffers: &'a Buffers,
    textures: &'a [Option<Texture>],
    visited: usize,
    /// The meshes of each node in the order of the file. Each primitive of a node is an object.
    meshes: Vec<Vec<PaintedMesh<'a>>>,
    faces: usize,
    objects: usize,
    /// The first camera.
    pub(crate) camera: Option<Camera>,
}

impl<'a> Nodes<'a> {
    /// Reads the nodes of a scene.
    ///
    /// # Errors
    /// If one of them, or what it names, cannot be read.
    pub(crate) fn read(
        scene: &Scene<'_>,
        buffers: &'a Buffers,
        textures: &'a [Option<Texture>],
    ) -> Result<Self, ModelError> {
        let mut nodes = Self {
            buffers,
            textures,
            visited: 0,
            meshes: Vec::new(),
            faces: 0,
            objects: 0,
            camera: None,
        };
        for node in scene.nodes() {
            nodes.add(&node, &DMat4::IDENTITY, 0)?;
        }
        Ok(nodes)
    }

    fn add(&mut self, node: &Node<'_>, parent: &DMat4, depth: usize) -> Result<(), ModelError> {
        let place = || part("node", node.index(), node.name());
        self.visited += 1;
        if depth > DEEPEST || self.visited > MOST_NODES {
            let message =
                "nodes are nested too deeply or too often; a node must not be its own child";
            return Err(ModelError::new(place(), message));
        }
        let own = Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
        let to_world = *parent * own;
        if !to_world.is_finite() {
            let message = "its transform is no finite number; export the file again";
            return Err(ModelError::new(place(), message));
        }
        if let Some(mesh) = node.mesh() {
            let within = |error: ModelError| {
                let name = part("mesh", mesh.index(), mesh.name());
                error.within(&name).within(&place())
            };
            let mut painted = Vec::new();
            for primitive in mesh.primitives() {
                painted.push(self.primitive(&primitive, &to_world).map_err(within)?);
            }
            self.meshes.push(painted);
        }
        if let Some(camera) = node.camera()
            && self.camera.is_none()
        {
            let seen = self::camera(&camera, &to_world);
            self.camera = Some(seen.map_err(|error| error.within(&place()))?);
        }
        for child in node.children() {
            self.add(&child, &to_world, depth + 1)?;
        }
        Ok(())
    }

    fn primitive(
        &mut self,
        primitive: &Primitive<'_>,
        to_world: &DMat4,
    ) -> Result<PaintedMesh<'a>, ModelError> {
        let mesh = PaintedMesh::read(
            primitive,
            to_world,
            self.objects,
            self.buffers,
            self.textures,
        )?;
        self.objects += 1;
        self.faces += mesh.faces();
        if self.faces > MOST_TRIANGLES {
            return Err(ModelError::new(
                format!("primitive {}", primitive.index()),
                format!(
                    "the scene has more than {MOST_TRIANGLES} triangles with it; decimate it, or leave out what its camera does not see"
                ),
            ));
        }
        Ok(mesh)
    }

    /// Returns all triangles, in the order of nodes and primitives. Where colours vary within triangles, these are cut into
    /// pieces.
    pub(crate) fn triangles(&self) -> Vec<ModelTriangle> {
        // The primitives of a mesh can share edges.
        let varies = self
            .meshes
            .iter()
            .map(|meshes| meshes.iter().any(PaintedMesh::varies));
        let meshes: Vec<_> = self.meshes.iter().zip(varies).collect();
        let varying = meshes.iter().filter(|(_, varies)| *varies);
        let parts = parts(&varying.flat_map(|(meshes, _)| *meshes).collect::<Vec<_>>());
        let mut triangles = Vec::new();
        for (meshes, varies) in meshes {
            let parts = if varies { parts } else { 1 };
            for mesh in meshes {
                mesh.add_to(&mut triangles, parts);
            }
        }
        triangles
    }
}

/// Returns the number of parts into which the sides of triangles are cut: as few as keep their colours, or as many as
/// [`MOST_PIECES`] allows.
fn parts(meshes: &[&PaintedMesh<'_>]) -> usize {
    let faces: usize = meshes.iter().map(|mesh| mesh.faces()).sum();
    let mut finest = 1;
    while finest < MOST_PARTS && 4 * finest * finest * faces <= MOST_PIECES {
        finest *= 2;
    }
    let mut parts = 1;
    while parts < finest && meshes.iter().any(|mesh| mesh.loses_colors(parts, finest)) {
        parts *= 2;
    }
    parts
}

/// Returns a camera in its place. The picture has the height that the file says; its width is the frame's.
fn camera(camera: &gltf::Camera<'_>, to_world: &DMat4) -> Result<Camera, ModelError> {
    let wrong =
        |message: &str| ModelError::new(part("camera", camera.index(), camera.name()), message);
    let axes = [to_world.x_axis, to_world.y_axis, to_world.z_axis].map(|a| a.truncate());
    // A camera is not scaled or sheared by the nodes above it.
    let back = axes[2].try_normalize();
    let right = back.and_then(|back| axes[1].cross(back).try_normalize());
    let (Some(back), Some(right)) = (back, right) else {
        return Err(wrong("the scale of its node is 0; give it the scale 1"));
    };
    let up: DVec3 = back.cross(right);
    let (lens, planes) = match camera.projection() {
        Projection::Perspective(lens) => (
            Lens::Perspective((f64::from(lens.yfov()) / 2.0).tan()),
            [lens.znear(), lens.zfar().unwrap_or(f32::INFINITY)],
        ),
        Projection::Orthographic(lens) => (
            Lens::Parallel(f64::from(lens.ymag()).abs()),
            [lens.znear(), lens.zfar()],
        ),
    };
    let (Lens::Perspective(half) | Lens::Parallel(half)) = lens;
    let planes = planes.map(f64::from);
    let near_is_valid = match lens {
        Lens::Perspective(_) => planes[0] > 0.0,
        Lens::Parallel(_) => planes[0] >= 0.0,
    };
    if !(half.is_finite() && half > 0.0 && near_is_valid && planes[0] < planes[1]) {
        return Err(wrong(
            "its field of view or its planes are impossible; it needs a positive angle below 180 degrees, and 0 < near < far",
        ));
    }
    Ok(Camera {
        world: DMat4::from_cols(
            right.extend(0.0),
            up.extend(0.0),
            back.extend(0.0),
            to_world.w_axis,
        ),
        lens,
        planes,
    })
}
