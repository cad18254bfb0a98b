//! The lists of the built-in cases.

use crate::device::Abilities;
use crate::{
    Access, Binding, CallList, Device, DrawCommand, EncoderCommand, PassCommand, RenderPass,
    buffer_usage, lower,
};
use etalon_backend::Backend;
use etalon_case::{Library, Profile};
use etalon_cpu::CpuBackend;
use etalon_frame::{Feature, PathDraws, PathValue};
use etalon_scene::Scene;
use std::collections::BTreeSet;

/// Returns a device that supports what WebGPU has.
fn device() -> Device {
    let mut limits = CpuBackend::new("cpu").limits().clone();
    limits.formats.retain(|format, _| crate::is_known(*format));
    for support in limits.formats.values_mut() {
        support.samples.retain(|samples| matches!(samples, 1 | 4));
    }
    limits.features = BTreeSet::from([
        Feature::BaseVertex,
        Feature::CentroidInterpolation,
        Feature::ClipDistances,
        Feature::DepthBiasClamp,
        Feature::DepthClamp,
        Feature::DualSourceBlending,
        Feature::FirstInstance,
        Feature::FirstProvokingVertex,
        Feature::FractionalViewport,
        Feature::FragmentShaderAbsent,
        Feature::FragmentStorage,
        Feature::IndependentBlend,
        Feature::LinearInterpolation,
        Feature::SampleInterpolation,
        Feature::SampleMaskInput,
        Feature::SampleMaskOutput,
        Feature::SampleShading,
        Feature::StorageCounters,
        Feature::ViewportOutside,
    ]);
    let abilities = Abilities {
        copies: true,
        casts: true,
        layers: true,
    };
    limits.paths = crate::path::paths(true, abilities, &limits.features);
    Device {
        limits,
        abilities,
        max_texture_2d: 8192,
        max_texture_3d: 2048,
        uniform_alignment: 256,
        storage_alignment: 256,
        indirect_first_instance: true,
    }
}

/// Calls a function with the scenes of cases from every file, and their lists. Returns the number of lists.
fn each_list(device: &Device, mut check: impl FnMut(&str, &Scene, &CallList)) -> usize {
    let library = Library::built_in();
    let mut lowered = 0;
    for (number, found) in library.cases(Profile::Quick).enumerate() {
        if number % 3 != 0 {
            continue;
        }
        let case = found.build().expect("a built-in case");
        if let Ok(list) = lower(device, &case.scene) {
            lowered += 1;
            check(&case.id.to_string(), &case.scene, &list);
        }
    }
    lowered
}

fn commands(list: &CallList) -> impl Iterator<Item = &EncoderCommand> {
    let frame = list.frame.iter().flatten();
    list.first.iter().chain(frame).chain(&list.read)
}

/// Returns the passes of the frame.
fn passes(list: &CallList) -> impl Iterator<Item = &RenderPass> {
    commands(list).filter_map(|command| match command {
        EncoderCommand::Pass(pass) => Some(pass),
        _ => None,
    })
}

fn draws(list: &CallList) -> impl Iterator<Item = &DrawCommand> {
    let in_passes = passes(list).flat_map(|pass| &pass.commands);
    let in_passes = in_passes.filter_map(|command| match command {
        PassCommand::Draw(command) => Some(command),
        _ => None,
    });
    in_passes.chain(list.bundles.iter().flat_map(|bundle| &bundle.commands))
}

#[test]
fn every_list_names_only_what_it_holds() {
    let device = device();
    let lowered = each_list(&device, |case, _, list| {
        let buffer = |place: usize, usage: u32| {
            let found = &list.buffers[place];
            assert_eq!(found.usage & usage, usage, "{case}: buffer {place}");
            found.size
        };
        for view in &list.views {
            let texture = &list.textures[view.texture];
            if let Some([level, layer]) = view.part {
                assert!(level < texture.levels && layer < texture.size[2], "{case}");
            }
        }
        for described in &list.buffers {
            assert!(described.contents.len() as u64 <= described.size, "{case}");
            assert_eq!(described.contents.len() % 4, 0, "{case}");
        }
        for group in &list.groups {
            assert_eq!(
                group.entries.len(),
                list.layouts[group.layout].len(),
                "{case}"
            );
            for (_, resource) in &group.entries {
                match *resource {
                    Binding::Buffer {
                        buffer,
                        offset,
                        size,
                    } => assert!(offset + size <= list.buffers[buffer].size, "{case}"),
                    Binding::View(view) => assert!(view < list.views.len(), "{case}"),
                    Binding::Sampler(sampler) => assert!(sampler < list.samplers.len(), "{case}"),
                }
            }
        }
        for pipeline in &list.pipelines {
            let _ = &list.shaders[pipeline.shader];
            assert!(
                pipeline
                    .layout
                    .is_none_or(|layout| layout < list.layouts.len()),
                "{case}"
            );
        }
        for command in draws(list) {
            match command {
                DrawCommand::SetPipeline(pipeline) => {
                    assert!(*pipeline < list.pipelines.len(), "{case}");
                }
                DrawCommand::SetBindGroup { group, .. } => {
                    assert!(*group < list.groups.len(), "{case}");
                }
                DrawCommand::SetVertexBuffer {
                    buffer: b, place, ..
                } => assert!(place.end <= buffer(*b, buffer_usage::VERTEX), "{case}"),
                DrawCommand::SetIndexBuffer {
                    buffer: b, place, ..
                } => assert!(place.end <= buffer(*b, buffer_usage::INDEX), "{case}"),
                DrawCommand::DrawIndirect { buffer: b, offset }
                | DrawCommand::DrawIndexedIndirect { buffer: b, offset } => {
                    assert!(offset + 16 <= buffer(*b, buffer_usage::INDIRECT), "{case}");
                }
                DrawCommand::Draw { .. } | DrawCommand::DrawIndexed { .. } => {}
            }
        }
        for command in commands(list) {
            if let EncoderCommand::Download { to, .. } = command {
                assert_eq!(to.buffer, list.output, "{case}");
                assert!(to.offset < list.reading.bytes, "{case}");
            }
        }
        let mapped = buffer(list.output, buffer_usage::MAP_READ);
        assert!(list.reading.bytes <= mapped, "{case}");
    });
    assert!(lowered > 400, "{lowered} cases were lowered");
}

