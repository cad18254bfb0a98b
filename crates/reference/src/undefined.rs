//! Results that depend on discarded contents.
//!
//! A store operation discards an aspect as a whole, and a draw that reads undefined contents is assumed to
//! make everything that it writes undefined. The undefined parts therefore follow from the scene alone, are
//! the same at every sample, and are not part of the worlds.

use etalon_frame::Aspect;
use etalon_scene::{Clear, ClearTarget, CompareFunction, Draw, Pass, ResolveMode, Scene};
use std::collections::BTreeSet;

/// The parts of a scene's results that depend on discarded contents.
#[derive(Clone, Debug, Default)]
pub(crate) struct Undefined {
    /// Aspects of attachments.
    aspects: BTreeSet<(usize, Aspect)>,
    /// Counters.
    counters: BTreeSet<usize>,
}

impl Undefined {
    pub(crate) fn of(scene: &Scene) -> Self {
        let mut result = Self::default();
        for pass in &scene.passes {
            result.pass(pass);
        }
        result
    }

    /// Returns true if an aspect of an attachment is undefined at the end.
    pub(crate) fn aspect(&self, attachment: usize, aspect: Aspect) -> bool {
        self.aspects.contains(&(attachment, aspect))
    }

    /// Returns true if a counter depends on undefined contents.
    pub(crate) fn counter(&self, counter: usize) -> bool {
        self.counters.contains(&counter)
    }

    fn pass(&mut self, pass: &Pass) {
        for cleared in pass.cleared() {
            self.aspects.remove(&cleared);
        }
        for (index, draw) in pass.draws.iter().enumerate() {
            self.clears(pass, pass.clears_before(index));
            if !self.aspects.is_empty() && self.is_read(pass, draw) {
                self.aspects.extend(written(pass, draw));
                self.counters.extend(&draw.counters);
            }
        }
        self.clears(pass, pass.clears_before(pass.draws.len()));
        for (source, target) in pass.color.iter().zip(&pass.resolve) {
            let Some(target) = target else { continue };
            if self.aspect(*source, Aspect::Color) {
                self.aspects.insert((*target, Aspect::Color));
            } else {
                self.aspects.remove(&(*target, Aspect::Color));
            }
        }
        if let (Some(source), Some(resolve)) = (pass.depth_stencil, &pass.depth_stencil_resolve) {
            for (mode, aspect) in [
                (resolve.depth, Aspect::Depth),
                (resolve.stencil, Aspect::Stencil),
            ] {
                if mode == ResolveMode::None {
                    continue;
                }
                if self.aspect(source, aspect) {
                    self.aspects.insert((resolve.to, aspect));
                } else {
                    self.aspects.remove(&(resolve.to, aspect));
                }
            }
        }
        self.aspects.extend(pass.discarded());
    }

    /// Marks as defined everything that clear commands write completely.
    fn clears(&mut self, pass: &Pass, clears: &[Clear]) {
        let is_complete = |clear: &&Clear| clear.rect.is_none() && !clear.target.is_masked();
        for clear in clears.iter().filter(is_complete) {
            match clear.target {
                ClearTarget::Color { location, .. } => {
                    self.aspects.remove(&(pass.color[location], Aspect::Color));
                }
                ClearTarget::DepthStencil { depth, stencil, .. } => {
                    let Some(index) = pass.depth_stencil else {
                        continue;
                    };
                    for (cleared, aspect) in [
                        (depth.is_some(), Aspect::Depth),
                        (stencil.is_some(), Aspect::Stencil),
                    ] {
                        if cleared {
                            self.aspects.remove(&(index, aspect));
                        }
                    }
                }
            }
        }
    }

    /// Returns true if the fragments of a draw, or their values, depend on undefined contents. Blending does
    /// not count, because it changes only contents that are undefined already.
    fn is_read(&self, pass: &Pass, draw: &Draw) -> bool {
        let undefined = |aspect| pass.depth_stencil.is_some_and(|i| self.aspect(i, aspect));
        let reads = |function: CompareFunction| {
            !matches!(function, CompareFunction::Always | CompareFunction::Never)
        };
        let depth = draw.depth_bounds.is_some() || draw.depth.is_some_and(|d| reads(d.compare));
        let stencil = draw
            .stencil
            .is_some_and(|s| reads(s.front.compare) || reads(s.back.compare));
        let read = [Aspect::Color, Aspect::Depth, Aspect::Stencil];
        let mut textures = draw.textures.iter();
        depth && undefined(Aspect::Depth)
            || stencil && undefined(Aspect::Stencil)
            || textures.any(|i| read.iter().any(|aspect| self.aspect(*i, *aspect)))
    }
}

