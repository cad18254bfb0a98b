//! The way in which a case fails: what a smaller case must share with it, or it shows something else.
//!
//! A picture's violation is named by the attachment and the aspect of its first wrong sample, and by the
//! operations that decide what the sample must hold: the last one that stores there or clears, and those that
//! keep later draws away; where the driver left what was there before, it is the store, whatever it had to compute. A
//! smaller case has fewer draws, so that its operations are some of the larger one's; one that is
//! new is another violation. Counters and relations have a name of their own.

use etalon_case::Case;
use etalon_frame::{Aspect, Band, CounterKind, Story, StoryLine};
use etalon_record::{Record, Verdict};
use etalon_scene::Scene;
use std::collections::BTreeSet;
use std::fmt;

/// Operations that end a draw at a sample. Coverage stands apart: every draw has primitives elsewhere.
const REJECTIONS: [&str; 14] = [
    "rasterizer discard",
    "viewport",
    "clipping",
    "culling",
    "scissor",
    "sample coverage",
    "sample mask",
    "discard",
    "shader's sample mask",
    "alpha to coverage",
    "depth bounds",
    "stencil test",
    "depth test",
    "early tests",
];

/// Operations that compute what is stored.
const COMPUTED: [&str; 3] = ["logic operation", "advanced blend", "blend"];

/// One way to fail.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// The verdict.
    pub verdict: Verdict,
    /// The part of the outcome that is wrong.
    pub kind: ViolationKind,
}

/// The part of an outcome that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ViolationKind {
    /// A picture.
    Picture {
        /// Name of the attachment.
        attachment: String,
        /// The aspect.
        aspect: Aspect,
        /// The operations that decide what the first wrong sample must hold.
        operations: BTreeSet<String>,
    },
    /// A counter.
    Counter {
        /// Its kind.
        kind: CounterKind,
        /// True if it counted too much.
        high: bool,
    },
    /// Pictures that must be the same are not: the reason why they must.
    Relation {
        /// The name of the invariance.
        invariance: String,
    },
}

impl Violation {
    /// Returns the way in which a record's case failed; `None` if it did not.
    pub fn of(case: &Case, record: &Record) -> Option<Self> {
        if !record.verdict.is_violation() {
            return None;
        }
        let violation = |kind| {
            Some(Self {
                verdict: record.verdict,
                kind,
            })
        };
        let story = record.story.as_ref();
        let related = story.is_some_and(|s| s.lines.iter().any(|l| l.operation == "alone"));
        if let Some(relation) = case.relation.as_ref().filter(|_| related) {
            return violation(ViolationKind::Relation {
                invariance: relation.invariance.name().to_owned(),
            });
        }
        let wrong = record.wrong.first().filter(|w| w.band > Band::Imprecise);
        if let Some(channel) = wrong.and_then(|w| w.channels.first()) {
            let operations = story.map(|story| {
                let scene = case.judged_scene();
                operations(scene, story, &channel.attachment, channel.aspect)
            });
            return violation(ViolationKind::Picture {
                attachment: channel.attachment.clone(),
                aspect: channel.aspect,
                operations: operations.unwrap_or_default(),
            });
        }
        let counter = record.counters.iter().max_by_key(|c| c.band)?;
        violation(ViolationKind::Counter {
            kind: counter.kind,
            high: counter.actual > counter.low,
        })
    }

    /// True if a smaller case that fails like `other` fails like this one.
    pub fn covers(&self, other: &Self) -> bool {
        if self.verdict != other.verdict {
            return false;
        }
        match (&self.kind, &other.kind) {
            (
                ViolationKind::Picture {
                    attachment,
                    aspect,
                    operations,
                },
                ViolationKind::Picture {
                    attachment: other_attachment,
                    aspect: other_aspect,
                    operations: others,
                },
            ) => {
                (attachment, aspect) == (other_attachment, other_aspect)
                    && others.is_subset(operations)
                    && others.is_empty() == operations.is_empty()
            }
            (one, other) => one == other,
        }
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            ViolationKind::Picture {
                attachment,
                aspect,
                operations,
            } => {
                let operations: Vec<&str> = operations.iter().map(String::as_str).collect();
                write!(
                    f,
                    "{} of {attachment} ({})",
                    aspect.name(),
                    operations.join(", ")
                )
            }
            ViolationKind::Counter { kind, high } => {
                let way = if *high { "much" } else { "little" };
                write!(f, "counter {} counts too {way}", kind.name())
            }
            ViolationKind::Relation { invariance } => write!(f, "relation {invariance}"),
        }
    }
}

