//! Recorded calls of Vulkan as C: statements, and the types, functions, variables and data that they need.

use crate::c;
use crate::error::BundleError;
use etalon_backend::{Argument, Call, Constant, Member, Phase};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fmt::Write;

/// The declarations that the statements so far need.
#[derive(Default)]
pub(super) struct Printer {
    /// The types of handles.
    handles: BTreeSet<String>,
    /// The structures, in the order in which each may be declared, with their declarations.
    structures: Vec<(String, String)>,
    /// The functions: result and parameters.
    functions: BTreeMap<String, (&'static str, Vec<String>)>,
    /// The variables that hold objects, with their types.
    variables: Vec<(String, String)>,
    /// The variable of an object, by kind and number.
    objects: HashMap<(String, u64), String>,
    /// The objects of each kind so far.
    counts: HashMap<String, u32>,
    /// Data, as declarations.
    data: String,
    arrays: u32,
    /// Memory that is read: its size by its number.
    memories: BTreeMap<u32, u64>,
    parts: Vec<String>,
}

/// The handles that are addresses.
const DISPATCHABLE: [&str; 4] = ["VkPhysicalDevice", "VkDevice", "VkQueue", "VkCommandBuffer"];

impl Printer {
    /// Returns the functions that make the calls.
    pub(super) fn body(&mut self, calls: &[Call]) -> Result<String, BundleError> {
        let key = ("VkPhysicalDevice".to_owned(), 0);
        self.handles.insert(key.0.clone());
        let mut text = String::new();
        let mut phase = None;
        for call in calls {
            if phase != Some(call.phase) {
                if phase.is_some() {
                    text.push_str("}\n");
                }
                phase = Some(call.phase);
                let name = self.part(call.phase);
                let _ = write!(text, "\nstatic void {name}(void)\n{{\n");
            }
            let statement = wrapped(&self.statement(call)?);
            for line in statement.lines() {
                let _ = writeln!(text, "    {line}");
            }
        }
        if phase.is_some() {
            text.push_str("}\n");
        }
        Ok(text)
    }

    /// Returns the name of the next function.
    fn part(&mut self, phase: Phase) -> String {
        let name = match phase {
            Phase::Prepare => "prepare",
            Phase::Submit => "draw",
            Phase::Read => "read_back",
        };
        let before = self
            .parts
            .iter()
            .filter(|part| part.trim_end_matches(char::is_numeric) == name)
            .count();
        let name = match before {
            0 => name.to_owned(),
            n => format!("{name}{}", n + 1),
        };
        self.parts.push(name.clone());
        name
    }

    /// Returns the calls of the functions.
    pub(super) fn parts(&self) -> String {
        let calls = self.parts.iter().map(|part| format!("    {part}();\n"));
        calls.collect()
    }

    /// Returns the types.
    pub(super) fn types(&self) -> String {
        let mut text = String::new();
        for kind in &self.handles {
            let own = match DISPATCHABLE.contains(&kind.as_str()) {
                true => "void *",
                false => "uint64_t ",
            };
            let _ = writeln!(text, "typedef {own}{kind};");
        }
        for (_, declaration) in &self.structures {
            text.push('\n');
            text.push_str(declaration);
        }
        text
    }

    /// Returns the declarations of the functions.
    pub(super) fn functions(&self) -> String {
        let mut text = String::from("\n");
        for (name, (result, parameters)) in &self.functions {
            let parameters = parameters.join(", ");
            let _ = writeln!(text, "static {result} (*{name})({parameters});");
        }
        text
    }

    /// Returns the function that finds the functions.
    pub(super) fn load(&self) -> String {
        let mut text = String::from("\nstatic void load(void)\n{\n");
        for name in self.functions.keys() {
            let _ = writeln!(text, "    *(void **)&{name} = function(\"{name}\");");
        }
        text + "}\n"
    }

    /// Returns the declarations of objects, memory and data.
    pub(super) fn variables(&self) -> String {
        let mut text = String::from("\n");
        for (kind, name) in &self.variables {
            let _ = writeln!(text, "static {kind} {name};");
        }
        for (number, bytes) in &self.memories {
            let _ = writeln!(
                text,
                "static unsigned char memory_{number}[{}];",
                bytes.max(&1)
            );
        }
        text.push_str(&self.data);
        text
    }

