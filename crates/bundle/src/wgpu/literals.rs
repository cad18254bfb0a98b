//! Texts, numbers, names and bytes of recorded calls as literals.

use super::calls::{digits, flags, word};
use super::code::Code;
use crate::error::BundleError;
use etalon_backend::Tree;

/// Returns a text as a literal. No script ends in one.
pub(super) fn string(text: &str) -> Code {
    let escaped = |c: char| -> [String; 2] {
        match c {
            '"' | '\\' => [format!("\\{c}"), format!("\\{c}")],
            '\n' => ["\\n".to_owned(), "\\n".to_owned()],
            '<' => ["<".to_owned(), "\\u003c".to_owned()],
            ' '..='~' => [c.to_string(), c.to_string()],
            c => {
                let mut units = [0; 2];
                let units = c.encode_utf16(&mut units).iter();
                [
                    format!("\\u{{{:x}}}", u32::from(c)),
                    units.map(|unit| format!("\\u{unit:04x}")).collect(),
                ]
            }
        }
    };
    let [mut rust, mut script] = [const { String::new() }; 2];
    for c in text.chars() {
        let [in_rust, in_script] = escaped(c);
        rust.push_str(&in_rust);
        script.push_str(&in_script);
    }
    Code::new(format!("\"{rust}\""), format!("\"{script}\""))
}

/// Returns the source of a shader as a literal over several lines.
pub(super) fn source(text: &str) -> Code {
    let literal = string(text);
    let plain = |c: char| c == '\n' || (' '..='~').contains(&c);
    if !text.chars().all(plain) {
        return literal;
    }
    let rust = if text.contains("\"###") {
        literal.rust
    } else {
        format!("r###\"{text}\"###")
    };
    // An attribute of wgpu.
    if text.contains("@early_depth_test") {
        return Code::of_wgpu(rust);
    }
    let is_odd = ["`", "\\", "${", "</", "<!"]
        .iter()
        .any(|odd| text.contains(odd));
    let script = if is_odd {
        literal.script
    } else {
        Some(format!("`{text}`"))
    };
    Code { rust, script }
}

/// Returns a number as a literal.
pub(super) fn number(value: f64) -> Code {
    if value.is_finite() {
        Code::same(format!("{value:?}"))
    } else if value.is_nan() {
        Code::new("f64::NAN", "NaN")
    } else if value > 0.0 {
        Code::new("f64::INFINITY", "Infinity")
    } else {
        Code::new("f64::NEG_INFINITY", "-Infinity")
    }
}

/// Returns bytes as an expression: zeros, floats, words, or bytes.
pub(super) fn bytes(all: &[u8]) -> Code {
    let size = all.len();
    if all.iter().all(|byte| *byte == 0) {
        return Code::new(format!("&[0; {size}]"), format!("new Uint8Array({size})"));
    }
    if !size.is_multiple_of(4) {
        return Code::new(format!("&{all:?}"), format!("new Uint8Array({all:?})"));
    }
    let words = || {
        let each = all.chunks_exact(4);
        each.map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
    };
    let is_float = |bits: u32| {
        let value = f32::from_bits(bits).abs();
        bits == 0 || (1e-6..1e9).contains(&value)
    };
    let (function, array, items): (_, _, Vec<String>) = if words().all(is_float) {
        let values = words().map(|w| format!("{:?}", f32::from_bits(w)));
        ("floats", "Float32Array", values.collect())
    } else {
        let words = words().map(|w| format!("0x{w:x}"));
        ("words", "Uint32Array", words.collect())
    };
    let lines: Vec<String> = items.chunks(10).map(|line| line.join(", ")).collect();
    let lines = lines.join(",\n        ");
    Code::new(
        format!("&{function}(&[\n        {lines},\n    ])"),
        format!("new {array}([\n        {lines},\n    ])"),
    )
}

/// Returns the digits of a number.
pub(super) fn plain(value: &Tree) -> Result<Code, BundleError> {
    digits(value).map(Code::same)
}

/// Returns a word: `true` or `false`.
pub(super) fn truth(value: &Tree) -> Result<Code, BundleError> {
    word(value).map(Code::same)
}

/// Returns a text.
pub(super) fn text(value: &Tree) -> Result<Code, BundleError> {
    match value {
        Tree::Text(text) => Ok(string(text)),
        _ => Err(BundleError::Call("a text that is none".to_owned())),
    }
}

