//! Draws of random scenes: shaders, states, and changes from one draw to the next.

use super::meshes::VertexDepth;
use super::{Maker, PassDraft};
use etalon_frame::Feature;
use etalon_scene::Shader;
use serde_json::{Value, json};

/// States in which a draw can differ from the previous draw, whatever the two draw.
const ALONE: [&str; 13] = [
    "cull",
    "front_face",
    "depth",
    "stencil",
    "scissor",
    "depth_bias",
    "depth_bounds",
    "depth_clamp",
    "rasterizer_discard",
    "params",
    "output",
    "multisample",
    "sampler",
];

impl Maker<'_> {
    /// Makes a draw of a pass. One in four is the previous draw with another value of one state.
    pub(super) fn draw(&mut self, pass: &PassDraft, previous: Option<&Value>) -> Value {
        self.choices.begin_draw();
        if let Some(previous) = previous
            && self.choices.once_in(4)
        {
            return self.changed(pass, previous);
        }
        let shader = self.shader(pass);
        self.choices.note("shader", shader.name());
        let mut draw = json!({ "shader": shader.name() });
        let early = self.early_tests(shader);
        draw["early_tests"] = json!(early);
        let written = match (shader.depth_from_vertex_color(), early) {
            (false, _) => VertexDepth::Nothing,
            (true, "greater-equal") => VertexDepth::Always(1.0),
            (true, "less-equal") => VertexDepth::Always(0.0),
            (true, _) => VertexDepth::Red,
        };
        self.textures_of(pass, shader, &mut draw);
        let area = self.viewport(shader, &mut draw);
        self.mesh(pass, shader, written, area, &mut draw);
        self.factors(&mut draw);
        draw["params"] = self.params(shader);
        for state in ["cull", "front_face", "depth", "stencil"] {
            self.set(state, pass, shader, &mut draw);
        }
        if self.choices.once_in(3) {
            self.set("scissor", pass, shader, &mut draw);
        }
        let others = [
            "depth_bias",
            "depth_bounds",
            "depth_clamp",
            "rasterizer_discard",
            "output",
            "multisample",
        ];
        for state in others {
            self.set(state, pass, shader, &mut draw);
        }
        if let Some(provoking) = pass.provoking {
            draw["provoking"] = json!(provoking);
        }
        if shader.clip_distances() > 0 && self.extra_with("clip mask", Feature::ClipDistanceMask) {
            draw["clip_distances"] = json!(self.choices.below(1 << shader.clip_distances()));
        }
        self.counters(shader, &mut draw);
        let is_plain = draw["mesh"]["kind"] == "full" && shader == Shader::UniformColor;
        if is_plain && self.extra("tiles") {
            let size = self.size.map(|n| n.div_ceil(2));
            let colors: Vec<Value> = (0..4).map(|_| self.color()).collect();
            draw["tiles"] = json!({ "size": size, "colors": colors });
            for key in ["viewport", "instances", "tessellation", "fetch"] {
                if let Some(draw) = draw.as_object_mut() {
                    draw.remove(key);
                }
            }
        }
        draw
    }

    /// Changes the w of a mesh's vertices; rarely, vertices are behind the eye. Outlines keep their w.
    fn factors(&mut self, draw: &mut Value) {
        if draw["polygon_mode"] == "line" || !self.extra("w") {
            return;
        }
        let lists: [&[f64]; 6] = [
            &[2.0],
            &[0.25, 4.0],
            &[1.0, 2.0, 4.0],
            &[8.0, 1.0, 0.5],
            &[1.0, 65536.0, 1.0],
            &[1.0, 1.0, -1.0],
        ];
        let number = self.choices.below(lists.len() as u32);
        self.choices.note("w", number);
        draw["w"] = json!(lists[number as usize]);
    }

    /// Returns the previous draw with another value of one state.
    fn changed(&mut self, pass: &PassDraft, previous: &Value) -> Value {
        let mut draw = previous.clone();
        let shader = Shader::ALL.iter().find(|s| draw["shader"] == s.name());
        let state = self.choices.word("changed", &ALONE);
        if let (Some(shader), Some(keys)) = (shader.copied(), draw.as_object_mut()) {
            let value = match state {
                "output" => &["blend", "advanced_blend", "logic", "targets", "write_mask"][..],
                _ => &[state],
            };
            for key in value {
                keys.remove(*key);
            }
            self.set(state, pass, shader, &mut draw);
        }
        draw
    }

    /// Sets one state of a draw, or leaves it at its default.
    fn set(&mut self, state: &str, pass: &PassDraft, shader: Shader, draw: &mut Value) {
        match state {
            "cull" => {
                let both = self.extra_with("cull both", Feature::FrontAndBackCulling);
                draw["cull"] = if both && self.choices.once_in(2) {
                    json!("front-and-back")
                } else {
                    json!(
                        self.choices
                            .word("cull", &["none", "back", "front", "none"])
                    )
                };
            }
            "front_face" => {
                draw["front_face"] = json!(self.choices.word("front face", &["ccw", "cw"]));
            }
            "depth" => draw["depth"] = json!(self.depth_test(pass)),
            "stencil" => draw["stencil"] = json!(self.stencil_test(pass)),
            "scissor" => draw["scissor"] = json!(self.scissor()),
            "depth_bias" if pass.has_depth() && self.extra("depth bias") => {
                let constant = self.choices.of(&[1000, -1000, 1, -1, 1_000_000, 0]);
                let slope = self.choices.of(&[0.0, 1.0, -2.0]);
                let mut bias = json!({ "constant": constant, "slope": slope });
                if self.extra_with("bias clamp", Feature::DepthBiasClamp) {
                    bias["clamp"] = json!(self.choices.of(&[0.01, -0.01, 0.25]));
                }
                self.choices.note("depth bias", constant > 0);
                draw["depth_bias"] = bias;
            }
            "depth_bounds"
                if pass.has_depth() && self.extra_with("depth bounds", Feature::DepthBounds) =>
            {
                let bounds = [
                    [0.0, 0.6],
                    [0.3, 1.0],
                    [0.1, 0.9],
                    [0.0, 0.0],
                    [1.0, 1.0],
                    [0.21, 0.62],
                    [0.39, 0.41],
                    [0.6, 0.84],
                ];
                self.choices.note("depth bounds", true);
                draw["depth_bounds"] = json!(self.choices.of(&bounds));
            }
            "depth_clamp" if self.extra_with("depth clamp", Feature::DepthClamp) => {
                self.choices.note("depth clamp", true);
                draw["depth_clamp"] = json!(true);
            }
            "rasterizer_discard"
                if self.extra_with("rasterizer discard", Feature::RasterizerDiscard) =>
            {
                draw["rasterizer_discard"] = json!(self.choices.once_in(2));
            }
            "params" => draw["params"] = self.params(shader),
            "output" if !shader.has_fragment() => draw["write_mask"] = json!(""),
            "output" => self.output(pass, shader.has_second_source(), draw),
            "multisample" => self.multisample(pass, shader, draw),
            "sampler" if shader.samples_texture() => draw["sampler"] = self.sampler(),
            _ => {}
        }
    }

    fn params(&mut self, shader: Shader) -> Value {
        let mut color = self.color();
        if shader == Shader::FragCoordColor {
            color = json!([0.0625, 0.03125, self.choices.of(&[0.0, 1.0]), 1.0]);
        }
        if shader.discards() {
            // The smallest alpha, or blue, that is kept.
            let least = self.choices.of(&[0.5, 0.0, 1.0, 0.3]);
            color[2] = json!(least);
            color[3] = json!(least);
        }
        json!({ "color": color, "back_color": self.color() })
    }

    fn scissor(&mut self) -> [u32; 4] {
        let mut rect = self.rect();
        if self.choices.once_in(8) {
            let side = self.choices.of(&[2, 3]);
            rect[side] = 0;
        } else if self.extra_with("scissor outside", Feature::ScissorOutside) {
            rect[2] += self.size[0];
        }
        rect
    }

    /// Sets the viewport and returns its size in texels.
    fn viewport(&mut self, shader: Shader, draw: &mut Value) -> [u32; 2] {
        let own_depth = shader.writes_depth();
        let ranges = [
            [0.0, 1.0],
            [0.125, 0.875],
            [0.25, 1.0],
            [0.0, 0.75],
            [0.5, 0.5],
        ];
        let mut depth = if own_depth {
            [0.0, 1.0]
        } else {
            self.choices.of(&ranges)
        };
        if !own_depth && self.extra_with("reversed depth", Feature::ReversedDepthRange) {
            depth.reverse();
        }
        if depth == [0.0, 1.0] && !self.choices.once_in(2) {
            return self.size;
        }
        let mut rect: [f64; 4] = if self.choices.once_in(2) {
            self.rect().map(f64::from)
        } else {
            [0.0, 0.0, f64::from(self.size[0]), f64::from(self.size[1])]
        };
        if self.extra_with("viewport outside", Feature::ViewportOutside) {
            rect[0] -= f64::from(self.choices.range(0, 4));
            rect[3] += f64::from(self.choices.range(0, 4));
        }
        let area = [rect[2] as u32, rect[3] as u32];
        if self.extra_with("mirrored", Feature::MirroredViewport) {
            rect[1] += rect[3];
            rect[3] = -rect[3];
        }
        draw["viewport"] = json!({ "rect": rect, "depth": depth });
        area
    }

    fn early_tests(&mut self, shader: Shader) -> &'static str {
        if !shader.has_fragment() {
            return "implicit";
        }
        let mut words = vec!["implicit"];
        let feature = if shader.writes_depth() {
            Feature::ForcedEarlyTestsWithDepth
        } else {
            Feature::ForcedEarlyTests
        };
        let forced = self.extra_with("forced", feature);
        words.extend(forced.then_some("forced"));
        let promise =
            shader.writes_depth() && self.extra_with("promise", Feature::ConservativeDepth);
        if promise && shader == Shader::FragCoordDepth {
            words.push("unchanged");
        } else if promise && shader.depth_from_vertex_color() {
            words.extend(["greater-equal", "less-equal"]);
        }
        self.choices.word("early tests", &words)
    }

    /// Returns a shader that writes what the pass's attachments need.
    fn shader(&mut self, pass: &PassDraft) -> Shader {
        use Shader as Is;
        if pass.is_integer() {
            return Is::UintColor;
        }
        let without =
            pass.color.is_empty() || self.space.has(Feature::FragmentShaderAbsentWithColor);
        if without && self.extra_with("no fragment shader", Feature::FragmentShaderAbsent) {
            return Is::VertexOnly;
        }
        if pass.color.len() > 1 {
            return Is::TexelColorAll;
        }
        let per_sample = self.space.has(Feature::SampleShading);
        let families: [(&'static str, Feature, &[Shader]); 6] = [
            (
                "exported",
                Feature::StencilExport,
                &[
                    Is::ExportedColor,
                    Is::ExportedDepth,
                    Is::ExportedDiscard,
                    Is::ExportedFacing,
                    Is::ExportedSample,
                ],
            ),
            (
                "written mask",
                Feature::SampleMaskOutput,
                &[
                    Is::MaskedColor,
                    Is::MaskedDepth,
                    Is::MaskedDiscard,
                    Is::MaskedSample,
                ],
            ),
            (
                "dual source",
                Feature::DualSourceBlending,
                &[Is::TexelDualSource],
            ),
            (
                "counted",
                Feature::StorageCounters,
                &[Is::CountedColor, Is::CountedDepth, Is::CountedDiscard],
            ),
            (
                "clip distances",
                Feature::ClipDistances,
                &[Is::ClipFlat, Is::ClipUniform],
            ),
            (
                "per sample",
                Feature::SampleShading,
                &[Is::SampleIndex, Is::SampleDepth, Is::Stochastic],
            ),
        ];
        for (family, feature, shaders) in families {
            if self.extra_with(family, feature) {
                let usable = |s: &Shader| per_sample || !s.runs_per_sample();
                let shaders: Vec<Shader> = shaders.iter().copied().filter(usable).collect();
                return self.choices.of(&shaders);
            }
        }
        if pass.samples == 1 && self.extra("sampled") {
            return self.choices.of(&[Is::SampledColor, Is::SampledDiscard]);
        }
        if self.extra("rare shaders") {
            let mut keys = vec![
                Is::FragCoordColor,
                Is::FragCoordDepth,
                Is::DepthGrey,
                Is::DepthRange,
                Is::ExpensiveColor,
            ];
            let centroid = self.space.has(Feature::CentroidInterpolation);
            keys.extend(centroid.then_some(Is::Centroid));
            return self.choices.of(&keys);
        }
        if pass.provoking.is_some() && self.choices.once_in(2) {
            return Is::FlatColor;
        }
        self.choices.of(&[
            Is::UniformColor,
            Is::FlatColor,
            Is::FrontFacing,
            Is::FlatColorDepth,
            Is::TexelColor,
            Is::TexelDiscard,
        ])
    }

    /// Names the textures of a shader.
    fn textures_of(&mut self, pass: &PassDraft, shader: Shader, draw: &mut Value) {
        if shader.samples_texture() {
            let drawn = pass.drawn.first().filter(|_| self.choices.once_in(2));
            let texture = match drawn {
                Some(drawn) => drawn.clone(),
                None => self.sampled_texture().to_owned(),
            };
            draw["textures"] = json!([texture]);
            draw["sampler"] = self.sampler();
            return;
        }
        let names = if shader.writes_mask() {
            vec![self.masks()]
        } else if shader.writes_reference() {
            vec![self.references()]
        } else {
            let each = (0..shader.textures()).map(|i| match pass.drawn.first() {
                Some(drawn) if self.choices.once_in(2) => drawn.clone(),
                _ => self.texture(["first", "second"][i.min(1)]),
            });
            each.collect()
        };
        if !names.is_empty() {
            draw["textures"] = json!(names);
        }
    }

    fn sampler(&mut self) -> Value {
        let modes = ["clamp-to-edge", "repeat", "mirror-repeat"];
        let filter = self.choices.word("filter", &["nearest", "linear"]);
        let address = ["across", "down"].map(|state| self.choices.word(state, &modes));
        json!({ "filter": filter, "address": address })
    }

    /// Returns a texture that every driver filters.
    fn sampled_texture(&mut self) -> &'static str {
        let texture =
            json!({ "format": "rgba8unorm", "size": [4, 4], "texels": { "kind": "codes" } });
        self.attachments.insert("sampled".to_owned(), texture);
        "sampled"
    }

    fn counters(&mut self, shader: Shader, draw: &mut Value) {
        let mut names = Vec::new();
        if shader.counts_runs() {
            names.push(("runs", "shader-runs"));
        }
        if self.extra("counters") {
            let precise = self.space.has(Feature::PreciseOcclusion) && self.choices.once_in(2);
            let second = self.choices.once_in(2);
            names.push(match (precise, second) {
                (true, false) => ("passed", "samples-passed"),
                (true, true) => ("passed2", "samples-passed"),
                (false, false) => ("any", "any-samples-passed"),
                (false, true) => ("any2", "any-samples-passed"),
            });
        }
        if self.extra_with("statistics", Feature::FragmentInvocations) {
            names.push(("invocations", "fragment-invocations"));
        }
        for (name, kind) in &names {
            self.choices.note("counter", *kind);
            self.counters.insert((*name).to_owned(), json!(kind));
        }
        if !names.is_empty() {
            let names: Vec<&str> = names.iter().map(|(name, _)| *name).collect();
            draw["counters"] = json!(names);
        }
    }
}
