//! The same calls as a page that runs in a browser.

use super::code::Code;
use super::printer::Statements;
use crate::head::Head;
use std::fmt::Write;

/// Features of wgpu with WebGPU's names.
const FEATURES: [(&str, &str); 8] = [
    ("CLIP_DISTANCES", "clip-distances"),
    ("DEPTH32FLOAT_STENCIL8", "depth32float-stencil8"),
    ("DEPTH_CLIP_CONTROL", "depth-clip-control"),
    ("DUAL_SOURCE_BLENDING", "dual-source-blending"),
    ("FLOAT32_BLENDABLE", "float32-blendable"),
    ("INDIRECT_FIRST_INSTANCE", "indirect-first-instance"),
    ("RG11B10UFLOAT_RENDERABLE", "rg11b10ufloat-renderable"),
    (
        "TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES",
        "texture-formats-tier1",
    ),
];

/// Returns wgpu's names of a browser's features, limited to the features that calls can need.
pub(super) fn names_of_wgpu(features: &[String]) -> Vec<String> {
    let known = FEATURES
        .iter()
        .filter(|(_, web)| features.iter().any(|f| f == web));
    known.map(|(rust, _)| (*rust).to_owned()).collect()
}

/// Returns the page; `None` if the calls use anything that WebGPU lacks.
pub(super) fn page(head: &Head, statements: &Statements<'_>, check: &Code) -> Option<String> {
    let body = statements.body.script.as_ref()?;
    let check = check.script.as_ref()?;
    let web = |name: &&str| FEATURES.iter().find(|(rust, _)| rust == name);
    let needed: Option<Vec<_>> = statements.needed.iter().map(web).collect();
    let names = |features: &[&(&str, &str)]| {
        let names = features.iter().map(|(_, name)| format!("\"{name}\""));
        names.collect::<Vec<_>>().join(", ")
    };
    let used: Vec<_> = statements.features.iter().filter_map(web).collect();
    let [title, sentence] = [&head.title, &head.sentence].map(|text| escaped(text));
    let mut read = String::new();
    for memory in &statements.memories {
        let _ = writeln!(read, "      {},", memory.expression("bytes"));
    }
    let mapped = &statements.mapped;
    let mut text = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>{title}</title>\n<h1>{title}</h1>\n<p>{sentence}</p>\n\
         <p>The last line, which is also the title, is the result: right, the wrong value, what the browser does not support, or a call \
         that fails.</p>\n\
         <pre id=\"result\">running</pre>\n<script>\n\"use strict\";\n// Features that the calls need, and features of the device on which they were recorded.\n\
         const needed = [{}], enabled = [{}];\n",
        names(&needed?),
        names(&used),
    );
    text.push_str(MAIN);
    let _ = write!(
        text,
        "\n// Makes the calls. Returns what they wrote.\nasync function draw(device, queue) {{\n{}  await {mapped}.mapAsync(GPUMapMode.READ);\n  const bytes = \
         new Uint8Array({mapped}.getMappedRange());\n  return [\n{read}  ];\n}}\n",
        narrower(body),
    );
    text.push_str(check);
    text.push_str("\nrun();\n</script>\n");
    Some(text)
}

/// Halves the indentation of statements.
fn narrower(body: &str) -> String {
    let lines = body.lines().map(|line| {
        let spaces = line.len() - line.trim_start().len();
        format!("{}{}\n", " ".repeat(spaces / 2), line.trim_start())
    });
    lines.collect()
}

/// Escapes a text for HTML.
fn escaped(text: &str) -> String {
    let mut safe = String::new();
    for c in text.chars() {
        match c {
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '&' => safe.push_str("&amp;"),
            c if c.is_control() => safe.push(' '),
            c => safe.push(c),
        }
    }
    safe
}

/// The script that opens the device, makes the calls and shows the result.
const MAIN: &str = r#"
class Lacks extends Error {}

async function answer(tell) {
  if (!navigator.gpu)
    throw new Lacks("WebGPU");
  const adapter = await navigator.gpu.requestAdapter();
  if (!adapter)
    throw new Lacks("an adapter");
  const { vendor, architecture, device: name, description } = adapter.info;
  tell([vendor, architecture, name, description].filter((word) => word).join(", "));
  for (const feature of needed)
    if (!adapter.features.has(feature))
      throw new Lacks(feature);
  const requiredLimits = {};
  for (const limit in adapter.limits)
    if (typeof adapter.limits[limit] === "number")
      requiredLimits[limit] = adapter.limits[limit];
  const requiredFeatures = enabled.filter((feature) => adapter.features.has(feature));
  const device = await adapter.requestDevice({ requiredFeatures, requiredLimits });
  for (const kind of ["validation", "out-of-memory", "internal"])
    device.pushErrorScope(kind);
  const drawn = await draw(device, device.queue).catch((error) => ({ error }));
  for (let i = 0; i < 3; i++) {
    const error = await device.popErrorScope();
    if (error)
      throw error;
  }
  if (drawn.error)
    throw drawn.error;
  return wrong(drawn) ?? "right";
}

async function run() {
  const result = document.getElementById("result");
  const lines = [];
  const tell = (line) => {
    lines.push(line);
    result.textContent = lines.join("\n");
  };
  try {
    tell(await answer(tell));
  } catch (error) {
    // For a format that it does not support, the browser throws a `TypeError` that names the format.
    const lacks = error instanceof Lacks || error instanceof TypeError && /format|feature/i.test(error.message);
    tell(`${lacks ? "not supported" : "a call fails"}: ${error.message}`);
  }
  document.title = lines[lines.length - 1];
}

// Returns the rows without the bytes between them.
function rows(bytes, offset, pitch, row, rows) {
  const all = new Uint8Array(row * rows);
  for (let y = 0; y < rows; y++)
    all.set(bytes.subarray(offset + y * pitch, offset + y * pitch + row), y * row);
  return all;
}

// Packs bits into bytes: bits 0 to 3 come from one image, and bits 4 to 7 from the other.
function bits(low, high) {
  return Uint8Array.from({ length: low.length / 4 }, (_, texel) => {
    let all = 0;
    for (let bit = 0; bit < 4; bit++)
      all |= (low[4 * texel + bit] ? 1 << bit : 0) | (high[4 * texel + bit] ? 16 << bit : 0);
    return all;
  });
}
"#;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_texts_become_no_element() {
        assert_eq!(escaped("a<script>&\n"), "a&lt;script&gt;&amp; ");
    }
}
