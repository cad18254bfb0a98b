//! Smaller sequences of choices, for scenes that end the process that draws them.
//!
//! A reduction tries hundreds of scenes, which is too dear where each costs a new process or a timeout. Choices
//! are cut by halves, quarters and eighths instead, and each cut is still a scene.

use crate::fuzz::{Fuzzer, RandomScene};

/// Returns the smallest scene found by trying at most so many, all of which `fails` was asked about.
pub fn shrink(
    fuzzer: &Fuzzer,
    scene: RandomScene,
    most: usize,
    fails: &mut dyn FnMut(&RandomScene) -> bool,
) -> RandomScene {
    let mut best = scene;
    let mut tried = 0;
    let mut part = 2;
    while part <= 8 && tried < most {
        let length = best.choices.len();
        let size = length.div_ceil(part).max(1);
        let mut kept = false;
        // The end first: what stands there depends on what stands in front.
        let mut starts: Vec<usize> = (0..length).step_by(size).collect();
        starts.reverse();
        for start in starts {
            let mut choices = best.choices.clone();
            let end = (start + size).min(length);
            choices[start..end].fill(0);
            let Some(smaller) = fuzzer.replay(best.index, &choices) else {
                continue;
            };
            if smaller.candidate.document == best.candidate.document {
                continue;
            }
            tried += 1;
            if fails(&smaller) {
                best = smaller;
                kept = true;
                break;
            }
            if tried >= most {
                break;
            }
        }
        if !kept {
            part *= 2;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::Space;
    use etalon_frame::TextureFormat;

    #[test]
    fn cut_choices_keep_what_fails() {
        let space = Space {
            color: vec![TextureFormat::Rgba8Unorm],
            depth_stencil: vec![TextureFormat::Depth32FloatStencil8],
            most_color: 1,
            ..Space::default()
        };
        let mut fuzzer = Fuzzer::new(4, space);
        let text = |s: &RandomScene| s.candidate.document.to_string();
        let scenes: Vec<RandomScene> = std::iter::from_fn(|| fuzzer.scene(&|_| true))
            .take(40)
            .collect();
        let scene = scenes.into_iter().find(|s| text(s).contains("\"cw\""));
        let scene = scene.unwrap();
        let mut tried = 0;
        let small = shrink(&fuzzer, scene.clone(), 30, &mut |s| {
            tried += 1;
            text(s).contains("\"cw\"")
        });
        assert!(text(&small).contains("\"cw\""));
        assert!(text(&small).len() < text(&scene).len());
        assert!((1..=30).contains(&tried), "{tried}");
    }
}
