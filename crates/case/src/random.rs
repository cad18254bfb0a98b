//! Random scenes from a seed: several draws with all their states different and none at its default.
//!
//! A scene is made as the JSON of a case file, so that people can copy and edit it. Inputs are limited to
//! what can be proven: written depths are 0, 1 or far apart, samples are away from edges, alpha is 0 or 1 if
//! it decides coverage, and colours avoid values whose rounding is open (see [`Palette`]).

use etalon_frame::SplitMix64;
use etalon_scene::{
    BlendFactor, BlendOperation, CompareFunction, LogicOperation, StencilOperation,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// The states of a random scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Flavor {
    /// Depth, stencil, blending, culling, masks, scissor and viewport, in the form that every API has.
    Common,
    /// [`Flavor::Common`] with four samples, sample masks and alpha to coverage.
    Multisample,
    /// [`Flavor::Common`] plus one state per scene that only some APIs have: separate stencil masks, two
    /// sources, logic operations, depth bounds, depth clamp or reversed depth.
    Extended,
    /// [`Flavor::Common`] with shaders that write the stencil reference.
    Exported,
    /// [`Flavor::Common`] with any w: vertices in front of the eye, behind it, and in its plane.
    Perspective,
}

/// A state that only some APIs have.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Extra {
    Nothing,
    SeparateMasks,
    DualSource,
    Logic,
    DepthBounds,
    DepthClamp,
    ReversedDepth,
    AlphaToOne,
    Exported,
    Perspective,
}

/// The colours of a scene, for which few codes are legal.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Palette {
    /// Sums of powers of two. Their multiples by `2^b - 1` are never nearly integers, so two codes are legal
    /// for each.
    Normalized,
    /// Values between two codes that differ only in the last bit, for 8 and for 10 bits: a logic operation
    /// carries no more than that bit into the result.
    Bits,
    /// Values that are exact in floats, as are their products. Their factors differ, so few differences are
    /// nearly 0, where many codes would be legal. Textures have such values too.
    Float,
}

impl Palette {
    const fn values(self) -> [f64; 6] {
        match self {
            Self::Normalized => [0.0, 0.25, 0.375, 0.625, 0.75, 1.0],
            Self::Float => [0.0, 0.4375, 0.8125, 1.0, 1.375, 2.125],
            Self::Bits => [0.0, 0.11, 0.3, 0.62, 0.81, 1.0],
        }
    }

    /// Returns a value near an 8-bit code that is exact in a 16-bit float.
    fn near(self, code: u32) -> f64 {
        match self {
            Self::Normalized | Self::Float => {
                let values = self.values();
                values[code as usize * values.len() / 256]
            }
            Self::Bits => {
                let between = |most: f64, v: f64| {
                    let scaled = v * most;
                    scaled.floor() % 2.0 == 0.0 && (0.05..0.95).contains(&scaled.fract())
                };
                let fits = |v: &f64| between(255.0, *v) && between(1023.0, *v);
                let mut from = (code * 4..1024).map(|k| f64::from(k) / 1024.0);
                match code {
                    0 => 0.0,
                    _ => from.find(fits).unwrap_or(1.0),
                }
            }
        }
    }
}

/// The width and height of all attachments.
const SIZE: u32 = 16;

/// Factors of positions: the w of a mesh's vertices in turn, repeated over the mesh.
const FACTORS: [&[f64]; 7] = [
    &[1.0],
    &[2.0, 0.5, 8.0],
    &[0.25, 1.0, 1.0, 4.0],
    &[1.0, 64.0],
    &[4.0, 1.0, 0.125, 2.0, 16.0],
    &[65536.0],
    &[9.536_743_164_062_5e-7],
];

