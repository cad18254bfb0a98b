//! Recorded calls as a test for piglit's `shader_runner`, where that format can say them.
//!
//! It knows one program, attributes in one table, uniforms by name, one target, one clear before the draws, and few
//! states. It has no clip control: its vertex shader does what that would do to the position. Whatever it cannot say
//! makes the scene none for it.

use super::trim::{Trim, trimmed};
use crate::due::{Due, DueTexel};
use etalon_backend::{Argument, Call, Phase, Recording};
use etalon_frame::Aspect;
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write;

/// Returns the test; `None` if the format cannot say the scene or what must come back.
pub(crate) fn shader_test(
    es: bool,
    version: [u32; 2],
    recording: &Recording,
    due: &Due,
) -> Option<String> {
    let mut scene = Scene::default();
    for call in trimmed(&recording.calls, Trim::Idle) {
        if call.phase != Phase::Read {
            scene.take(call)?;
        }
    }
    let [width, height] = scene.size?;
    let [vertex, fragment] = [scene.source(VERTEX_SHADER)?, scene.source(FRAGMENT_SHADER)?];
    let polygons = scene.draws.iter().any(|draw| draw.mode >= TRIANGLES);
    if !scene.clip_control || polygons && (scene.faces || fragment.contains("gl_FrontFacing")) {
        // Without clip control the image is upside down, and with it each polygon faces the other way.
        return None;
    }
    let (api, language) = match es {
        true => ("GL ES", "GLSL ES"),
        false => ("GL", "GLSL"),
    };
    let glsl = glsl_version(vertex)?;
    let mut text = format!(
        "[require]\n{api} >= {}.{}\n{language} >= {}.{:02}\nSIZE {width} {height}\n\n[vertex shader]\n{}\n[fragment shader]\n{fragment}\n",
        version[0],
        version[1],
        glsl / 100,
        glsl % 100,
        turned(vertex)?,
    );
    text.push_str(&scene.vertices()?);
    let _ = write!(
        text,
        "\n[test]\ntexture rgbw 0 ( {width} , {height} ) {}\nfb tex 2d 0\n",
        scene.format
    );
    text.push_str(&scene.commands(&[vertex, fragment])?);
    for texel in &due.texels {
        text.push_str(&probe(texel)?);
    }
    due.counters.is_empty().then_some(text)
}

const VERTEX_SHADER: u32 = 0x8B31;
const FRAGMENT_SHADER: u32 = 0x8B30;
/// The first mode that makes polygons.
const TRIANGLES: u32 = 0x0004;
const ARRAY_BUFFER: u32 = 0x8892;
const FLOAT: u32 = 0x1406;
const UPPER_LEFT: u32 = 0x8CA2;
const ZERO_TO_ONE: u32 = 0x935F;
const COLOR_ATTACHMENT0: u64 = 0x8CE0;
const DITHER: u32 = 0x0BD0;
const FRAMEBUFFER_SRGB: u32 = 0x8DB9;
const PROGRAM_POINT_SIZE: u32 = 0x8642;

/// The state that the calls make, as far as the format has it.
#[derive(Default)]
struct Scene<'a> {
    buffers: HashMap<u64, &'a [u8]>,
    array_buffer: u64,
    attributes: BTreeMap<u64, Attribute>,
    shaders: BTreeMap<u64, (u32, &'a str)>,
    programs: u32,
    /// The binding and the block's name of each program's block.
    blocks: HashMap<u64, &'a str>,
    bindings: HashMap<u64, String>,
    size: Option<[u64; 2]>,
    format: String,
    clip_control: bool,
    /// True if a winding or a provoking vertex is set.
    faces: bool,
    clear: Option<String>,
    /// State that was set since the last draw, as commands.
    state: String,
    uniforms: BTreeMap<String, &'a [u8]>,
    draws: Vec<Draw<'a>>,
}

/// The layout of an attribute's values.
#[derive(Clone, Copy)]
struct Attribute {
    buffer: u64,
    components: usize,
    stride: usize,
    offset: usize,
}

struct Draw<'a> {
    mode: u32,
    command: String,
    end: usize,
    state: String,
    uniforms: BTreeMap<String, &'a [u8]>,
}

