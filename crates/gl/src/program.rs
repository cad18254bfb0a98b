//! Programs: the suite's shaders, translated by naga, and the shaders that read attachments back.

use crate::caps::{ADVANCED_BLEND, SECOND_VIEWPORT, STENCIL_EXPORT};
use crate::context::Context;
use crate::enums::blend_support;
use crate::own_pass::{self, OwnFetch};
use crate::path::Variant;
use etalon_backend::BackendError;
use etalon_scene::{
    AdvancedBlend, CONTROL_GLSL, EVALUATION_GLSL, EarlyTests, FrontFace, STENCIL_REFERENCE, Shader,
    Tessellation,
};
use glow::HasContext;
use naga::back::glsl;
use naga::proc::BoundsCheckPolicies;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, ResourceBinding, ShaderStage};
use std::collections::HashMap;

/// The binding point of the parameter block.
pub(crate) const PARAMS_BINDING: u32 = 0;
/// The binding point of the storage buffer: the counter of shader runs, or the pool.
pub(crate) const STORAGE_BINDING: u8 = 0;

/// The capabilities beyond WebGPU's core that the suite's shaders use.
const CAPABILITIES: Capabilities = Capabilities::DUAL_SOURCE_BLENDING
    .union(Capabilities::CLIP_DISTANCES)
    .union(Capabilities::MULTISAMPLED_SHADING)
    .union(Capabilities::EARLY_DEPTH_TEST);

/// The binding of the storage buffer in the suite's shaders.
const STORAGE: ResourceBinding = ResourceBinding {
    group: 0,
    binding: 3,
};

/// The programs of a context, created on first use.
#[derive(Default)]
pub(crate) struct Programs {
    shaders: HashMap<(Shader, FragmentForm, Variant, Option<FrontFace>), glow::Program>,
    readers: HashMap<(ReadType, View), (glow::Program, Option<glow::UniformLocation>)>,
}

/// The properties of a draw that change its fragment shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct FragmentForm {
    pub(crate) tests: EarlyTests,
    /// The advanced blend equation that the shader allows.
    pub(crate) blend: Option<AdvancedBlend>,
    /// The attachments that the shader fetches from the framebuffer in place of its textures.
    pub(crate) fetch: Option<OwnFetch>,
}

/// The type of the values that a read-back program fetches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum ReadType {
    /// The bits of colours or depths as floats.
    Floats,
    /// Stencil values or integer colours.
    Integers,
}

/// The kind of texture that a read-back program fetches from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum View {
    /// A view of a single image.
    Plain,
    /// A multisampled image.
    Samples,
    /// An array texture.
    Layers,
    /// A 3D texture.
    Slices,
}

impl Programs {
    /// Returns the program of one of the suite's shaders.
    pub(crate) fn shader(
        &mut self,
        context: &Context,
        shader: Shader,
        form: FragmentForm,
        variant: Variant,
        tessellation: Option<Tessellation>,
    ) -> Result<glow::Program, BackendError> {
        let order = tessellation.map(|t| t.order);
        let key = (shader, form, variant, order);
        if let Some(program) = self.shaders.get(&key) {
            return Ok(*program);
        }
        let fail = |message: String| BackendError::shader(shader.name(), message);
        let translated = GlslShader::new(context, shader, form.tests).map_err(fail)?;
        let vertex = varied(context, translated.vertex, variant);
        let mut stages = vec![(glow::VERTEX_SHADER, vertex)];
        let mut fragment = translated.fragment.map(|text| match form.blend {
            Some(mode) => allowing(context, &text, mode),
            None => text,
        });
        if let (Some(text), Some(fetch)) = (&mut fragment, form.fetch) {
            *text = own_pass::fetching(text, &translated.textures, fetch).map_err(fail)?;
        }
        stages.extend(fragment.map(|text| (glow::FRAGMENT_SHADER, text)));
        stages.extend(order.into_iter().flat_map(|o| patches(context, o)));
        let program = link(context, shader.name(), &stages)?;
        let gl = &context.gl;
        // SAFETY: the context is current and the program is linked.
        unsafe {
            gl.use_program(Some(program));
            for block in &translated.blocks {
                // If the compiler removed the block, it has no index.
                if let Some(index) = gl.get_uniform_block_index(program, block) {
                    gl.uniform_block_binding(program, index, PARAMS_BINDING);
                }
            }
            for (name, unit) in &translated.textures {
                let location = gl.get_uniform_location(program, name);
                gl.uniform_1_i32(location.as_ref(), *unit as i32);
            }
        }
        self.shaders.insert(key, program);
        Ok(program)
    }

