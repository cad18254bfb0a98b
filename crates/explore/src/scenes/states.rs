//! States of random draws: tests, blending, masks.

use super::{Maker, PassDraft};
use etalon_frame::{Feature, TextureFormat};
use etalon_scene::{
    AdvancedBlend, BlendFactor, BlendOperation, CompareFunction, LogicOperation, Shader,
    StencilOperation,
};
use serde_json::{Value, json};

impl Maker<'_> {
    pub(super) fn compare(&mut self, state: &'static str) -> &'static str {
        // Functions that draw something occur more than once, because pictures would stay empty otherwise.
        use CompareFunction as Is;
        let functions = [
            Is::Always,
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
        ];
        self.choices.word(state, &functions.map(Is::name))
    }

    pub(super) fn depth_test(&mut self, pass: &PassDraft) -> Option<Value> {
        if !pass.has_depth() || self.choices.flag("no depth test", 5) {
            return None;
        }
        let compare = self.compare("depth compare");
        let write = !self.choices.flag("depth write off", 4) && !pass.read_only;
        Some(json!({ "compare": compare, "write": write }))
    }

    pub(super) fn stencil_test(&mut self, pass: &PassDraft) -> Option<Value> {
        const STATES: [[&str; 4]; 2] = [
            [
                "front compare",
                "front fail",
                "front depth fail",
                "front pass",
            ],
            ["back compare", "back fail", "back depth fail", "back pass"],
        ];
        if !pass.has_stencil() || self.choices.flag("no stencil test", 3) {
            return None;
        }
        let operations: Vec<&'static str> =
            StencilOperation::ALL.iter().map(|o| o.name()).collect();
        let mut faces = STATES.map(|[compare, fail, depth_fail, pass]| {
            let compare = self.compare(compare);
            let mut operation = |state| self.choices.word(state, &operations);
            json!({
                "compare": compare,
                "fail_op": operation(fail),
                "depth_fail_op": operation(depth_fail),
                "pass_op": operation(pass)
            })
        });
        if self.extra_with("separate masks", Feature::SeparateStencilMasks) {
            for face in &mut faces {
                face["read_mask"] = json!(self.bits());
                face["reference"] = json!(self.stored_stencil());
                let write = self.bits();
                face["write_mask"] = json!(if pass.read_only { 0 } else { write });
            }
        }
        let [front, back] = faces;
        let mut mask = || {
            if self.choices.once_in(2) {
                self.bits()
            } else {
                0xff
            }
        };
        let (read, write) = (mask(), mask());
        let mut stencil = json!({
            "front": front,
            "read_mask": read,
            "write_mask": if pass.read_only { 0 } else { write },
            "reference": self.stored_stencil()
        });
        if self.choices.once_in(2) {
            stencil["back"] = back;
        }
        Some(stencil)
    }

    /// Returns the letters of channels to write.
    pub(super) fn channels(&mut self) -> &'static str {
        let some = [
            "rgba", "rgb", "rga", "gba", "rba", "rb", "ga", "r", "g", "b", "a", "",
        ];
        self.choices.word("write mask", &some)
    }

    /// Adds blending or a replacement for it, and write masks.
    pub(super) fn output(&mut self, pass: &PassDraft, second: bool, draw: &mut Value) {
        let space = self.space;
        let blendable = |f: &TextureFormat| space.blendable.contains(f) && !f.is_integer();
        let can_blend = pass.color.iter().all(|(_, f)| blendable(f));
        let single = pass.color.len() == 1;
        if !second && self.extra_with("logic", Feature::LogicOperations) {
            let operations: Vec<&'static str> =
                LogicOperation::ALL.iter().map(|o| o.name()).collect();
            draw["logic"] = json!(self.choices.word("logic", &operations));
            draw["write_mask"] = json!(self.mask());
            return;
        }
        let simple = |f: &TextureFormat| !f.is_integer() && !f.is_snorm();
        let advanced = single && !second && can_blend && simple(&pass.color[0].1);
        if advanced && self.extra_with("advanced", Feature::AdvancedBlend) {
            let modes: Vec<&'static str> = AdvancedBlend::ALL.iter().map(|o| o.name()).collect();
            draw["advanced_blend"] = json!(self.choices.word("advanced", &modes));
            draw["write_mask"] = json!(self.mask());
            return;
        }
        if pass.color.len() > 1 && self.extra_with("apart", Feature::IndependentBlend) {
            let each: Vec<Value> = (0..pass.color.len())
                .map(|_| {
                    let mut target = json!({ "write_mask": self.mask() });
                    if can_blend && self.choices.once_in(2) {
                        target["blend"] = self.blend(second);
                    }
                    target
                })
                .collect();
            draw["targets"] = json!(each);
        } else {
            if can_blend && self.choices.flag("blends", 2) {
                draw["blend"] = self.blend(second);
            }
            draw["write_mask"] = json!(self.mask());
        }
        draw["blend_constant"] = self.color();
    }

    /// Returns a write mask, usually of all channels.
    fn mask(&mut self) -> &'static str {
        if self.choices.once_in(3) {
            self.channels()
        } else {
            "rgba"
        }
    }

    fn blend(&mut self, second: bool) -> Value {
        let color = self.component(second, true);
        let alpha = self.component(second, false);
        json!({ "color": color, "alpha": alpha })
    }

    fn component(&mut self, second: bool, is_color: bool) -> Value {
        use BlendOperation as Is;
        let operations = [
            Is::Add,
            Is::Add,
            Is::Add,
            Is::Subtract,
            Is::ReverseSubtract,
            Is::Min,
            Is::Max,
        ];
        let states = if is_color {
            ["color operation", "color src", "color dst"]
        } else {
            ["alpha operation", "alpha src", "alpha dst"]
        };
        let operation = self.choices.word(states[0], &operations.map(Is::name));
        let is_extreme = ["min", "max"].contains(&operation);
        if is_extreme && !self.extra_with("extreme factors", Feature::MinMaxBlendFactors) {
            return json!({ "operation": operation, "src_factor": "one", "dst_factor": "one" });
        }
        let constant_alpha = self.extra_with("constant alpha", Feature::ConstantAlphaBlendFactor);
        let usable = |f: &&BlendFactor| {
            let of_constant_alpha = matches!(
                f,
                BlendFactor::ConstantAlpha | BlendFactor::OneMinusConstantAlpha
            );
            (second || !f.is_second_source()) && (constant_alpha || !is_color || !of_constant_alpha)
        };
        let factors: Vec<&'static str> = BlendFactor::ALL
            .iter()
            .filter(usable)
            .map(|f| f.name())
            .collect();
        json!({
            "operation": operation,
            "src_factor": self.choices.word(states[1], &factors),
            "dst_factor": self.choices.word(states[2], &factors)
        })
    }

    /// Adds states of multisampling, some of them also without several samples.
    pub(super) fn multisample(&mut self, pass: &PassDraft, shader: Shader, draw: &mut Value) {
        let mut value = json!({});
        if pass.samples > 1 {
            if self.choices.flag("sample mask", 3) {
                value["mask"] = json!(self.choices.of(&[0x5, 0x1, 0xa, 0xe, 0x0, 0xfff0, 0x8]));
            }
            let masks = !shader.writes_mask()
                || self.space.has(Feature::SampleMaskOutputWithAlphaToCoverage);
            let alpha = pass.has_alpha() || self.space.has(Feature::AlphaToCoverageWithoutAlpha);
            if shader.has_fragment() && masks && alpha && self.extra("alpha to coverage") {
                self.choices.note("alpha to coverage", true);
                value["alpha_to_coverage"] = json!(true);
            }
            if shader.has_fragment() && self.extra_with("alpha to one", Feature::AlphaToOne) {
                self.choices.note("alpha to one", true);
                value["alpha_to_one"] = json!(true);
            }
        }
        if self.extra_with("sample shading", Feature::MinSampleShading) {
            value["min_sample_shading"] = json!(self.choices.of(&[1.0, 0.5, 0.0, 0.3]));
        }
        if self.extra_with("sample coverage", Feature::SampleCoverage) {
            let share = self.choices.of(&[0.5, 0.0, 1.0, 0.25, 0.75, -0.5, 1.5]);
            let invert = self.choices.once_in(2);
            value["sample_coverage"] = json!({ "value": share, "invert": invert });
        }
        if value != json!({}) {
            draw["multisample"] = value;
        }
    }
}