impl<'a> Scene<'a> {
    /// Takes a call in. `None` if the format has nothing for it.
    fn take(&mut self, call: &'a Call) -> Option<()> {
        let all = call.arguments.as_slice();
        let numbers: Vec<Option<u64>> = all.iter().map(integer).collect();
        let at = |index: usize| numbers.get(index).copied().flatten();
        match call.function.as_str() {
            "glGenVertexArrays"
            | "glBindVertexArray"
            | "glEnableVertexAttribArray"
            | "glGenBuffers"
            | "glGenTextures"
            | "glGenFramebuffers"
            | "glBindFramebuffer"
            | "glActiveTexture"
            | "glBindTexture"
            | "glTexParameteri"
            | "glBindSampler"
            | "glReadBuffer"
            | "glCheckFramebufferStatus"
            | "glCompileShader"
            | "glLinkProgram"
            | "glUseProgram"
            | "glAttachShader"
            | "glClampColor"
            | "glPixelStorei"
            | "glStencilMask"
            | "glFlush"
            | "glFinish" => {}
            "glCreateProgram" => self.programs += 1,
            "glCreateShader" => {
                let Some(Argument::Object(_, shader)) = &call.result else {
                    return None;
                };
                let stage = u32::try_from(at(0)?).ok()?;
                self.shaders.insert(*shader, (stage, ""));
            }
            "glShaderSource" => {
                let [shader, _, Argument::Text(source), ..] = all else {
                    return None;
                };
                self.shaders.get_mut(&integer(shader)?)?.1 = source;
            }
            "glGetUniformBlockIndex" => {
                let (Some(Argument::Text(name)), Some(Argument::Object(_, block))) =
                    (all.get(1), &call.result)
                else {
                    return None;
                };
                self.blocks.insert(*block, name);
            }
            "glUniformBlockBinding" => {
                let name = (*self.blocks.get(&at(1)?)?).to_owned();
                self.bindings.insert(at(2)?, name);
            }
            "glBindBuffer" if at(0) == Some(u64::from(ARRAY_BUFFER)) => {
                self.array_buffer = at(1)?;
            }
            "glBindBuffer" if at(1) == Some(0) => {}
            "glBufferData" => {
                let Some(Argument::Bytes(bytes)) = all.get(2) else {
                    return None;
                };
                self.buffers.insert(self.array_buffer, bytes);
            }
            "glBindBufferRange" => {
                let bytes = self.buffers.get(&at(2)?)?;
                let start = usize::try_from(at(3)?).ok()?;
                let bytes = bytes.get(start..start + usize::try_from(at(4)?).ok()?)?;
                let name = self.bindings.get(&at(1)?)?.clone();
                self.uniforms.insert(name, bytes);
            }
            "glVertexAttribPointer" => {
                let floats = at(2) == Some(u64::from(FLOAT));
                let offset = match all.get(5)? {
                    Argument::Null => 0,
                    Argument::Offset(offset) => usize::try_from(*offset).ok()?,
                    _ => return None,
                };
                let attribute = Attribute {
                    buffer: self.array_buffer,
                    components: usize::try_from(at(1)?).ok()?,
                    stride: usize::try_from(at(4)?).ok()?,
                    offset,
                };
                let before = self.attributes.insert(at(0)?, attribute);
                let same = |b: Attribute| b.buffer == attribute.buffer && b.offset == offset;
                if !floats || attribute.stride == 0 || !before.is_none_or(same) {
                    return None;
                }
            }
            "glTexImage2D" if self.size.is_none() && matches!(all.last(), Some(Argument::Null)) => {
                let Some(Argument::Constant(format)) = all.get(2) else {
                    return None;
                };
                self.size = Some([at(3)?, at(4)?]);
                self.format.clone_from(&format.name);
            }
            "glFramebufferTexture2D" if at(1) == Some(COLOR_ATTACHMENT0) && at(4) == Some(0) => {}
            "glDrawBuffers" if at(0) == Some(1) => {}
            "glClipControl" if !self.clip_control => {
                let upper_left = at(0) == Some(u64::from(UPPER_LEFT));
                if !upper_left || at(1) != Some(u64::from(ZERO_TO_ONE)) {
                    return None;
                }
                self.clip_control = true;
            }
            "glFrontFace" | "glProvokingVertex" => self.faces = true,
            "glPolygonMode" => {
                let name = |index: usize| match all.get(index) {
                    Some(Argument::Constant(constant)) => Some(constant.name.as_str()),
                    _ => None,
                };
                let _ = writeln!(self.state, "polygon mode {} {}", name(0)?, name(1)?);
            }
            "glViewportIndexedf" => {
                let float = |index: usize| match all.get(index) {
                    Some(Argument::Float(bits)) => Some(f64::from(f32::from_bits(*bits))),
                    _ => None,
                };
                let [width, height] = self.size?.map(|side| side as f64);
                let whole = [Some(0.0), Some(0.0), Some(width), Some(height)];
                if at(0) != Some(0) || [1, 2, 3, 4].map(float) != whole {
                    return None;
                }
            }
            "glEnable" | "glDisable" => {
                let capability = u32::try_from(at(0)?).ok()?;
                let word = call.function.trim_start_matches("gl").to_lowercase();
                match capability {
                    DITHER => {}
                    FRAMEBUFFER_SRGB if !self.format.contains("SRGB") => {}
                    PROGRAM_POINT_SIZE => {
                        let _ = writeln!(self.state, "{word} GL_PROGRAM_POINT_SIZE");
                    }
                    0x3000..=0x3007 => {
                        let plane = capability - 0x3000;
                        let _ = writeln!(self.state, "{word} GL_CLIP_PLANE{plane}");
                    }
                    _ => return None,
                }
            }
            "glClearBufferfv" if self.clear.is_none() && self.draws.is_empty() => {
                let Some(Argument::Array(values)) = all.get(2) else {
                    return None;
                };
                let values: Option<Vec<String>> = values.iter().map(float_text).collect();
                self.clear = Some(values?.join(" "));
            }
            "glDrawArrays" => {
                let Some(Argument::Constant(mode)) = all.first() else {
                    return None;
                };
                let (first, count) = (at(1)?, at(2)?);
                self.draws.push(Draw {
                    mode: mode.value,
                    command: format!("draw arrays {} {first} {count}\n", mode.name),
                    end: usize::try_from(first + count).ok()?,
                    state: std::mem::take(&mut self.state),
                    uniforms: self.uniforms.clone(),
                });
            }
            _ => return None,
        }
        (self.programs <= 1).then_some(())
    }