/// The x, y and w of triangles that reach behind the eye.
const BEHIND: [[[f64; 3]; 3]; 6] = [
    [[-2.0, -3.0, 1.0], [2.0, -3.0, 1.0], [0.0, 1.0, 0.0]],
    [[-2.0, 3.0, 1.0], [-2.0, -3.0, 1.0], [1.0, 0.0, 0.0]],
    [[-2.0, -2.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    [[-2.0, -2.0, 1.0], [3.0, 2.0, -1.0], [2.0, 3.0, -1.0]],
    [[-3.0, -2.0, 1.0], [3.0, -2.0, 1.0], [0.0, 4.0, -1.0]],
    [[2.0, 2.0, 1.0], [-3.0, -2.0, -1.0], [-2.0, -3.0, -1.0]],
];

/// Returns the scene of a seed. A seed must always give the same scene, because ids contain it.
pub(crate) fn scene(flavor: Flavor, seed: u64) -> Value {
    // Flavours with the same seed make unrelated scenes.
    let mut dice = Dice(SplitMix64(seed ^ (0x9e37_79b9 * (flavor as u64 + 1))));
    let samples = if flavor == Flavor::Multisample { 4 } else { 1 };
    let extra = match flavor {
        Flavor::Common => Extra::Nothing,
        Flavor::Exported => Extra::Exported,
        Flavor::Perspective => Extra::Perspective,
        Flavor::Multisample => *dice.of(&[Extra::Nothing, Extra::Nothing, Extra::AlphaToOne]),
        Flavor::Extended => *dice.of(&[
            Extra::SeparateMasks,
            Extra::DualSource,
            Extra::Logic,
            Extra::DepthBounds,
            Extra::DepthClamp,
            Extra::ReversedDepth,
        ]),
    };
    let color = *dice.of(&[
        "rgba8unorm",
        "rgba8unorm",
        "bgra8unorm",
        "rgb10a2unorm",
        "rgba16float",
    ]);
    // Drivers differ in resolving and counting samples of the 10-bit format and of floats.
    let color = if samples > 1 { "rgba8unorm" } else { color };
    let depth = *dice.of(&["depth24plus-stencil8", "depth32float-stencil8"]);
    let palette = match (color, extra) {
        ("rgba16float", _) => Palette::Float,
        (_, Extra::Logic) => Palette::Bits,
        _ => Palette::Normalized,
    };
    let mut maker = Maker {
        samples,
        extra,
        palette,
        whole_alpha: color == "rgb10a2unorm",
        reference: dice.range(1, 200),
        dice,
    };
    let count = maker.dice.range(3, 5);
    let draws: Vec<Value> = (0..count).map(|i| maker.draw(i)).collect();
    let clear = maker.color();
    let stored = *maker.dice.of(&[0.0, 0.5, 1.0]);
    let stencil = maker.dice.range(1, 254);
    let mut scene = json!({
        "attachments": {
            "color": { "format": color, "samples": samples, "size": [SIZE, SIZE], "clear": clear },
            "depth": {
                "format": depth, "samples": samples, "size": [SIZE, SIZE],
                "clear": { "depth": stored, "stencil": stencil }
            },
            "first": maker.texture(),
            "second": maker.texture()
        },
        "passes": [{ "color": ["color"], "depth_stencil": "depth", "draws": draws }],
        "read": ["color", "depth"]
    });
    if extra == Extra::Exported {
        scene["attachments"]["references"] = maker.references();
    }
    scene
}

/// Returns true if the viewport must not change the depths that a shader writes.
fn writes_depth(shader: &str) -> bool {
    matches!(shader, "flat_color_depth" | "exported_depth")
}

struct Maker {
    samples: u32,
    extra: Extra,
    palette: Palette,
    /// True if alpha is 0 or 1. With two bits of alpha, values in between could legally round to different
    /// thirds, and as factors these would affect the colours.
    whole_alpha: bool,
    /// The stencil reference that all draws share. If each draw had its own, comparisons with the stored value
    /// would almost never find both equal.
    reference: u32,
    dice: Dice,
}

impl Maker {
    fn draw(&mut self, index: u32) -> Value {
        let (shader, textures) = match self.extra {
            Extra::DualSource => ("texel_dual_source", json!(["first", "second"])),
            // The first draw always writes a stencil reference.
            Extra::Exported if index == 0 || self.dice.range(0, 2) > 0 => {
                let shaders = [
                    "exported_color",
                    "exported_depth",
                    "exported_discard",
                    "exported_facing",
                ];
                (*self.dice.of(&shaders), json!(["references"]))
            }
            _ => match self.dice.range(0, 3) {
                0 => ("flat_color", json!([])),
                1 => ("front_facing", json!([])),
                2 => ("flat_color_depth", json!([])),
                _ => ("texel_color", json!(["first"])),
            },
        };
        let mut draw = json!({
            "mesh": self.mesh(shader, index),
            "shader": shader,
            "textures": textures,
            "params": { "color": self.color(), "back_color": self.color() },
            "cull": self.dice.of(&["none", "front", "back"]),
            "front_face": self.dice.of(&["ccw", "cw"]),
            "viewport": {
                "rect": self.rect(),
                "depth": if writes_depth(shader) { json!([0, 1]) } else { self.depth_range() }
            },
            "scissor": self.scissor(),
            "depth": { "compare": self.compare(), "write": self.dice.range(0, 3) > 0 },
            "stencil": self.stencil(),
            "write_mask": self.dice.of(&["rgba", "rgb", "rga", "gba", "rb", "a"]),
            "blend_constant": self.color()
        });
        match self.extra {
            Extra::Logic => draw["logic"] = json!(self.dice.of(LogicOperation::ALL)),
            _ => draw["blend"] = self.blend(),
        }
        match self.extra {
            Extra::DepthBounds => {
                let bounds = *self.dice.of(&[[0.0, 0.6], [0.3, 1.0], [0.1, 0.9]]);
                draw["depth_bounds"] = json!(bounds);
            }
            Extra::DepthClamp => draw["depth_clamp"] = true.into(),
            Extra::Perspective => {
                draw["w"] = json!(self.dice.of(&FACTORS));
                // The first draw's mesh covers the viewport.
                if index > 0 && self.dice.range(0, 1) == 0 {
                    draw["mesh"] = self.reaching_behind(shader);
                }
            }
            _ => {}
        }
        if self.samples > 1 {
            let covers = self.extra != Extra::AlphaToOne && self.dice.range(0, 2) == 0;
            draw["multisample"] = json!({
                "mask": self.dice.range(1, 14),
                "alpha_to_coverage": covers,
                "alpha_to_one": self.extra == Extra::AlphaToOne
            });
        }
        draw
    }

    /// Returns bands across or down with depths and windings of their own; with several samples, a whole
    /// quad, so that no sample is near an edge.
    fn mesh(&mut self, shader: &str, index: u32) -> Value {
        let written = shader == "flat_color_depth";
        if self.samples > 1 {
            let value = if written {
                json!(self.depth())
            } else {
                self.color()
            };
            return json!({ "kind": "cover", "value": value, "z": self.vertex_depth() });
        }
        let kind = if index.is_multiple_of(2) {
            "columns"
        } else {
            "rows"
        };
        let count = self.dice.range(3, 6);
        let values: Vec<Value> = (0..count)
            .map(|_| {
                if written {
                    json!(self.depth())
                } else {
                    self.color()
                }
            })
            .collect();
        let z: Vec<f64> = (0..count).map(|_| self.vertex_depth()).collect();
        let windings: Vec<&str> = (0..count).map(|_| *self.dice.of(&["ccw", "cw"])).collect();
        json!({ "kind": kind, "values": values, "z": z, "windings": windings })
    }

    /// Returns a triangle with a vertex behind the eye, or in its plane. The lines of its edges are outside
    /// the viewport, so they avoid its texel centres, whatever its size.
    fn reaching_behind(&mut self, shader: &str) -> Value {
        let written = shader == "flat_color_depth";
        let value = if written {
            json!(self.depth())
        } else {
            self.color()
        };
        let z = self.vertex_depth();
        let mut positions = self
            .dice
            .of(&BEHIND)
            .map(|[x, y, w]| json!([x, y, z * w, w]));
        if self.dice.range(0, 1) == 0 {
            positions.swap(0, 1);
        }
        json!({ "kind": "vertices", "positions": positions, "values": [value] })
    }

    /// Returns a depth to be written: two such depths are equal or far apart.
    fn depth(&mut self) -> f64 {
        *self.dice.of(&[0.0, 0.0, 0.21, 0.4, 0.62, 0.83, 1.0, 1.0])
    }

    /// Returns a clip-space depth, never near a clipping plane.
    fn vertex_depth(&mut self) -> f64 {
        if self.extra == Extra::DepthClamp {
            return *self.dice.of(&[-0.75, 0.0, 0.3, 0.7, 1.0, 1.75]);
        }
        *self.dice.of(&[0.0, 0.17, 0.37, 0.57, 0.77, 0.97])
    }

    fn depth_range(&mut self) -> Value {
        let range = *self
            .dice
            .of(&[[0.0, 1.0], [0.125, 0.875], [0.25, 1.0], [0.0, 0.75]]);
        match self.extra {
            Extra::ReversedDepth => json!([range[1], range[0]]),
            _ => json!(range),
        }
    }

    /// Returns a scissor rectangle. Multisampled scenes get none, because a known driver bug would hide all
    /// others.
    fn scissor(&mut self) -> Value {
        match self.samples {
            1 => json!(self.rect()),
            _ => Value::Null,
        }
    }

    /// Returns a rectangle of at least 11 texels a side that is smaller than the attachment.
    fn rect(&mut self) -> [u32; 4] {
        let (x, y) = (self.dice.range(0, 4), self.dice.range(0, 4));
        let side = |dice: &mut Dice, start| dice.range(11, SIZE - start - u32::from(start == 0));
        let (w, h) = (side(&mut self.dice, x), side(&mut self.dice, y));
        [x, y, w, h]
    }

    /// Returns channels of 0, 1 and values in between; alpha is 0 or 1 with several samples.
    fn color(&mut self) -> Value {
        let values = self.palette.values();
        let mut color = [0, 0, 0, 0].map(|_| *self.dice.of(&values));
        if self.samples > 1 {
            color[3] = *self.dice.of(&[0.0, 1.0, 1.0]);
        }
        if self.whole_alpha {
            color[3] = color[3].round();
        }
        json!(color)
    }

    fn texture(&mut self) -> Value {
        let one_sample = self.samples == 1;
        let values: Vec<[u32; 4]> = (0..SIZE)
            .map(|_| {
                let mut texel = [0; 4].map(|_: u32| self.dice.range(0, 255));
                if !one_sample {
                    texel[3] = *self.dice.of(&[0, 255]);
                }
                if self.whole_alpha {
                    texel[3] = texel[3] / 128 * 255;
                }
                texel
            })
            .collect();
        let kind = *self.dice.of(&["columns", "rows"]);
        let palette = self.palette;
        if palette == Palette::Normalized {
            return json!({ "format": "rgba8unorm", "size": [SIZE, SIZE], "texels": { "kind": kind, "values": values } });
        }
        let values: Vec<_> = values
            .iter()
            .map(|t| t.map(|code| palette.near(code)))
            .collect();
        json!({ "format": "rgba16float", "size": [SIZE, SIZE], "texels": { "kind": kind, "values": values } })
    }

    /// Returns texels of stencil references (many equal the scene's in the relevant bits), written depths,
    /// and values that decide a discard.
    fn references(&mut self) -> Value {
        let reference = self.reference;
        let values: Vec<Value> = (0..SIZE)
            .map(|_| {
                let mut next_reference = || {
                    let other = self.dice.range(0, 255);
                    let high = *self.dice.of(&[0, 0, 256, -256, 768]);
                    let low = *self.dice.of(&[reference, reference, reference + 1, other]);
                    i64::from(low) + high
                };
                let (front, back) = (next_reference(), next_reference());
                let blue = self.dice.range(0, 3).min(1);
                json!([front, self.depth(), blue, back])
            })
            .collect();
        let kind = *self.dice.of(&["columns", "rows"]);
        json!({ "format": "rgba32float", "size": [SIZE, SIZE], "texels": { "kind": kind, "values": values } })
    }

    fn compare(&mut self) -> CompareFunction {
        use CompareFunction as Is;
        // Functions that let something pass occur more than once; otherwise pictures would stay empty.
        *self.dice.of(&[
            Is::Less,
            Is::LessEqual,
            Is::LessEqual,
            Is::Greater,
            Is::GreaterEqual,
            Is::GreaterEqual,
            Is::NotEqual,
            Is::NotEqual,
            Is::Equal,
            Is::Always,
            Is::Never,
        ])
    }

    fn stencil(&mut self) -> Value {
        let masks = [0xff, 0x0f, 0xf0, 0x55, 0xaa, 0x3c, 0x81];
        let face = |dice: &mut Dice, compare: CompareFunction| {
            json!({
                "compare": compare,
                "fail_op": dice.of(StencilOperation::ALL),
                "depth_fail_op": dice.of(StencilOperation::ALL),
                "pass_op": dice.of(StencilOperation::ALL)
            })
        };
        let compares = [self.compare(), self.compare()];
        let mut front = face(&mut self.dice, compares[0]);
        let mut back = face(&mut self.dice, compares[1]);
        if self.extra == Extra::SeparateMasks {
            for side in [&mut front, &mut back] {
                side["read_mask"] = json!(self.dice.of(&masks));
                side["write_mask"] = json!(self.dice.of(&masks));
                side["reference"] = json!(self.dice.range(1, 254));
            }
        }
        json!({
            "front": front,
            "back": back,
            "read_mask": self.dice.of(&masks),
            "write_mask": self.dice.of(&masks),
            "reference": self.reference
        })
    }

    fn blend(&mut self) -> Value {
        let operation = |dice: &mut Dice| {
            *dice.of(&[
                BlendOperation::Add,
                BlendOperation::Add,
                BlendOperation::Subtract,
                BlendOperation::ReverseSubtract,
            ])
        };
        let second = self.extra == Extra::DualSource;
        // Some APIs lack constant alpha as a factor for colours.
        let usable = |factor: &BlendFactor, is_color: bool| {
            (second || !factor.is_second_source())
                && !(is_color
                    && matches!(
                        factor,
                        BlendFactor::ConstantAlpha | BlendFactor::OneMinusConstantAlpha
                    ))
        };
        let part = |dice: &mut Dice, is_color: bool| {
            let factors: Vec<BlendFactor> = BlendFactor::ALL
                .iter()
                .copied()
                .filter(|f| usable(f, is_color))
                .collect();
            let min_max = dice.range(0, 7) == 0;
            if min_max {
                let operation = *dice.of(&[BlendOperation::Min, BlendOperation::Max]);
                return json!({ "operation": operation, "src_factor": "one", "dst_factor": "one" });
            }
            json!({
                "operation": operation(dice),
                "src_factor": dice.of(&factors),
                "dst_factor": dice.of(&factors)
            })
        };
        let color = part(&mut self.dice, true);
        let alpha = part(&mut self.dice, false);
        json!({ "color": color, "alpha": alpha })
    }
}

/// Random choices, which must never change.
struct Dice(SplitMix64);

impl Dice {
    fn roll(&mut self) -> u64 {
        self.0.roll()
    }

    /// Returns a number from `low` to `high`, both included.
    fn range(&mut self, low: u32, high: u32) -> u32 {
        let span = u64::from(high.saturating_sub(low)) + 1;
        low + (self.roll() % span) as u32
    }

    /// Returns an element of a list.
    fn of<'l, T>(&mut self, list: &'l [T]) -> &'l T {
        &list[(self.roll() % list.len() as u64) as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_seeds_give_equal_scenes_and_others_differ() {
        for flavor in [
            Flavor::Common,
            Flavor::Multisample,
            Flavor::Extended,
            Flavor::Exported,
            Flavor::Perspective,
        ] {
            assert_eq!(scene(flavor, 7), scene(flavor, 7));
            assert_ne!(scene(flavor, 7), scene(flavor, 8));
        }
    }
}
