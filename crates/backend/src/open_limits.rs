//! The limits of programs and of files, which say less about a device than a driver does.

use crate::texels::{has_form, read_path};
use etalon_frame::{Feature, Limits, Requirement, TextureFormat};
use std::collections::BTreeSet;

/// Returns limits for frames in files, whose depths are floats and whose colours have a layout in WebGPU. The files do
/// not say how depths were stored.
pub fn file_limits(mut limits: Limits) -> Limits {
    limits.formats.retain(|format, _| has_form(*format));
    for (format, support) in &mut limits.formats {
        support.depth = format.depth_encodings().to_vec();
        support.read = read_path(*format);
    }
    limits.exempt = exempt();
    limits
}

/// Returns everything: a program may lack what its API requires of drivers.
pub fn exempt() -> BTreeSet<Requirement> {
    let formats = TextureFormat::ALL.into_iter().flat_map(|format| {
        let samples = [2, 4, 8, 16].map(|n| Requirement::Samples(format, n));
        let uses = [
            Requirement::Format(format),
            Requirement::Drawing(format),
            Requirement::Blending(format),
        ];
        uses.into_iter().chain(samples)
    });
    Feature::ALL
        .map(Requirement::Feature)
        .into_iter()
        .chain(formats)
        .chain([
            Requirement::Size(u32::MAX),
            Requirement::ColorAttachments(u32::MAX),
        ])
        .collect()
}
