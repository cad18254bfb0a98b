//! Stories of random scenes: every primitive is explained, and every reported rejection is true.

use super::explained;
use crate::rules::Rules;
use crate::sample::Sample;
use crate::test_limits;
use etalon_case::{CaseFile, Profile};
use etalon_frame::{Api, Demand, Effect, Limits, Origin, Rejection};
use etalon_scene::Scene;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

/// Meshes with topology and shader, some of them covering little or nothing.
const MESHES: [&str; 10] = [
    r#""mesh":{"kind":"full","z":0.5},"shader":"uniform_color""#,
    r#""mesh":{"kind":"cover","z":0.25},"shader":"uniform_color""#,
    r#""mesh":{"kind":"cover","z":1.5},"shader":"uniform_color""#,
    r#""mesh":{"kind":"columns","values":[0,0.5,1]},"shader":"flat_color_depth""#,
    r#""mesh":{"kind":"vertices","positions":[[-1,-1,0.2],[1,-1,0.2],[1,1,0.2],[-1,-1,0.2],[1,1,0.2],[-1,1,0.2]]},
       "shader":"uniform_color""#,
    r#""mesh":{"kind":"vertices","positions":[[-1,-1,0.2],[1,1,0.2],[0,0,0.2]]},"shader":"uniform_color""#,
    r#""mesh":{"kind":"vertices","positions":[[-1,-1,0.2],[-0.5,-1,0.2],[-1,-0.5,0.2]]},"shader":"uniform_color""#,
    r#""mesh":{"kind":"vertices","positions":[[-1,0.1,0.2],[1,0.1,0.2]]},"topology":"line-list","shader":"uniform_color""#,
    r#""mesh":{"kind":"vertices","positions":[[0.1,0.1,0.2]]},"topology":"point-list","shader":"uniform_color""#,
    r#""mesh":{"kind":"full","z":0.5},"shader":"texel_discard","textures":["texture"]"#,
];
/// States that reject fragments, or can reject them.
const STATES: [&str; 18] = [
    r#""scissor":[1,1,2,2]"#,
    r#""scissor":[0,0,0,0]"#,
    r#""viewport":{"rect":[0,0,2,4],"depth":[0,1]}"#,
    r#""viewport":{"rect":[0.5,0.5,2,2],"depth":[0.25,0.5]}"#,
    r#""cull":"front""#,
    r#""cull":"back""#,
    r#""polygon_mode":"line""#,
    r#""multisample":{"mask":5}"#,
    r#""multisample":{"alpha_to_coverage":true}"#,
    r#""depth_bounds":[0.1,0.4]"#,
    r#""depth":{"compare":"less","write":true}"#,
    r#""depth":{"compare":"never","write":true}"#,
    r#""depth":{"compare":"equal","write":false}"#,
    r#""stencil":{"front":{"compare":"equal","pass_op":"increment-clamp","fail_op":"zero"},"reference":0}"#,
    r#""stencil":{"front":{"compare":"never"}}"#,
    r#""write_mask":"""#,
    r#""rasterizer_discard":true"#,
    r#""early_tests":"forced""#,
];

fn draw() -> impl Strategy<Value = String> {
    let states = prop::sample::subsequence(STATES.to_vec(), 0..=4);
    let color = prop::sample::select(vec!["[1,0,0,1]", "[0,1,0,0]", "[0,0,1,0.5]"]);
    (prop::sample::select(MESHES.to_vec()), states, color).prop_map(|(mesh, states, color)| {
        let mut parts: Vec<String> =
            vec![mesh.to_owned(), format!(r#""params":{{"color":{color}}}"#)];
        let mut keys = Vec::new();
        for state in states {
            let key = state.split(':').next();
            if !keys.contains(&key) {
                keys.push(key);
                parts.push(state.to_owned());
            }
        }
        format!("{{{}}}", parts.join(","))
    })
}

/// Returns a scene, if the draws are possible together.
fn scene(draws: &[String], samples: u32) -> Option<Scene> {
    let text = format!(
        r#"{{"about":"t","spec":["t"],"scene":{{"attachments":{{
            "color":{{"format":"rgba8unorm","size":[4,4],"samples":{samples}}},
            "depth":{{"format":"depth24plus-stencil8","size":[4,4],"samples":{samples},"clear":{{"depth":0.5,"stencil":0}}}},
            "texture":{{"format":"rgba8unorm","size":[4,4],"texels":{{"kind":"columns","values":[[9,8,7,255],[9,8,7,0],[9,8,7,9],[0,0,0,255]]}}}}
            }},"passes":[{{"color":["color"],"depth_stencil":"depth","draws":[{}]}}],"read":["color","depth"]}}}}"#,
        draws.join(",")
    );
    let file = CaseFile::parse("t.json", &text).ok()?;
    let case = file.cases(Profile::Full).next()?;
    Some(case.build().ok()?.scene)
}

