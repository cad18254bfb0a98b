//! `etalon explain`.

use crate::cases::{find, library};
use crate::discovery::{discover, refuse_absent};
use crate::failure::{Failure, UNEXPECTED};
use crate::flags::AdapterFileArguments;
use crate::output::print;
use crate::recorded_frame::recorded_frame;
use crate::saved_run::UnpackArguments;
use clap::Args;
use etalon_adapters::Query;
use etalon_backend::Backend;
use etalon_case::Case;
use etalon_cpu::CpuBackend;
use etalon_frame::{Band, ChannelMismatch, Frame, ImageInfo, Limits, Ruling, Story, WrongTexel};
use etalon_judge::{Judge, judge_texel, story_of_relation, story_of_sample};
use etalon_reference::{Rules, Sample};
use etalon_report::{judged_by, operations_text, sentence, story_text};
use etalon_scene::Scene;
use std::fmt::Write;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Id of the case
    #[arg(value_name = "CASE")]
    pub(crate) case: String,
    /// Column and row of the texel, counted from the top left corner. Default: the first wrong one
    #[arg(long, value_name = "X,Y", value_parser = parse_texel)]
    pub(crate) texel: Option<[u32; 2]>,
    /// Explain only this sample, counted from 0. Default: all samples of the texel
    #[arg(long, value_name = "S")]
    pub(crate) sample: Option<u32>,
    /// Draw the case on this adapter and judge the texel
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
    /// Draw nothing, and judge the texel in the frame that this run keeps: a run folder, or a run that the page saved
    /// (`*.tar.gz`). If it has several adapters, choose one with --adapter
    #[arg(long, value_name = "RUN")]
    pub(crate) run: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) unpack: UnpackArguments,
    /// Also compare the texel with the yardstick, the band of good quality within the legal values
    #[arg(long)]
    pub(crate) yardstick: bool,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
}

/// Explains one texel by the rules; with an adapter, also judges the value that it returned.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let library = library(arguments.cases.as_ref())?;
    let found = find(&library, &arguments.case)?;
    let case = found.build().map_err(Failure::usage)?;
    if let Some(texel) = arguments.texel {
        refuse_outside(case.judged_scene(), texel, arguments.sample)?;
    }
    let (limits, frames) = match (&arguments.run, &arguments.adapter) {
        (Some(run), adapter) => {
            let folder = arguments.unpack.folder(run)?;
            let recorded = recorded_frame(&folder, adapter.as_deref(), &case.id, &case.scene)?;
            (recorded.adapter.limits, vec![recorded.frame])
        }
        (None, None) => (CpuBackend::new("cpu").limits().clone(), Vec::new()),
        (None, Some(name)) => draw(name, arguments.file.adapter_file.as_deref(), &case)?,
    };
    let texel = match arguments.texel {
        Some(texel) => texel,
        None => first_wrong(&case, &limits, &frames)?,
    };
    refuse_outside(case.judged_scene(), texel, arguments.sample)?;
    let asked = AskedTexel {
        case: &case,
        texel,
        sample: arguments.sample,
        frames: &frames,
    };
    let sections = asked.all(&limits, arguments.yardstick)?;
    print(&sections.text(&case))?;
    let bad = sections.worst() > Some(Band::Imprecise);
    Ok(if bad && case.judged_as.is_none() {
        UNEXPECTED
    } else {
        0
    })
}

/// Returns the first wrong texel of a drawn case. A case with only wrong counters has the first texel.
fn first_wrong(case: &Case, limits: &Limits, frames: &[Frame]) -> Result<[u32; 2], Failure> {
    if frames.is_empty() {
        return Err(Failure::usage(
            "name a texel by --texel X,Y; or a driver that draws the case by --adapter, whose first wrong texel is \
             explained",
        ));
    }
    let record = Judge::default().judge(0, case, "", limits, frames).record;
    match record.wrong.first() {
        Some(wrong) => Ok([wrong.x, wrong.y]),
        None if record.verdict.is_violation() => Ok([0, 0]),
        None => Err(Failure::nothing(format!(
            "no texel of {} is wrong ({}); --texel X,Y explains any",
            case.id, record.verdict
        ))),
    }
}

/// Refuses a texel or a sample that is in no attachment that the case reads back.
fn refuse_outside(scene: &Scene, [x, y]: [u32; 2], sample: Option<u32>) -> Result<(), Failure> {
    let read = || scene.read.iter().map(|i| &scene.attachments[*i]);
    let inside = || read().filter(|a| x < a.size[0] && y < a.size[1]);
    if inside().next().is_none() {
        let sizes = read().map(|a| format!("{} is {} by {}", a.name, a.size[0], a.size[1]));
        return Err(Failure::usage(format!(
            "texel {x},{y} is outside every attachment that the case reads back: {}",
            sizes.collect::<Vec<_>>().join(", ")
        )));
    }
    if let Some(sample) = sample
        && !inside().any(|a| sample < a.samples)
    {
        let counts = inside().map(|a| match a.samples {
            1 => format!("{} has 1 sample", a.name),
            n => format!("{} has {n} samples, 0 to {}", a.name, n - 1),
        });
        return Err(Failure::usage(format!(
            "texel {x},{y} has no sample {sample}: {}",
            counts.collect::<Vec<_>>().join(", ")
        )));
    }
    Ok(())
}