    fn statement(&mut self, call: &Call) -> Result<String, BundleError> {
        let name = call.function.as_str();
        let unknown = || BundleError::Call(name.to_owned());
        if !is_identifier(name) {
            return Err(unknown());
        }
        let all = call.arguments.as_slice();
        match (name, all) {
            ("write", [mapped, Argument::Size(offset), Argument::Bytes(bytes)]) => {
                let mapped = self.value(call, mapped)?;
                let data = self.bytes(bytes);
                return Ok(format!(
                    "memcpy({mapped} + {offset}, {data}, {});",
                    bytes.len()
                ));
            }
            (
                "read",
                [
                    Argument::Output(number, size),
                    mapped,
                    Argument::Size(offset),
                ],
            ) => {
                self.memories.insert(*number, *size);
                let mapped = self.value(call, mapped)?;
                return Ok(format!(
                    "memcpy(memory_{number}, {mapped} + {offset}, {size});"
                ));
            }
            ("vkGetBufferMemoryRequirements" | "vkGetImageMemoryRequirements", [_, object, _]) => {
                let object = self.value(call, object)?;
                let device = self.value(call, &all[0])?;
                let kind = kind_of(&all[1]);
                let parameters = vec!["VkDevice".to_owned(), kind, "void *".to_owned()];
                self.functions.insert(name.to_owned(), ("void", parameters));
                return Ok(format!("{name}({device}, {object}, &needs);"));
            }
            ("vkAllocateMemory", [device, Argument::Constant(flags), _, made]) => {
                let device = self.value(call, device)?;
                let made = self.value(call, made)?;
                return Ok(format!(
                    "allocate({device}, {}, {made}, __LINE__);",
                    word(flags)
                ));
            }
            ("vkCreateImage", [device, info, _, made]) => {
                let device = self.value(call, device)?;
                let info = self.value(call, info)?;
                let made = self.value(call, made)?;
                return Ok(format!("create_image({device}, {info}, {made}, __LINE__);"));
            }
            ("vkMapMemory", [device, memory, _, _, _, Argument::Created(_, mapped)]) => {
                let device = self.value(call, device)?;
                let memory = self.value(call, memory)?;
                let variable = self.define("mapped", *mapped.first().ok_or_else(unknown)?);
                return Ok(format!("{variable} = map({device}, {memory}, __LINE__);"));
            }
            ("vkCreateDevice", [_, info, _, Argument::Created(kind, made)]) => {
                let info = self.value(call, info)?;
                let device = self.define(kind, *made.first().ok_or_else(unknown)?);
                return Ok(format!(
                    "{device} = create_device({info}, __LINE__);\nload_device({device});"
                ));
            }
            _ => {}
        }
        let mut values = Vec::new();
        for argument in all {
            values.push(self.value(call, argument)?);
        }
        let types = all.iter().map(kind_of).collect();
        let made = format!("{name}({})", values.join(", "));
        let void = name.starts_with("vkCmd")
            || matches!(name, "vkGetDeviceQueue" | "vkUpdateDescriptorSets");
        let result = match void {
            true => "void",
            false => "int32_t",
        };
        self.functions
            .entry(name.to_owned())
            .or_insert((result, types));
        Ok(match void {
            true => format!("{made};"),
            false => format!("check({made}, \"{name}\", __LINE__);"),
        })
    }

    /// Returns a new variable for an object.
    fn define(&mut self, kind: &str, number: u64) -> String {
        let short = kind.trim_start_matches("Vk").trim_end_matches("KHR");
        let mut stem = String::new();
        for c in short.chars() {
            if c.is_ascii_uppercase() && !stem.is_empty() {
                stem.push('_');
            }
            stem.extend(c.to_lowercase());
        }
        let count = self.counts.entry(kind.to_owned()).or_default();
        *count += 1;
        let variable = format!("{stem}_{count}");
        let own = match kind {
            "mapped" => "unsigned char *",
            kind => kind,
        };
        if own == kind {
            self.handles.insert(kind.to_owned());
        }
        self.variables.push((own.to_owned(), variable.clone()));
        self.objects
            .insert((kind.to_owned(), number), variable.clone());
        variable
    }

