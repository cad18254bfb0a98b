//! Faults that a test plants between a list of calls and its device.

use crate::calls::{
    Access, CallList, DrawCommand, EncoderCommand, Filled, PassCommand, RenderPass, TextureView,
};
use crate::pipeline_state::PipelineState;
use etalon_backend::{CallFault, Fault};

/// Changes a list as a driver would that handles its calls wrongly. Some faults have no equivalent in a list
/// ([`CallFault::is_in`]).
pub fn plant(fault: Option<Fault>, list: &mut CallList) {
    let Some(Fault::Call(fault)) = fault else {
        return;
    };
    match fault {
        CallFault::LayerDropped => parts(list, |[level, _]| [level, 0]),
        CallFault::LevelDropped => parts(list, |[_, layer]| [0, layer]),
        CallFault::WriteMaskOpen => {
            let targets = list.pipelines.iter_mut();
            for target in targets
                .flat_map(|pipeline| &mut pipeline.state.targets)
                .flatten()
            {
                target.write_mask = 0xf;
            }
        }
        CallFault::GapEnds => {
            for pipeline in &mut list.pipelines {
                let targets = pipeline.state.targets.iter_mut();
                for target in targets.skip_while(|target| target.is_some()).flatten() {
                    target.write_mask = 0;
                }
            }
        }
        CallFault::ViewFormat => texture_formats(list),
        CallFault::SecondaryFirstDraw => {
            for bundle in &mut list.bundles {
                if let Some(first) = bundle.commands.iter().position(DrawCommand::is_draw) {
                    bundle.commands.remove(first);
                }
            }
        }
        CallFault::CompareKept => kept_state(list, |state, before| {
            if let (Some(state), Some(before)) = (&mut state.depth_stencil, before.depth_stencil) {
                state.depth_compare = before.depth_compare;
            }
        }),
        CallFault::DepthWriteKept => kept_state(list, |state, before| {
            if let (Some(state), Some(before)) = (&mut state.depth_stencil, before.depth_stencil) {
                state.depth_write = before.depth_write;
            }
        }),
        CallFault::CullKept => kept_state(list, |state, before| {
            state.primitive.cull = before.primitive.cull;
        }),
        _ => {
            for (number, pass) in passes(&mut list.frame).enumerate() {
                in_pass(fault, number, pass);
            }
        }
    }
}

fn passes(frame: &mut [Vec<EncoderCommand>]) -> impl Iterator<Item = &mut RenderPass> {
    frame
        .iter_mut()
        .flatten()
        .filter_map(|command| match command {
            EncoderCommand::Pass(pass) => Some(pass),
            _ => None,
        })
}

/// Changes the level and layer of the views that passes draw to.
fn parts(list: &mut CallList, change: impl Fn([u32; 2]) -> [u32; 2]) {
    let drawn: Vec<usize> = passes(&mut list.frame)
        .flat_map(|pass| {
            let depth_stencil = pass.depth_stencil.iter().map(|attachment| attachment.view);
            let color = pass
                .color
                .iter()
                .flatten()
                .map(|attachment| attachment.view);
            color.chain(depth_stencil).collect::<Vec<_>>()
        })
        .collect();
    for view in drawn {
        let TextureView { part, .. } = &mut list.views[view];
        *part = part.map(&change);
    }
}

/// Gives views the formats of their textures, and pipelines and bundles the formats of the views.
fn texture_formats(list: &mut CallList) {
    let mut formats = Vec::new();
    for view in &mut list.views {
        if let Some(format) = view.format.take() {
            formats.push((format, list.textures[view.texture].format));
        }
    }
    let targets = list.pipelines.iter_mut();
    let targets = targets
        .flat_map(|pipeline| &mut pipeline.state.targets)
        .flatten();
    let bundles = list
        .bundles
        .iter_mut()
        .flat_map(|bundle| &mut bundle.color)
        .flatten();
    for drawn in targets.map(|target| &mut target.format).chain(bundles) {
        let stored = formats.iter().find(|(format, _)| format == drawn);
        *drawn = stored.map_or(*drawn, |(_, stored)| *stored);
    }
}

