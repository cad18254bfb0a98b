//! Stories as records keep them, each of a small scene that a planted bug or a driver draws wrong.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use etalon_backend::Backend;
use etalon_case::{Case, CaseFile, Profile};
use etalon_frame::{Frame, Limits, Story};
use etalon_judge::Judge;
use etalon_mutants::MutantBackend;
use etalon_record::{Record, Verdict};
use etalon_report::{sentence, story_text};

fn case(body: &str) -> Case {
    let text = format!(r#"{{"about":"t","spec":["t"],{body}}}"#);
    let file = CaseFile::parse("t.json", &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    file.cases(Profile::Full).next().unwrap().build().unwrap()
}

/// Returns a case that reads a 4 by 4 colour attachment back, which is cleared to black.
fn scene(attachments: &str, depth: &str, draws: &str, read: &str) -> Case {
    case(&format!(
        r#""scene":{{"attachments":{{"color":{{"format":"rgba8unorm","size":[4,4],"clear":[0,0,0,1]}}{attachments}}},
           "passes":[{{"color":["color"]{depth},"draws":[{draws}]}}],"read":["color"{read}]}}"#
    ))
}

fn frames(mutant: &str, case: &Case) -> (Limits, Vec<Frame>) {
    let backend = MutantBackend::new(mutant).unwrap_or_else(|| panic!("no mutant {mutant}"));
    let frame = |scene| {
        let mut prepared = backend.prepare(scene).unwrap();
        prepared.submit().unwrap();
        prepared.read_back().unwrap()
    };
    (backend.limits().clone(), case.scenes().map(frame).collect())
}

/// Returns the record of a case that a planted bug draws.
fn record(mutant: &str, case: &Case) -> Record {
    let (limits, frames) = frames(mutant, case);
    Judge::default()
        .judge(0, case, "cpu", &limits, &frames)
        .record
}

/// Returns the story of a bug. Its verdict must be Fail.
fn story(mutant: &str, case: &Case) -> Story {
    let record = record(mutant, case);
    assert_eq!(record.verdict, Verdict::Fail, "{mutant}: {record:?}");
    record.story.unwrap()
}

const RED: &str = r#""shader":"uniform_color","params":{"color":[1,0,0,1]}"#;
const COVER: &str = r#""mesh":{"kind":"cover","z":0.25}"#;
const DEPTH: &str = r#","depth":{"format":"depth32float","size":[4,4],"clear":0.5}"#;
const STENCIL: &str =
    r#","depth":{"format":"depth24plus-stencil8","size":[4,4],"clear":{"depth":0.5,"stencil":3}}"#;
const WITH_DEPTH: &str = r#","depth_stencil":"depth""#;

/// A draw that covers everything in red, with a state.
fn red(state: &str) -> String {
    format!("{{{COVER},{RED},{state}}}")
}

#[test]
fn every_rejection_cites_its_clause() {
    let rejections = [
        (
            "scissor",
            "scissor/ignored",
            scene("", "", &red(r#""scissor":[2,2,2,2]"#), ""),
        ),
        (
            "viewport",
            "viewport/ignored",
            scene(
                "",
                "",
                &red(r#""viewport":{"rect":[0,0,2,4],"depth":[0,1]}"#),
                "",
            ),
        ),
        (
            "culling",
            "cull/front-and-back-swapped",
            scene("", "", &red(r#""cull":"front","front_face":"ccw""#), ""),
        ),
        (
            "mask",
            "samples/mask-ignored",
            case(&format!(
                r#""scene":{{"attachments":{{"color":{{"format":"rgba8unorm","size":[4,4],"samples":4,"clear":[0,0,0,1]}}}},
                   "passes":[{{"color":["color"],"draws":[{}]}}],"read":["color"]}}"#,
                red(r#""multisample":{"mask":11}"#)
            )),
        ),
        (
            "bounds",
            "bounds/ignored",
            scene(DEPTH, WITH_DEPTH, &red(r#""depth_bounds":[0.75,1]"#), ""),
        ),
        (
            "discard",
            "discard/discard-off",
            scene(
                r#","alpha":{"format":"rgba8unorm","size":[4,4],
                   "texels":{"kind":"columns","values":[[255,0,0,0],[255,0,0,255],[255,0,0,255],[255,0,0,255]]}}"#,
                "",
                &format!(
                    r#"{{{COVER},"shader":"texel_discard","params":{{"color":[0,0,0,0.5]}},"textures":["alpha"]}}"#
                ),
                "",
            ),
        ),
        (
            "stencil",
            "stencil/compare-never-as-less",
            scene(
                STENCIL,
                WITH_DEPTH,
                &red(
                    r#""stencil":{"front":{"compare":"never","fail_op":"increment-clamp"},"reference":1}"#,
                ),
                "",
            ),
        ),
        (
            "depth",
            "depth/test-off",
            scene(
                DEPTH,
                WITH_DEPTH,
                &red(r#""depth":{"compare":"greater","write":true}"#),
                "",
            ),
        ),
        (
            "write-mask",
            "write-mask/zero-still-writes",
            scene("", "", &red(r#""write_mask":"""#), ""),
        ),
    ];
    for (name, mutant, case) in rejections {
        let story = story(mutant, &case);
        insta::assert_snapshot!(format!("story_{name}"), story_text(&story));
    }
}

#[test]
fn the_worlds_of_an_edge_are_distinguished() {
    let half = r#""mesh":{"kind":"vertices","positions":[[-1,-1,0.2],[1,1,0.2],[-1,1,0.2]]}"#;
    let case = scene("", "", &format!("{{{half},{RED}}}"), "");
    // On the diagonal both outcomes are legal, but not a third one.
    let (limits, mut frames) = frames("scissor/ignored", &case);
    let offset = (2 * 4 + 1) * 4;
    frames[0].images[0].codes[offset..offset + 4].copy_from_slice(&[9, 0, 0, 255]);
    let judged = Judge::default().judge(0, &case, "cpu", &limits, &frames);
    insta::assert_snapshot!("story_edge", story_text(&judged.record.story.unwrap()));
}

#[test]
fn a_failing_relation_shows_both_sides() {
    let text = include_str!("../../../../cases/order/scissor.json");
    let file = CaseFile::parse("order/scissor.json", text).unwrap();
    let record = file
        .cases(Profile::Full)
        .map(|case| record("invariance/scissor-moves-values", &case.build().unwrap()))
        .find(|record| record.verdict.is_violation())
        .unwrap();
    let story = record.story.unwrap();
    assert!(
        sentence(&story).unwrap().contains("must be the same"),
        "{story:?}"
    );
    insta::assert_snapshot!("story_relation", story_text(&story));
}
