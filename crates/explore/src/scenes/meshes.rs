//! Meshes of random draws, with topology, indices and instances.

use super::{Maker, PassDraft};
use etalon_frame::Feature;
use etalon_scene::Shader;
use serde_json::{Value, json};

/// The form of a mesh that is given as vertices.
#[derive(Clone, Copy, Debug)]
struct Form {
    /// True for triangles, three vertices each.
    list: bool,
    /// True if an index can restart a strip.
    restarts: bool,
    indexed: bool,
    /// True if each vertex has its own colour.
    apart: bool,
}

/// The depth that a mesh's vertex colours contain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum VertexDepth {
    /// No depth: the numbers are colours.
    Nothing,
    /// Any depth.
    Red,
    /// Always this depth.
    Always(f64),
}

impl Maker<'_> {
    /// Adds the mesh of a draw whose viewport has this size in texels. One arm per kind of mesh.
    pub(super) fn mesh(
        &mut self,
        pass: &PassDraft,
        shader: Shader,
        written: VertexDepth,
        [w, h]: [u32; 2],
        draw: &mut Value,
    ) {
        let several = pass.samples > 1;
        if shader.clip_distances() > 0 || shader.uses_uv() {
            draw["mesh"] = self.with_coordinates(pass, shader, [w, h], draw);
            return;
        }
        let plain = !several || self.choices.once_in(5);
        let mut kinds = vec!["cover", "stack"];
        if plain {
            kinds.splice(0..0, ["columns", "rows", "full", "rect", "columns", "rows"]);
            kinds.extend(["grid", "field", "vertices"]);
        }
        if pass.provoking.is_some() && shader == Shader::FlatColor {
            kinds.extend(["vertices", "fan", "polyline"].repeat(3));
        }
        if written == VertexDepth::Nothing && self.extra("slopes") {
            kinds = vec!["slope"];
        }
        if !several {
            kinds.extend(["points", "fan", "strip"]);
            kinds.extend((w >= 8).then_some("lines"));
            let outlines = w >= 8 && h >= 8 && self.space.has(Feature::PolygonModeLine);
            kinds.extend(outlines.then_some("outlines"));
        }
        let kind = self.choices.word("mesh", &kinds);
        let z = self.vertex_depth();
        let mut indexed = false;
        draw["mesh"] = match kind {
            "columns" | "rows" => {
                let most = if kind == "columns" { w } else { h };
                self.bands(kind, most.min(6), written)
            }
            "rect" => {
                let (l, t) = (self.choices.below(w), self.choices.below(h));
                let (r, b) = (self.choices.range(l + 1, w), self.choices.range(t + 1, h));
                let winding = self.choices.word("winding", &["ccw", "cw"]);
                json!({ "kind": "rect", "texels": [l, t, r, b], "z": z,
                        "value": self.value(written), "winding": winding })
            }
            "full" => {
                let winding = self.choices.word("winding", &["ccw", "cw"]);
                json!({ "kind": "full", "z": z, "value": self.value(written), "winding": winding })
            }
            "stack" => {
                let count = self.choices.range(2, 4);
                let z: Vec<f64> = (0..count).map(|_| self.vertex_depth()).collect();
                let values: Vec<Value> = (0..count).map(|_| self.value(written)).collect();
                json!({ "kind": "stack", "z": z, "values": values })
            }
            "grid" => {
                indexed = true;
                let cells = [w, h].map(|n| self.choices.range(1, n.min(4)));
                json!({ "kind": "grid", "cells": cells, "z": z, "value": self.value(written) })
            }
            "field" | "points" | "lines" | "outlines" => {
                let primitives = if kind == "field" { "triangles" } else { kind };
                let (topology, mode, room) = match kind {
                    "points" => ("point-list", "fill", w * h),
                    "lines" => ("line-list", "fill", w / 8 * h),
                    "outlines" => ("triangle-list", "line", (w / 8) * (h / 8)),
                    _ => ("triangle-list", "fill", w * h),
                };
                draw["topology"] = json!(topology);
                draw["polygon_mode"] = json!(mode);
                let count = self.choices.range(1, room.min(40));
                indexed = self.choices.once_in(2);
                let values: Vec<Value> = (0..3).map(|_| self.value(written)).collect();
                json!({ "kind": "field", "of": primitives, "count": count, "z": z,
                        "values": values, "indexed": indexed })
            }
            "strip" if h >= 2 => {
                draw["topology"] = json!("triangle-strip");
                let count = self.choices.range(1, (w * (h / 2 * 2)).min(20));
                indexed = self.choices.once_in(2);
                json!({ "kind": "strip", "of": "triangles", "count": count, "z": z,
                        "value": self.value(written), "indexed": indexed })
            }
            "slope" => self.slope([w, h]),
            "vertices" | "fan" | "polyline" => {
                let list = kind == "vertices";
                let fans = self.space.has(Feature::TriangleFans);
                let topologies = ["triangle-strip", "triangle-fan"];
                if kind == "polyline" {
                    let lines = ["line-list", "line-strip"];
                    draw["topology"] = json!(self.choices.word("topology", &lines));
                } else if !list {
                    let usable = &topologies[..1 + usize::from(fans)];
                    draw["topology"] = json!(self.choices.word("topology", usable));
                }
                indexed = self.choices.once_in(2);
                let apart = pass.provoking.is_some() && shader == Shader::FlatColor;
                let restarts = draw.get("topology").is_some_and(|t| t != "line-list");
                let form = Form {
                    list,
                    restarts,
                    indexed,
                    apart,
                };
                self.vertices([w, h], form, written)
            }
            _ => json!({ "kind": "cover", "z": z, "value": self.value(written) }),
        };
        self.fetch(indexed, draw);
        // Strips and fans need indices to end an instance.
        let list = draw.get("topology").is_none_or(|t| t == "triangle-list");
        if written == VertexDepth::Nothing && (list || indexed) && self.extra("instances") {
            let count = self.choices.range(1, 3);
            let colors: Vec<Value> = (0..count).map(|_| self.color()).collect();
            let first = if self.space.has(Feature::FirstInstance) {
                self.choices.of(&[0, 1, 5])
            } else {
                0
            };
            draw["instances"] = json!({ "colors": colors, "first": first });
        }
        let patches = list && draw.get("instances").is_none() && shader.passes_position_alone();
        if patches && self.extra_with("tessellation", Feature::Tessellation) {
            let order = self.choices.word("patches", &["ccw", "cw"]);
            let upper = self.space.has(Feature::UpperLeftDomain) && self.choices.once_in(2);
            let origin = if upper { "upper-left" } else { "lower-left" };
            draw["tessellation"] = json!({ "order": order, "origin": origin });
        }
    }

    /// Returns the value of a vertex: a colour or a depth.
    fn value(&mut self, written: VertexDepth) -> Value {
        match written {
            VertexDepth::Nothing => self.color(),
            VertexDepth::Red => json!(self.depth()),
            VertexDepth::Always(depth) => json!(depth),
        }
    }

    /// Returns bands across or down, each with its own depth and winding.
    fn bands(&mut self, kind: &str, most: u32, written: VertexDepth) -> Value {
        let count = self.choices.range(1, most);
        let values: Vec<Value> = (0..count).map(|_| self.value(written)).collect();
        let z: Vec<f64> = (0..count).map(|_| self.vertex_depth()).collect();
        let windings: Vec<&str> = (0..count)
            .map(|_| self.choices.of(&["ccw", "cw"]))
            .collect();
        json!({ "kind": kind, "values": values, "z": z, "windings": windings })
    }

    /// Returns a mesh over everything, as two triangles in a plane that is not parallel to the picture.
    fn slope(&mut self, [w, h]: [u32; 2]) -> Value {
        let ends = self.choices.of(&[[0.2, 0.7], [0.9, 0.1], [0.45, 0.55]]);
        let down = self.choices.once_in(2);
        let [right, bottom] = [w, h].map(|n| f64::from(n) + 1.0);
        let corner = |(x, y, across, below): (f64, f64, usize, usize)| {
            json!([x, y, ends[if down { below } else { across }]])
        };
        let corners = [
            (-1.0, -1.0, 0, 0),
            (-1.0, bottom, 0, 1),
            (right, -1.0, 1, 0),
            (right, -1.0, 1, 0),
            (-1.0, bottom, 0, 1),
            (right, bottom, 1, 1),
        ];
        let mut positions = corners.map(corner);
        if self.choices.once_in(2) {
            positions.reverse();
        }
        json!({
            "kind": "vertices", "units": "texels", "positions": positions, "values": [self.color()]
        })
    }

    /// Returns triangles at any position, some with edges through samples. Most have a constant depth.
    fn vertices(&mut self, [w, h]: [u32; 2], form: Form, written: VertexDepth) -> Value {
        let Form {
            list,
            restarts,
            indexed,
            apart,
        } = form;
        let count = if list {
            3 * self.choices.range(1, 3)
        } else {
            self.choices.of(&[4, 6])
        };
        let colors = if apart { count } else { 1 };
        let values: Vec<Value> = (0..colors).map(|_| self.value(written)).collect();
        let sloped = written == VertexDepth::Nothing && self.choices.once_in(6);
        let mut z = 0.0;
        let positions: Vec<Value> = (0..count)
            .map(|i| {
                let mut place =
                    |length: u32| f64::from(self.choices.below(length * 4 + 17)) / 4.0 - 2.0;
                let (x, y) = (place(w), place(h));
                if sloped || if list { i % 3 == 0 } else { i == 0 } {
                    z = self.vertex_depth();
                }
                json!([x, y, z])
            })
            .collect();
        let mut mesh = json!({
            "kind": "vertices", "units": "texels", "positions": positions, "values": values
        });
        if indexed {
            let mut indices: Vec<Option<u32>> = (0..count).map(Some).collect();
            if list {
                indices.reverse();
            } else if restarts && self.choices.once_in(2) {
                indices.push(None);
                indices.extend((0..count).rev().map(Some));
            }
            mesh["indices"] = json!(indices);
        }
        mesh
    }

    /// Sets a mesh with texture coordinates: either the texture a few times, or texels beyond a line, such
    /// that planes are between samples.
    fn with_coordinates(
        &mut self,
        pass: &PassDraft,
        shader: Shader,
        [w, h]: [u32; 2],
        draw: &mut Value,
    ) -> Value {
        let z = self.vertex_depth();
        if shader.samples_texture() {
            let some = [0.0, 1.0, 2.0, -1.0];
            let mut place = || self.choices.of(&some);
            let [l, t, r, b] = [place(), place(), 1.0 + place(), 1.0 + place()];
            return json!({ "kind": "cover", "z": z, "uv": [l, t, r, b] });
        }
        let centroid = shader == Shader::Centroid;
        // The left side of a centroid-interpolated mesh is between the samples of a texel.
        let cut = f64::from(self.choices.below(w)) + 0.25;
        let left = if centroid { cut } else { -1.0 };
        let [right, bottom] = [w, h].map(|n| f64::from(n) + 1.0);
        let mut line = |length: u32| {
            let position = f64::from(self.choices.range(0, length));
            let sign = self.choices.of(&[1.0, -1.0]);
            move |place: f64| (place - position) * sign
        };
        let (u, v) = (line(w), line(h));
        // A distance that is 0 everywhere clips nothing.
        let flat = self.choices.once_in(8);
        let corners = [
            (left, -1.0),
            (left, bottom),
            (right, -1.0),
            (right, -1.0),
            (left, bottom),
            (right, bottom),
        ];
        if pass.samples == 1 && !centroid && self.choices.once_in(4) {
            let topology = self.choices.word("topology", &["point-list", "line-list"]);
            draw["topology"] = json!(topology);
            let points = [
                (0.5, 0.5),
                (f64::from(w) - 0.5, 0.5),
                (0.5, 1.5),
                (1.5, 1.5),
            ];
            let uv = points.map(|(x, y)| [u(x), v(y)]);
            let positions = points.map(|(x, y)| [x, y, z]);
            return json!({
                "kind": "vertices", "units": "texels", "positions": positions, "uv": uv,
                "values": [self.color()]
            });
        }
        let positions = corners.map(|(x, y)| [x, y, z]);
        let uv = corners.map(|(x, y)| {
            if centroid {
                [x - left, 0.0]
            } else if flat {
                [0.0, v(y)]
            } else {
                [u(x), v(y)]
            }
        });
        json!({
            "kind": "vertices", "units": "texels", "positions": positions, "uv": uv,
            "values": [self.color()]
        })
    }

    /// Adds the first index, base vertex or first vertex of the draw call.
    fn fetch(&mut self, indexed: bool, draw: &mut Value) {
        if !self.extra("fetch") {
            return;
        }
        draw["fetch"] = if indexed {
            let base = if self.space.has(Feature::BaseVertex) {
                self.choices.of(&[0, 3, -2])
            } else {
                0
            };
            let index = self.choices.of(&["uint32", "uint16"]);
            let first = self.choices.of(&[0, 3, 6]);
            json!({ "index": index, "base_vertex": base, "first_index": first })
        } else {
            json!({ "first_vertex": self.choices.of(&[0, 1, 3]) })
        };
    }
}
