//! The objects of a list of calls.

use crate::gpu::{BufferLease, Gpu, TextureLease};
use etalon_backend::BackendError;
use etalon_webgpu::{BindGroup, Binding, CallList, QueryType};
use wgpu::BufferUsages;

/// The objects of a list of calls, at the indices of their descriptions.
pub(crate) struct CallObjects<'a> {
    pub(crate) textures: Vec<TextureLease<'a>>,
    pub(crate) views: Vec<wgpu::TextureView>,
    pub(crate) buffers: Vec<BufferLease<'a>>,
    pub(crate) query_sets: Vec<wgpu::QuerySet>,
    samplers: Vec<wgpu::Sampler>,
    pub(crate) groups: Vec<wgpu::BindGroup>,
    pub(crate) pipelines: Vec<wgpu::RenderPipeline>,
    /// Empty until the other objects exist, with which bundles are recorded.
    pub(crate) bundles: Vec<wgpu::RenderBundle>,
}

impl<'a> CallObjects<'a> {
    /// Creates the objects of a list and fills its buffers.
    pub(crate) fn new(gpu: &'a Gpu, list: &CallList) -> Result<Self, BackendError> {
        let textures = list.textures.iter().map(|texture| gpu.texture(texture));
        let textures = textures.collect::<Result<Vec<_>, _>>()?;
        let views = list
            .views
            .iter()
            .map(|view| textures[view.texture].view(*view));
        let views = views.collect::<Result<_, _>>()?;
        let buffers = list.buffers.iter().map(|buffer| {
            let usage = BufferUsages::from_bits_truncate(buffer.usage);
            let made = gpu.buffer(usage, buffer.size);
            if !buffer.contents.is_empty() {
                gpu.queue.write_buffer(&made, 0, &buffer.contents);
            }
            made
        });
        let buffers = buffers.collect();
        gpu.errors.check("making attachments")?;
        let query_sets = list.query_sets.iter().map(|set| {
            gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: match set.ty {
                    QueryType::Occlusion => wgpu::QueryType::Occlusion,
                    QueryType::FragmentInvocations => wgpu::QueryType::PipelineStatistics(
                        wgpu::PipelineStatisticsTypes::FRAGMENT_SHADER_INVOCATIONS,
                    ),
                },
                count: set.count,
            })
        });
        let query_sets = query_sets.collect();
        gpu.errors.check("making counters")?;
        let samplers = list.samplers.iter();
        let samplers = samplers.map(|sampler| gpu.pipelines.sampler(&gpu.device, *sampler));
        let mut objects = Self {
            samplers: samplers.collect::<Result<_, _>>()?,
            textures,
            views,
            buffers,
            query_sets,
            groups: Vec::new(),
            pipelines: Vec::new(),
            bundles: Vec::new(),
        };
        let groups = list
            .groups
            .iter()
            .map(|group| objects.group(gpu, list, group));
        objects.groups = groups.collect::<Result<_, _>>()?;
        let pipelines = list.pipelines.iter().map(|pipeline| {
            gpu.pipelines
                .pipeline(&gpu.device, &gpu.errors, list, pipeline)
        });
        objects.pipelines = pipelines.collect::<Result<_, _>>()?;
        Ok(objects)
    }

    fn group(
        &self,
        gpu: &Gpu,
        list: &CallList,
        group: &BindGroup,
    ) -> Result<wgpu::BindGroup, BackendError> {
        let entry = |(number, resource): &(u32, Binding)| wgpu::BindGroupEntry {
            binding: *number,
            resource: match *resource {
                Binding::Buffer {
                    buffer,
                    offset,
                    size,
                } => wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: &self.buffers[buffer],
                    offset,
                    size: wgpu::BufferSize::new(size),
                }),
                Binding::View(view) => wgpu::BindingResource::TextureView(&self.views[view]),
                Binding::Sampler(sampler) => {
                    wgpu::BindingResource::Sampler(&self.samplers[sampler])
                }
            },
        };
        let entries: Vec<_> = group.entries.iter().map(entry).collect();
        let layout = gpu
            .pipelines
            .layout(&gpu.device, &list.layouts[group.layout])?;
        Ok(gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout.bindings,
            entries: &entries,
        }))
    }
}
