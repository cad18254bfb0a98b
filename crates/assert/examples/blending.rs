//! A test of a renderer that draws by `wgpu`: its blending is judged by what WebGPU allows.
//!
//! ```text
//! cargo run -p etalon-assert --example blending
//! ```

use etalon_assert::scene::AttachmentContents;
use etalon_assert::{Api, AssertError, Case, Frame, case, frame, judge_frame};
use std::error::Error;

/// The case that the renderer should pass: premultiplied colours over a picture.
const CASE: &str = "blend/textbook/porter-duff-source-over";

fn main() -> Result<(), Box<dyn Error>> {
    let renderer = Renderer::new()?;
    let case = case(CASE)?;
    for (name, blend) in [
        (
            "PREMULTIPLIED_ALPHA_BLENDING",
            wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING,
        ),
        ("ALPHA_BLENDING", wgpu::BlendState::ALPHA_BLENDING),
    ] {
        let frames = [renderer.draw(&case, blend)?];
        let judged = judge_frame(&case, &frames, Api::WebGpu, None)?;
        println!("{name}: {judged}");
        if !judged.is_allowed() {
            println!("{}", judged.explain()?);
        }
    }
    Ok(())
}

#[test]
fn source_over_is_premultiplied() -> Result<(), Box<dyn Error>> {
    let renderer = Renderer::new()?;
    let case = case(CASE)?;
    let allows = |blend| -> Result<bool, Box<dyn Error>> {
        let frames = [renderer.draw(&case, blend)?];
        Ok(judge_frame(&case, &frames, Api::WebGpu, None)?.is_allowed())
    };
    assert!(allows(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING)?);
    // Multiplies by alpha once more.
    assert!(!allows(wgpu::BlendState::ALPHA_BLENDING)?);
    Ok(())
}

/// The renderer under test. It fills a picture with a colour.
struct Renderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
}

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Bytes of a texel.
const TEXEL: u32 = 4;

impl Renderer {
    fn new() -> Result<Self, Box<dyn Error>> {
        let described = wgpu::InstanceDescriptor::new_without_display_handle();
        let instance = wgpu::Instance::new(described);
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
        Ok(Self { device, queue })
    }

    /// Draws the only draw of a case, which fills its only attachment.
    fn draw(&self, case: &Case, blend: wgpu::BlendState) -> Result<Frame, AssertError> {
        let (picture, draw) = (&case.scene.attachments[0], &case.scene.passes[0].draws[0]);
        let AttachmentContents::Texels(codes) = &picture.contents else {
            panic!("the case uploads texels");
        };
        let texels: Vec<u8> = codes.iter().map(|code| *code as u8).collect();
        let [width, height] = picture.size;
        let size = wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        };
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::COPY_DST
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let rows = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(width * TEXEL),
            rows_per_image: None,
        };
        self.queue
            .write_texture(texture.as_image_copy(), &texels, rows, size);

        let pipeline = self.pipeline(draw.params.color, blend);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let view = texture.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.draw(0..3, 0..1);
        drop(pass);

        let pitch = (width * TEXEL).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(pitch * height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let rows = wgpu::TexelCopyBufferLayout {
            bytes_per_row: Some(pitch),
            ..rows
        };
        let copied = wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: rows,
        };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), copied, size);
        self.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the device draws");
        let mapped = buffer.slice(..).get_mapped_range().expect("it is mapped");
        let read: Vec<u8> = mapped
            .chunks(pitch as usize)
            .flat_map(|row| row[..(width * TEXEL) as usize].to_vec())
            .collect();
        frame(&case.scene, &[], |_| read.clone())
    }

    fn pipeline(&self, [r, g, b, a]: [f32; 4], blend: wgpu::BlendState) -> wgpu::RenderPipeline {
        let shader = format!(
            "@vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {{
                return vec4f(f32(i & 1) * 4 - 1, f32(i >> 1) * 4 - 1, 0, 1);
            }}
            @fragment fn fs() -> @location(0) vec4f {{ return vec4f({r:?}, {g:?}, {b:?}, {a:?}); }}"
        );
        let module = self
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(shader.into()),
            });
        let target = wgpu::ColorTargetState {
            format: FORMAT,
            blend: Some(blend),
            write_mask: wgpu::ColorWrites::ALL,
        };
        self.device
            .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: None,
                layout: None,
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: None,
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: None,
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: None,
                    compilation_options: Default::default(),
                    targets: &[Some(target)],
                }),
                multiview_mask: None,
                cache: None,
            })
    }
}
