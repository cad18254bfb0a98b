//! `etalon export`.

use crate::cases::{find, library};
use crate::failure::Failure;
use crate::flags::AdapterFileArguments;
use crate::legal_worlds::worlds;
use crate::named_files::NamedFiles;
use crate::output::{say, summarize};
use crate::reducing::start;
use clap::Args;
use etalon_assert::any_device;
use etalon_backend::texels::AspectForm;
use etalon_case::{Case, CaseRef, Library, Profile, select};
use etalon_external::files::{FrameFiles, ImageFiles, MANIFEST, Manifest, array_file};
use etalon_external::scene::SentScene;
use etalon_external::{description, languages, not_expressed};
use etalon_frame::{Api, CodeInterval, Frame, Image, ImageInfo};
use etalon_reference::{Judgement, judgements};
use etalon_report::reference_png;
use etalon_runner::Worker;
use etalon_scene::Scene;
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The page of the folder.
const README: &str = include_str!("export/README.md");
/// The APIs whose legal values are exported.
const APIS: [Api; 4] = [Api::Vulkan, Api::OpenGl, Api::OpenGlEs, Api::WebGpu];

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Ids of cases, or globs
    #[arg(value_name = "CASE", required = true)]
    pub(crate) globs: Vec<String>,
    /// Folder that gets a folder for each case
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Also draw on this adapter, and write frames in the form that `etalon judge` reads, and limits.json
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Leave out the legal values
    #[arg(long)]
    pub(crate) no_values: bool,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
    /// Replace files of the same names
    #[arg(long)]
    pub(crate) force: bool,
}

/// Files by their folder below that of `--out`.
#[derive(Default)]
struct Folders(BTreeMap<String, Vec<(String, Vec<u8>)>>);

impl Folders {
    fn add(&mut self, folder: &str, name: &str, content: Vec<u8>) {
        let files = self.0.entry(folder.to_owned()).or_default();
        files.push((name.to_owned(), content));
    }

    fn add_json(
        &mut self,
        folder: &str,
        name: &str,
        value: &impl Serialize,
    ) -> Result<(), Failure> {
        let mut text = serde_json::to_vec_pretty(value).map_err(Failure::incomplete)?;
        text.push(b'\n');
        self.add(folder, name, text);
        Ok(())
    }

    fn write(self, arguments: &Arguments) -> Result<(), Failure> {
        for (folder, files) in self.0 {
            let force = arguments.force;
            let folder = &arguments.out.join(folder);
            NamedFiles { folder, force }.write(&files)?;
        }
        Ok(())
    }
}

/// Writes cases for programs in any language.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let library = library(arguments.cases.as_ref())?;
    let cases = chosen(&library, &arguments.globs)?;
    let started = arguments.adapter.as_ref();
    let started = started.map(|name| start(name, arguments.file.adapter_file.as_deref()));
    let mut worker = started.transpose()?.map(|(_, worker)| worker);
    let mut top = Folders::default();
    top.add("", "README.md", README.as_bytes().to_vec());
    if let Some(worker) = &worker {
        let hello = description(&worker.hello.info, &worker.hello.limits);
        top.add_json("", "limits.json", &hello)?;
    }
    top.write(arguments)?;
    let mut count = 0;
    for case in cases {
        let document = case.document().map_err(Failure::usage)?;
        let case = case.build().map_err(Failure::usage)?;
        if let Some(other) = case.scenes().find_map(not_expressed) {
            say!("{}: left out, because the form has no {other}", case.id);
            continue;
        }
        let mut folders = Folders::default();
        folders.add_json(&case.id, "case.json", &document)?;
        for (index, scene) in case.scenes().enumerate() {
            let judged = if index == 0 {
                case.judged_scene()
            } else {
                scene
            };
            let folder = scene_folder(&case, index);
            add_scene(&mut folders, &folder, scene)?;
            if !arguments.no_values {
                add_values(&mut folders, &folder, judged)?;
            }
        }
        if let Some(worker) = &mut worker {
            add_frames(&mut folders, &case, worker)?;
        }
        folders.write(arguments)?;
        count += 1;
    }
    if count == 0 {
        return Err(Failure::nothing("no selected case has this form"));
    }
    summarize(&format!("Cases: {count}, in {}\n", arguments.out.display()));
    Ok(0)
}

/// Returns the cases that match: an id selects its case from any profile.
fn chosen<'l>(library: &'l Library, globs: &[String]) -> Result<Vec<CaseRef<'l>>, Failure> {
    let selected = select(library, Profile::Quick, globs).map_err(Failure::usage)?;
    match (selected.cases.is_empty(), globs) {
        (true, [id]) => Ok(vec![find(library, id)?]),
        (true, _) => Err(Failure::nothing("no case of the quick profile matches")),
        _ => Ok(selected.cases),
    }
}

/// Returns the folder of one of a case's scenes.
fn scene_folder(case: &Case, index: usize) -> String {
    match index.checked_sub(1) {
        None => case.id.clone(),
        Some(variant) => format!(
            "{}/variants/{}",
            case.id,
            plain(&case.variants[variant].name)
        ),
    }
}

/// Returns a name that is the same on every file system.
fn plain(name: &str) -> String {
    let fine = |c: char| c.is_ascii_alphanumeric() || "-_=+".contains(c);
    name.chars()
        .map(|c| if fine(c) { c } else { '_' })
        .collect()
}

fn file_name(form: &AspectForm) -> String {
    format!("{}-{}", plain(&form.attachment), form.aspect)
}

