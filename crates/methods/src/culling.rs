//! Culling: of faces by their winding, and of whole objects outside the picture.

mod claims;
mod lessons;

pub(crate) use claims::CLAIMS;
pub(crate) use lessons::LESSONS;

use crate::error::{ParameterError, within};
use crate::grid::settle;
use crate::method_scene::MethodScene;
use crate::polygon::{self, Polygon};
use crate::stage::{self, SIZE, Stage};
use crate::truth::{TexelCoverage, Truth};
use crate::view::{Face, View, cuboid};
use etalon_frame::TextureFormat;
use etalon_scene::{CompareFunction, CullMode, Draw, FrontFace, Shader};
use glam::{DMat4, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;

/// The colour behind everything.
const BACKGROUND: [f64; 3] = [0.12, 0.14, 0.2];

/// Solids, and what is culled.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "scene", rename_all = "kebab-case", deny_unknown_fields)]
pub enum CullingWire {
    /// A closed box through which the eye flies; the near plane cuts it on the way.
    FlyThrough {
        /// The faces or objects that are culled.
        method: CullingMethod,
        /// The distance of the eye from the middle of the box, whose sides are 2 long: 0 to 8.
        eye: f64,
    },
    /// A box without a lid, tilted towards the viewer.
    OpenMesh {
        /// The faces or objects that are culled.
        method: CullingMethod,
        /// The tilt in degrees, -90 to 90.
        angle: f64,
    },
    /// A box and its mirror image, which has the other winding.
    Mirrored {
        /// The faces or objects that are culled.
        method: CullingMethod,
        /// The angle by which the box is turned in degrees, -180 to 180.
        angle: f64,
    },
    /// A box with transparent faces around another box.
    SeeThrough {
        /// The faces or objects that are culled.
        method: CullingMethod,
        /// The faces' alpha, 0 to 1.
        alpha: f64,
    },
    /// A torus, with its triangles from back to front, so that depth tests save nothing.
    ClosedMesh {
        /// The faces or objects that are culled.
        method: CullingMethod,
        /// The number of segments around the torus's hole, 4 to 256; its tube has half as many.
        segments: u32,
    },
    /// A grid of boxes, one draw per box; the picture shows a ninth of the grid.
    Field {
        /// The faces or objects that are culled.
        method: CullingMethod,
        /// The number of objects, 1 to 1024.
        objects: u32,
    },
}

/// The faces or objects that are culled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CullingMethod {
    /// Culls nothing.
    None,
    /// Culls back faces.
    Back,
    /// Culls back faces, with the front face's winding reversed for mirrored objects.
    BackFlipped,
    /// Culls front faces.
    Front,
    /// Culls front faces in a first pass over the object, and back faces in a second.
    FrontThenBack,
    /// Culls objects whose bounding sphere is outside the picture.
    Frustum,
}

/// The draws of a scene and the polygons that should be seen.
struct ShownSolids {
    /// The draws that the method makes.
    draws: Vec<Draw>,
    /// All polygons that can be visible.
    polygons: Vec<Polygon>,
}

pub(crate) fn make(wire: &CullingWire) -> Result<MethodScene, ParameterError> {
    let ShownSolids { draws, polygons } = match *wire {
        CullingWire::FlyThrough { method, eye } => {
            within("eye", eye, 0.0..=8.0)?;
            fly_through(method, eye)
        }
        CullingWire::OpenMesh { method, angle } => {
            within("angle", angle, -90.0..=90.0)?;
            open_mesh(method, angle)
        }
        CullingWire::Mirrored { method, angle } => {
            within("angle", angle, -180.0..=180.0)?;
            mirrored(method, angle)
        }
        CullingWire::SeeThrough { method, alpha } => {
            within("alpha", alpha, 0.0..=1.0)?;
            see_through(method, alpha)
        }
        CullingWire::ClosedMesh { method, segments } => {
            within("segments", segments.into(), 4.0..=256.0)?;
            closed_mesh(method, segments)
        }
        CullingWire::Field { method, objects } => {
            within("objects", objects.into(), 1.0..=1024.0)?;
            field(method, objects)
        }
    }?;
    let mut stage = Stage::new();
    let background = [BACKGROUND[0], BACKGROUND[1], BACKGROUND[2], 1.0];
    let picture = stage.color("picture", TextureFormat::Rgba8Unorm, SIZE, background);
    let depth = stage.depth("depth", TextureFormat::Depth24Plus, SIZE, 1, 1.0);
    stage.pass(&[picture], Some(depth), draws);
    let truth = Truth {
        size: SIZE,
        background: BACKGROUND,
        coverage: TexelCoverage::Center,
        surfaces: polygons.iter().map(Polygon::surface).collect(),
    };
    Ok(MethodScene {
        scene: stage.read(&[picture]),
        truth,
    })
}

