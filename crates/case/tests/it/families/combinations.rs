//! Properties of the families that combine states: what each needs to show its bugs.

use super::breadth::all_cases;
use etalon_case::Case;
use etalon_frame::TextureFormat;
use etalon_scene::{Draw, LoadOperation, ResolveMode};
use std::collections::BTreeSet;

fn draws(case: &Case) -> Vec<&Draw> {
    case.scene.passes.iter().flat_map(|p| &p.draws).collect()
}

/// A draw without its inputs: two draws with the same state can share a pipeline and its dynamic state.
fn state(draw: &Draw) -> Draw {
    let mut state = draw.clone();
    state.mesh.vertices.clear();
    state.params = Default::default();
    state.textures.clear();
    state.counters.clear();
    state
}

#[test]
fn coverage_is_tested_with_a_first_target_that_stores_no_alpha() {
    let mut masked = BTreeSet::new();
    let mut formats = BTreeSet::new();
    for case in all_cases("multisample/coverage-targets/") {
        let draw = draws(&case)[0];
        if draw.multisample.alpha_to_coverage {
            let first = case.scene.passes[0].color[0];
            formats.insert(case.scene.attachments[first].format);
            masked.insert(draw.targets[0].write_mask & 0b1000 == 0);
            assert!(draw.targets.len() == 3, "{}", case.id);
        }
    }
    assert_eq!(masked.len(), 2);
    assert!(formats.contains(&TextureFormat::R8Unorm));
    assert!(formats.contains(&TextureFormat::Rg11b10Ufloat));
}

#[test]
fn draws_that_share_a_pipeline_come_back_to_their_state() {
    for case in all_cases("sequence/shared/") {
        let draws = draws(&case);
        // In the files whose draws count, viewports are only places.
        let states: Vec<Draw> = draws
            .iter()
            .map(|draw| Draw {
                viewport: draws[0].viewport,
                ..state(draw)
            })
            .collect();
        assert_eq!(states.len(), 4, "{}", case.id);
        assert!(
            states[0] == states[2] && states[1] == states[3],
            "{}",
            case.id
        );
        let value = |axis: &str| {
            let mut parts = case.id.split('/');
            parts.find_map(|part| part.strip_prefix(axis))
        };
        let same = value("first=") == value("then=");
        assert_eq!(states[0] == states[1], same, "{}", case.id);
    }
}

#[test]
fn a_discarded_draw_is_between_draws_of_one_state() {
    for case in all_cases("sequence/after-discarded/") {
        let draws = draws(&case);
        let [first, discarded, second, again, third] = draws.as_slice() else {
            panic!("{} has other draws", case.id);
        };
        assert!(
            state(first) == state(second) && state(first) == state(third),
            "{}",
            case.id
        );
        assert!(
            discarded == again && state(first) != state(discarded),
            "{}",
            case.id
        );
    }
}

#[test]
fn passes_without_colour_have_none_and_every_format_of_depth() {
    let mut seen = BTreeSet::new();
    for case in all_cases("early-z/colorless-") {
        let pass = &case.scene.passes[0];
        assert!(pass.color.is_empty(), "{}", case.id);
        let index = pass.depth_stencil.expect("it has depth or stencil");
        let attachment = &case.scene.attachments[index];
        seen.insert((attachment.format, attachment.samples));
    }
    assert_eq!(seen.len(), 6 * 2);
}

#[test]
fn passes_without_draws_come_last_and_each_kind_of_resolve_is_tried() {
    let (mut colors, mut depths, mut stencils) = (0, 0, 0);
    for case in all_cases("sequence/empty-") {
        let last = case.scene.passes.last().expect("a scene has passes");
        assert!(last.draws.is_empty(), "{}", case.id);
        colors += last.resolve.iter().flatten().count();
        if let Some(resolve) = &last.depth_stencil_resolve {
            depths += usize::from(resolve.depth != ResolveMode::None);
            stencils += usize::from(resolve.stencil != ResolveMode::None);
        }
        assert!(
            last.resolve_targets().all(|t| case.scene.read.contains(&t)),
            "{}",
            case.id
        );
    }
    assert!(colors > 0 && depths > 0 && stencils > 0);
}

#[test]
fn every_pair_of_targets_has_a_case_that_clears_one_and_loads_the_other() {
    let mut pairs = BTreeSet::new();
    for case in all_cases("sequence/loads-by-target/") {
        let pass = &case.scene.passes[0];
        let cleared = |target: usize| pass.color_operations(target).load != LoadOperation::Load;
        for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
            if cleared(a) && !cleared(b) {
                pairs.insert((a, b));
            }
        }
    }
    // The third is cleared only together with others.
    let missing: Vec<_> = (0..4)
        .flat_map(|a| (0..4).map(move |b| (a, b)))
        .filter(|(a, b)| a != b && !pairs.contains(&(*a, *b)))
        .collect();
    assert_eq!(missing, [(2, 1), (2, 3)]);
}

#[test]
fn the_middle_of_each_viewport_is_outside_its_attachment() {
    for case in all_cases("scissor/viewport-middle-outside/") {
        let pass = &case.scene.passes[0];
        let size = case.scene.pass_size(pass).map(|side| side as f32);
        let [x, y, width, height] = pass.draws[0].viewport.rect;
        let middle = [x + width / 2.0, y + height / 2.0];
        let inside = (0..2).all(|i| (0.0..=size[i]).contains(&middle[i]));
        assert!(!inside, "{}: {middle:?}", case.id);
    }
}

#[test]
fn vertices_are_beyond_each_side_of_the_viewport_and_inside() {
    for case in all_cases("scissor/viewport-beside/") {
        let draw = &case.scene.passes[0].draws[0];
        let places = draw.mesh.vertices.iter().map(|v| v.position);
        let side = |axis: usize, below: bool| {
            let beyond = |p: [f32; 4]| {
                if below {
                    p[axis] < -p[3]
                } else {
                    p[axis] > p[3]
                }
            };
            places.clone().any(beyond)
        };
        let both_sides = [0, 1].map(|axis| side(axis, true) && side(axis, false));
        let inside = |p: [f32; 4]| p[0].abs() < p[3] && p[1].abs() < p[3];
        let both = both_sides == [true; 2] && places.clone().filter(|p| inside(*p)).count() == 4;
        assert!(both, "{}", case.id);
    }
}

#[test]
fn many_references_have_no_bit_in_a_nonzero_write_mask() {
    let mut outside = 0;
    for case in all_cases("stencil/reference-outside-mask/") {
        let tested = draws(&case).pop().and_then(|draw| draw.stencil);
        let face = tested.expect("the family tests stencil").front;
        outside += u32::from(face.write_mask != 0 && face.reference & face.write_mask == 0);
    }
    assert!(outside > 100, "{outside}");
}
