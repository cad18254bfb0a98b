//! Programs: the suite's shaders through naga, and the two that read depth and stencil back.

use crate::context::{Context, refused};
use etalon_backend::BackendError;
use etalon_case::state::Shader;
use glow::HasContext;
use naga::ShaderStage;
use naga::back::glsl;
use naga::proc::BoundsCheckPolicies;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use std::collections::HashMap;

/// The uniform block's binding point.
pub(crate) const PARAMS_BINDING: u32 = 0;

/// Programs of one context, made at first need.
#[derive(Default)]
pub(crate) struct Programs {
    shaders: HashMap<Shader, glow::Program>,
    readers: HashMap<Reader, glow::Program>,
}

/// What a read-back program fetches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Reader {
    /// The bits of the depth that a shader sees.
    Depth,
    /// The stencil value.
    Stencil,
}

impl Programs {
    /// The program of one of the suite's shaders.
    pub(crate) fn shader(
        &mut self,
        context: &Context,
        shader: Shader,
    ) -> Result<glow::Program, BackendError> {
        if let Some(program) = self.shaders.get(&shader) {
            return Ok(*program);
        }
        let fail = |message| BackendError::Shader {
            shader: shader.name().to_owned(),
            message,
        };
        let translated = Translated::new(context, shader.wgsl()).map_err(fail)?;
        let program = link(
            context,
            shader.name(),
            &translated.vertex,
            &translated.fragment,
        )?;
        let gl = &context.gl;
        // SAFETY: the context is current and the program is linked.
        unsafe {
            gl.use_program(Some(program));
            for block in &translated.blocks {
                // A block that the compiler found unused has no index.
                if let Some(index) = gl.get_uniform_block_index(program, block) {
                    gl.uniform_block_binding(program, index, PARAMS_BINDING);
                }
            }
            for (name, unit) in &translated.textures {
                let location = gl.get_uniform_location(program, name);
                gl.uniform_1_i32(location.as_ref(), *unit as i32);
            }
        }
        self.shaders.insert(shader, program);
        Ok(program)
    }

    /// A program that draws what it fetches from texture unit 0, texel by texel.
    pub(crate) fn reader(
        &mut self,
        context: &Context,
        reader: Reader,
    ) -> Result<glow::Program, BackendError> {
        if let Some(program) = self.readers.get(&reader) {
            return Ok(*program);
        }
        let header = format!("#version {}\n", context.caps.glsl)
            + "precision highp float;\nprecision highp int;\n";
        let vertex = header.clone()
            + "void main() {\n\
               vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));\n\
               gl_Position = vec4(corner * 4.0 - 1.0, 0.5, 1.0);\n}\n";
        let (sampler, value) = match reader {
            Reader::Depth => ("sampler2D", "floatBitsToUint(texelFetch(source, at, 0).r)"),
            Reader::Stencil => ("usampler2D", "texelFetch(source, at, 0).r"),
        };
        let fragment = header
            + &format!(
                "uniform highp {sampler} source;\n\
                 layout(location = 0) out highp uint value;\n\
                 void main() {{\n\
                 ivec2 at = ivec2(gl_FragCoord.xy);\n\
                 value = {value};\n}}\n"
            );
        let name = match reader {
            Reader::Depth => "read depth",
            Reader::Stencil => "read stencil",
        };
        let program = link(context, name, &vertex, &fragment)?;
        // SAFETY: the context is current and the program is linked.
        unsafe {
            let gl = &context.gl;
            gl.use_program(Some(program));
            let location = gl.get_uniform_location(program, "source");
            gl.uniform_1_i32(location.as_ref(), 0);
        }
        self.readers.insert(reader, program);
        Ok(program)
    }
}

/// A shader in GLSL.
struct Translated {
    vertex: String,
    fragment: String,
    /// Names of uniform blocks.
    blocks: Vec<String>,
    /// Names of textures with their units: the binding less one.
    textures: Vec<(String, u32)>,
}

impl Translated {
    fn new(context: &Context, source: &str) -> Result<Self, String> {
        let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
        let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .map_err(|e| e.emit_to_string(source))?;
        let mut translated = Self {
            vertex: String::new(),
            fragment: String::new(),
            blocks: Vec::new(),
            textures: Vec::new(),
        };
        translated.vertex = translated.stage(context, &module, &info, ShaderStage::Vertex)?;
        translated.fragment = translated.stage(context, &module, &info, ShaderStage::Fragment)?;
        Ok(translated)
    }

    fn stage(
        &mut self,
        context: &Context,
        module: &naga::Module,
        info: &ModuleInfo,
        stage: ShaderStage,
    ) -> Result<String, String> {
        let options = glsl::Options {
            version: context.caps.glsl,
            writer_flags: if context.caps.clip_control {
                glsl::WriterFlags::empty()
            } else {
                glsl::WriterFlags::ADJUST_COORDINATE_SPACE
            },
            // Bindings are set by name, which every version can.
            ..glsl::Options::default()
        };
        let entry_point = if stage == ShaderStage::Vertex {
            "vs"
        } else {
            "fs"
        };
        let pipeline = glsl::PipelineOptions {
            shader_stage: stage,
            entry_point: entry_point.to_owned(),
            multiview: None,
        };
        let mut text = String::new();
        let reflection = glsl::Writer::new(
            &mut text,
            module,
            info,
            &options,
            &pipeline,
            BoundsCheckPolicies::default(),
        )
        .and_then(|mut writer| writer.write())
        .map_err(|e| e.to_string())?;
        self.blocks.extend(reflection.uniforms.into_values());
        for (name, mapping) in reflection.texture_mapping {
            let binding = module.global_variables[mapping.texture].binding.as_ref();
            let unit = binding
                .and_then(|b| b.binding.checked_sub(1))
                .ok_or_else(|| format!("texture `{name}` has no binding from 1 on"))?;
            self.textures.push((name, unit));
        }
        Ok(text)
    }
}

fn link(
    context: &Context,
    name: &str,
    vertex: &str,
    fragment: &str,
) -> Result<glow::Program, BackendError> {
    let gl = &context.gl;
    let fail = |message: String| BackendError::Shader {
        shader: name.to_owned(),
        message,
    };
    // SAFETY: the context is current and all objects are its own.
    unsafe {
        let program = gl.create_program().map_err(|e| refused("a program", e))?;
        for (stage, source) in [
            (glow::VERTEX_SHADER, vertex),
            (glow::FRAGMENT_SHADER, fragment),
        ] {
            let shader = gl
                .create_shader(stage)
                .map_err(|e| refused("a shader", e))?;
            gl.shader_source(shader, source);
            gl.compile_shader(shader);
            if !gl.get_shader_compile_status(shader) {
                let log = gl.get_shader_info_log(shader);
                gl.delete_shader(shader);
                gl.delete_program(program);
                return Err(fail(format!("{}\n{source}", log.trim())));
            }
            gl.attach_shader(program, shader);
            // The program keeps it.
            gl.delete_shader(shader);
        }
        gl.link_program(program);
        if !gl.get_program_link_status(program) {
            let log = gl.get_program_info_log(program);
            gl.delete_program(program);
            return Err(fail(log.trim().to_owned()));
        }
        Ok(program)
    }
}