/// The texel to explain, and the frames of the case's scenes, if it was drawn.
struct AskedTexel<'a> {
    case: &'a Case,
    texel: [u32; 2],
    sample: Option<u32>,
    frames: &'a [Frame],
}

/// The story that one or several samples share.
struct SharedStory {
    story: Story,
    band: Option<Band>,
}

/// Stories under a heading.
struct StorySection {
    heading: Option<String>,
    told: Vec<SharedStory>,
    /// The lines about counters, and the worst band of a counter.
    counters: (Vec<String>, Option<Band>),
    /// True if the section judges the quality of a value, not its legality.
    yardstick: bool,
}

/// The whole explanation.
struct Explanation {
    sections: Vec<StorySection>,
}

impl AskedTexel<'_> {
    fn all(&self, limits: &Limits, yardstick: bool) -> Result<Explanation, Failure> {
        let mut sections = vec![self.scene(0, limits)?];
        if yardstick {
            sections.push(self.yardstick(limits));
        }
        for index in 1..self.frames.len() {
            // A variant has a section only if its own picture is wrong.
            let scene = self.scene(index, limits)?;
            if scene.worst() > Some(Band::Imprecise) {
                sections.push(scene);
            }
        }
        if let Some((band, story)) = story_of_relation(self.case, limits, self.frames, self.texel) {
            sections.push(StorySection {
                heading: Some("pictures that must be the same".to_owned()),
                told: vec![SharedStory {
                    story,
                    band: Some(band),
                }],
                counters: (Vec::new(), None),
                yardstick: false,
            });
        }
        Ok(Explanation { sections })
    }

    /// Returns the stories of one of the case's scenes, with the encodings that fit the frame best.
    fn scene(&self, index: usize, limits: &Limits) -> Result<StorySection, Failure> {
        let scene = match index {
            0 => self.case.judged_scene(),
            _ => &self.case.variants[index - 1].scene,
        };
        let frame = self.frames.get(index);
        let judged = judge_texel(self.case, index, limits, self.texel, frame);
        let (judgement, comparison) = judged.map_err(Failure::incomplete)?;
        let rules = judgement.rules.clone();
        let band = |sample: &Sample| {
            let wrong = &comparison.as_ref()?.wrong;
            // Attachments of different sizes have texels with the same coordinates.
            let of_shape = |m: &ChannelMismatch| {
                let mut attachments = scene.attachments.iter();
                let attachment = attachments.find(|a| a.name == m.attachment);
                attachment.is_some_and(|a| (a.size, a.samples) == (sample.size, sample.samples))
            };
            let here = |w: &&WrongTexel| {
                (w.x, w.y, w.sample) == (sample.x, sample.y, sample.sample)
                    && w.channels.iter().all(of_shape)
            };
            // Values that only the yardstick forbids are reported only with `--yardstick`.
            let found = wrong.iter().find(here)?;
            (found.band > Band::Imprecise).then_some(found.band)
        };
        let several = limits.alternatives(&scene.formats()).len() > 1;
        let encodings = |i: &ImageInfo| format!("{} {} {}", i.attachment, i.aspect, i.channels[0]);
        let heading = several.then(|| {
            let lines: Vec<String> = judgement.legal.images.iter().map(encodings).collect();
            let why = if self.frames.is_empty() {
                "one of several encodings that the API leaves open"
            } else {
                "the API leaves the encoding open, and this one fits the texel best"
            };
            format!("{} ({why})", lines.join(", "))
        });
        let counters = comparison.as_ref().map_or_else(Vec::new, |c| {
            let word = |band: Option<Band>| match band {
                None => "allowed",
                Some(Band::Imprecise) => "allowed, outside the yardstick",
                Some(_) => "NOT ALLOWED",
            };
            c.counters
                .iter()
                .map(|c| {
                    let (kind, legal) = (c.kind.name(), c.range());
                    format!(
                        "counter {} ({kind}): {} of {legal}: {}",
                        c.name,
                        c.actual,
                        word(c.band)
                    )
                })
                .collect()
        });
        let worst = comparison
            .iter()
            .flat_map(|c| &c.counters)
            .filter_map(|c| c.band)
            .max();
        Ok(StorySection {
            heading,
            told: self.samples(index, (&judgement.limits, &rules), band),
            counters: (counters, worst),
            yardstick: false,
        })
    }

    fn yardstick(&self, limits: &Limits) -> StorySection {
        let formats = self.case.judged_scene().formats();
        let first = limits.alternatives(&formats).swap_remove(0);
        let rules = Rules::yardstick(&first);
        StorySection {
            heading: Some("by the yardstick".to_owned()),
            told: self.samples(0, (&first, &rules), |_| None),
            counters: (Vec::new(), None),
            yardstick: true,
        }
    }

    /// Returns the stories of the requested samples. Samples whose stories differ only in the sample number
    /// share one.
    fn samples(
        &self,
        index: usize,
        by: (&Limits, &Rules),
        band: impl Fn(&Sample) -> Option<Band>,
    ) -> Vec<SharedStory> {
        let scene = match index {
            0 => self.case.judged_scene(),
            _ => &self.case.variants[index - 1].scene,
        };
        let [x, y] = self.texel;
        let mut shapes: Vec<([u32; 2], u32)> = Vec::new();
        for attachment in scene.read.iter().map(|i| &scene.attachments[*i]) {
            let shape = (attachment.size, attachment.samples);
            if x < shape.0[0] && y < shape.0[1] && !shapes.contains(&shape) {
                shapes.push(shape);
            }
        }
        let mut texels: Vec<SharedStory> = Vec::new();
        for (size, samples) in shapes {
            let from = texels.len();
            for sample in (0..samples).filter(|s| self.sample.is_none_or(|asked| asked == *s)) {
                let position = Sample {
                    size,
                    samples,
                    x,
                    y,
                    sample,
                };
                let band = band(&position);
                let frame = self.frames.get(index);
                let story = story_of_sample(self.case, index, by, position, (frame, band));
                match texels[from..]
                    .iter_mut()
                    .find(|other| other.is_alike(&story))
                {
                    Some(SharedStory { story: other, .. }) => {
                        if let Some(ruling) = &mut other.ruling {
                            ruling.samples.push(sample);
                        }
                    }
                    None => texels.push(SharedStory { story, band }),
                }
            }
        }
        texels
    }
}