    /// Returns the expression of an argument.
    fn value(&mut self, call: &Call, argument: &Argument) -> Result<String, BundleError> {
        Ok(match argument {
            Argument::Integer(value) if *value == i32::MIN => "INT32_MIN".to_owned(),
            Argument::Integer(value) => value.to_string(),
            Argument::Unsigned(value) => unsigned(*value),
            Argument::Size(-1) => "~(uint64_t)0".to_owned(),
            Argument::Size(value) => value.cast_unsigned().to_string(),
            Argument::Float(bits) => c::float(*bits),
            Argument::Constant(constant) => word(constant),
            Argument::Object(kind, 0) => {
                self.handles.insert(kind.clone());
                "0".to_owned()
            }
            Argument::Object(kind, number) => {
                let known = self.objects.get(&(kind.clone(), *number)).cloned();
                known.ok_or_else(|| BundleError::Unknown {
                    function: call.function.clone(),
                    kind: kind.clone(),
                    number: *number,
                })?
            }
            Argument::Created(kind, numbers) => match numbers.as_slice() {
                [number] => format!("&{}", self.define(kind, *number)),
                _ => return Err(BundleError::Call(call.function.clone())),
            },
            Argument::Bytes(bytes) => self.bytes(bytes),
            Argument::Array(all) => {
                let kind = element_of(all);
                let values = self.values(call, all)?;
                format!("(const {kind}[]){{ {values} }}")
            }
            Argument::Values(all) => format!("{{ {} }}", self.values(call, all)?),
            Argument::Struct {
                kind,
                size,
                members,
            } => {
                self.declare(kind, *size, members)?;
                let mut values = Vec::new();
                let mut zero = String::new();
                for member in members {
                    let value = self.value(call, &member.value)?;
                    let text = format!(".{} = {value}", member.name);
                    if !is_zero(&member.value) {
                        values.push(text);
                    } else if zero.is_empty() {
                        zero = text;
                    }
                }
                match values.is_empty() {
                    true => format!("{{ {zero} }}"),
                    false => format!("{{ {} }}", values.join(", ")),
                }
            }
            Argument::Text(text) => c::string(text),
            Argument::Offset(0) | Argument::Null => "NULL".to_owned(),
            Argument::Output(number, bytes) => {
                self.memories.insert(*number, *bytes);
                format!("memory_{number}")
            }
            _ => return Err(BundleError::Call(call.function.clone())),
        })
    }

    fn values(&mut self, call: &Call, all: &[Argument]) -> Result<String, BundleError> {
        let mut values = Vec::new();
        for value in all {
            values.push(self.value(call, value)?);
        }
        Ok(values.join(", "))
    }

    /// Declares a structure, unless it is declared.
    fn declare(&mut self, kind: &str, size: u64, members: &[Member]) -> Result<(), BundleError> {
        if !is_identifier(kind) || self.structures.iter().any(|(name, _)| name == kind) {
            return Ok(());
        }
        let mut text = String::from("typedef struct {\n");
        let mut nested = Vec::new();
        for member in members {
            if !is_identifier(&member.name) {
                return Err(BundleError::Call(kind.to_owned()));
            }
            let declaration = match &member.value {
                Argument::Values(all) => {
                    format!("{} {}[{}]", element_of(all), member.name, all.len())
                }
                Argument::Struct {
                    kind,
                    size,
                    members,
                } => {
                    nested.push((kind.clone(), *size, members.clone()));
                    format!("{kind} {}", member.name)
                }
                value => {
                    if let Argument::Object(kind, _) = value {
                        self.handles.insert(kind.clone());
                    }
                    let own = kind_of(value);
                    let space = if own.ends_with('*') { "" } else { " " };
                    format!("{own}{space}{}", member.name)
                }
            };
            let _ = writeln!(text, "    {declaration};");
        }
        for (kind, size, members) in nested {
            self.declare(&kind, size, &members)?;
        }
        let _ = writeln!(text, "}} {kind};");
        // A wrong layout does not compile.
        let _ = writeln!(
            text,
            "typedef char size_of_{kind}[sizeof({kind}) == {size} ? 1 : -1];"
        );
        self.structures.push((kind.to_owned(), text));
        Ok(())
    }

