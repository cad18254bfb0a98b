//! The shaders of a scene in the languages that a program asks for.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use etalon_backend::BackendError;
use naga::back::{glsl, spv};
use naga::proc::BoundsCheckPolicies;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, ShaderStage};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// A shading language.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "lowercase")]
pub enum ShaderLanguage {
    /// WGSL.
    Wgsl,
    /// SPIR-V 1.3 for Vulkan.
    Spirv,
    /// GLSL 4.50.
    Glsl,
}

/// A shader in the languages of the description. In WGSL and SPIR-V, its entry points are `vs` and, unless it has no
/// fragment shader, `fs`.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct ShaderSource {
    /// The text in WGSL.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wgsl: Option<String>,
    /// The module in SPIR-V 1.3, little-endian, in base64. It leaves y up, so Vulkan needs a viewport of negative height.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spirv: Option<String>,
    /// The texts in GLSL 4.50, by stage: `vertex` and `fragment`. Depths in clip space stay 0 to w, and y stays up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub glsl: Option<BTreeMap<&'static str, String>>,
}

impl ShaderSource {
    /// Returns the texts and the module as files with their names.
    pub fn files(&self, name: &str) -> Vec<(String, Vec<u8>)> {
        let name = name.replace(':', "-");
        let text =
            |ending: &str, text: &String| (format!("{name}.{ending}"), text.clone().into_bytes());
        let mut files: Vec<_> = self.wgsl.iter().map(|wgsl| text("wgsl", wgsl)).collect();
        // The module was encoded here.
        let module = self
            .spirv
            .iter()
            .filter_map(|module| STANDARD.decode(module).ok());
        files.extend(module.map(|module| (format!("{name}.spv"), module)));
        let stages = self.glsl.iter().flatten();
        files.extend(stages.map(|(stage, glsl)| text(&format!("{stage}.glsl"), glsl)));
        files
    }
}

/// Returns a shader in these languages.
pub(crate) fn sources(
    name: &str,
    wgsl: &str,
    languages: &BTreeSet<ShaderLanguage>,
) -> Result<ShaderSource, BackendError> {
    let fail = |message: String| BackendError::shader(name, message);
    let mut source = ShaderSource::default();
    let asks = |language| languages.contains(&language);
    if asks(ShaderLanguage::Wgsl) {
        source.wgsl = Some(wgsl.to_owned());
    }
    if asks(ShaderLanguage::Spirv) || asks(ShaderLanguage::Glsl) {
        let module =
            naga::front::wgsl::parse_str(wgsl).map_err(|e| fail(e.emit_to_string(wgsl)))?;
        let info = Validator::new(ValidationFlags::all(), Capabilities::all())
            .validate(&module)
            .map_err(|e| fail(e.emit_to_string(wgsl)))?;
        if asks(ShaderLanguage::Spirv) {
            source.spirv = Some(spirv(&module, &info).map_err(fail)?);
        }
        if asks(ShaderLanguage::Glsl) {
            let texts = module.entry_points.iter().map(|entry| {
                let stage = match entry.stage {
                    ShaderStage::Vertex => "vertex",
                    _ => "fragment",
                };
                let text = glsl(&module, &info, entry.stage, &entry.name).map_err(fail)?;
                Ok((stage, text))
            });
            source.glsl = Some(texts.collect::<Result<_, BackendError>>()?);
        }
    }
    Ok(source)
}

fn spirv(module: &Module, info: &ModuleInfo) -> Result<String, String> {
    // Points need a size, and other topologies ignore it. The viewport turns y up.
    let options = spv::Options {
        lang_version: (1, 3),
        flags: spv::WriterFlags::FORCE_POINT_SIZE,
        ..spv::Options::default()
    };
    let words = spv::write_vec(module, info, &options, None).map_err(|e| e.to_string())?;
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    Ok(STANDARD.encode(bytes))
}

fn glsl(
    module: &Module,
    info: &ModuleInfo,
    stage: ShaderStage,
    entry: &str,
) -> Result<String, String> {
    let bindings = module.global_variables.iter().filter_map(|(_, variable)| {
        let binding = variable.binding?;
        Some((binding, u8::try_from(binding.binding).ok()?))
    });
    let options = glsl::Options {
        version: glsl::Version::Desktop(450),
        writer_flags: glsl::WriterFlags::FORCE_POINT_SIZE,
        binding_map: bindings.collect(),
        ..glsl::Options::default()
    };
    let pipeline = glsl::PipelineOptions {
        shader_stage: stage,
        entry_point: entry.to_owned(),
        multiview: None,
    };
    let mut text = String::new();
    glsl::Writer::new(
        &mut text,
        module,
        info,
        &options,
        &pipeline,
        BoundsCheckPolicies::default(),
    )
    .and_then(|mut writer| writer.write())
    .map_err(|e| e.to_string())?;
    Ok(text)
}
