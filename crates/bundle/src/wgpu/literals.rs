//! Texts, numbers, names and bytes of calls as literals.

use super::code::Code;
use etalon_webgpu::GpuFormat;

/// Returns a text as a literal, which cannot end a script element.
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
    // WebGPU lacks this attribute of wgpu.
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

/// Returns bytes as an expression: zeros, floats, words, or single bytes.
pub(super) fn bytes(values: &[u8]) -> Code {
    let size = values.len();
    if values.iter().all(|byte| *byte == 0) {
        return Code::new(format!("&[0; {size}]"), format!("new Uint8Array({size})"));
    }
    if !size.is_multiple_of(4) {
        return Code::new(
            format!("&{values:?}"),
            format!("new Uint8Array({values:?})"),
        );
    }
    let words = || {
        let each = values.chunks_exact(4);
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

/// Returns a value that both languages print the same way: an integer, `true` or `false`.
pub(super) fn plain(value: impl std::fmt::Display) -> Code {
    Code::same(value.to_string())
}

/// Returns a float for a place that expects 32 bits.
pub(super) fn float(value: f32) -> Code {
    Code::same(format!("{value:?}"))
}

/// Returns a value of an enumeration, given WebGPU's name.
pub(super) fn of(kind: &str, name: &str) -> Code {
    Code::new(
        format!("wgpu::{kind}::{}", variant(name)),
        format!("\"{name}\""),
    )
}

/// Returns a format.
pub(super) fn format(format: GpuFormat) -> Code {
    const PARTS: [&str; 7] = [
        "unorm", "snorm", "uint", "sint", "ufloat", "plus", "stencil",
    ];
    let word = format.name();
    let mut name = variant(word);
    for part in PARTS {
        name = name.replace(part, &format!("{}{}", part[..1].to_uppercase(), &part[1..]));
    }
    if !name.contains("Ufloat") {
        name = name.replace("float", "Float");
    }
    Code::new(
        format!("wgpu::TextureFormat::{name}"),
        format!("\"{word}\""),
    )
}

/// The flags of a type in wgpu and WebGPU, from bit 0 on. A bit without a name is unused.
pub(super) struct Flags {
    rust: &'static str,
    script: &'static str,
    names: &'static [&'static str],
}

/// The usages of buffers.
pub(super) const BUFFER_USAGES: Flags = Flags {
    rust: "wgpu::BufferUsages",
    script: "GPUBufferUsage",
    names: &[
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
};

/// The usages of textures.
pub(super) const TEXTURE_USAGES: Flags = Flags {
    rust: "wgpu::TextureUsages",
    script: "GPUTextureUsage",
    names: &[
        "COPY_SRC",
        "COPY_DST",
        "TEXTURE_BINDING",
        "STORAGE_BINDING",
        "RENDER_ATTACHMENT",
    ],
};

/// The colour channels that are written.
pub(super) const COLOR_WRITES: Flags = Flags {
    rust: "wgpu::ColorWrites",
    script: "GPUColorWrite",
    names: &["RED", "GREEN", "BLUE", "ALPHA"],
};

impl Flags {
    /// Returns the shader stages; bit 0 is the fragment stage.
    pub(super) const fn of_fragment_stage() -> Self {
        Self {
            rust: "wgpu::ShaderStages",
            script: "GPUShaderStage",
            names: &["FRAGMENT"],
        }
    }

    /// Returns a union of flags.
    pub(super) fn union(&self, bits: u32) -> Code {
        let names = (0..).zip(self.names);
        let set: Vec<&str> = names
            .filter(|(bit, _)| bits & 1 << bit != 0)
            .map(|(_, name)| *name)
            .collect();
        if set.is_empty() {
            return Code::new(format!("{}::empty()", self.rust), "0");
        }
        let union = |owner: &str, between: &str| {
            let flags: Vec<String> = set
                .iter()
                .map(|name| format!("{owner}{between}{name}"))
                .collect();
            flags.join(" | ")
        };
        Code::new(union(self.rust, "::"), union(self.script, "."))
    }
}

/// Converts a name in WebGPU's spelling to wgpu's variant.
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

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::TextureFormat;

    #[test]
    fn names_become_variants_and_texts() {
        for (name, rust) in [
            ("one-minus-src", "OneMinusSrc"),
            ("2d", "D2"),
            ("depth-only", "DepthOnly"),
        ] {
            let code = of("A", name);
            assert_eq!(code.rust, format!("wgpu::A::{rust}"));
            assert_eq!(code.script.unwrap(), format!("\"{name}\""));
        }
        for (known, wgpu) in [
            (TextureFormat::Rgba8UnormSrgb, "Rgba8UnormSrgb"),
            (TextureFormat::Depth24PlusStencil8, "Depth24PlusStencil8"),
            (TextureFormat::Depth32FloatStencil8, "Depth32FloatStencil8"),
            (TextureFormat::Rg11b10Ufloat, "Rg11b10Ufloat"),
            (TextureFormat::Rgb10a2Unorm, "Rgb10a2Unorm"),
            (TextureFormat::Stencil8, "Stencil8"),
        ] {
            let printed = format(GpuFormat::Attachment(known));
            assert_eq!(printed.rust, format!("wgpu::TextureFormat::{wgpu}"));
            assert_eq!(printed.script.unwrap(), format!("\"{known}\""));
        }
        assert_eq!(
            format(GpuFormat::Rgba32Uint).rust,
            "wgpu::TextureFormat::Rgba32Uint"
        );
    }
    #[test]
    fn hostile_texts_stay_in_their_literal() {
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
    }

    #[test]
    fn bytes_are_written_as_floats_words_or_bytes() {
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
    fn flags_are_written_as_a_union() {
        let code = TEXTURE_USAGES.union(0x11);
        assert_eq!(
            code.rust,
            "wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::RENDER_ATTACHMENT"
        );
        let script = "GPUTextureUsage.COPY_SRC | GPUTextureUsage.RENDER_ATTACHMENT";
        assert_eq!(code.script.unwrap(), script);
        assert_eq!(
            COLOR_WRITES.union(0),
            Code::new("wgpu::ColorWrites::empty()", "0")
        );
    }
}
