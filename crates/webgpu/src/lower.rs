//! The lowering of a scene.

use crate::attachment::Attached;
use crate::binding::BindGroups;
use crate::calls::{CallList, EncoderCommand, PassCommand, RenderBundle, RenderPass, buffer_usage};
use crate::counting::Counting;
use crate::device::Device;
use crate::draw::{GeometryBuffers, PreparedDraw, runs};
use crate::format::GpuFormat;
use crate::tables::Lowering;
use crate::{path, read};
use etalon_frame::{PathCommands, Requirement};
use etalon_scene::Scene;

/// Returns the calls of a scene on a device.
///
/// # Errors
/// If the device lacks something that the scene requires, which the error names.
pub fn lower(device: &Device, scene: &Scene) -> Result<CallList, Requirement> {
    if let Some(missing) = device.limits.missing(&scene.requirements()) {
        return Err(missing);
    }
    let scene = &*scene.on_path();
    let mut lowering = Lowering {
        device,
        list: CallList::default(),
    };
    let attachments = (0..scene.attachments.len())
        .map(|index| Attached::new(&mut lowering, scene, index))
        .collect::<Result<Vec<_>, _>>()?;
    let (counting, counted) = Counting::new(&mut lowering, scene);
    let pool = scene.pool.map(|pool| {
        let usage = buffer_usage::STORAGE | buffer_usage::COPY_DST;
        (lowering.buffer(usage, pool.bytes()), pool)
    });
    let mut groups = BindGroups::new(&mut lowering, scene, &attachments, &counting);
    groups.pool = pool.map(|(buffer, pool)| (buffer, pool.bytes()));
    let mut geometry = GeometryBuffers::new();
    let mut counted = counted.into_iter();
    let mut passes = Vec::new();
    for pass in &scene.passes {
        let mut draws = Vec::new();
        for (draw, counted) in pass.draws.iter().zip(counted.by_ref()) {
            let bound = groups.bind(&mut lowering, draw, counted.runs);
            let parts = (bound, counted);
            draws.push(PreparedDraw::new(
                &mut lowering,
                scene,
                pass,
                draw,
                parts,
                &mut geometry,
            )?);
        }
        passes.push(draws);
    }
    groups.finish(&mut lowering);
    geometry.finish(&mut lowering);

    let mut first = Vec::new();
    let mut initial = Vec::new();
    for attachment in &attachments {
        attachment.initialise(&mut lowering, &mut first, &mut initial);
    }
    initial.extend(counting.start());
    initial.extend(pool.map(|(buffer, pool)| EncoderCommand::ClearBuffer {
        buffer,
        size: pool.cleared_bytes(),
    }));
    let mut rendered = Vec::new();
    for (number, draws) in passes.iter().enumerate() {
        let commands = if scene.path.commands == PathCommands::Secondary {
            bundled(&mut lowering, scene, number, draws, &counting)?
        } else {
            each(scene, draws, &counting)
        };
        rendered.push(render_pass(
            &mut lowering,
            scene,
            number,
            &attachments,
            &counting,
            commands,
        ));
    }
    let mut rendered = rendered.into_iter();
    let mut frame: Vec<Vec<EncoderCommand>> = Vec::new();
    for passes in path::commands(scene) {
        let mut commands = std::mem::take(&mut initial);
        commands.extend(
            rendered
                .by_ref()
                .take(passes.len())
                .map(EncoderCommand::Pass),
        );
        frame.push(commands);
    }
    if let Some(last) = frame.last_mut() {
        last.extend(counting.finish());
    }
    lowering.list.first = first;
    lowering.list.frame = frame;
    read::plan(&mut lowering, scene, &attachments, &counting)?;
    Ok(lowering.list)
}

/// Returns the commands of a pass, draw by draw.
fn each(scene: &Scene, draws: &[PreparedDraw], counting: &Counting) -> Vec<PassCommand> {
    let mut commands = Vec::new();
    for draw in draws {
        commands.extend(counting.begin(draw.counted));
        commands.extend(draw.state(scene.path.state));
        commands.extend(draw.commands.iter().cloned().map(PassCommand::Draw));
        commands.extend(counting.end(draw.counted));
    }
    commands
}

/// Returns the commands of a pass whose draws are in bundles. Bundles set no dynamic state and no queries, so
/// each bundle contains draws that share these.
fn bundled(
    lowering: &mut Lowering<'_>,
    scene: &Scene,
    number: usize,
    draws: &[PreparedDraw],
    counting: &Counting,
) -> Result<Vec<PassCommand>, Requirement> {
    let pass = &scene.passes[number];
    let known = |i: &usize| GpuFormat::of(scene.attachments[*i].format);
    let colors = pass.color.iter().map(|index| {
        if scene.is_gap(*index) {
            Ok(None)
        } else {
            known(index).map(Some)
        }
    });
    let color = colors.collect::<Result<Vec<_>, _>>()?;
    let depth_stencil = pass.depth_stencil.as_ref().map(known).transpose()?;
    let mut commands = Vec::new();
    for run in runs(draws) {
        let shared = &draws[run.start];
        let bundle = RenderBundle {
            color: color.clone(),
            depth_stencil,
            read_only: pass.depth_stencil_read_only,
            samples: scene.pass_samples(pass),
            commands: draws[run].iter().flat_map(|d| d.commands.clone()).collect(),
        };
        lowering.list.bundles.push(bundle);
        commands.extend(counting.begin(shared.counted));
        commands.extend(shared.dynamic_state());
        commands.push(PassCommand::Execute(lowering.list.bundles.len() - 1));
        commands.extend(counting.end(shared.counted));
    }
    Ok(commands)
}

/// Returns a pass with these commands.
fn render_pass(
    lowering: &mut Lowering<'_>,
    scene: &Scene,
    number: usize,
    attachments: &[Attached],
    counting: &Counting,
    commands: Vec<PassCommand>,
) -> RenderPass {
    let pass = &scene.passes[number];
    let mut color = Vec::new();
    for (location, (index, resolve)) in pass.color.iter().zip(&pass.resolve).enumerate() {
        if scene.is_gap(*index) {
            color.push(None);
            continue;
        }
        let resolve = resolve.map(|target| lowering.view(attachments[target].target));
        let operations = pass.color_operations(location);
        let attachment = &attachments[*index];
        color.push(Some(attachment.as_color(
            lowering,
            Some(number),
            resolve,
            operations,
        )));
    }
    let depth_stencil = pass.depth_stencil.map(|index| {
        let attachment = &attachments[index];
        if pass.depth_stencil_read_only {
            attachment.as_read_only(lowering)
        } else {
            attachment.as_depth_stencil(lowering, Some(number), &pass.operations)
        }
    });
    RenderPass {
        color,
        depth_stencil,
        occlusion: counting.occlusion(),
        timed: [number == 0, number + 1 == scene.passes.len()],
        commands,
    }
}