/// Returns the faces that a method culls in its single pass over an object; refuses methods that need more
/// than one pass.
fn one_pass(method: CullingMethod) -> Result<CullMode, ParameterError> {
    match method {
        CullingMethod::None => Ok(CullMode::None),
        CullingMethod::Back => Ok(CullMode::Back),
        CullingMethod::Front => Ok(CullMode::Front),
        CullingMethod::BackFlipped | CullingMethod::FrontThenBack | CullingMethod::Frustum => {
            let message = "this scene is drawn by `none`, `back` and `front`";
            Err(ParameterError::new("method", message))
        }
    }
}

/// Returns a draw of opaque triangles.
fn opaque(polygons: &[Polygon], cull: CullMode) -> Draw {
    let mut draw = stage::draw(Shader::FlatColor, polygon::mesh(SIZE, polygons));
    draw.depth = stage::depth(CompareFunction::Less, true);
    draw.cull = cull;
    draw
}

/// Gives each face of a box its own colour.
fn colored(faces: &mut [Face]) {
    let colors = [
        [0.9, 0.35, 0.3],
        [0.35, 0.75, 0.4],
        [0.35, 0.45, 0.9],
        [0.9, 0.8, 0.35],
        [0.75, 0.4, 0.85],
        [0.35, 0.8, 0.85],
    ];
    for (face, [r, g, b]) in faces.iter_mut().zip(colors) {
        face.color = [r, g, b, face.color[3]];
    }
}

/// Returns a box of coloured faces around the origin, with sides twice as long as `half`.
fn colored_box(half: f64) -> Vec<Face> {
    let corner = DVec3::splat(half);
    let mut faces = cuboid(-corner, corner, [1.0; 4]);
    colored(&mut faces);
    faces
}

fn moved(faces: &[Face], by: DMat4) -> Vec<Face> {
    faces.iter().map(|face| face.moved(&by)).collect()
}

fn fly_through(method: CullingMethod, eye: f64) -> Result<ShownSolids, ParameterError> {
    let turn = DMat4::from_rotation_x(0.26) * DMat4::from_rotation_y(0.52);
    let from = DVec3::new(0.0, 0.0, eye);
    let view = View::perspective(SIZE, [from, from - DVec3::Z], 60.0, [0.1, 20.0]);
    let polygons = settle(SIZE, &view.see(&moved(&colored_box(1.0), turn)));
    Ok(ShownSolids {
        draws: vec![opaque(&polygons, one_pass(method)?)],
        polygons,
    })
}

/// Returns a view from in front of the origin, at a distance.
fn front_view(distance: f64) -> View {
    let eye = DVec3::new(0.0, 0.0, distance);
    View::perspective(SIZE, [eye, DVec3::ZERO], 40.0, [0.5, 20.0])
}

fn open_mesh(method: CullingMethod, angle: f64) -> Result<ShownSolids, ParameterError> {
    let mut faces = colored_box(1.0);
    // The lid.
    faces.remove(3);
    let turn = DMat4::from_rotation_x(angle.to_radians()) * DMat4::from_rotation_y(0.61);
    let polygons = settle(SIZE, &front_view(4.6).see(&moved(&faces, turn)));
    Ok(ShownSolids {
        draws: vec![opaque(&polygons, one_pass(method)?)],
        polygons,
    })
}

fn mirrored(method: CullingMethod, angle: f64) -> Result<ShownSolids, ParameterError> {
    let (cull, flips) = match method {
        CullingMethod::BackFlipped => (CullMode::Back, true),
        other => (one_pass(other)?, false),
    };
    let turn = DMat4::from_rotation_x(0.44) * DMat4::from_rotation_y(angle.to_radians());
    let place = DMat4::from_translation(DVec3::new(-1.25, 0.0, 0.0)) * turn;
    let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let faces = colored_box(0.7);
    let view = front_view(6.0);
    let mut shown = ShownSolids {
        draws: Vec::new(),
        polygons: Vec::new(),
    };
    for (matrix, is_mirrored) in [(place, false), (mirror * place, true)] {
        let polygons = settle(SIZE, &view.see(&moved(&faces, matrix)));
        let mut draw = opaque(&polygons, cull);
        if flips && is_mirrored {
            draw.front_face = FrontFace::Cw;
        }
        shown.draws.push(draw);
        shown.polygons.extend(polygons);
    }
    Ok(shown)
}

