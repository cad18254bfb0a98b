//! Explanations of texels, operation by operation, with rules and citations.

use crate::error::AssertError;
use etalon_case::Case;
use etalon_frame::{Band, ChannelMismatch, Frame, ImageInfo, Limits, Ruling, Story, WrongTexel};
use etalon_judge::{judge_texel, story_of_relation, story_of_sample};
use etalon_reference::{Rules, Sample};
use etalon_report::{judged_by, operations_text, sentence, story_text};
use etalon_scene::Scene;
use std::fmt::Write;

/// Refuses a texel or a sample that is in no attachment that the case reads back.
fn refuse_outside(scene: &Scene, [x, y]: [u32; 2], sample: Option<u32>) -> Result<(), AssertError> {
    let read = || scene.read.iter().map(|i| &scene.attachments[*i]);
    let inside = || read().filter(|a| x < a.size[0] && y < a.size[1]);
    if inside().next().is_none() {
        let sizes = read().map(|a| format!("{} is {} by {}", a.name, a.size[0], a.size[1]));
        return Err(AssertError::Outside(format!(
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
        return Err(AssertError::Outside(format!(
            "texel {x},{y} has no sample {sample}: {}",
            counts.collect::<Vec<_>>().join(", ")
        )));
    }
    Ok(())
}

/// The texel to explain, and the frames of the case's scenes, if they were drawn.
#[derive(Clone, Copy, Debug)]
pub struct AskedTexel<'a> {
    /// The case.
    pub case: &'a Case,
    /// Column and row, from the top left corner.
    pub texel: [u32; 2],
    /// The only sample to explain, from 0; all samples of the texel if `None`.
    pub sample: Option<u32>,
    /// The frame of the case's scene, then those of its variants; empty if nothing was drawn.
    pub frames: &'a [Frame],
}

/// The story that one or several samples share.
#[derive(Debug)]
struct SharedStory {
    story: Story,
    band: Option<Band>,
}

/// Stories under a heading.
#[derive(Debug)]
struct StorySection {
    heading: Option<String>,
    told: Vec<SharedStory>,
    /// The lines about counters, and the worst band of a counter.
    counters: (Vec<String>, Option<Band>),
    /// True if the section judges the quality of a value, not its legality.
    yardstick: bool,
}

/// The explanation of a texel.
#[derive(Debug)]
pub struct Explanation {
    sections: Vec<StorySection>,
}

impl AskedTexel<'_> {
    /// Explains the texel by the rules of the limits' API; with `yardstick` also by the band of good quality.
    ///
    /// # Errors
    /// If the texel or the sample is in no attachment that the case reads back, or if a frame does not fit the case.
    pub fn explain(&self, limits: &Limits, yardstick: bool) -> Result<Explanation, AssertError> {
        refuse_outside(self.case.judged_scene(), self.texel, self.sample)?;
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
    fn scene(&self, index: usize, limits: &Limits) -> Result<StorySection, AssertError> {
        let scene = match index {
            0 => self.case.judged_scene(),
            _ => &self.case.variants[index - 1].scene,
        };
        let frame = self.frames.get(index);
        let judged = judge_texel(self.case, index, limits, self.texel, frame);
        let (judgement, comparison) = judged.map_err(AssertError::Unfit)?;
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
    /// Returns the worst band that a value or a counter is outside of; `None` if all are allowed.
    pub fn worst(&self) -> Option<Band> {
        self.sections.iter().filter_map(StorySection::worst).max()
    }

    /// Returns the text: the worst verdict, the case, then all stories.
    pub fn text(&self, case: &Case) -> String {
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
