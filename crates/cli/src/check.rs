//! Checks cases without a driver: what they assert, how sharply, which inputs leave a driver a choice, and
//! which draws and tests change nothing.
//!
//! Legal sets need no frame, so a case file can be checked before any driver sees it. The limits are those of
//! the rasterizer with the coarsest vertex positions that an API allows: a value that they decide is decided
//! on every driver.

pub(crate) mod edges;
mod idle;
pub(crate) mod pairs;

use crate::processors::processors;
use edges::{Near, nearest};
use etalon_case::{Case, CaseError, CaseFile, CaseRef, Profile};
use etalon_cpu::limits_of;
use etalon_frame::threads::each;
use etalon_frame::{Api, Aspect, CodeInterval, LegalSet};
use etalon_record::Assertion;
use etalon_reference::{Judgement, Rules, judgements};
use idle::idle;
use std::collections::BTreeMap;

/// A case and what checking it found.
pub(crate) struct CheckedCase {
    pub(crate) id: String,
    /// The assertions of the legal set and of the yardstick, per aspect; empty if the case is measured rather
    /// than judged.
    pub(crate) assertions: Vec<Assertion>,
    /// Every channel that is read back, with true if anything is asserted of it.
    pub(crate) channels: BTreeMap<AttachmentChannel, bool>,
    /// True if a texel, a counter or a relation is asserted.
    pub(crate) asserts: bool,
    /// The mesh edge that passes so near a texel's centre that coverage is open.
    pub(crate) near: Option<Near>,
    /// True if points, lines or outlines are drawn; their vertices are at texel centres.
    pub(crate) outlines: bool,
}

/// A channel of an attachment.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct AttachmentChannel {
    pub(crate) attachment: String,
    pub(crate) aspect: Aspect,
    pub(crate) channel: usize,
}

/// A case file and what checking it found.
pub(crate) struct CheckedFile {
    pub(crate) name: String,
    pub(crate) errors: Vec<CaseError>,
    pub(crate) warnings: Vec<CaseError>,
    /// The cases of the profile.
    pub(crate) cases: Vec<CheckedCase>,
    /// The number of all cases of the file.
    pub(crate) all: usize,
}