    /// Returns the name of an array of these bytes: as words, or byte by byte.
    fn bytes(&mut self, bytes: &[u8]) -> String {
        self.arrays += 1;
        let name = format!("data_{}", self.arrays);
        let words = bytes
            .chunks_exact(4)
            .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        let (kind, values): (&str, Vec<String>) = if bytes.iter().all(|byte| *byte == 0) {
            let _ = writeln!(
                self.data,
                "static const unsigned char {name}[{}];",
                bytes.len().max(1)
            );
            return name;
        } else if bytes.len().is_multiple_of(4) {
            ("uint32_t", words.map(|w| format!("0x{w:08x}")).collect())
        } else {
            ("unsigned char", bytes.iter().map(u8::to_string).collect())
        };
        let _ = writeln!(
            self.data,
            "static const {kind} {name}[{}] = {{",
            values.len()
        );
        for line in values.chunks(12) {
            let _ = writeln!(self.data, "    {},", line.join(", "));
        }
        self.data.push_str("};\n");
        name
    }
}

/// Breaks lines that are too long, at the commas of what is in brackets there.
fn wrapped(statement: &str) -> String {
    const LONGEST: usize = 108;
    let lines = statement.lines().map(|line| {
        let indent = line.len() - line.trim_start().len();
        if line.len() <= LONGEST || indent > 60 {
            return line.to_owned();
        }
        let Some((open, close, commas)) = brackets(line) else {
            return line.to_owned();
        };
        let deeper = " ".repeat(indent + 4);
        let mut text = line[..=open].to_owned();
        let mut start = open + 1;
        for end in commas.into_iter().map(|comma| comma + 1).chain([close]) {
            text.push_str(&format!(
                "\n{}",
                wrapped(&format!("{deeper}{}", line[start..end].trim()))
            ));
            start = end;
        }
        text + &format!("\n{}{}", " ".repeat(indent), &line[close..])
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Returns the places of the longest outermost pair of brackets and of the commas in it, texts and comments aside.
fn brackets(line: &str) -> Option<(usize, usize, Vec<usize>)> {
    let mut longest: Option<(usize, usize, Vec<usize>)> = None;
    let (mut depth, mut open, mut commas) = (0, 0, Vec::new());
    let (mut quoted, mut comment, mut before) = (false, false, ' ');
    for (at, c) in line.char_indices() {
        match c {
            '"' if !comment && before != '\\' => quoted = !quoted,
            '*' if before == '/' && !quoted => comment = true,
            '/' if before == '*' => comment = false,
            _ if quoted || comment => {}
            '(' | '[' | '{' => {
                if depth == 0 {
                    (open, commas) = (at, Vec::new());
                }
                depth += 1;
            }
            ')' | ']' | '}' => {
                depth -= 1;
                let length = |(open, close, _): &(usize, usize, Vec<usize>)| close - open;
                if depth == 0 && longest.as_ref().is_none_or(|l| length(l) < at - open) {
                    longest = Some((open, at, std::mem::take(&mut commas)));
                }
            }
            ',' if depth == 1 => commas.push(at),
            _ => {}
        }
        before = c;
    }
    longest
}

/// True if a value is what C gives to what is left out.
fn is_zero(value: &Argument) -> bool {
    match value {
        Argument::Integer(0)
        | Argument::Unsigned(0)
        | Argument::Size(0)
        | Argument::Float(0)
        | Argument::Object(_, 0)
        | Argument::Null => true,
        Argument::Constant(constant) => constant.value == 0,
        Argument::Values(all) => all.iter().all(is_zero),
        Argument::Struct { members, .. } => members.iter().all(|member| is_zero(&member.value)),
        _ => false,
    }
}

fn unsigned(value: u32) -> String {
    match value {
        0..=0xffff => value.to_string(),
        _ => format!("0x{value:x}u"),
    }
}

/// Returns a value, with its name as a comment.
fn word(constant: &Constant) -> String {
    let value = unsigned(constant.value);
    let name = c::comment(&constant.name);
    match name.is_empty() || name == value || constant.value == 0 {
        true => value,
        false => format!("{value} /* {name} */"),
    }
}

/// Returns the type of an argument. All addresses are alike.
fn kind_of(argument: &Argument) -> String {
    match argument {
        Argument::Integer(_) => "int32_t",
        Argument::Unsigned(_) | Argument::Constant(_) => "uint32_t",
        Argument::Size(_) => "uint64_t",
        Argument::Float(_) => "float",
        Argument::Object(kind, _) if is_identifier(kind) => kind,
        Argument::Created(..) | Argument::Output(..) => "void *",
        _ => "const void *",
    }
    .to_owned()
}

/// Returns the type of the values of an array.
fn element_of(all: &[Argument]) -> String {
    match all.first() {
        Some(Argument::Struct { kind, .. }) if is_identifier(kind) => kind.clone(),
        Some(Argument::Text(_)) => "char *const".to_owned(),
        Some(value) => kind_of(value),
        None => "char".to_owned(),
    }
}

/// True if a name may stand in C as it is.
fn is_identifier(name: &str) -> bool {
    let first = name.chars().next();
    first.is_some_and(|c| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}