/// Returns a value of an enumeration.
pub(super) fn of(kind: &str, value: &Tree) -> Result<Code, BundleError> {
    Ok(Code::new(
        format!("wgpu::{kind}::{}", variant(word(value)?)),
        format!("\"{}\"", hyphened(word(value)?)),
    ))
}

/// Returns a format.
pub(super) fn format(value: &Tree) -> Result<Code, BundleError> {
    const PARTS: [&str; 7] = [
        "unorm", "snorm", "uint", "sint", "ufloat", "plus", "stencil",
    ];
    let word = word(value)?;
    let mut name = variant(word);
    for part in PARTS {
        name = name.replace(part, &format!("{}{}", part[..1].to_uppercase(), &part[1..]));
    }
    if !name.contains("Ufloat") {
        name = name.replace("float", "Float");
    }
    Ok(Code::new(
        format!("wgpu::TextureFormat::{name}"),
        format!("\"{word}\""),
    ))
}

/// Types of flags, with WebGPU's name and the flags that it has.
const FLAGS: [(&str, &str, &[&str]); 4] = [
    (
        "BufferUsages",
        "GPUBufferUsage",
        &[
            "MAP_READ",
            "MAP_WRITE",
            "COPY_SRC",
            "COPY_DST",
            "INDEX",
            "VERTEX",
            "UNIFORM",
            "STORAGE",
            "INDIRECT",
            "QUERY_RESOLVE",
        ],
    ),
    (
        "TextureUsages",
        "GPUTextureUsage",
        &[
            "COPY_SRC",
            "COPY_DST",
            "TEXTURE_BINDING",
            "STORAGE_BINDING",
            "RENDER_ATTACHMENT",
        ],
    ),
    (
        "ShaderStages",
        "GPUShaderStage",
        &["VERTEX", "FRAGMENT", "COMPUTE"],
    ),
    (
        "ColorWrites",
        "GPUColorWrite",
        &["RED", "GREEN", "BLUE", "ALPHA", "ALL"],
    ),
];

/// Returns a union of flags.
pub(super) fn bits(kind: &str, value: &Tree) -> Result<Code, BundleError> {
    let number = match value {
        Tree::Tuple(name, parts) if name.is_empty() => parts.first(),
        value => Some(value),
    };
    let web = FLAGS.iter().find(|(of, ..)| *of == kind);
    if let Some(number @ Tree::Number(_)) = number {
        let number = digits(number)?;
        return Ok(Code {
            rust: format!("wgpu::{kind}::from_bits_truncate({number})"),
            script: web.map(|_| number.to_owned()),
        });
    }
    let names = flags(value)?;
    if names.is_empty() {
        return Ok(Code::new(format!("wgpu::{kind}::empty()"), "0"));
    }
    let union = |owner: &str, between: &str| {
        let flags: Vec<String> = names
            .iter()
            .map(|name| format!("{owner}{between}{name}"))
            .collect();
        flags.join(" | ")
    };
    let web = web.filter(|(_, _, known)| names.iter().all(|name| known.contains(name)));
    Ok(Code {
        rust: union(&format!("wgpu::{kind}"), "::"),
        script: web.map(|(_, name, _)| union(name, ".")),
    })
}

/// Returns a name in WebGPU's spelling as wgpu's variant.
fn variant(word: &str) -> String {
    let word = match word.split_once('d') {
        Some((side @ ("1" | "2" | "3"), dimension)) => format!("D{side}{dimension}"),
        _ => word.to_owned(),
    };
    let capital = |part: &str| {
        let mut letters = part.chars();
        let first = letters.next().map(|c| c.to_ascii_uppercase());
        first.into_iter().chain(letters).collect::<String>()
    };
    word.split('-').map(capital).collect()
}

