//! The table of permitted values.

use super::code::{Code, Structure, list};
use super::literals::{number, string};
use crate::due::Due;
use crate::error::BundleError;
use crate::table::{self, BitOrder, CheckedChannel, TableTexel};
use crate::wrap::wrapped;
use etalon_backend::Recording;

/// The types and functions for the table, in Rust.
const RUST: &str = r#"
/// The comparison of the bits of a channel: as a number, a signed number, a float of 16 bits (by its sign and
/// magnitude), a float of 32 bits, or a byte that a shorter code was widened to.
#[allow(dead_code)]
enum Order {
    Unsigned,
    Signed,
    Half,
    Single,
    Value,
    Widened,
}

struct Channel {
    name: &'static str,
    memory: usize,
    at: usize,
    bit: usize,
    bits: usize,
    order: Order,
    width: u32,
}

struct Texel {
    place: &'static str,
    channels: &'static [Channel],
    allowed: &'static [&'static [[f64; 2]]],
}

fn value_of(memories: &[Vec<u8>], c: &Channel) -> f64 {
    let first = c.at + c.bit / 8;
    let bytes = &memories[c.memory][first..first + (c.bit % 8 + c.bits).div_ceil(8)];
    let word = bytes.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte));
    let code = (word >> (c.bit % 8)) as u32 & (u32::MAX >> (32 - c.bits));
    let sign = 1 << (c.width - 1);
    match c.order {
        Order::Signed if code & sign != 0 => f64::from(code) - 2.0 * f64::from(sign),
        Order::Half | Order::Single if code & sign != 0 => -f64::from(code - sign),
        Order::Value => f64::from(f32::from_bits(code)),
        Order::Widened => f64::from((code * ((1 << c.width) - 1) + 127) / 255),
        _ => f64::from(code),
    }
}

/// Returns the number that a position in the order represents.
fn shown(c: &Channel, order: f64) -> f64 {
    let size = order.abs();
    let value = match c.order {
        Order::Single if size < f64::from(0x7F80_0000) => f64::from(f32::from_bits(size as u32)),
        Order::Half if size < 1024.0 => size * (-24_f64).exp2(),
        Order::Half if size < 31744.0 => (size % 1024.0 + 1024.0) * ((size / 1024.0).floor() - 25.0).exp2(),
        Order::Single | Order::Half => f64::INFINITY,
        _ => return order,
    };
    value.copysign(order)
}

fn is_right(memories: &[Vec<u8>], texel: &Texel) -> bool {
    texel.allowed.iter().any(|outcome| {
        texel.channels.iter().zip(*outcome).all(|(channel, [least, most])| {
            let value = value_of(memories, channel);
            value >= *least && value <= *most
        })
    })
}

fn tell(memories: &[Vec<u8>], texel: &Texel) -> String {
    let mut line = format!("{} is wrong:", texel.place);
    for (number, channel) in texel.channels.iter().enumerate() {
        let value = value_of(memories, channel);
        let told = format!(" {} {}", channel.name, shown(channel, value));
        let [outcome] = texel.allowed else {
            line += &told;
            continue;
        };
        let [least, most] = outcome[number];
        if value >= least && value <= most {
            continue;
        }
        let [low, high] = [shown(channel, least), shown(channel, most)];
        let allowed = match (least.is_infinite(), most.is_infinite()) {
            _ if least == most => low.to_string(),
            (_, true) => format!("at least {low}"),
            (true, _) => format!("at most {high}"),
            _ => format!("{low} to {high}"),
        };
        line += &format!("{told} (must be {allowed})");
    }
    line
}
"#;