fn see_through(method: CullingMethod, alpha: f64) -> Result<ShownSolids, ParameterError> {
    let passes = match method {
        CullingMethod::FrontThenBack => vec![CullMode::Front, CullMode::Back],
        other => vec![one_pass(other)?],
    };
    let turn = DMat4::from_rotation_x(0.4) * DMat4::from_rotation_y(0.7);
    let mut outer = moved(&colored_box(1.0), turn);
    for face in &mut outer {
        face.color[3] = alpha;
    }
    let corner = DVec3::splat(0.4);
    let inner = moved(&cuboid(-corner, corner, [0.9, 0.9, 0.85, 1.0]), turn);
    let view = front_view(4.6);
    let solid = settle(SIZE, &view.see(&inner));
    let faces = settle(SIZE, &view.see(&outer));
    let mut draws = vec![opaque(&solid, CullMode::Back)];
    draws.extend(passes.into_iter().map(|cull| {
        let mut draw = opaque(&faces, cull);
        draw.depth = stage::depth(CompareFunction::Less, false);
        draw.targets[0].blend = stage::over();
        draw
    }));
    Ok(ShownSolids {
        draws,
        polygons: [solid, faces].concat(),
    })
}

fn closed_mesh(method: CullingMethod, segments: u32) -> Result<ShownSolids, ParameterError> {
    let turn = DMat4::from_rotation_x(0.7) * DMat4::from_rotation_y(0.3);
    let faces = moved(&torus(segments), turn);
    let mut polygons = settle(SIZE, &front_view(4.6).see(&faces));
    let depth = |p: &Polygon| p.corners.iter().map(|c| c[2]).sum::<f64>();
    polygons.sort_by(|a, b| depth(b).total_cmp(&depth(a)));
    Ok(ShownSolids {
        draws: vec![opaque(&polygons, one_pass(method)?)],
        polygons,
    })
}

/// Returns the triangles of a torus around the z axis, seen from outside.
fn torus(segments: u32) -> Vec<Face> {
    let [around, across] = [segments, segments / 2];
    let point = |i: u32, j: u32| {
        let turn = |k: u32, n: u32| f64::from(k % n) / f64::from(n) * std::f64::consts::TAU;
        let (sin, cos) = turn(i, around).sin_cos();
        let (up, out) = turn(j, across.max(3)).sin_cos();
        let radius = 1.0 + 0.45 * out;
        DVec3::new(radius * cos, radius * sin, 0.45 * up)
    };
    let mut faces = Vec::new();
    for (i, j) in (0..around).flat_map(|i| (0..across.max(3)).map(move |j| (i, j))) {
        let [a, b] = [point(i, j), point(i + 1, j)];
        let [c, d] = [point(i + 1, j + 1), point(i, j + 1)];
        let color = match (i + j) % 2 {
            0 => [0.9, 0.6, 0.35, 1.0],
            _ => [0.4, 0.65, 0.9, 1.0],
        };
        for corners in [vec![a, b, c], vec![a, c, d]] {
            faces.push(Face { corners, color }.lit());
        }
    }
    faces
}

fn field(method: CullingMethod, objects: u32) -> Result<ShownSolids, ParameterError> {
    let (cull, by_object) = match method {
        CullingMethod::Frustum => (CullMode::None, true),
        other => (one_pass(other)?, false),
    };
    // The picture is 2 wide, the grid 6.
    let eye = DVec3::new(0.0, 0.0, 10.0);
    let view = View::parallel(SIZE, [eye, DVec3::ZERO], 2.0, [5.0, 15.0]);
    let side = f64::from(objects).sqrt().ceil();
    let half = 0.32 * 6.0 / side;
    let mut shown = ShownSolids {
        draws: Vec::new(),
        polygons: Vec::new(),
    };
    for object in 0..objects {
        let n = f64::from(object);
        let [column, row] = [n % side, (n / side).floor()];
        let place = [column, row].map(|c| (c + 0.5) / side * 6.0 - 3.0);
        // Compares the sphere around the box with the sides of the frustum, which is a box too.
        let radius = half * 3.0_f64.sqrt();
        let turn = DMat4::from_rotation_x(0.5 + n) * DMat4::from_rotation_y(0.8 + 0.6 * n);
        let to = DMat4::from_translation(DVec3::new(place[0], place[1], 0.0));
        let faces = moved(&colored_box(half), to * turn);
        let polygons = settle(SIZE, &view.unbounded(&faces));
        let outside = place.iter().any(|c| c.abs() - radius > 1.0);
        if !(by_object && outside) {
            shown.draws.push(opaque(&polygons, cull));
        }
        shown.polygons.extend(polygons);
    }
    Ok(shown)
}