fn add_scene(folders: &mut Folders, folder: &str, scene: &Scene) -> Result<(), Failure> {
    let sent = SentScene::new(scene, &languages(scene));
    let sent = sent.map_err(|error| Failure::incomplete(error.to_string()))?;
    folders.add_json(folder, "scene.json", &sent)?;
    for (name, shader) in &sent.shaders {
        for (name, content) in shader.files(name) {
            folders.add(folder, &name, content);
        }
    }
    Ok(())
}

/// Adds the least and largest legal values, by API.
fn add_values(folders: &mut Folders, folder: &str, scene: &Scene) -> Result<(), Failure> {
    let forms = AspectForm::of_scene(scene);
    let mut by_api = BTreeMap::new();
    for api in APIS {
        let judgements = judgements(scene, &any_device(api));
        let Some(first) = judgements.first() else {
            continue;
        };
        let api = api.to_string();
        let below = format!("{folder}/{api}");
        for (form, info) in forms.iter().zip(&first.legal.images) {
            let hulls = hulls(info, &judgements);
            let (least, largest): (Vec<i64>, Vec<i64>) =
                hulls.iter().map(|hull| (hull.low, hull.high)).unzip();
            for (name, orders) in [("least", least), ("largest", largest)] {
                let codes = orders.iter().zip(info.channels.iter().cycle());
                let codes: Vec<u32> = codes.map(|(o, e)| e.code_of_order(*o)).collect();
                let name = format!("{}.{name}", file_name(form));
                let bytes = form.bytes(&info.channels, &codes);
                folders.add(&below, &format!("{name}.npy"), array_file(form, &bytes));
                let image = form.image(&bytes).map_err(Failure::incomplete)?;
                if let Some(png) = picture(image) {
                    folders.add(&below, &format!("{name}.png"), png);
                }
            }
        }
        let sets = judgements.iter().map(|judgement| &*judgement.legal);
        let mut text = serde_json::to_vec(&worlds(sets)).map_err(Failure::incomplete)?;
        text.push(b'\n');
        folders.add(&below, "worlds.json", text);
        by_api.insert(api, counters(scene, &judgements));
    }
    if !scene.counters.is_empty() {
        folders.add_json(folder, "counters.json", &by_api)?;
    }
    Ok(())
}

fn picture(image: Image) -> Option<Vec<u8>> {
    reference_png(&Frame {
        images: vec![image],
        counters: Vec::new(),
    })
}

/// Returns the hull of the legal orders under all judgements, for each channel of each sample.
fn hulls(info: &ImageInfo, judgements: &[Judgement]) -> Vec<CodeInterval> {
    let mut hulls: Vec<CodeInterval> = Vec::new();
    for judgement in judgements {
        let mut of_judgement = Vec::with_capacity(hulls.len());
        for (end, set) in judgement.legal.groups[info.group].runs() {
            let channels = info.channels.iter().enumerate();
            let channels = channels.map(|(channel, encoding)| {
                let all = CodeInterval::new(encoding.min_order(), encoding.max_order());
                set.hull(info.first_channel + channel).unwrap_or(all)
            });
            let sample: Vec<CodeInterval> = channels.collect();
            while of_judgement.len() < end * sample.len() {
                of_judgement.extend(&sample);
            }
        }
        if hulls.is_empty() {
            hulls = of_judgement;
        } else {
            for (hull, other) in hulls.iter_mut().zip(of_judgement) {
                *hull = hull.hull(other);
            }
        }
    }
    hulls
}

/// Returns the least and largest legal value of each counter; the largest is `null` without a limit.
fn counters(scene: &Scene, judgements: &[Judgement]) -> Vec<Value> {
    let counters = scene.counters.iter().enumerate();
    let counters = counters.map(|(index, counter)| {
        let ranges = || judgements.iter().filter_map(|j| j.legal.counters.get(index));
        let low = ranges().map(|c| c.range.low).min();
        let high = ranges().map(|c| c.range.high).reduce(|a, b| a.zip(b).map(|(a, b)| a.max(b)));
        json!({ "name": counter.name, "kind": counter.kind, "least": low, "largest": high.flatten() })
    });
    counters.collect()
}

/// Draws a case, and adds its frames and their manifest.
fn add_frames(folders: &mut Folders, case: &Case, worker: &mut Worker) -> Result<(), Failure> {
    if let Some(missing) = worker.hello.limits.missing(&case.requirements()) {
        say!(
            "{}: not drawn, because the adapter has no {missing}",
            case.id
        );
        return Ok(());
    }
    let frames = worker.draw(case).map_err(Failure::incomplete)?;
    let mut named = Vec::new();
    for (index, (scene, frame)) in case.scenes().zip(frames).enumerate() {
        let folder = scene_folder(case, index);
        let below = folder.strip_prefix(&case.id).unwrap_or_default();
        let below = below
            .strip_prefix('/')
            .map_or_else(String::new, |b| format!("{b}/"));
        let mut images = Vec::new();
        for (form, image) in AspectForm::of_scene(scene).iter().zip(&frame.images) {
            let name = format!("{}.npy", file_name(form));
            let bytes = form.bytes(&image.channels, &image.codes);
            folders.add(&folder, &name, array_file(form, &bytes));
            images.push(ImageFiles {
                attachment: form.attachment.clone(),
                aspect: form.aspect,
                files: vec![format!("{below}{name}")],
            });
        }
        let variant = index.checked_sub(1).map(|v| case.variants[v].name.clone());
        let counters = frame.counters;
        named.push(FrameFiles {
            variant,
            images,
            counters,
        });
    }
    let manifest = Manifest {
        case: case.id.clone(),
        frames: named,
    };
    folders.add_json(&case.id, MANIFEST, &manifest)
}