    /// Returns a program that fetches texture unit 0 texel by texel, and the location of the uniform for its
    /// sample or layer.
    pub(crate) fn reader(
        &mut self,
        context: &Context,
        reader: ReadType,
        view: View,
    ) -> Result<(glow::Program, Option<glow::UniformLocation>), BackendError> {
        if let Some(known) = self.readers.get(&(reader, view)) {
            return Ok(*known);
        }
        let header = format!("#version {}\n", context.caps.glsl)
            + "precision highp float;\nprecision highp int;\n";
        let vertex = header.clone()
            + "void main() {\n\
               vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));\n\
               gl_Position = vec4(corner * 4.0 - 1.0, 0.5, 1.0);\n}\n";
        let prefix = match reader {
            ReadType::Floats => "",
            ReadType::Integers => "u",
        };
        let (sampler, place) = match view {
            View::Plain => ("sampler2D", "ivec2(gl_FragCoord.xy), 0"),
            View::Samples => ("sampler2DMS", "ivec2(gl_FragCoord.xy), number"),
            View::Layers => ("sampler2DArray", "ivec3(gl_FragCoord.xy, number), 0"),
            View::Slices => ("sampler3D", "ivec3(gl_FragCoord.xy, number), 0"),
        };
        let fetched = format!("texelFetch(source, {place})");
        let (name, value) = match reader {
            ReadType::Floats => ("read floats", format!("floatBitsToUint({fetched})")),
            ReadType::Integers => ("read integers", fetched),
        };
        let fragment = header
            + &format!(
                "uniform highp {prefix}{sampler} source;\n\
                 uniform highp int number;\n\
                 layout(location = 0) out highp uvec4 value;\n\
                 void main() {{\nvalue = {value};\n}}\n"
            );
        let stages = [
            (glow::VERTEX_SHADER, vertex),
            (glow::FRAGMENT_SHADER, fragment),
        ];
        let program = link(context, name, &stages)?;
        let gl = &context.gl;
        // SAFETY: the context is current and the program is linked.
        let location = unsafe {
            gl.use_program(Some(program));
            let source = gl.get_uniform_location(program, "source");
            gl.uniform_1_i32(source.as_ref(), 0);
            gl.get_uniform_location(program, "number")
        };
        let made = (program, location);
        self.readers.insert((reader, view), made);
        Ok(made)
    }
}

/// Returns the stages that tessellate patches of three vertices, the initial number of a context (OpenGL 4.6,
/// 10.1.15; ES 3.2, 10.1.12).
fn patches(context: &Context, order: FrontFace) -> [(u32, String); 2] {
    let (version, es) = (context.caps.glsl, context.caps.es);
    let extensions = context.caps.tessellation.unwrap_or_default();
    let precision = if es { "precision highp float;\n" } else { "" };
    let order = order.name();
    let stage = |text: &str| {
        // The first line declares another version.
        let body = text.split_once('\n').map_or(text, |(_, body)| body);
        format!("#version {version}\n{extensions}{precision}#define ORDER {order}\n{body}")
    };
    [
        (glow::TESS_CONTROL_SHADER, stage(CONTROL_GLSL)),
        (glow::TESS_EVALUATION_SHADER, stage(EVALUATION_GLSL)),
    ]
}

/// Returns a vertex shader in the variant of a draw's path.
fn varied(context: &Context, vertex: String, variant: Variant) -> String {
    let Some((head, body)) = vertex.split_once('\n') else {
        return vertex;
    };
    if variant == Variant::default() {
        return vertex;
    }
    let mut made = format!("{head}\n");
    let viewport = variant.second_viewport.then_some(SECOND_VIEWPORT);
    let layer = variant.layer.and(context.caps.vertex_layer);
    for extension in viewport.into_iter().chain(layer) {
        made += &format!("#extension {extension} : require\n");
    }
    made += &format!("#define main drawn\n{body}\n#undef main\nvoid main() {{\ndrawn();\n");
    if variant.mirrored {
        made += "gl_Position.y = -gl_Position.y;\n";
    }
    if variant.second_viewport {
        made += "gl_ViewportIndex = 1;\n";
    }
    if let Some(layer) = variant.layer {
        made += &format!("gl_Layer = {layer};\n");
    }
    made + "}\n"
}

