//! Render bundles.

use crate::gpu::Gpu;
use crate::objects::CallObjects;
use crate::{encode, format};
use etalon_backend::BackendError;
use etalon_webgpu::{CallList, RenderBundle};

/// Returns the bundles of a list, recorded with its other objects.
pub(crate) fn bundles(
    gpu: &Gpu,
    objects: &CallObjects<'_>,
    list: &CallList,
) -> Result<Vec<wgpu::RenderBundle>, BackendError> {
    let each = list.bundles.iter();
    each.map(|described| bundle(objects, gpu, described))
        .collect()
}

fn bundle(
    objects: &CallObjects<'_>,
    gpu: &Gpu,
    bundle: &RenderBundle,
) -> Result<wgpu::RenderBundle, BackendError> {
    let colors = bundle
        .color
        .iter()
        .map(|f| f.map(format::known).transpose());
    let colors = colors.collect::<Result<Vec<_>, _>>()?;
    let depth_stencil = bundle.depth_stencil.map(format::known).transpose()?;
    let mut encoder =
        gpu.device
            .create_render_bundle_encoder(&wgpu::RenderBundleEncoderDescriptor {
                label: None,
                color_formats: &colors,
                depth_stencil: depth_stencil.map(|format| wgpu::RenderBundleDepthStencil {
                    format,
                    depth_read_only: bundle.read_only,
                    stencil_read_only: bundle.read_only,
                }),
                sample_count: bundle.samples,
                multiview: None,
            });
    for command in &bundle.commands {
        encode::draw(objects, &mut encoder, command);
    }
    Ok(encoder.finish(&Default::default()))
}