/// The functions for the table, in JavaScript.
const SCRIPT: &str = r#"
// How the bits of a channel are compared: as an unsigned or signed number, a float of 16 bits ("half", by its sign and
// magnitude), a float of 32 bits ("single" by its sign and magnitude, "value" by its value), or a byte that a shorter
// code was "widened" to.
function valueOf(memories, c) {
  const first = c.at + Math.floor(c.bit / 8), shift = c.bit % 8;
  let word = 0;
  for (let i = Math.ceil((shift + c.bits) / 8) - 1; i >= 0; i--)
    word = word * 256 + memories[c.memory][first + i];
  const code = Math.floor(word / 2 ** shift) % 2 ** c.bits;
  const sign = 2 ** (c.width - 1);
  switch (c.order) {
    case "signed":
      return code >= sign ? code - 2 * sign : code;
    case "half":
    case "single":
      return code >= sign ? -(code - sign) : code;
    case "value":
      return new Float32Array(new Uint32Array([code]).buffer)[0];
    case "widened":
      return Math.floor((code * (2 ** c.width - 1) + 127) / 255);
    default:
      return code;
  }
}

// Returns the number that a position in the order represents.
function shown(c, order) {
  const size = Math.abs(order), sign = order < 0 ? -1 : 1;
  if (c.order === "single")
    return sign * (size < 0x7f800000 ? new Float32Array(new Uint32Array([size]).buffer)[0] : Infinity);
  if (c.order !== "half")
    return order;
  if (size >= 31744)
    return sign * Infinity;
  return sign * (size < 1024 ? size * 2 ** -24 : (size % 1024 + 1024) * 2 ** (Math.floor(size / 1024) - 25));
}

function isRight(memories, texel) {
  return texel.allowed.some((outcome) => texel.channels.every((channel, i) => {
    const value = valueOf(memories, channel);
    return value >= outcome[i][0] && value <= outcome[i][1];
  }));
}

function tell(memories, texel) {
  let line = texel.place + " is wrong:";
  texel.channels.forEach((channel, i) => {
    const value = valueOf(memories, channel);
    const told = ` ${channel.name} ${shown(channel, value)}`;
    if (texel.allowed.length !== 1) {
      line += told;
      return;
    }
    const [least, most] = texel.allowed[0][i];
    if (value >= least && value <= most)
      return;
    const [low, high] = [shown(channel, least), shown(channel, most)];
    let allowed = `${low} to ${high}`;
    if (least === most)
      allowed = low;
    else if (most === Infinity)
      allowed = `at least ${low}`;
    else if (least === -Infinity)
      allowed = `at most ${high}`;
    line += `${told} (must be ${allowed})`;
  });
  return line;
}
"#;

/// Returns the functions that check the values that were read.
pub(super) fn check(recording: &Recording, expected: &Due) -> Result<Code, BundleError> {
    let texels = table::texels(recording, expected)?;
    let mut text = Code::same("");
    if !texels.is_empty() {
        text.push(&Code::new(RUST, SCRIPT));
        let entries = list(texels.iter().map(texel));
        text.push(&Code {
            rust: wrapped(&format!("\nstatic TEXELS: &[Texel] = {};", entries.rust)) + "\n",
            script: entries
                .script
                .map(|texels| wrapped(&format!("\nconst texels = {texels};")) + "\n"),
        });
    }
    text.push(&Code::new(
        "\n/// Returns the first value that is wrong.\nfn wrong(memories: &[Vec<u8>]) -> Option<String> {\n",
        "\n// Returns the first value that is wrong.\nfunction wrong(memories) {\n",
    ));
    if !texels.is_empty() {
        text.push(&Code::new(
            "    for texel in TEXELS {\n        if !is_right(memories, texel) {\n            return Some(tell(memories, \
             texel));\n        }\n    }\n",
            "  for (const texel of texels)\n    if (!isRight(memories, texel))\n      return tell(memories, texel);\n",
        ));
    }
    for expected_counter in &expected.counters {
        text.push(&counter(recording, expected_counter)?);
    }
    text.push(&Code::new("    None\n}\n", "  return null;\n}\n"));
    Ok(text)
}