/// Returns a fragment shader that allows an advanced blend equation, which naga does not support.
fn allowing(context: &Context, fragment: &str, mode: AdvancedBlend) -> String {
    let Some((version, body)) = fragment.split_once('\n') else {
        return fragment.to_owned();
    };
    // Directives must come first.
    let directives = body
        .split_inclusive('\n')
        .take_while(|line| line.trim().is_empty() || line.starts_with('#'))
        .map(str::len)
        .sum();
    let (directives, code) = body.split_at(directives);
    let extension = if context.caps.es && context.caps.version >= (3, 2) {
        String::new()
    } else {
        format!("#extension {ADVANCED_BLEND} : require\n")
    };
    let word = blend_support(mode);
    format!("{version}\n{extension}{directives}layout(blend_support_{word}) out;\n{code}")
}

/// Returns true if naga can write a shader in the context's GLSL.
pub(crate) fn translates(context: &Context, shader: Shader, tests: EarlyTests) -> bool {
    GlslShader::new(context, shader, tests).is_ok()
}

/// A shader in GLSL.
struct GlslShader {
    vertex: String,
    /// `None` for a vertex shader alone.
    fragment: Option<String>,
    /// The names of uniform blocks.
    blocks: Vec<String>,
    /// The names of textures with their units. A unit is the binding minus one.
    textures: Vec<(String, u32)>,
}