    /// Returns the source of the only shader of a stage; `None` if there are others, of that stage or a further one.
    fn source(&self, stage: u32) -> Option<&'a str> {
        let mut of_stage = self.shaders.values().filter(|(s, _)| *s == stage);
        let (_, source) = of_stage.next()?;
        (self.shaders.len() == 2).then_some(*source)
    }

    /// Returns the table of attributes.
    fn vertices(&self) -> Option<String> {
        let names: Vec<String> = self
            .attributes
            .iter()
            .map(|(index, attribute)| format!("{index}/float/vec{}", attribute.components))
            .collect();
        let mut text = format!("[vertex data]\n{}\n", names.join(" "));
        let end = self.draws.iter().map(|draw| draw.end).max()?;
        for vertex in 0..end {
            let mut row = Vec::new();
            for attribute in self.attributes.values() {
                let bytes = self.buffers.get(&attribute.buffer)?;
                let start = attribute.offset + vertex * attribute.stride;
                let values = bytes.get(start..start + 4 * attribute.components)?;
                row.extend(words(values).map(|word| format!("{:?}", f32::from_bits(word))));
            }
            let _ = writeln!(text, "{}", row.join(" "));
        }
        Some(text)
    }

    /// Returns the clear and the draws.
    fn commands(&self, sources: &[&str]) -> Option<String> {
        let mut text = format!("clear color {}\nclear\n", self.clear.as_ref()?);
        for draw in &self.draws {
            text.push_str(&draw.state);
            for (block, bytes) in &draw.uniforms {
                let mut all = sources.iter();
                let lines = all.find_map(|source| uniforms(source, block, bytes));
                text.push_str(&lines?);
            }
            text.push_str(&draw.command);
        }
        Some(text)
    }
}