fn texel(texel: &TableTexel) -> Code {
    let outcome = |outcome: &Vec<[f64; 2]>| {
        let range = |ends: &[f64; 2]| {
            let [least, most] = ends.map(number);
            let text = |least: &str, most: &str| format!("[{least}, {most}]");
            Code {
                rust: text(&least.rust, &most.rust),
                script: least
                    .script
                    .zip(most.script)
                    .map(|(least, most)| text(&least, &most)),
            }
        };
        list(outcome.iter().map(range))
    };
    Structure::of("Texel")
        .with("place", string(&texel.place))
        .with("channels", list(texel.channels.iter().map(channel)))
        .with("allowed", list(texel.allowed.iter().map(outcome)))
        .end()
}

fn channel(channel: &CheckedChannel) -> Code {
    let (rust, script) = match channel.order {
        BitOrder::Unsigned => ("Order::Unsigned", "\"unsigned\""),
        BitOrder::Signed => ("Order::Signed", "\"signed\""),
        BitOrder::Half => ("Order::Half", "\"half\""),
        BitOrder::Single => ("Order::Single", "\"single\""),
        BitOrder::Value => ("Order::Value", "\"value\""),
        BitOrder::Widened => ("Order::Widened", "\"widened\""),
    };
    Structure::of("Channel")
        .with("name", string(&channel.name))
        .with("memory", Code::same(channel.output.to_string()))
        .with("at", Code::same(channel.at.to_string()))
        .with("bit", Code::same(channel.bit.to_string()))
        .with("bits", Code::same(channel.bits.to_string()))
        .with("order", Code::new(rust, script))
        .with("width", Code::same(channel.width.to_string()))
        .end()
}

/// Returns the statements that check a counter.
fn counter(recording: &Recording, expected: &crate::due::DueCounter) -> Result<Code, BundleError> {
    let counter = table::counter(recording, expected)?;
    let parts = counter.parts.iter().map(|part| {
        let (memory, first) = (part.output, part.offset);
        let end = first + part.bytes;
        Code::new(
            format!("&memories[{memory}][{first}..{end}]"),
            format!("memories[{memory}].slice({first}, {end})"),
        )
    });
    let parts = list(parts);
    let (each, total) = if counter.any {
        (
            "u64::from(part.iter().any(|byte| *byte != 0))",
            "max().unwrap_or(0)",
        )
    } else {
        (
            "part.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte))",
            "sum::<u64>()",
        )
    };
    let (each_script, total_script) = if counter.any {
        ("part.some((byte) => byte) ? 1 : 0", "Math.max(all, part)")
    } else {
        (
            "part.reduceRight((word, byte) => word * 256 + byte, 0)",
            "all + part",
        )
    };
    let (low, high) = (expected.range.low, expected.range.high);
    let range = match high {
        Some(high) => format!("{low}..={high}"),
        None => format!("{low}.."),
    };
    let above = match high {
        Some(high) => format!(" || count > {high}"),
        None => String::new(),
    };
    let (name, allowed) = (string(&expected.name), string(&expected.range.to_string()));
    let script = |parts: String| {
        let (name, allowed) = (name.script.as_ref()?, allowed.script.as_ref()?);
        Some(format!(
            "  {{\n    const count = {parts}.map((part) => {each_script}).reduce((all, part) => {total_script}, 0);\n    if (count < \
             {low}{above})\n      return `counter ${{{name}}} is ${{count}} (must be ${{{allowed}}})`;\n  }}\n"
        ))
    };
    Ok(Code {
        rust: format!(
            "    let parts: &[&[u8]] = {};\n    let count = parts.iter().map(|part| {each}).{total};\n    if \
             !({range}).contains(&count) {{\n        return Some(format!(\"counter {{}} is {{count}} (must be {{}})\", {}, \
             {}));\n    }}\n",
            parts.rust, name.rust, allowed.rust,
        ),
        script: parts.script.and_then(script),
    })
}