impl SharedStory {
    /// Returns true if another sample's story is the same.
    fn is_alike(&self, story: &Story) -> bool {
        let ruling = story.ruling.as_ref().zip(self.story.ruling.as_ref());
        let same = ruling.is_some_and(|(ruling, mine)| {
            let mine = Ruling {
                samples: ruling.samples.clone(),
                ..mine.clone()
            };
            *ruling == mine
        });
        same && self.story.events == story.events
    }
}

impl StorySection {
    fn worst(&self) -> Option<Band> {
        let band = self.told.iter().filter_map(|t| t.band).max();
        band.max(self.counters.1)
    }
}

impl Explanation {
    fn worst(&self) -> Option<Band> {
        self.sections.iter().filter_map(StorySection::worst).max()
    }

    /// Returns the text: the worst verdict, the case, then all stories.
    fn text(&self, case: &Case) -> String {
        let texels = || {
            let sections = self.sections.iter().filter(|s| !s.yardstick);
            sections.flat_map(|s| &s.told)
        };
        let worst = texels().filter_map(|t| t.band).max();
        let first = texels().find(|t| t.band == worst);
        let mut text = String::new();
        // Writing to a string cannot fail.
        let lines = first.map(|t| [sentence(&t.story), judged_by(&t.story)]);
        for line in lines.into_iter().flatten().flatten() {
            let _ = writeln!(text, "{line}");
        }
        let _ = writeln!(text, "\n{}\n{}", case.id, case.about);
        let alone = texels().count() == 1 && self.sections.len() == 1;
        for section in &self.sections {
            text.push('\n');
            if let Some(heading) = &section.heading {
                let _ = writeln!(text, "{heading}");
            }
            for (i, texel) in section.told.iter().enumerate() {
                if i > 0 {
                    text.push('\n');
                }
                text.push_str(&if alone {
                    operations_text(&texel.story)
                } else {
                    story_text(&texel.story)
                });
            }
            for line in &section.counters.0 {
                let _ = writeln!(text, "{line}");
            }
        }
        text
    }
}

/// Draws the case on an adapter. The frame of the case's own scene comes first, then those of its variants.
fn draw(name: &str, file: Option<&Path>, case: &Case) -> Result<(Limits, Vec<Frame>), Failure> {
    let adapters = discover(&Query {
        names: &[name.to_owned()],
        file,
        ..Query::default()
    })?;
    refuse_absent(std::slice::from_ref(&name.to_owned()), &adapters)?;
    let Some((_, mut worker)) = adapters.ready.into_iter().next() else {
        return Err(Failure::usage(format!("adapter {name} cannot be used")));
    };
    let limits = worker.hello.limits.clone();
    if let Some(missing) = limits.missing(&case.requirements()) {
        return Err(Failure::usage(format!("{name} does not support {missing}")));
    }
    let frames = worker.draw(case).map_err(Failure::incomplete)?;
    if frames.is_empty() {
        return Err(Failure::incomplete("no frame was returned"));
    }
    Ok((limits, frames))
}

fn parse_texel(text: &str) -> Result<[u32; 2], String> {
    let wrong = || "expected X,Y: two whole numbers".to_owned();
    let (x, y) = text.split_once(',').ok_or_else(wrong)?;
    let number = |t: &str| t.trim().parse().map_err(|_| wrong());
    Ok([number(x)?, number(y)?])
}