impl GlslShader {
    fn new(context: &Context, shader: Shader, tests: EarlyTests) -> Result<Self, String> {
        let source = &*shader.wgsl_with(tests);
        let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
        let info = Validator::new(ValidationFlags::all(), CAPABILITIES)
            .validate(&module)
            .map_err(|e| e.emit_to_string(source))?;
        let mut translated = Self {
            vertex: String::new(),
            fragment: None,
            blocks: Vec::new(),
            textures: Vec::new(),
        };
        translated.vertex = translated.stage(context, &module, &info, ShaderStage::Vertex)?;
        if shader.cull_distances() > 0 {
            // WGSL has no cull distances.
            translated.vertex = translated
                .vertex
                .replace("gl_ClipDistance", "gl_CullDistance");
        }
        if !shader.has_fragment() {
            return Ok(translated);
        }
        let fragment = translated.stage(context, &module, &info, ShaderStage::Fragment)?;
        // naga puts GLSL's signed sample index where WGSL's is unsigned; ES does not convert it.
        let mut fragment = fragment.replace("gl_SampleID", "uint(gl_SampleID)");
        if shader.reads_mask() {
            fragment = with_input_mask(&fragment, context.caps.es)?;
        }
        if shader.writes_mask() {
            fragment = with_mask(&fragment, context.caps.es)?;
        }
        if shader.writes_reference() {
            fragment = with_reference(&fragment)?;
        }
        // naga omits qualifiers that the GLSL version lacks.
        if let Some(word) = qualifier(tests)
            && !fragment.contains(word)
        {
            return Err(format!("GLSL {} has no `{word}`", context.caps.glsl));
        }
        translated.fragment = Some(fragment);
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
            // Points are one texel wide. In ES, their size is undefined unless the shader writes it.
            writer_flags: if context.caps.clip_control {
                glsl::WriterFlags::FORCE_POINT_SIZE
            } else {
                glsl::WriterFlags::FORCE_POINT_SIZE | glsl::WriterFlags::ADJUST_COORDINATE_SPACE
            },
            // Other bindings are set by name, which all versions can do; ES cannot do it for storage buffers.
            binding_map: glsl::BindingMap::from([(STORAGE, STORAGE_BINDING)]),
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
        for (variable, name) in reflection.uniforms {
            if module.global_variables[variable].space == AddressSpace::Uniform {
                self.blocks.push(name);
            }
        }
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

/// Returns a fragment shader that assigns its sample mask in valid GLSL. naga assigns an unsigned number to
/// an array of signed ones, and omits the extension of ES.
fn with_mask(fragment: &str, es: bool) -> Result<String, String> {
    let assigned = fragment
        .split_once("gl_SampleMask = ")
        .and_then(|(before, behind)| Some((before, behind.split_once(';')?)));
    let (before, (value, behind)) = assigned.ok_or("naga assigns no sample mask")?;
    let text = format!("{before}gl_SampleMask[0] = int({value});{behind}");
    with_sample_variables(text, es)
}

/// Returns a fragment shader that reads its sample mask in valid GLSL, for the same reasons.
fn with_input_mask(fragment: &str, es: bool) -> Result<String, String> {
    let text = fragment.replace("gl_SampleMaskIn", "uint(gl_SampleMaskIn[0])");
    with_sample_variables(text, es)
}

/// Returns a shader that, in ES, enables the extension for sample variables.
fn with_sample_variables(text: String, es: bool) -> Result<String, String> {
    const EXTENSION: &str = "#extension GL_OES_sample_variables : require\n";
    let (version, body) = text.split_once('\n').ok_or("naga writes no version")?;
    Ok(if es && !text.contains(EXTENSION) {
        format!("{version}\n{EXTENSION}{body}")
    } else {
        text
    })
}

/// Returns a fragment shader whose output at the stencil reference's location is GLSL's built-in, which naga
/// does not support.
fn with_reference(fragment: &str) -> Result<String, String> {
    let declared = format!("layout(location = {STENCIL_REFERENCE}) out int ");
    let (before, behind) = fragment
        .split_once(&declared)
        .ok_or("naga declares no stencil reference")?;
    let (name, after) = behind.split_once(';').ok_or("naga declares no output")?;
    let text = format!("{before}{}", after.trim_start());
    let text = text.replace(&format!("{name} = "), "gl_FragStencilRefARB = ");
    let (version, body) = text.split_once('\n').ok_or("naga writes no version")?;
    Ok(format!(
        "{version}\n#extension {STENCIL_EXPORT} : require\n{body}"
    ))
}

/// Returns GLSL's layout qualifier of an early-test mode.
fn qualifier(tests: EarlyTests) -> Option<&'static str> {
    match tests {
        EarlyTests::Implicit => None,
        EarlyTests::Forced => Some("early_fragment_tests"),
        EarlyTests::GreaterEqual => Some("depth_greater"),
        EarlyTests::LessEqual => Some("depth_less"),
        EarlyTests::Unchanged => Some("depth_unchanged"),
    }
}

fn link(
    context: &Context,
    name: &str,
    stages: &[(u32, String)],
) -> Result<glow::Program, BackendError> {
    let gl = &context.gl;
    let fail = |message: String| BackendError::shader(name, message);
    // SAFETY: the context is current and owns all objects.
    unsafe {
        let program = gl
            .create_program()
            .map_err(|e| BackendError::refused("a program", e))?;
        for (stage, source) in stages {
            let shader = gl
                .create_shader(*stage)
                .map_err(|e| BackendError::refused("a shader", e))?;
            gl.shader_source(shader, source);
            gl.compile_shader(shader);
            if !gl.get_shader_compile_status(shader) {
                let log = gl.get_shader_info_log(shader);
                gl.delete_shader(shader);
                gl.delete_program(program);
                return Err(fail(format!("{}\n{source}", log.trim())));
            }
            gl.attach_shader(program, shader);
            // The program keeps the shader alive.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stencil_reference_is_assigned_to_the_built_in() {
        let text = "#version 330 core\nlayout(location = 0) out vec4 a;\nlayout(location = 1) out int b;\n\
                    void main() {\na = _e1.color;\nb = _e1.stencil_reference;\nreturn;\n}\n";
        let expected = "#version 330 core\n#extension GL_ARB_shader_stencil_export : require\n\
                        layout(location = 0) out vec4 a;\nvoid main() {\na = _e1.color;\n\
                        gl_FragStencilRefARB = _e1.stencil_reference;\nreturn;\n}\n";
        assert_eq!(with_reference(text).as_deref(), Ok(expected));
        assert!(with_reference(expected).is_err());
    }

    #[test]
    fn a_sample_mask_is_assigned_as_the_first_word_of_an_array() {
        let text = "#version 310 es\nvoid main() {\ngl_SampleMask = _e1.mask;\nreturn;\n}\n";
        let made = with_mask(text, true).expect("it assigns one");
        let expected = "#version 310 es\n#extension GL_OES_sample_variables : require\nvoid main() {\n\
                        gl_SampleMask[0] = int(_e1.mask);\nreturn;\n}\n";
        assert_eq!(made, expected);
        let twice = with_mask(
            &text.replace("void", "#extension GL_OES_sample_variables : require\nvoid"),
            true,
        );
        assert_eq!(twice.as_deref(), Ok(expected));
        assert!(
            !with_mask(text, false)
                .expect("as before")
                .contains("#extension")
        );
        assert!(with_mask("#version 450\nvoid main() {}\n", false).is_err());
    }

    #[test]
    fn a_sample_mask_is_read_as_the_first_word_of_an_array() {
        let text = "#version 310 es\nvoid main() {\nuint covered = gl_SampleMaskIn;\n}\n";
        let expected = "#version 310 es\n#extension GL_OES_sample_variables : require\nvoid main() {\n\
                        uint covered = uint(gl_SampleMaskIn[0]);\n}\n";
        assert_eq!(with_input_mask(text, true).as_deref(), Ok(expected));
        let made = with_input_mask(text, false).expect("it has a version");
        assert!(!made.contains("#extension"));
    }
}