fn limits(api: Api) -> Limits {
    let mut limits = test_limits::limits(api);
    let four = vec![[96, 32], [224, 96], [32, 160], [160, 224]];
    limits.sample_positions.insert(4, four);
    limits
}

fn config() -> Config {
    Config {
        cases: 400,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..Config::default()
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn nothing_is_skipped_in_silence(
        draws in prop::collection::vec(draw(), 1..4),
        samples in prop::sample::select(vec![1, 4]),
        (x, y, sample) in (0..4_u32, 0..4_u32, 0..4_u32),
        api in prop::sample::select(vec![Api::Vulkan, Api::OpenGl, Api::OpenGlEs, Api::WebGpu]),
        yardstick in any::<bool>(),
    ) {
        let Some(scene) = scene(&draws, samples) else {
            return Err(TestCaseError::reject("an impossible draw"));
        };
        let limits = limits(api);
        let rules = if yardstick { Rules::yardstick(&limits) } else { Rules::of(&limits) };
        let at = Sample { size: [4, 4], samples, x, y, sample: sample % samples };
        let (set, ruling, notes) = explained(&scene, &limits, &rules, at, None);
        if set.is_open() {
            return Ok(());
        }
        for (d, draw) in scene.passes[0].draws.iter().enumerate() {
            let events = || notes.iter().map(|note| &note.event).filter(|e| {
                !e.effect.is_none() && e.origin.draw().is_some_and(|(_, draw)| draw == d)
            });
            for primitive in 0..draw.primitives().len() as u32 {
                prop_assert!(
                    events().any(|e| e.origin.includes(primitive)),
                    "primitive {primitive} of draw {d} at {at:?} is not explained:\n{notes:#?}"
                );
            }
            // A draw whose fragments are all rejected changes nothing: the same values are legal without it.
            if events().all(|e| matches!(e.effect, Effect::Rejects(_) | Effect::Keeps(_))) {
                let mut without = scene.clone();
                without.passes[0].draws.remove(d);
                let (other, ..) = explained(&without, &limits, &rules, at, None);
                prop_assert_eq!(sorted(&set), sorted(&other), "draw {} at {:?}", d, at);
            }
        }
        for note in notes.iter().filter(|n| !n.event.effect.is_none()) {
            let cited = note.event.citation.as_ref().is_some_and(|c| c.contains(':'));
            prop_assert!(cited, "no clause: {:?}", note);
        }
        match ruling.demand {
            Demand::Values(values) => prop_assert!(!values.allowed.is_empty()),
            demand => prop_assert!(false, "{:?}", demand),
        }
    }
}

fn sorted(set: &etalon_frame::TexelSet) -> Vec<etalon_frame::WorldBox> {
    let mut worlds = set.worlds.clone();
    worlds.sort_unstable();
    worlds.dedup();
    worlds
}

#[test]
fn triangles_that_miss_a_texel_are_one_event_of_its_story() {
    let mut positions = Vec::new();
    for i in 0..1000 {
        let x = -1.0 + f64::from(i) / 2000.0;
        positions.push(format!("[{x},-1,0],[{x},-0.9,0],[-1,-0.9,0]"));
    }
    // The last triangle covers the texel.
    positions.push("[-1,-1,0],[3,-1,0],[-1,3,0]".to_owned());
    let mesh = format!(
        r#"{{"mesh":{{"kind":"vertices","positions":[{}]}},"shader":"uniform_color"}}"#,
        positions.join(",")
    );
    let scene = scene(&[mesh], 1).expect("builds");
    let limits = limits(Api::Vulkan);
    let at = Sample {
        size: [4, 4],
        samples: 1,
        x: 3,
        y: 1,
        sample: 0,
    };
    let (_, _, notes) = explained(&scene, &limits, &Rules::of(&limits), at, None);
    assert!(notes.len() < 12, "{notes:#?}");
    let elsewhere = Origin::Draw {
        pass: 0,
        draw: 0,
        primitives: (0..1000).collect(),
    };
    let mut events = notes.iter().map(|note| &note.event);
    assert!(
        events.any(|e| e.origin == elsewhere && e.effect == Effect::Rejects(Rejection::Coverage)),
        "{notes:#?}"
    );
}