/// Checks files: builds all of their cases, draws some of them on the rasterizer, and judges those of the profile.
pub(crate) fn check(files: &[CaseFile], profile: Profile) -> Vec<CheckedFile> {
    let mut checked: Vec<CheckedFile> = Vec::new();
    let looked_at = each(processors(), files, |file| {
        let errors = build_all(file);
        let mut warnings = file.warnings();
        if errors.is_empty() {
            warnings.extend(idle(file));
        }
        (errors, warnings)
    });
    for (file, (errors, warnings)) in files.iter().zip(looked_at) {
        checked.push(CheckedFile {
            name: file.name().to_owned(),
            errors,
            warnings,
            cases: Vec::new(),
            all: file.cases(Profile::Full).count(),
        });
    }
    let sound = files.iter().zip(&checked).enumerate();
    let sound = sound.filter(|(_, (_, checked))| checked.errors.is_empty());
    let cases: Vec<(usize, CaseRef<'_>)> = sound
        .flat_map(|(number, (file, _))| file.cases(profile).map(move |case| (number, case)))
        .collect();
    let judged = each(processors(), &cases, |(number, case)| {
        (*number, case.build().map(|c| check_case(&c)))
    });
    for (number, case) in judged {
        match case {
            Ok(case) => checked[number].cases.push(case),
            Err(error) => checked[number].errors.push(error),
        }
    }
    for (file, checked) in files.iter().zip(&mut checked) {
        checked.warnings.extend(of_cases(file, &checked.cases));
    }
    checked
}

/// Builds all cases of a file, and returns each error once.
fn build_all(file: &CaseFile) -> Vec<CaseError> {
    let mut errors: Vec<CaseError> = Vec::new();
    for error in file
        .cases(Profile::Full)
        .filter_map(|case| case.build().err())
    {
        if !errors
            .iter()
            .any(|e| (e.line, &e.key) == (error.line, &error.key))
        {
            errors.push(error);
        }
    }
    errors
}

/// Judges one case.
pub(crate) fn check_case(case: &Case) -> CheckedCase {
    let mut checked = CheckedCase {
        id: case.id.clone(),
        assertions: Vec::new(),
        channels: BTreeMap::new(),
        asserts: true,
        near: None,
        outlines: case
            .scene
            .passes
            .iter()
            .flat_map(|p| &p.draws)
            .any(edges::draws_outlines),
    };
    // The pictures of measured cases are large, and they assert only a distance.
    if case.measured {
        return checked;
    }
    let scene = case.judged_scene();
    let mut apis = [Api::Vulkan, Api::WebGpu, Api::OpenGl, Api::OpenGlEs].into_iter();
    while let Some(api) = apis.next()
        && (checked.channels.is_empty() || checked.channels.values().any(|asserted| !asserted))
    {
        let limits = limits_of(api);
        let judged = judgements(scene, &limits);
        let Some(first) = judged.first() else {
            break;
        };
        for judgement in &judged {
            note_channels(&judgement.legal, &mut checked.channels);
        }
        if api == Api::Vulkan {
            checked.assertions = assertions(first);
            checked.near = nearest(scene, &first.legal).filter(|_| case.relation.is_none());
        }
        let counters = first
            .legal
            .counters
            .iter()
            .any(|c| !c.range.is_open(c.kind));
        let relation = case.relation.as_ref();
        let related =
            relation.is_some_and(|r| Rules::invariance(&limits, r.invariance).value().is_some());
        checked.asserts =
            counters || related || checked.channels.values().any(|asserted| *asserted);
    }
    checked
}

fn assertions(judgement: &Judgement) -> Vec<Assertion> {
    let yardstick = judgement.yardstick.statistics();
    let legal = judgement.legal.statistics().iter();
    legal
        .map(|(aspect, legal)| {
            let channel = yardstick.iter().find(|(other, _)| other == aspect);
            Assertion::new(
                *aspect,
                *legal,
                channel.map_or_else(Default::default, |(_, codes)| *codes),
            )
        })
        .collect()
}

/// Records, for each channel that is read back, whether anything is asserted of it.
fn note_channels(legal: &LegalSet, channels: &mut BTreeMap<AttachmentChannel, bool>) {
    for image in &legal.images {
        let sets = legal.groups[image.group].distinct();
        for (channel, encoding) in image.channels.iter().enumerate() {
            let codes = CodeInterval::new(encoding.min_order(), encoding.max_order()).count();
            let asserted = sets.iter().any(|(set, times)| {
                *times > 0 && !set.is_open() && set.count(image.first_channel + channel) < codes
            });
            let key = AttachmentChannel {
                attachment: image.attachment.clone(),
                aspect: image.aspect,
                channel,
            };
            *channels.entry(key).or_default() |= asserted;
        }
    }
}

/// Returns the warnings that follow from a file's cases.
fn of_cases(file: &CaseFile, cases: &[CheckedCase]) -> Vec<CaseError> {
    let mut errors = Vec::new();
    let silent: Vec<&CheckedCase> = cases.iter().filter(|c| !c.asserts).collect();
    if let Some(first) = silent.first() {
        errors.push(file.warning(
            &[file.scene_key()],
            format!(
                "{} of {} judged cases assert nothing and can only be Open, such as {}: choose inputs that \
                 the specifications pin down",
                silent.len(),
                cases.len(),
                first.id
            ),
        ));
    }
    let mut channels: BTreeMap<&AttachmentChannel, bool> = BTreeMap::new();
    for (channel, asserted) in cases.iter().flat_map(|c| &c.channels) {
        *channels.entry(channel).or_default() |= asserted;
    }
    // If whole cases assert nothing, the warning above already says so.
    for (channel, _) in channels
        .iter()
        .filter(|(_, asserted)| !**asserted && silent.is_empty())
    {
        errors.push(file.warning(
            &[file.scene_key(), "read"],
            format!("no case asserts anything of {channel}: make its inputs exact, or do not read it back"),
        ));
    }
    let mut places: Vec<[usize; 2]> = Vec::new();
    // A mesh that is also drawn as an outline has its vertices at texel centres, as outlines need.
    let filled = !cases.iter().any(|c| c.outlines);
    for case in cases.iter().filter(|_| filled) {
        let Some(near) = &case.near else {
            continue;
        };
        if places.contains(&near.draw) {
            continue;
        }
        places.push(near.draw);
        let [pass, draw] = near.draw;
        let keys = [
            file.scene_key(),
            "passes",
            &pass.to_string(),
            "draws",
            &draw.to_string(),
            "mesh",
        ];
        errors.push(file.warning(
            &keys,
            format!(
                "an edge passes at {:.3} texels from the centre of texel {},{}, so that drivers may cover it or not, in \
                 {}: move the vertices, or use a mesh that keeps its edges off the centres",
                near.distance, near.texel[0], near.texel[1], case.id
            ),
        ));
    }
    errors
}

impl std::fmt::Display for AttachmentChannel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let name = self.aspect.channel(self.channel);
        write!(f, "{name} of `{}`", self.attachment)
    }
}
