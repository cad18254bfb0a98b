//! The rasterizer as an adapter with its limits.
//!
//! It draws a scene in one of two ways, with equal bits. The span code draws every scene, on the calling thread. The
//! tiles draw scenes of 64 by 64 texels or more whose draws all have kernels, on several threads. A tile keeps a range
//! around its depths and one around its stencil values, and a test that these decide costs nothing per texel.
//!
//! `etalon show CASE --kernels` lists the kernels. Planted bugs replace steps of the span code, so `etalon mutants`
//! uses it alone.

use crate::linear::SUB_PIXEL_BITS;
use crate::prepared::CpuScene;
use crate::raster::SAMPLES;
use crate::steps::Faithful;
use crate::surface::depth_encoding;
use crate::tiles::{KernelMachine, KernelPlan, TiledScene, lines};
use etalon_backend::{Backend, BackendError, Prepared};
use etalon_frame::{
    AdapterInfo, Api, ApiVersion, Feature, FormatSupport, Limits, PathValue, Property, ReadPath,
    TextureFormat, standard_sample_positions,
};
use etalon_scene::Scene;
use std::collections::BTreeSet;

/// The bits of sub-pixel precision that viewport bounds in 32-bit floats have at least, up to 128 texels.
const VIEWPORT_BITS: u8 = 16;

/// The least number of texels of a scene's largest attachment for the scene to be drawn in tiles.
const LEAST_TEXELS: usize = 64 * 64;

/// The rasterizer.
#[derive(Debug)]
pub struct CpuBackend {
    info: AdapterInfo,
    limits: Limits,
    /// The machine's resources for kernels; `None` draws every scene with the span code.
    tiles: Option<KernelMachine>,
}

impl CpuBackend {
    /// Returns the rasterizer with this adapter name.
    pub fn new(name: &str) -> Self {
        Self {
            tiles: Some(KernelMachine::whole()),
            ..Self::spans(name)
        }
    }

    /// Returns the rasterizer without its kernels: the span code draws every scene, on the calling thread.
    pub fn spans(name: &str) -> Self {
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
                offer: None,
            },
            limits: Limits {
                api: Api::Vulkan,
                version: ApiVersion::new(1, 4),
                // A line covers all samples of a texel or none, as in Bresenham's algorithm.
                properties: Property::ALL
                    .into_iter()
                    .filter(|property| *property != Property::LinesAreParallelograms)
                    .collect(),
                sub_pixel_bits: SUB_PIXEL_BITS,
                viewport_bits: Some(VIEWPORT_BITS),
                texel_bits: Some(8),
                max_size: 4096,
                max_storage: Some(1 << 32),
                max_color_attachments: 8,
                formats,
                features: Feature::ALL.into_iter().collect(),
                // No path changes the picture, so every path is drawn in the same way.
                paths: PathValue::all().into_iter().collect(),
                exempt: BTreeSet::new(),
                sample_positions: SAMPLES
                    .into_iter()
                    .map(|n| (n, standard_sample_positions(n)))
                    .collect(),
            },
            tiles: None,
        }
    }
}

/// The fewest sub-pixel bits that an API allows (Vulkan: Limits, `subPixelPrecisionBits`).
const COARSEST_BITS: u8 = 4;

/// Returns the rasterizer's limits by the rules of an API in its newest version, with the coarsest grid of vertices that it
/// allows.
pub fn limits_of(api: Api) -> Limits {
    let version = match api {
        Api::Vulkan => ApiVersion::new(1, 4),
        Api::OpenGl => ApiVersion::new(4, 6),
        Api::OpenGlEs => ApiVersion::new(3, 2),
        Api::WebGpu => ApiVersion::UNKNOWN,
    };
    Limits {
        api,
        version,
        sub_pixel_bits: COARSEST_BITS,
        ..CpuBackend::new("cpu").limits
    }
}

/// Returns a description of how a scene is drawn: a line with the kernels of each draw, or the reason why the
/// span code draws the scene.
pub fn kernels(scene: &Scene) -> Vec<String> {
    lines(scene, LEAST_TEXELS)
}

/// Prepares a scene of any size for its kernels.
///
/// # Errors
/// The reason why the span code draws the scene.
pub fn in_tiles(
    scene: &Scene,
    machine: KernelMachine,
) -> Result<impl Prepared + use<>, &'static str> {
    let plan = KernelPlan::new(scene, 0)?;
    Ok(TiledScene::new(scene.clone(), plan, machine))
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
        if let Some(machine) = self.tiles
            && let Ok(plan) = KernelPlan::new(scene, LEAST_TEXELS)
        {
            return Ok(Box::new(TiledScene::new(scene.clone(), plan, machine)));
        }
        Ok(Box::new(CpuScene::new(scene.clone(), Faithful)))
    }
}
