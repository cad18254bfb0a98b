//! Comparisons of the kernels with the span code.

use etalon_backend::Prepared;
use etalon_case::{CaseFile, CaseRef, Library, Profile};
use etalon_cpu::steps::Faithful;
use etalon_cpu::{CpuScene, KernelMachine, in_tiles};
use etalon_frame::Frame;
use etalon_scene::{AttachmentContents, Scene, Shader};
use fearless_simd::{Level, Simd};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Returns the sets of vector instructions that this machine has, with their names.
fn levels() -> Vec<(&'static str, Level)> {
    let best = Level::new();
    let mut levels = Vec::new();
    #[cfg(target_arch = "x86_64")]
    {
        let named = [
            ("sse2", best.as_sse2().map(|s| s.level())),
            ("sse4.2", best.as_sse4_2().map(|s| s.level())),
            ("avx2", best.as_avx2().map(|s| s.level())),
            ("avx512", best.as_avx512().map(|s| s.level())),
        ];
        levels.extend(named.into_iter().filter_map(|(n, l)| Some((n, l?))));
    }
    if levels.is_empty() {
        levels.push(("best", best));
    }
    levels
}

fn drawn(mut prepared: impl Prepared) -> Frame {
    // The second submission finds the memory that the first left.
    prepared.submit().expect("draws");
    prepared.submit().expect("draws");
    prepared.read_back().expect("reads")
}

/// Returns the first difference between the frames of the kernels and the frame of the span code, if the
/// scene has kernels, or else the reason why it has none.
fn compare(
    scene: &Scene,
    machines: &[(&'static str, KernelMachine)],
) -> Result<Option<String>, &'static str> {
    let mut scene = scene.clone();
    scene.read = (0..scene.attachments.len()).collect();
    let mut expected = None;
    for (name, machine) in machines {
        let frame = drawn(in_tiles(&scene, *machine)?);
        let expected =
            expected.get_or_insert_with(|| drawn(CpuScene::new(scene.clone(), Faithful)));
        if frame != *expected {
            return Ok(Some(format!(
                "{name}, {}: {}",
                machine.threads,
                difference(&frame, expected)
            )));
        }
    }
    Ok(None)
}

fn difference(frame: &Frame, expected: &Frame) -> String {
    if frame.counters != expected.counters {
        return format!("counters {:?} for {:?}", frame.counters, expected.counters);
    }
    for (image, expected) in frame.images.iter().zip(&expected.images) {
        let mut codes = image.codes.iter().zip(&expected.codes);
        if let Some(index) = codes.position(|(a, b)| a != b) {
            let channels = image.channels.len();
            let texel = index / channels / image.samples as usize;
            let (x, y) = (
                texel % image.size[0] as usize,
                texel / image.size[0] as usize,
            );
            return format!(
                "{} {:?} {x},{y} sample {} channel {}: {} for {}",
                image.attachment,
                image.aspect,
                index / channels % image.samples as usize,
                index % channels,
                image.codes[index],
                expected.codes[index]
            );
        }
    }
    "shapes".to_owned()
}

/// Returns every level, each with one of three numbers of threads.
fn machines(turn: usize) -> Vec<(&'static str, KernelMachine)> {
    let levels = levels().into_iter().enumerate();
    levels
        .map(|(i, (name, level))| {
            let threads = 1 + (turn + i) % 3;
            (name, KernelMachine { level, threads })
        })
        .collect()
}

/// Returns one level with one number of threads. Consecutive turns go through all pairs.
fn machine(turn: usize) -> Vec<(&'static str, KernelMachine)> {
    let levels = levels();
    let (name, level) = levels[turn % levels.len()];
    let threads = 1 + turn / levels.len() % 3;
    vec![(name, KernelMachine { level, threads })]
}

/// The scenes whose pictures a test compares.
type Scenes = Vec<(String, Scene)>;

/// Compares the pictures of scenes on two threads. Returns the number of scenes that have kernels.
fn compare_all(
    count: usize,
    scenes: impl Fn(usize) -> Scenes + Sync,
    machines: impl Fn(usize) -> Vec<(&'static str, KernelMachine)> + Sync,
) -> usize {
    let names: Vec<_> = levels().into_iter().map(|(name, _)| name).collect();
    println!("levels: {}", names.join(", "));
    let (next, found) = (AtomicUsize::new(0), Mutex::new(Found::default()));
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let turn = next.fetch_add(1, Ordering::Relaxed);
                    if turn >= count {
                        return;
                    }
                    for (name, scene) in scenes(turn) {
                        let outcome = compare(&scene, &machines(turn));
                        let mut found = found.lock().expect("no panic");
                        match outcome {
                            Err(reason) => *found.reasons.entry(reason).or_default() += 1,
                            Ok(None) => found.equal += 1,
                            Ok(Some(different)) => {
                                found.different.push(format!("{name}: {different}"))
                            }
                        }
                    }
                }
            });
        }
    });
    let found = found.into_inner().expect("no panic");
    println!(
        "{} scenes have kernels; the others: {:?}",
        found.equal, found.reasons
    );
    let some = found.different.iter().take(20).cloned().collect::<Vec<_>>();
    assert!(
        some.is_empty(),
        "{} differ:\n{}",
        found.different.len(),
        some.join("\n")
    );
    found.equal
}

#[derive(Default)]
struct Found {
    equal: usize,
    different: Vec<String>,
    reasons: BTreeMap<&'static str, usize>,
}