/// Changes the state of each pipeline, given the state of the pipeline that its pass set before it.
fn kept_state(list: &mut CallList, change: impl Fn(&mut PipelineState, &PipelineState)) {
    let CallList {
        frame, pipelines, ..
    } = list;
    for pass in passes(frame) {
        let mut before: Option<PipelineState> = None;
        for command in &mut pass.commands {
            let PassCommand::Draw(DrawCommand::SetPipeline(place)) = command else {
                continue;
            };
            let mut pipeline = pipelines[*place].clone();
            let state = pipeline.state.clone();
            if let Some(before) = before.replace(state) {
                change(&mut pipeline.state, &before);
                pipelines.push(pipeline);
                *place = pipelines.len() - 1;
            }
        }
    }
}

fn in_pass(fault: CallFault, number: usize, pass: &mut RenderPass) {
    match fault {
        CallFault::LoadClears if number > 0 => {
            for color in pass.color.iter_mut().flatten() {
                color.operations.clear.get_or_insert([0.0; 4]);
            }
        }
        CallFault::LoadColorIgnored => {
            let colors = pass.color.iter_mut().flatten();
            colors.for_each(|color| color.operations.clear = None);
        }
        CallFault::LoadDepthIgnored => {
            if let Some(attachment) = &mut pass.depth_stencil {
                loaded(&mut attachment.depth);
            }
        }
        CallFault::LoadStencilIgnored => {
            if let Some(attachment) = &mut pass.depth_stencil {
                loaded(&mut attachment.stencil);
            }
        }
        CallFault::ResolveFirst => {
            let others = pass.color.iter_mut().skip(1).flatten();
            others.for_each(|color| color.resolve = None);
        }
        CallFault::ResolveSecondDropped => {
            if let Some(Some(second)) = pass.color.get_mut(1) {
                second.resolve = None;
            }
        }
        CallFault::LaterPassDraw if number > 0 => {
            let is_draw =
                |command: &PassCommand| matches!(command, PassCommand::Draw(c) if c.is_draw());
            if let Some(first) = pass.commands.iter().position(is_draw) {
                pass.commands.remove(first);
            }
        }
        _ => in_commands(fault, &mut pass.commands),
    }
}

/// Makes an access load the aspect instead of clearing it.
fn loaded<V>(access: &mut Access<V>) {
    if let Access::Written(Filled { clear, .. }) = access {
        *clear = None;
    }
}

fn in_commands(fault: CallFault, commands: &mut [PassCommand]) {
    let mut before = None;
    for command in commands {
        let keeps = match command {
            PassCommand::SetViewport { .. } => fault == CallFault::ViewportKept,
            PassCommand::SetScissorRect(_) => fault == CallFault::ScissorKept,
            PassCommand::SetBlendConstant(_) => fault == CallFault::BlendConstantKept,
            PassCommand::SetStencilReference(_) => fault == CallFault::StencilReferenceKept,
            _ => false,
        };
        if keeps {
            let given = command.clone();
            if let Some(before) = before.replace(given) {
                *command = before;
            }
        }
        match command {
            PassCommand::SetScissorRect([x, _, width, _])
                if fault == CallFault::ScissorEdge && (*x + *width).is_multiple_of(16) =>
            {
                *width = width.saturating_sub(1);
            }
            PassCommand::Draw(draw) => in_draw(fault, draw),
            _ => {}
        }
    }
}

fn in_draw(fault: CallFault, draw: &mut DrawCommand) {
    let (DrawCommand::Draw { instances, .. } | DrawCommand::DrawIndexed { instances, .. }) = draw
    else {
        return;
    };
    match fault {
        CallFault::FirstInstance => *instances = 0..instances.end - instances.start,
        CallFault::SecondInstance => instances.end = instances.end.min(instances.start + 1),
        _ => {}
    }
    let DrawCommand::DrawIndexed {
        indices,
        base_vertex,
        ..
    } = draw
    else {
        return;
    };
    match fault {
        CallFault::BaseVertex => *base_vertex = 0,
        CallFault::IndexOffset => *indices = 0..indices.end - indices.start,
        CallFault::FirstIndex if indices.start > 0 && indices.start < indices.end => {
            indices.start += 1;
        }
        _ => {}
    }
}
