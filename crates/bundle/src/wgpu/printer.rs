//! A list of calls as statements.

use super::code::Code;
use super::memories::{FilledMemory, memories};
use super::objects::variable;
use super::{commands, objects};
use crate::wrap::wrapped;
use etalon_backend::Recording;
use etalon_webgpu::CallList;

/// The statements, and the data and features that they need.
pub(super) struct Statements<'a> {
    /// The statements in their order, indented.
    pub(super) body: Code,
    /// The buffer that is mapped.
    pub(super) mapped: String,
    /// The memory regions that are filled from it.
    pub(super) memories: Vec<FilledMemory>,
    /// The features that the device had.
    pub(super) features: Vec<&'a str>,
    /// The features that the calls need.
    pub(super) needed: Vec<&'a str>,
}

/// Features, and text in calls that shows that they need the feature.
const NEEDED: [(&str, &str); 7] = [
    ("DUAL_SOURCE_BLENDING", "dual_source_blending"),
    ("CLIP_DISTANCES", "clip_distances"),
    ("DEPTH_CLIP_CONTROL", "unclipped_depth: true"),
    ("DEPTH32FLOAT_STENCIL8", "Depth32FloatStencil8"),
    ("PIPELINE_STATISTICS_QUERY", "QueryType::PipelineStatistics"),
    ("SHADER_EARLY_DEPTH_TEST", "@early_depth_test"),
    ("RG11B10UFLOAT_RENDERABLE", "Rg11b10Ufloat"),
];

/// Returns the statements of the calls on a device with these features.
pub(super) fn statements<'a>(
    recording: &Recording,
    calls: &CallList,
    features: &'a [String],
) -> Statements<'a> {
    let mut body = Code::same("");
    for statement in in_order(calls) {
        let line = |text: &str| {
            let end = if matches!(text, "{" | "}") { "" } else { ";" };
            let line = format!("    {text}{end}");
            // Lines of a shader are not wrapped.
            if text.contains("create_shader_module") || text.contains("createShaderModule") {
                line + "\n"
            } else {
                wrapped(&line) + "\n"
            }
        };
        body.push(&statement.map(line));
    }
    let features: Vec<&str> = features.iter().map(String::as_str).collect();
    let uses = |feature: &&str| {
        let is_used = |(name, word): &(&str, &str)| name == feature && body.rust.contains(word);
        NEEDED.iter().any(is_used)
    };
    Statements {
        mapped: variable("buffer", calls.output),
        memories: memories(recording),
        needed: features.iter().copied().filter(uses).collect(),
        features,
        body,
    }
}

fn in_order(calls: &CallList) -> Vec<Code> {
    let mut statements = objects::definitions(calls);
    for (place, bundle) in calls.bundles.iter().enumerate() {
        statements.extend(commands::bundle(bundle, place));
    }
    let mut first = &calls.first[..];
    let buffers = calls.frame.iter().chain([&calls.read]);
    for (number, buffer) in (1..).zip(buffers) {
        let commands = std::mem::take(&mut first).iter().chain(buffer);
        statements.extend(commands::submission(calls, commands, number));
    }
    statements
}
