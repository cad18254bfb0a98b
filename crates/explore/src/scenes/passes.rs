//! Passes of random scenes: attachments, load and store operations, clears and resolves.

use super::{Maker, PassDraft};
use etalon_frame::{Feature, TextureFormat};
use serde_json::{Value, json};

impl Maker<'_> {
    /// Makes the passes, and returns them with the names of the attachments to read back.
    pub(super) fn passes(&mut self) -> (Vec<Value>, Vec<String>) {
        let logic = self.extra_with("logic", Feature::LogicOperations);
        let none = self.choices.once_in(10);
        let several = self.extra("several");
        let most = self.space.most_color.clamp(1, 4);
        let count = match (none, several) {
            (true, _) => 0,
            (_, true) => self.choices.range(2.min(most), most),
            _ => 1,
        };
        let formats = self.color_formats(count, logic);
        let mut depth_stencil = self.depth_stencil_format();
        if formats.is_empty() && depth_stencil.is_none() {
            depth_stencil = self.space.depth_stencil.first().copied();
        }
        let samples = self.samples(&formats, depth_stencil);
        self.choices.note("samples", samples);
        if samples > 1 {
            self.whole_alpha |= self.choices.once_in(2);
        }
        let mut read = Vec::new();
        let mut color = Vec::new();
        for (i, format) in formats.iter().enumerate() {
            let name = format!("color{i}");
            self.add_color(&name, *format, samples);
            read.push(name.clone());
            color.push((name, *format));
        }
        if let Some(format) = depth_stencil {
            self.add_depth_stencil("depth", format, samples);
            read.push("depth".to_owned());
        }
        let number = self.choices.of(&[1, 1, 2, 3]);
        let framebuffers =
            number > 1 && samples == 1 && !color.is_empty() && self.choices.once_in(2);
        if framebuffers {
            let (_, format) = color[0];
            self.add_color("other", format, 1);
            read.push("other".to_owned());
        }
        self.choices.note("passes", number);
        let mut passes = Vec::new();
        for index in 0..number {
            // The last pass reads what the first one drew, or draws to attachments that the first pass did
            // not draw to.
            let other = framebuffers && index % 2 == 1;
            let mut colors = color.clone();
            let mut drawn = Vec::new();
            if other {
                drawn.push(colors[0].0.clone());
                colors[0].0 = "other".to_owned();
                colors.truncate(1);
            } else if framebuffers && index > 0 {
                drawn.push("other".to_owned());
            }
            let pass = PassDraft {
                color: colors,
                depth_stencil,
                samples,
                read_only: depth_stencil.is_some() && self.extra("read only"),
                drawn: drawn
                    .into_iter()
                    .filter(|_| !self.is_integer(&color))
                    .collect(),
                provoking: self.provoking(),
            };
            passes.push(self.pass(&pass, index, &mut read));
        }
        (passes, read)
    }

    fn is_integer(&self, color: &[(String, TextureFormat)]) -> bool {
        color.iter().any(|(_, f)| f.is_integer())
    }

    /// Returns the provoking vertex of a pass's draws.
    fn provoking(&mut self) -> Option<&'static str> {
        let first = self.space.has(Feature::FirstProvokingVertex);
        let last = self.space.has(Feature::LastProvokingVertex);
        if !(first || last) || !self.extra("provoking") {
            return None;
        }
        let both: Vec<&'static str> = [("first", first), ("last", last)]
            .into_iter()
            .filter_map(|(name, has)| has.then_some(name))
            .collect();
        Some(self.choices.word("provoking", &both))
    }

    /// Returns a number of samples that all formats support.
    fn samples(&mut self, formats: &[TextureFormat], depth_stencil: Option<TextureFormat>) -> u32 {
        if !self.choices.once_in(3) {
            return 1;
        }
        let attachments = formats.iter().chain(&depth_stencil);
        let mut counts = vec![4, 4, 2, 8, 16];
        for format in attachments {
            let supported = self.space.samples.get(format);
            counts.retain(|n| supported.is_some_and(|s| s.contains(n)));
        }
        match counts[..] {
            [] => 1,
            _ => self.choices.of(&counts),
        }
    }

    fn pass(&mut self, pass: &PassDraft, index: usize, read: &mut Vec<String>) -> Value {
        let names: Vec<&String> = pass.color.iter().map(|(name, _)| name).collect();
        let mut value = json!({ "color": names });
        if pass.depth_stencil.is_some() {
            value["depth_stencil"] = json!("depth");
        }
        let count = self.choices.of(&[1, 2, 3, 4, 2, 0, 3]);
        let mut draws: Vec<Value> = Vec::new();
        for _ in 0..count {
            let previous = draws.last().cloned();
            draws.push(self.draw(pass, previous.as_ref()));
        }
        if pass.read_only {
            value["depth_stencil_read_only"] = json!(true);
        }
        if self.extra("operations") {
            value["operations"] = self.operations(pass);
        }
        if self.extra_with("clears", Feature::ClearCommands) {
            let clears = self.clears(pass, count);
            if !clears.is_empty() {
                value["clears"] = json!(clears);
            }
        }
        if pass.samples > 1 {
            self.resolves(pass, index, &mut value, read);
        }
        value["draws"] = json!(draws);
        value
    }

    fn operations(&mut self, pass: &PassDraft) -> Value {
        let mut value = json!({});
        let each: Vec<Value> = pass
            .color
            .iter()
            .map(|_| {
                let clear = self.cleared_color();
                self.operation(clear)
            })
            .collect();
        if !each.is_empty() {
            value["color"] = json!(each);
        }
        if pass.has_depth() && !pass.read_only {
            let depth = self.depth();
            value["depth"] = self.operation(json!(depth));
        }
        if pass.has_stencil() && !pass.read_only {
            let stencil = self.stored_stencil();
            value["stencil"] = self.operation(json!(stencil));
        }
        value
    }

    /// Returns the load and store operation of an aspect.
    fn operation(&mut self, clear: Value) -> Value {
        let mut value = json!({});
        if self.choices.flag("load clear", 2) {
            value["load"] = json!({ "clear": clear });
        }
        if self.choices.flag("store discard", 8) {
            value["store"] = json!("discard");
        }
        value
    }

    /// Returns clear commands between the draws.
    fn clears(&mut self, pass: &PassDraft, draws: u32) -> Vec<Value> {
        let count = self.choices.range(1, 2);
        let mut before = 0;
        let mut clears = Vec::new();
        let masked = self.extra_with("masked clears", Feature::MaskedClears);
        for _ in 0..count {
            before = self.choices.range(before, draws);
            let mut clear = json!({ "before": before });
            let aspects = !pass.read_only && pass.depth_stencil.is_some();
            let of_color = !pass.color.is_empty() && (!aspects || self.choices.once_in(2));
            if of_color {
                let place = self.choices.below(pass.color.len() as u32);
                clear["color"] = json!(place);
                clear["value"] = self.cleared_color();
                if masked {
                    clear["write_mask"] = json!(self.channels());
                }
            } else if aspects {
                let both = pass.has_depth() && pass.has_stencil();
                let which = self.choices.below(3);
                if pass.has_depth() && (!both || which != 1) {
                    clear["depth"] = json!(self.depth());
                }
                if pass.has_stencil() && (!both || which != 2) {
                    clear["stencil"] = json!(self.stored_stencil());
                }
                if masked {
                    let (depth, bits) = (self.choices.once_in(2), self.bits());
                    let named = |key: &str| clear.get(key).is_some();
                    clear["write_mask"] = match (named("depth"), named("stencil")) {
                        (true, true) => json!({ "depth": depth, "stencil": bits }),
                        (true, false) => json!(depth),
                        _ => json!(bits),
                    };
                }
            } else {
                continue;
            }
            if self.choices.flag("clear rect", 2) {
                clear["rect"] = json!(self.rect());
            }
            clears.push(clear);
        }
        clears
    }

    /// Adds resolves to a pass with several samples.
    fn resolves(
        &mut self,
        pass: &PassDraft,
        index: usize,
        value: &mut Value,
        read: &mut Vec<String>,
    ) {
        if !pass.color.is_empty() && self.extra("resolve") {
            let mut resolves = Vec::new();
            for (i, (_, format)) in pass.color.iter().enumerate() {
                // Resolves into an earlier pass's resolve target, or into another attachment.
                let number = if self.choices.once_in(2) { 0 } else { index };
                let name = format!("resolved{number}-{i}");
                if !self.attachments.contains_key(&name) {
                    self.add_color(&name, *format, 1);
                    read.push(name.clone());
                }
                resolves.push(name);
            }
            value["resolve"] = json!(resolves);
        }
        let Some(format) = pass.depth_stencil else {
            return;
        };
        if !self.extra_with("depth resolve", Feature::DepthStencilResolve) {
            return;
        }
        let modes = |maker: &mut Self, choices: &[(&'static str, bool)]| {
            let usable = choices
                .iter()
                .filter(|(_, has)| *has)
                .map(|(name, _)| *name);
            let usable: Vec<&'static str> = usable.collect();
            maker.choices.word("resolve mode", &usable)
        };
        let has = |feature| self.space.has(feature);
        let of_depth = [
            ("sample-zero", true),
            ("average", has(Feature::DepthResolveAverage)),
            ("min", has(Feature::DepthResolveMin)),
            ("max", has(Feature::DepthResolveMax)),
        ];
        let of_stencil = [
            ("sample-zero", true),
            ("min", has(Feature::StencilResolveMin)),
            ("max", has(Feature::StencilResolveMax)),
        ];
        let name = format!("resolved{index}-depth");
        let mut resolve = json!({ "to": name });
        let both = format.has_depth() && format.has_stencil();
        let apart = both && has(Feature::IndependentResolve);
        let alone = both && has(Feature::IndependentResolveNone);
        let mode = modes(
            self,
            if both && !apart {
                &of_stencil
            } else {
                &of_depth
            },
        );
        let only = if alone { self.choices.below(3) } else { 0 };
        if format.has_depth() && only != 1 {
            resolve["depth"] = json!(mode);
        }
        if format.has_stencil() && only != 2 {
            let stencil = if both && !apart {
                mode
            } else {
                modes(self, &of_stencil)
            };
            resolve["stencil"] = json!(stencil);
        }
        self.add_depth_stencil(&name, format, 1);
        read.push(name);
        value["depth_stencil_resolve"] = resolve;
    }
}