#[test]
fn every_draw_of_a_scene_is_in_its_list() {
    let device = device();
    each_list(&device, |case, scene, list| {
        let scene = scene.on_path();
        let drawn = list
            .frame
            .iter()
            .flatten()
            .filter_map(|command| match command {
                EncoderCommand::Pass(pass) => Some(pass),
                _ => None,
            })
            .flat_map(|pass| &pass.commands)
            .filter_map(|command| match command {
                PassCommand::Draw(command) => Some(command),
                _ => None,
            })
            .chain(list.bundles.iter().flat_map(|bundle| &bundle.commands))
            .filter(|command| command.is_draw());
        let asked: usize = scene.passes.iter().map(|pass| pass.draws.len()).sum();
        assert_eq!(drawn.count(), asked, "{case}");
        let timed: Vec<_> = passes(list).filter(|pass| pass.timed[0]).collect();
        assert_eq!(timed.len(), usize::from(!scene.passes.is_empty()), "{case}");
    });
}

#[test]
fn a_call_list_survives_json() {
    let device = device();
    each_list(&device, |case, _, list| {
        let text = serde_json::to_string(list).expect("a list is JSON");
        let back: CallList = serde_json::from_str(&text).expect("JSON of a list");
        assert_eq!(back, *list, "{case}");
    });
}

#[test]
fn read_back_bytes_make_a_whole_frame_or_none() {
    let device = device();
    each_list(&device, |case, scene, list| {
        let bytes: Vec<u8> = (0..list.reading.bytes).map(|i| (i % 251) as u8).collect();
        let frame = list.reading.frame(&bytes).expect("enough bytes");
        assert_eq!(frame.counters.len(), scene.counters.len(), "{case}");
        let aspects = scene
            .read
            .iter()
            .map(|i| scene.attachments[*i].format.aspects().len());
        assert_eq!(frame.images.len(), aspects.sum::<usize>(), "{case}");
        for image in &frame.images {
            let [width, height] = image.size.map(|side| side as usize);
            let codes = width * height * image.samples as usize * image.channels.len();
            assert_eq!(image.codes.len(), codes, "{case}");
        }
        assert_eq!(list.reading.frame(&bytes[1..]), None, "{case}");
    });
}

#[test]
fn a_feature_that_the_device_lacks_is_named() {
    let library = Library::built_in();
    let mut cases = library.cases(Profile::Full);
    let first_instance = |scene: &Scene| {
        let indirect = scene.path.draws == PathDraws::Indirect;
        let mut draws = scene.passes.iter().flat_map(|pass| &pass.draws);
        indirect && draws.any(|draw| draw.call().first_instance > 0)
    };
    let scene = cases.find_map(|found| {
        let scene = found.build().ok()?.scene;
        first_instance(&scene).then_some(scene)
    });
    let scene = scene.expect("a case of indirect draws from another instance on");
    let complete = device();
    assert!(lower(&complete, &scene).is_ok());
    let poorer = Device {
        indirect_first_instance: false,
        ..complete
    };
    let missing = lower(&poorer, &scene).expect_err("a feature is missing");
    let value = PathValue::Draws(PathDraws::Indirect);
    assert_eq!(missing, etalon_frame::Requirement::Path(value));
}

#[test]
fn read_only_passes_write_no_aspect() {
    let device = device();
    let mut found = 0;
    each_list(&device, |case, scene, list| {
        let read_only = scene
            .passes
            .iter()
            .filter(|pass| pass.depth_stencil_read_only);
        let attached = passes(list).filter_map(|pass| pass.depth_stencil);
        let kept = attached.filter(|a| {
            let depth = matches!(a.depth, Access::Absent | Access::ReadOnly);
            depth && matches!(a.stencil, Access::Absent | Access::ReadOnly)
        });
        let expected = read_only
            .filter(|pass| pass.depth_stencil.is_some())
            .count();
        assert_eq!(kept.count(), expected, "{case}");
        found += expected;
    });
    assert!(found > 0, "no case has a read-only pass");
}