/// Returns the aspects that a draw writes.
fn written(pass: &Pass, draw: &Draw) -> Vec<(usize, Aspect)> {
    let colors = pass.color.iter().zip(&draw.targets);
    let mut aspects: Vec<_> = colors
        .filter(|(_, target)| target.write_mask != 0)
        .map(|(index, _)| (*index, Aspect::Color))
        .collect();
    for (writes, aspect) in [
        (draw.depth.is_some_and(|d| d.write), Aspect::Depth),
        (draw.stencil.is_some(), Aspect::Stencil),
    ] {
        aspects.extend(pass.depth_stencil.filter(|_| writes).map(|i| (i, aspect)));
    }
    aspects
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_case::{CaseFile, Profile};

    /// Returns the undefined parts after passes over `color`, `other` and `depth`, with a counter.
    fn undefined(passes: &str) -> Undefined {
        let text = format!(
            r#"{{"about":"t","spec":["t"],"scene":{{
            "attachments":{{"color":{{"format":"rgba8unorm","size":[4,4]}},
                "other":{{"format":"rgba8unorm"}},
                "many":{{"format":"rgba8unorm","samples":4}},
                "depth":{{"format":"depth24plus-stencil8"}}}},
            "counters":{{"passed":"samples-passed"}},
            "passes":[{passes}],"read":["color"]}}}}"#
        );
        let file = CaseFile::parse("t.json", &text).expect("it builds");
        let case = file.cases(Profile::Full).next().expect("it builds");
        Undefined::of(&case.build().expect("it builds").scene)
    }

    /// Indices follow the order of the attachments' names.
    const COLOR: (usize, Aspect) = (0, Aspect::Color);
    const DEPTH: (usize, Aspect) = (1, Aspect::Depth);
    const MANY: (usize, Aspect) = (2, Aspect::Color);
    const OTHER: (usize, Aspect) = (3, Aspect::Color);
    const STENCIL: (usize, Aspect) = (1, Aspect::Stencil);

    #[track_caller]
    fn check(passes: &str, expected: &[(usize, Aspect)], counted: bool) {
        let found = undefined(passes);
        assert_eq!(found.aspects, expected.iter().copied().collect());
        assert_eq!(found.counter(0), counted);
    }

    const DISCARD_DEPTH: &str = r#"{"color":["color"],"depth_stencil":"depth","draws":[],
        "operations":{"depth":{"store":"discard"}}}"#;

    #[test]
    fn a_load_operation_defines_what_was_discarded() {
        check(DISCARD_DEPTH, &[DEPTH], false);
        let cleared = r#"{"depth_stencil":"depth","draws":[],
            "operations":{"depth":{"load":{"clear":1}}}}"#;
        check(&format!("{DISCARD_DEPTH},{cleared}"), &[], false);
        let other = cleared.replace(
            r#""depth":{"load":{"clear":1}}"#,
            r#""stencil":{"load":{"clear":1}}"#,
        );
        check(&format!("{DISCARD_DEPTH},{other}"), &[DEPTH], false);
    }

    #[test]
    fn a_clear_defines_only_an_aspect_that_it_covers_whole() {
        let pass = |clear: &str| {
            format!(r#"{DISCARD_DEPTH},{{"depth_stencil":"depth","draws":[],"clears":[{clear}]}}"#)
        };
        check(&pass(r#"{"before":0,"depth":0.5}"#), &[], false);
        check(
            &pass(r#"{"before":0,"depth":0.5,"rect":[0,0,4,3]}"#),
            &[DEPTH],
            false,
        );
        check(
            &pass(r#"{"before":0,"depth":0.5,"write_mask":false}"#),
            &[DEPTH],
            false,
        );
        check(&pass(r#"{"before":0,"stencil":1}"#), &[DEPTH], false);
    }

    #[test]
    fn a_draw_makes_undefined_what_it_computes_from_undefined_contents() {
        let drawn = |state: &str| {
            format!(
                r#"{DISCARD_DEPTH},{{"color":["color"],"depth_stencil":"depth","draws":[
                {{"mesh":{{"kind":"full"}},"shader":"uniform_color","counters":["passed"]{state}}}]}}"#
            )
        };
        check(&drawn(""), &[DEPTH], false);
        let tested = r#","depth":{"compare":"less","write":false}"#;
        check(&drawn(tested), &[COLOR, DEPTH], true);
        let always = r#","depth":{"compare":"always","write":true}"#;
        check(&drawn(always), &[DEPTH], false);
        let masked = r#","depth":{"compare":"less","write":false},"write_mask":"",
            "stencil":{"front":{"compare":"always","pass_op":"replace"}}"#;
        check(&drawn(masked), &[DEPTH, STENCIL], true);
        check(&drawn(r#","depth_bounds":[0,1]"#), &[COLOR, DEPTH], true);
    }

    #[test]
    fn textures_and_resolves_pass_undefined_contents_on() {
        let dropped = r#"{"color":["other"],"draws":[],
            "operations":{"color":[{"store":"discard"}]}}"#;
        let fetch = r#"{"color":["color"],"draws":[{"mesh":{"kind":"full"},
            "shader":"texel_color","textures":["other"]}]}"#;
        check(&format!("{dropped},{fetch}"), &[COLOR, OTHER], false);
        let resolve = |store: &str| {
            format!(
                r#"{{"color":["many"],"resolve":["other"],"draws":[],
                "operations":{{"color":[{{"store":"{store}"}}]}}}}"#
            )
        };
        let (drop, keep) = (resolve("discard"), resolve("store"));
        check(&drop, &[MANY], false);
        check(&format!("{drop},{keep}"), &[MANY, OTHER], false);
        check(&format!("{dropped},{keep}"), &[], false);
    }
}