/// Returns a name in wgpu's or WebGPU's spelling in WebGPU's.
fn hyphened(word: &str) -> String {
    let mut name = String::new();
    for c in word.chars() {
        if c.is_ascii_uppercase() && !name.is_empty() {
            name.push('-');
        }
        name.push(c.to_ascii_lowercase());
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(name: &str) -> Tree {
        Tree::Name(name.to_owned())
    }

    #[test]
    fn names_become_variants_and_texts() {
        for (tree, rust, script) in [
            ("one-minus-src", "OneMinusSrc", "one-minus-src"),
            ("2d-array", "D2Array", "2d-array"),
            ("depth-only", "DepthOnly", "depth-only"),
            ("Occlusion", "Occlusion", "occlusion"),
        ] {
            let code = of("A", &name(tree)).unwrap();
            assert_eq!(code.rust, format!("wgpu::A::{rust}"));
            assert_eq!(code.script.unwrap(), format!("\"{script}\""));
        }
        for (webgpu, wgpu) in [
            ("rgba8unorm-srgb", "Rgba8UnormSrgb"),
            ("depth24plus-stencil8", "Depth24PlusStencil8"),
            ("depth32float-stencil8", "Depth32FloatStencil8"),
            ("rg11b10ufloat", "Rg11b10Ufloat"),
            ("rgb10a2unorm", "Rgb10a2Unorm"),
            ("rgba32uint", "Rgba32Uint"),
            ("stencil8", "Stencil8"),
        ] {
            let printed = format(&Tree::Text(webgpu.to_owned())).unwrap();
            assert_eq!(printed.rust, format!("wgpu::TextureFormat::{wgpu}"));
            assert_eq!(printed.script.unwrap(), format!("\"{webgpu}\""));
        }
    }

    #[test]
    fn no_text_leaves_its_literal() {
        let code = string("a\"; b\\\n\u{202e}</script>\u{1f600}");
        assert_eq!(code.rust, "\"a\\\"; b\\\\\\n\\u{202e}</script>\\u{1f600}\"");
        assert_eq!(
            code.script.unwrap(),
            "\"a\\\"; b\\\\\\n\\u202e\\u003c/script>\\ud83d\\ude00\""
        );
        let plain = source("fn a() {}\n");
        assert_eq!(plain.rust, "r###\"fn a() {}\n\"###");
        assert_eq!(plain.script.unwrap(), "`fn a() {}\n`");
        for hostile in [
            "\"### + std::process::exit(3); //",
            "`; alert(1); `${alert(1)}",
            "</script><script>alert(1)",
        ] {
            let code = source(hostile);
            assert!(!code.script.as_ref().unwrap().contains('<'), "{code:?}");
            let literal = string(hostile);
            assert!(code.rust == literal.rust || code.script == literal.script);
        }
        for hostile in ["a; b", "a::b", "", "a\n", "a/*"] {
            assert!(of("A", &name(hostile)).is_err(), "{hostile}");
        }
        for hostile in ["1; b", "inf", "NaN", "", "x"] {
            let number = Tree::Number(hostile.to_owned());
            assert!(plain_of(&number).is_err(), "{hostile}");
        }
    }

    fn plain_of(value: &Tree) -> Result<Code, BundleError> {
        plain(value)
    }

    #[test]
    fn bytes_are_floats_words_or_bytes() {
        assert_eq!(bytes(&[0; 8]), Code::new("&[0; 8]", "new Uint8Array(8)"));
        let floats = bytes(&1.5_f32.to_le_bytes());
        assert!(floats.rust.contains("floats(&[\n        1.5,"));
        assert!(
            floats
                .script
                .unwrap()
                .contains("Float32Array([\n        1.5,")
        );
        assert!(
            bytes(&7_u32.to_le_bytes())
                .rust
                .contains("words(&[\n        0x7,")
        );
        assert_eq!(bytes(&[1, 2]).rust, "&[1, 2]");
    }

    #[test]
    fn flags_that_webgpu_lacks_are_in_no_script() {
        let usage = Tree::Text("COPY_SRC | RENDER_ATTACHMENT".to_owned());
        let code = bits("TextureUsages", &usage).unwrap();
        let script = "GPUTextureUsage.COPY_SRC | GPUTextureUsage.RENDER_ATTACHMENT";
        assert_eq!(code.script.unwrap(), script);
        let usage = Tree::Text("COPY_SRC | TRANSIENT".to_owned());
        assert_eq!(bits("TextureUsages", &usage).unwrap().script, None);
        let mask = Tree::Number("15".to_owned());
        assert_eq!(
            bits("ColorWrites", &mask).unwrap().script.as_deref(),
            Some("15")
        );
    }
}
