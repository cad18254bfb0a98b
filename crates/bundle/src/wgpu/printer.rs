//! The calls of a recording as statements.

use super::calls::{self, Memory, Objects, field, flags, part};
use super::code::Code;
use super::{commands, descriptors};
use crate::error::BundleError;
use crate::wrap::wrapped;
use etalon_backend::{Recording, Tree};

/// The statements, and what they need.
pub(super) struct Statements<'a> {
    /// The statements in their order, indented.
    pub(super) body: Code,
    /// The buffer that is mapped.
    pub(super) mapped: String,
    /// The memories that are filled from it.
    pub(super) memories: Vec<Memory>,
    /// The features that the device had.
    pub(super) features: Vec<&'a str>,
    /// The features that the calls need.
    pub(super) needed: Vec<&'a str>,
}

/// Features and the words of calls that have need of them.
const NEEDED: [(&str, &str); 7] = [
    ("DUAL_SOURCE_BLENDING", "dual_source_blending"),
    ("CLIP_DISTANCES", "clip_distances"),
    ("DEPTH_CLIP_CONTROL", "unclipped_depth: true"),
    ("DEPTH32FLOAT_STENCIL8", "Depth32FloatStencil8"),
    ("PIPELINE_STATISTICS_QUERY", "QueryType::PipelineStatistics"),
    ("SHADER_EARLY_DEPTH_TEST", "@early_depth_test"),
    ("RG11B10UFLOAT_RENDERABLE", "Rg11b10Ufloat"),
];

/// Returns the statements of the calls that the program makes.
pub(super) fn statements(recording: &Recording) -> Result<Statements<'_>, BundleError> {
    let mut printer = Printer::default();
    let mut body = Code::same("");
    let mut features = Vec::new();
    for action in calls::needed(recording) {
        if action.name() == "Init" {
            features = flags(field(field(action, "desc")?, "required_features")?)?;
            continue;
        }
        let is_shader = action.name() == "CreateShaderModule";
        for statement in printer.statements(action)? {
            let line = |text: &str| {
                let end = if matches!(text, "{" | "}") { "" } else { ";" };
                let line = format!("    {text}{end}");
                // The lines of a shader are its own.
                if is_shader {
                    line + "\n"
                } else {
                    wrapped(&line) + "\n"
                }
            };
            body.push(&statement.map(line));
        }
    }
    let uses = |feature: &&str| {
        let is_used = |(name, word): &(&str, &str)| name == feature && body.rust.contains(word);
        NEEDED.iter().any(is_used)
    };
    let needed = features.iter().copied().filter(uses).collect();
    let unread = || BundleError::Unread("the frame".to_owned());
    Ok(Statements {
        mapped: printer.mapped.ok_or_else(unread)?,
        memories: calls::memories(recording),
        body,
        features,
        needed,
    })
}

/// Prints calls.
#[derive(Default)]
struct Printer {
    objects: Objects,
    /// The buffer that is mapped.
    mapped: Option<String>,
    submissions: u32,
}

impl Printer {
    /// Returns the statements of a call.
    fn statements(&mut self, action: &Tree) -> Result<Vec<Code>, BundleError> {
        let objects = &mut self.objects;
        let statement = match action.name() {
            "CreateBuffer" => descriptors::buffer(objects, &mut self.mapped, action)?,
            "CreateTexture" => descriptors::texture(objects, action)?,
            "CreateTextureView" => descriptors::view(objects, action)?,
            "CreateBindGroupLayout" => descriptors::group_layout(objects, action)?,
            "CreatePipelineLayout" => descriptors::pipeline_layout(objects, action)?,
            "CreateBindGroup" => descriptors::group(objects, action)?,
            "CreateShaderModule" => descriptors::shader(objects, action)?,
            "CreateGeneralRenderPipeline" => descriptors::pipeline(objects, action)?,
            "CreateQuerySet" => descriptors::query_set(objects, action)?,
            "CreateRenderBundle" => return commands::bundle(objects, action),
            "WriteBuffer" => descriptors::write(objects, action)?,
            "Submit" => {
                self.submissions += 1;
                return commands::submission(objects, part(action, 1)?, self.submissions);
            }
            name => return Err(BundleError::Call(name.to_owned())),
        };
        Ok(vec![statement])
    }
}
