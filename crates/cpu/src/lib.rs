//! The pipeline as a rasterizer backend: plain arithmetic in lanes, no dispatch per texel.
//!
//! It draws what every scene of the suite can ask for, follows Direct3D's top-left rule and
//! nearest snapping at 8 sub-pixel bits, and is judged like any driver, by Vulkan's rules.

mod mutants;
mod raster;
mod sampling;
mod span;
mod steps;
mod surface;

pub use mutants::{Mutant, MutantBackend, mutants};

use etalon_backend::{AdapterInfo, Backend, BackendError, FrameTime, Prepared};
use etalon_case::Scene;
use etalon_frame::{
    Api, Aspect, ChannelEncoding, CounterKind, Feature, FormatSupport, Frame, Image, Limits,
    ReadPath, TextureFormat, standard_sample_positions,
};
use span::Counted;
use std::time::Instant;
use steps::{Faithful, Steps};
use surface::Surface;

/// Bits of sub-pixel precision.
const SUB_PIXEL_BITS: u8 = 8;

/// Sample counts.
const SAMPLES: [u32; 5] = [1, 2, 4, 8, 16];

/// The rasterizer.
#[derive(Debug)]
pub struct CpuBackend {
    info: AdapterInfo,
    limits: Limits,
}

impl CpuBackend {
    /// The rasterizer under an adapter name.
    pub fn new(name: &str) -> Self {
        let formats = TextureFormat::ALL
            .into_iter()
            .map(|format| {
                let support = FormatSupport {
                    samples: SAMPLES.to_vec(),
                    blendable: format.is_color() && !format.is_integer(),
                    depth: depth_encoding(format).into_iter().collect(),
                    read: ReadPath::Copy,
                };
                (format, support)
            })
            .collect();
        Self {
            info: AdapterInfo {
                name: name.to_owned(),
                backend: "cpu".to_owned(),
                device: "etalon rasterizer".to_owned(),
                driver: "etalon".to_owned(),
                driver_version: env!("CARGO_PKG_VERSION").to_owned(),
                driver_id: concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"))
                    .to_owned(),
                api_version: "the reference pipeline in 32-bit floats".to_owned(),
                software: true,
            },
            limits: Limits {
                api: Api::Vulkan,
                sub_pixel_bits: SUB_PIXEL_BITS,
                max_size: 4096,
                max_color_attachments: 8,
                formats,
                features: Feature::ALL.into_iter().collect(),
                sample_positions: SAMPLES
                    .into_iter()
                    .map(|n| (n, standard_sample_positions(n)))
                    .collect(),
            },
        }
    }
}

/// The encoding in which the rasterizer stores a format's depth.
fn depth_encoding(format: TextureFormat) -> Option<ChannelEncoding> {
    format.depth_encodings().first().copied()
}

impl Backend for CpuBackend {
    fn adapter(&self) -> &AdapterInfo {
        &self.info
    }

    fn limits(&self) -> &Limits {
        &self.limits
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        if let Some(missing) = self.limits.missing(&scene.requirements()) {
            return Err(BackendError::NotSupported(missing));
        }
        Ok(Box::new(PreparedScene::new(scene.clone(), Faithful)))
    }
}

#[derive(Debug)]
struct PreparedScene<S> {
    scene: Scene,
    surfaces: Vec<Surface>,
    counters: Vec<Counted>,
    steps: S,
}

impl<S> PreparedScene<S> {
    fn new(scene: Scene, steps: S) -> Self {
        Self {
            scene,
            surfaces: Vec::new(),
            counters: Vec::new(),
            steps,
        }
    }
}

impl<S: Steps> Prepared for PreparedScene<S> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let start = Instant::now();
        self.surfaces = self
            .scene
            .attachments
            .iter()
            .map(|a| Surface::new(a, &self.steps))
            .collect();
        let counters = self.scene.counters.iter();
        self.counters = counters.map(|c| (c.kind, 0)).collect();
        for pass in &self.scene.passes {
            for draw in &pass.draws {
                let (surfaces, counters) = (&mut self.surfaces, &mut self.counters);
                raster::draw(&self.scene, pass, draw, surfaces, counters, &self.steps);
            }
            for (source, target) in pass.color.iter().zip(&pass.resolve) {
                if let Some(target) = target {
                    let both = self.surfaces.get_disjoint_mut([*source, *target]);
                    let [source, target] = both.map_err(|_| {
                        BackendError::Internal("an attachment is resolved to itself".to_owned())
                    })?;
                    target.resolve_from(source, &self.steps);
                }
            }
        }
        let elapsed = start.elapsed();
        Ok(FrameTime {
            cpu: elapsed,
            gpu: None,
            wall: elapsed,
        })
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        if self.surfaces.is_empty() {
            return Err(BackendError::Internal(
                "read back before anything was drawn".to_owned(),
            ));
        }
        let mut frame = Frame::default();
        for index in &self.scene.read {
            let attachment = &self.scene.attachments[*index];
            for aspect in attachment.format.aspects() {
                let channels = match aspect {
                    Aspect::Color => attachment.format.color_channels().to_vec(),
                    Aspect::Depth => depth_encoding(attachment.format).into_iter().collect(),
                    Aspect::Stencil => vec![ChannelEncoding::Uint(8)],
                };
                frame.images.push(Image {
                    attachment: attachment.name.clone(),
                    aspect: *aspect,
                    size: attachment.size,
                    samples: attachment.samples,
                    channels,
                    read: ReadPath::Copy,
                    codes: self.surfaces[*index].codes(*aspect),
                });
            }
        }
        frame.counters = self
            .counters
            .iter()
            .map(|(kind, count)| match kind {
                CounterKind::AnySamplesPassed => *count.min(&1),
                _ => *count,
            })
            .collect();
        Ok(frame)
    }
}

#[cfg(test)]
mod tests;
