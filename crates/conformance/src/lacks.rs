//! The capabilities that a driver lacks, by name, and the limits that remain.
//!
//! Drivers are described by what they lack, so that a capability that is new to the suite is expected of
//! all of them.

use etalon_frame::{Api, Feature, FormatSupport, Limits, ReadPath, Requirement, TextureFormat};

/// Names of features or formats, separated by spaces.
pub type LackNames = &'static [&'static str];

/// The capabilities that a driver lacks.
#[derive(Clone, Copy, Debug)]
pub struct Lacks {
    /// Features that it lacks.
    pub features: LackNames,
    /// Formats without textures.
    pub formats: LackNames,
    /// Formats that can only be fetched from.
    pub drawing: LackNames,
    /// Colour formats that can be drawn to but not blended into.
    pub blending: LackNames,
    /// Formats that can be drawn to, but not with four samples.
    pub samples: LackNames,
}

impl Lacks {
    /// Returns the limits of a driver that lacks exactly these.
    pub fn limits(&self, api: Api) -> Limits {
        let formats = TextureFormat::ALL.iter().copied();
        let formats = formats.filter(|f| !names(self.formats, f.name()));
        let features = Feature::ALL.iter().copied();
        let features = features.filter(|f| !names(self.features, f.name()));
        let four = vec![[96, 32], [224, 96], [32, 160], [160, 224]];
        Limits {
            sub_pixel_bits: 8,
            viewport_bits: Some(8),
            max_size: 4096,
            max_color_attachments: 4,
            formats: formats.map(|f| (f, self.support(api, f))).collect(),
            features: features.collect(),
            sample_positions: [(1, vec![[128, 128]]), (4, four)].into(),
            ..Limits::nothing(api)
        }
    }

    fn support(&self, api: Api, format: TextureFormat) -> FormatSupport {
        let name = format.name();
        let samples: &[u32] = match (names(self.drawing, name), names(self.samples, name)) {
            (true, _) => &[],
            (_, true) => &[1],
            _ => &[1, 4],
        };
        let blendable = format.is_color() && !format.is_integer() && !samples.is_empty();
        let shader = api == Api::OpenGlEs && format.has_depth();
        FormatSupport {
            samples: samples.to_vec(),
            blendable: blendable && !names(self.blending, name),
            depth: format.depth_encodings().iter().take(1).copied().collect(),
            read: [ReadPath::Copy, ReadPath::Shader][usize::from(shader)],
        }
    }

    /// Asserts that limits deny all these capabilities and no others.
    ///
    /// # Panics
    /// If they do not.
    pub fn check(&self, limits: &Limits) {
        let expected = self.limits(limits.api);
        let only = |by: &Limits, not_by: &Limits| -> Vec<String> {
            let requirements = requirements().into_iter();
            let only = requirements
                .filter(|r| by.missing(&[*r]).is_some() && not_by.missing(&[*r]).is_none());
            only.map(|r| r.to_string()).collect()
        };
        let (lost, gained) = (only(limits, &expected), only(&expected, limits));
        let same = lost.is_empty() && gained.is_empty();
        assert!(same, "lost: {lost:#?}, gained: {gained:#?}");
    }
}

/// Returns true if the lists have this name.
fn names(names: LackNames, name: &str) -> bool {
    names.iter().any(|list| list.split(' ').any(|n| n == name))
}

/// Returns everything that a driver can lack.
fn requirements() -> Vec<Requirement> {
    let features = Feature::ALL.iter().copied().map(Requirement::Feature);
    let mut requirements: Vec<_> = features.collect();
    for format in TextureFormat::ALL.iter().copied() {
        requirements.extend([
            Requirement::Format(format),
            Requirement::Drawing(format),
            Requirement::Blending(format),
            Requirement::Samples(format, 4),
        ]);
    }
    requirements
}