/// Returns a scene with all sizes multiplied, or `None` if it has uploaded texels.
fn enlarged(mut scene: Scene, by: u32) -> Option<Scene> {
    for attachment in &mut scene.attachments {
        if matches!(attachment.contents, AttachmentContents::Texels(_)) {
            return None;
        }
        attachment.size = attachment.size.map(|s| s * by);
    }
    for pass in &mut scene.passes {
        for draw in &mut pass.draws {
            draw.viewport.rect = draw.viewport.rect.map(|v| v * by as f32);
            draw.scissor = draw.scissor.map(|s| s.map(|v| v * by));
        }
    }
    Some(scene)
}

/// Returns a scene with formats and shaders that have kernels, chosen by turn.
fn adapted(mut scene: Scene, turn: usize) -> Scene {
    use etalon_frame::TextureFormat::{
        Bgra8Unorm, R8Unorm, Rgba8Snorm, Rgba8Unorm, Rgba8UnormSrgb,
    };
    let formats = [
        Rgba8Unorm,
        Rgba8UnormSrgb,
        Rgba8Unorm,
        Rgba8Snorm,
        Bgra8Unorm,
        R8Unorm,
    ];
    let shaders = [Shader::FlatColor, Shader::UniformColor, Shader::FrontFacing];
    let unused: Vec<usize> = (0..scene.attachments.len())
        .filter(|i| {
            !scene
                .passes
                .iter()
                .any(|p| p.color.contains(i) || p.depth_stencil == Some(*i))
        })
        .collect();
    for (i, attachment) in scene.attachments.iter_mut().enumerate() {
        if attachment.format.is_color() {
            attachment.format = formats[turn % formats.len()];
        }
        if unused.contains(&i) {
            attachment.contents = AttachmentContents::Color([0.25; 4]);
        }
    }
    for (i, draw) in scene
        .passes
        .iter_mut()
        .flat_map(|p| &mut p.draws)
        .enumerate()
    {
        let number = turn * 7 + i * 3;
        draw.shader = shaders[number % shaders.len()];
        draw.textures.clear();
        draw.depth_bounds = None;
        draw.counters.clear();
        let value = |c: usize| ((number * 37 + c * 101) % 257) as f32 / 200.0 - 0.1;
        draw.params.color = std::array::from_fn(value);
        draw.params.back_color = std::array::from_fn(|c| value(c + 5));
        for (v, vertex) in draw.mesh.vertices.iter_mut().enumerate() {
            vertex.color = std::array::from_fn(|c| value(c + v / 3));
        }
    }
    scene
}

/// Returns true if all cases are compared, false for a sample.
fn compares_all() -> bool {
    std::env::var_os("ETALON_TESTS").is_some_and(|v| v == "all")
}

/// Returns the scene of a case in a list, or an empty list if other cases are compared instead.
fn scene_of(case: &CaseRef<'_>, turn: usize) -> Scenes {
    let id = case.id();
    // Smaller pictures replace large ones, and most of the matrix is one scene in different formats.
    let large = ["1280x720", "1920x1080", "1024x1024"];
    let one_of_many = id.starts_with("perf/matrix/") && !turn.is_multiple_of(8) && !compares_all();
    if large.iter().any(|size| id.contains(size)) || one_of_many {
        Vec::new()
    } else {
        vec![(id, case.build().expect("builds").scene)]
    }
}

#[test]
fn kernels_draw_built_in_cases_as_spans_do() {
    let library = Library::built_in();
    let quick: Vec<_> = library.cases(Profile::Quick).collect();
    let scenes = |i: usize| scene_of(&quick[i], i);
    let machines = if compares_all() { machines } else { machine };
    let equal = compare_all(quick.len(), scenes, machines);
    assert!(equal > 1200, "{equal} quick cases have kernels");
    let step = if compares_all() { 1 } else { 20 };
    let full: Vec<_> = library.cases(Profile::Full).step_by(step).collect();
    let scenes = |i: usize| scene_of(&full[i], i);
    let equal = compare_all(full.len(), scenes, machine);
    assert!(equal > 11_000 / step, "{equal} cases have kernels");
}

#[test]
fn kernels_draw_random_scenes_in_many_tiles_as_spans_do() {
    // Each scene is drawn in two sizes: 1,800 pictures, or 10,200.
    let count = if compares_all() { 1_700 } else { 300 };
    let files = ["common", "extended", "multisample"].map(|flavor| {
        let text = format!(
            r#"{{"about":"t","spec":["t"],"axes":{{"seed":{{"from":5000,"count":{count}}}}},
            "random":{{"flavor":"{flavor}","seed":"$seed"}}}}"#
        );
        CaseFile::parse("random.json", &text).expect("parses")
    });
    let cases: Vec<_> = files
        .iter()
        .map(|f| f.cases(Profile::Full).collect::<Vec<_>>())
        .collect();
    let scenes = |i: usize| {
        let case = &cases[i % 3][i / 3];
        let scene = adapted(case.build().expect("builds").scene, i);
        let large = enlarged(scene.clone(), 9);
        let name = case.id();
        let large = large.map(|scene| (format!("{name}, enlarged"), scene));
        large.into_iter().chain([(name.clone(), scene)]).collect()
    };
    let equal = compare_all(3 * count, scenes, machine);
    assert!(equal > 3 * count, "{equal} scenes have kernels");
}