/// Returns an argument as an integer.
fn integer(argument: &Argument) -> Option<u64> {
    match argument {
        Argument::Integer(value) => u64::try_from(*value).ok(),
        Argument::Unsigned(value) => Some(u64::from(*value)),
        Argument::Size(value) => u64::try_from(*value).ok(),
        Argument::Constant(constant) => Some(u64::from(constant.value)),
        Argument::Object(_, number) => Some(*number),
        _ => None,
    }
}

fn float_text(argument: &Argument) -> Option<String> {
    match argument {
        Argument::Float(bits) => Some(format!("{:?}", f32::from_bits(*bits))),
        _ => None,
    }
}

fn words(bytes: &[u8]) -> impl Iterator<Item = u32> {
    let chunks = bytes.chunks_exact(4);
    chunks.map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
}

/// Returns the version of a shader's language, as its first line has it.
fn glsl_version(source: &str) -> Option<u32> {
    let line = source.lines().next()?.strip_prefix("#version ")?;
    line.split_whitespace().next()?.parse().ok()
}

/// Returns a vertex shader that turns what it makes upside down and maps depths from 0 to 1 to those from -1 to 1.
fn turned(source: &str) -> Option<String> {
    let (before, behind) = source.split_once("void main() {")?;
    Some(format!(
        "{before}void scene_main() {{{behind}\nvoid main() {{\n    scene_main();\n    gl_Position.y = -gl_Position.y;\n    \
         gl_Position.z = 2.0 * gl_Position.z - gl_Position.w;\n}}\n"
    ))
}

/// Returns the commands that set the members of a block, which holds one structure; `None` if a member is of another
/// kind than 4 floats.
fn uniforms(source: &str, block: &str, bytes: &[u8]) -> Option<String> {
    let (_, declaration) = source.split_once(&format!("uniform {block} {{"))?;
    let mut member = declaration.split('}').next()?.split_whitespace();
    let (kind, instance) = (member.next()?, member.next()?.trim_end_matches(';'));
    let (_, fields) = source.split_once(&format!("struct {kind} {{"))?;
    let mut text = String::new();
    for (index, field) in fields.split('}').next()?.split(';').enumerate() {
        let mut parts = field.split_whitespace();
        let Some(kind) = parts.next() else { continue };
        let name = parts.next()?;
        let values = bytes.get(16 * index..16 * index + 16)?;
        if kind != "vec4" || name.contains('[') {
            return None;
        }
        let values: Vec<String> = words(values)
            .map(|word| format!("{:?}", f32::from_bits(word)))
            .collect();
        let _ = writeln!(text, "uniform vec4 {instance}.{name} {}", values.join(" "));
    }
    Some(text)
}

/// Returns the command that compares a texel; `None` if it may have several values, or has not four channels.
fn probe(texel: &DueTexel) -> Option<String> {
    let [allowed] = texel.allowed.as_slice() else {
        return None;
    };
    let color = texel.channels.iter().all(|c| c.aspect == Aspect::Color);
    if texel.sample != 0 || allowed.len() != 4 || !color {
        return None;
    }
    let mut values = Vec::new();
    let mut tolerances = Vec::new();
    for ([low, high], channel) in allowed.iter().zip(&texel.channels) {
        let encoding = channel.encoding;
        let value = |order: i64| {
            encoding.value_of_order(order.clamp(encoding.min_order(), encoding.max_order()))
        };
        let (least, most) = (value(*low), value(*high));
        // Less than half of the way to the next value that is not allowed.
        let step = (value(high + 1) - most).max(least - value(low - 1));
        values.push(format!("{}", (least + most) / 2.0));
        tolerances.push(format!("{}", (most - least) / 2.0 + 0.4 * step));
    }
    Some(format!(
        "tolerance {}\nprobe rgba {} {} {}\n",
        tolerances.join(" "),
        texel.x,
        texel.y,
        values.join(" ")
    ))
}