/// Returns the operations that decide what an aspect of an attachment holds at the sample of a story.
fn operations(scene: &Scene, story: &Story, attachment: &str, aspect: Aspect) -> BTreeSet<String> {
    let [stores, keeps] = ["store", "keep"].map(|word| format!("{word} {}", aspect.name()));
    let mut deciding = BTreeSet::new();
    let mut drawn = false;
    let lines = story.operations();
    for group in lines.chunk_by(|a, b| a.at == b.at) {
        let Some(draw) = draw_at(scene, &group[0].at) else {
            // Clears, resolves and uploads, of which stories tell those of all attachments.
            let other = group[0].at.strip_prefix("attachment ");
            if other.is_some_and(|name| name != attachment) {
                continue;
            }
            for line in group.iter().filter(|l| l.operation != "read back") {
                deciding = BTreeSet::from([line.operation.clone()]);
            }
            continue;
        };
        let named = |operation: &str| group.iter().any(|l| l.operation == operation);
        drawn = true;
        if named(&stores) {
            deciding = BTreeSet::from([stores.clone()]);
            if aspect == Aspect::Color {
                deciding.extend(color_operation(scene, draw, attachment).map(str::to_owned));
            }
        } else if named(&keeps) {
            deciding.insert(keeps.clone());
        } else if let Some(line) = rejection(group) {
            deciding.insert(line.operation.clone());
        }
    }
    let is_initial = |o: &String| ["clear", "upload", "resolve"].contains(&o.as_str());
    // Where the driver left what was there, nothing was computed that could be wrong.
    let kept = story.verdict();
    if kept.is_some_and(|v| v.detail.contains("the driver kept ")) {
        deciding.retain(|o| !COMPUTED.contains(&o.as_str()));
    }
    // Every draw has primitives elsewhere: coverage decides where nothing else does.
    if drawn && deciding.iter().all(is_initial) {
        deciding.insert("coverage".to_owned());
    }
    deciding
}

/// Returns the last operation of a group of lines that ends the draw. Tests that pass are told too.
fn rejection(group: &[StoryLine]) -> Option<&StoryLine> {
    let passes = |line: &StoryLine| match line.operation.as_str() {
        "stencil test" => line.detail.contains(" passes"),
        "depth test" => line.detail.ends_with(" is true"),
        _ => false,
    };
    let mut lines = group.iter().rev();
    lines.find(|line| REJECTIONS.contains(&line.operation.as_str()) && !passes(line))
}

/// Returns pass and draw of a place: `pass 0, draw 2, primitive 1`, in a frame that may be named before.
fn draw_at(scene: &Scene, at: &str) -> Option<(usize, usize)> {
    let number = |word: &str| -> Option<usize> {
        let rest = &at[at.find(word)? + word.len()..];
        let end = rest.find(|c: char| !c.is_ascii_digit());
        rest[..end.unwrap_or(rest.len())].parse().ok()
    };
    let (pass, draw) = (number("pass ")?, number("draw ")?);
    scene.passes.get(pass)?.draws.get(draw)?;
    Some((pass, draw))
}

