//! The states of a draw, each under a name. Every struct is taken apart field by field, so that none can
//! be left out.

use etalon_scene::{
    AddressMode, BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTarget,
    CompareFunction, DepthBias, DepthState, Draw, FilterMode, LogicOperation, Mesh, Multisample,
    Params, SampleCoverage, Sampler, Shader, StencilFace, StencilOperation, StencilState, Vertex,
    Viewport,
};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;

/// The states of a draw by name. Disabled states have no parts; vertices are not a state.
pub(super) fn states(draw: &Draw) -> BTreeMap<String, String> {
    let mut states = States::default();
    let Draw {
        mesh,
        topology,
        tessellation,
        provoking,
        shader,
        params: Params { color, back_color },
        early_tests,
        textures,
        sampler,
        counters,
        cull,
        front_face,
        polygon_mode,
        rasterizer_discard,
        viewport: Viewport { rect, depth: range },
        scissor,
        clip_distances,
        depth_bias:
            DepthBias {
                constant,
                slope,
                clamp,
            },
        depth_clamp,
        depth_bounds,
        depth,
        stencil,
        targets,
        logic,
        multisample:
            Multisample {
                mask,
                alpha_to_coverage,
                alpha_to_one,
                min_sample_shading,
                sample_coverage,
            },
        blend_constant,
        fetch,
    } = draw;
    states.put("indices", &mesh.indices);
    states.put("topology", topology);
    states.put("tessellation", tessellation);
    states.put("provoking", provoking);
    states.put("shader", shader);
    states.put("params.color", color);
    states.put("params.back_color", back_color);
    states.put("early_tests", early_tests);
    states.put("textures", textures);
    if let Some(Sampler {
        filter,
        address: [across, down],
    }) = sampler
    {
        states.put("sampler.filter", filter);
        states.put("sampler.address.across", across);
        states.put("sampler.address.down", down);
    }
    states.put("counters", counters);
    states.put("cull", cull);
    states.put("front_face", front_face);
    states.put("polygon_mode", polygon_mode);
    states.put("rasterizer_discard", rasterizer_discard);
    states.put("viewport.rect", rect);
    states.put("viewport.depth", range);
    states.put("scissor", scissor);
    states.put("clip_distances", clip_distances);
    states.put("depth_bias.constant", constant);
    states.put("depth_bias.slope", slope);
    states.put("depth_bias.clamp", clamp);
    states.put("depth_clamp", depth_clamp);
    states.put("depth_bounds", depth_bounds);
    states.put("depth", &depth.is_some());
    if let Some(DepthState { compare, write }) = depth {
        states.put("depth.compare", compare);
        states.put("depth.write", write);
    }
    states.put("stencil", &stencil.is_some());
    if let Some(StencilState { front, back }) = stencil {
        states.face("front", front);
        states.face("back", back);
    }
    for (i, target) in targets.iter().enumerate() {
        let ColorTarget {
            blend,
            advanced,
            write_mask,
        } = target;
        states.put(&format!("targets.{i}.advanced"), advanced);
        states.put(&format!("targets.{i}.write_mask"), write_mask);
        states.put(&format!("targets.{i}.blend"), &blend.is_some());
        if let Some(BlendState { color, alpha }) = blend {
            states.component(&format!("targets.{i}.blend.color"), color);
            states.component(&format!("targets.{i}.blend.alpha"), alpha);
        }
    }
    states.put("logic", logic);
    states.put("multisample.mask", mask);
    states.put("multisample.alpha_to_coverage", alpha_to_coverage);
    states.put("multisample.alpha_to_one", alpha_to_one);
    states.put("multisample.min_sample_shading", min_sample_shading);
    states.put("multisample.sample_coverage", &sample_coverage.is_some());
    if let Some(SampleCoverage { value, invert }) = sample_coverage {
        states.put("multisample.sample_coverage.value", value);
        states.put("multisample.sample_coverage.invert", invert);
    }
    states.put("blend_constant", blend_constant);
    states.put("fetch", fetch);
    states.0
}

/// The names of all states of a draw with one target.
pub(super) fn every_state() -> BTreeSet<String> {
    let face = StencilFace {
        compare: CompareFunction::Always,
        fail_op: StencilOperation::Keep,
        depth_fail_op: StencilOperation::Keep,
        pass_op: StencilOperation::Keep,
        read_mask: 0,
        write_mask: 0,
        reference: 0,
    };
    let component = BlendComponent {
        operation: BlendOperation::Add,
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::Zero,
    };
    let mesh = Mesh {
        vertices: Vec::<Vertex>::new(),
        indices: None,
    };
    let draw = Draw {
        sampler: Some(Sampler {
            filter: FilterMode::Nearest,
            address: [AddressMode::Repeat; 2],
        }),
        depth: Some(DepthState {
            compare: CompareFunction::Always,
            write: true,
        }),
        stencil: Some(StencilState {
            front: face,
            back: face,
        }),
        targets: vec![ColorTarget {
            blend: Some(BlendState {
                color: component,
                alpha: component,
            }),
            advanced: None,
            write_mask: 15,
        }],
        logic: Some(LogicOperation::Copy),
        multisample: Multisample {
            sample_coverage: Some(SampleCoverage {
                value: 1.0,
                invert: false,
            }),
            ..Multisample::default()
        },
        ..Draw::new(Shader::FlatColor, mesh, Viewport::whole([1, 1]))
    };
    states(&draw).into_keys().collect()
}

#[derive(Default)]
struct States(BTreeMap<String, String>);

impl States {
    fn put(&mut self, name: &str, value: &impl Debug) {
        self.0.insert(name.to_owned(), format!("{value:?}"));
    }

    /// Adds the states of a face. The face is the last part of a name, so that draws that differ in both faces differ in
    /// the state `stencil.compare`.
    fn face(&mut self, name: &str, face: &StencilFace) {
        let StencilFace {
            compare,
            fail_op,
            depth_fail_op,
            pass_op,
            read_mask,
            write_mask,
            reference,
        } = face;
        self.put(&format!("stencil.compare.{name}"), compare);
        self.put(&format!("stencil.fail_op.{name}"), fail_op);
        self.put(&format!("stencil.depth_fail_op.{name}"), depth_fail_op);
        self.put(&format!("stencil.pass_op.{name}"), pass_op);
        self.put(&format!("stencil.read_mask.{name}"), read_mask);
        self.put(&format!("stencil.write_mask.{name}"), write_mask);
        self.put(&format!("stencil.reference.{name}"), reference);
    }

    fn component(&mut self, name: &str, component: &BlendComponent) {
        let BlendComponent {
            operation,
            src_factor,
            dst_factor,
        } = component;
        self.put(&format!("{name}.operation"), operation);
        self.put(&format!("{name}.src_factor"), src_factor);
        self.put(&format!("{name}.dst_factor"), dst_factor);
    }
}