/// Returns the operation that computes the colour which a draw stores in an attachment.
fn color_operation(
    scene: &Scene,
    (pass, draw): (usize, usize),
    attachment: &str,
) -> Option<&'static str> {
    let pass = &scene.passes[pass];
    let draw = &pass.draws[draw];
    let mut places = pass.color.iter();
    let location = places.position(|i| scene.attachments[*i].name == attachment);
    let target = draw.targets.get(location?)?;
    if draw.logic.is_some() {
        Some(COMPUTED[0])
    } else if target.advanced.is_some() {
        Some(COMPUTED[1])
    } else {
        target.blend.map(|_| COMPUTED[2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn line(at: &str, operation: &str) -> StoryLine {
        StoryLine {
            at: at.to_owned(),
            operation: operation.to_owned(),
            detail: String::new(),
            citation: None,
        }
    }

    fn scene() -> Scene {
        let draw = json!({ "mesh": { "kind": "full" }, "shader": "flat_color" });
        let mut logic = draw.clone();
        logic["logic"] = json!("xor");
        let document = json!({ "about": "", "spec": [], "scene": {
            "attachments": { "c": { "format": "rgba8unorm" } },
            "passes": [{ "color": ["c"], "draws": [logic, draw.clone(), draw] }],
            "read": ["c"]
        } });
        etalon_case::build("t", &document).expect("builds").scene
    }

    fn found(lines: &[(&str, &str)]) -> Vec<String> {
        let lines = lines.iter().map(|(at, o)| line(at, o)).collect();
        let all = operations(&scene(), &Story { lines }, "c", Aspect::Color);
        all.into_iter().collect()
    }

    #[test]
    fn the_last_store_and_later_rejections_decide() {
        let clear = ("attachment c", "clear");
        let logic = ("pass 0, draw 0, primitive 0", "store color");
        let upload = ("attachment d", "upload");
        let scissor = ("pass 0, draw 1", "scissor");
        let coverage = ("pass 0, draw 2", "coverage");
        assert_eq!(found(&[clear]), ["clear"]);
        assert_eq!(found(&[clear, logic]), ["logic operation", "store color"]);
        assert_eq!(
            found(&[clear, scissor, logic]),
            ["logic operation", "store color"]
        );
        assert_eq!(
            found(&[clear, logic, scissor, coverage]),
            ["logic operation", "scissor", "store color"]
        );
        assert_eq!(found(&[clear, upload, scissor]), ["clear", "scissor"]);
        assert_eq!(found(&[clear, coverage]), ["clear", "coverage"]);
        let plain = ("pass 0, draw 2, primitive 1", "store color");
        assert_eq!(found(&[clear, logic, plain]), ["store color"]);
    }

    #[test]
    fn a_draw_that_does_not_arrive_is_the_same_however_it_blends() {
        let verdict = |detail: &str| {
            let [at, by] = ["texel 0,0", "judged"].map(str::to_owned);
            StoryLine::verdict(at, detail.to_owned(), by)
        };
        let of = |detail: &str, last: &str| {
            let lines = vec![
                verdict(detail),
                line("attachment c", "clear"),
                line("pass 0, draw 0, primitive 0", last),
            ];
            let all = operations(&scene(), &Story { lines }, "c", Aspect::Color);
            all.into_iter().collect::<Vec<_>>()
        };
        let kept = "must be 1; the driver kept the clear colour 0";
        assert_eq!(of(kept, "store color"), ["store color"]);
        assert_eq!(of(kept, "scissor"), ["clear", "scissor"]);
        assert_eq!(
            of("must be 1; the driver wrote 0", "store color"),
            ["logic operation", "store color"]
        );
    }

    #[test]
    fn a_test_that_passes_rejects_nothing() {
        let mut lines = vec![
            line("pass 0, draw 1", "depth test"),
            line("pass 0, draw 1", "stencil test"),
        ];
        lines[0].detail = "0 greater stored 1 is false".to_owned();
        lines[1].detail = "reference 0 always stored 0 passes, depth fails".to_owned();
        assert_eq!(
            rejection(&lines).map(|l| l.operation.as_str()),
            Some("depth test")
        );
        lines[0].detail = "1 greater stored 0 is true".to_owned();
        assert_eq!(rejection(&lines), None);
    }

    #[test]
    fn a_smaller_violation_has_no_new_operation() {
        let violation = |operations: &[&str], attachment: &str, verdict| Violation {
            verdict,
            kind: ViolationKind::Picture {
                attachment: attachment.to_owned(),
                aspect: Aspect::Color,
                operations: operations.iter().map(|o| (*o).to_owned()).collect(),
            },
        };
        let fail = |operations: &[&str]| violation(operations, "c", Verdict::Fail);
        let whole = fail(&["blend", "scissor"]);
        assert!(whole.covers(&whole));
        assert!(whole.covers(&fail(&["blend"])));
        assert!(!whole.covers(&fail(&["store color"])));
        assert!(!whole.covers(&fail(&["blend", "store color"])));
        assert!(!whole.covers(&fail(&[])));
        assert!(!fail(&["blend"]).covers(&whole));
        assert!(!whole.covers(&violation(&["blend"], "d", Verdict::Fail)));
        assert!(!whole.covers(&violation(&["blend"], "c", Verdict::Disputed)));
        let counter = Violation {
            verdict: Verdict::Fail,
            kind: ViolationKind::Counter {
                kind: CounterKind::ShaderRuns,
                high: true,
            },
        };
        assert!(counter.covers(&counter) && !whole.covers(&counter) && !counter.covers(&whole));
    }
}
