//! Recorded Vulkan calls as C: statements, with the types, functions, variables and data that they need.

use crate::c;
use crate::declarations::{Body, Declarations, Words};
use crate::error::BundleError;
use crate::wrap::wrapped;
use etalon_backend::{Argument, Constant, Member, RecordedCall};
use std::collections::{BTreeSet, HashMap};
use std::fmt::Write;

/// Prints calls.
pub(super) struct Printer {
    pub(super) declarations: Declarations,
    /// The types of handles.
    handles: BTreeSet<String>,
    /// The structures with their declarations, ordered so that each is declared before its use.
    structures: Vec<(String, String)>,
    /// The variable of an object, by kind and number.
    objects: HashMap<(String, u64), String>,
}

/// Bytes are printed as words, since no call states that they are floats.
const WORDS: Option<Words> = None;
/// The handles that are pointers.
const DISPATCHABLE: [&str; 4] = ["VkPhysicalDevice", "VkDevice", "VkQueue", "VkCommandBuffer"];

impl Printer {
    /// Returns a printer that already has the physical device, which every program has.
    pub(super) fn new() -> Self {
        Self {
            declarations: Declarations::default(),
            handles: BTreeSet::from(["VkPhysicalDevice".to_owned()]),
            structures: Vec::new(),
            objects: HashMap::new(),
        }
    }

    /// Returns the functions that make the calls.
    pub(super) fn body(&mut self, calls: &[RecordedCall]) -> Result<Body, BundleError> {
        Body::of(calls, |call| Ok(wrapped(&self.statement(call)?)))
    }

    /// Returns the types.
    pub(super) fn types(&self) -> String {
        let mut text = String::new();
        for kind in &self.handles {
            let variable = if DISPATCHABLE.contains(&kind.as_str()) {
                "void *"
            } else {
                "uint64_t "
            };
            let _ = writeln!(text, "typedef {variable}{kind};");
        }
        for (_, declaration) in &self.structures {
            text.push('\n');
            text.push_str(declaration);
        }
        text
    }

    fn statement(&mut self, call: &RecordedCall) -> Result<String, BundleError> {
        let name = call.function.as_str();
        let unknown = || BundleError::Call(name.to_owned());
        if !c::is_identifier(name) {
            return Err(unknown());
        }
        let arguments = call.arguments.as_slice();
        match (name, arguments) {
            ("write", [mapped, Argument::Size(offset), Argument::Bytes(bytes)]) => {
                let mapped = self.value(call, mapped)?;
                let data = self.declarations.bytes(bytes, WORDS);
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
                let memory = self.declarations.memory(*number, *size);
                let mapped = self.value(call, mapped)?;
                return Ok(format!("memcpy({memory}, {mapped} + {offset}, {size});"));
            }
            ("vkGetBufferMemoryRequirements" | "vkGetImageMemoryRequirements", [_, object, _]) => {
                let object = self.value(call, object)?;
                let device = self.value(call, &arguments[0])?;
                let kind = kind_of(&arguments[1]);
                let parameters = vec!["VkDevice".to_owned(), kind, "void *".to_owned()];
                self.declarations.function(name, "void", parameters);
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
        for argument in arguments {
            values.push(self.value(call, argument)?);
        }
        let types = arguments.iter().map(kind_of).collect();
        let made = format!("{name}({})", values.join(", "));
        let void = name.starts_with("vkCmd")
            || matches!(name, "vkGetDeviceQueue" | "vkUpdateDescriptorSets");
        let result = if void { "void" } else { "int32_t" };
        self.declarations.function(name, result, types);
        Ok(if void {
            format!("{made};")
        } else {
            format!("check({made}, \"{name}\", __LINE__);")
        })
    }

    /// Declares a new variable for an object and returns its name.
    fn define(&mut self, kind: &str, number: u64) -> String {
        let short = kind.trim_start_matches("Vk").trim_end_matches("KHR");
        let mut stem = String::new();
        for c in short.chars() {
            if c.is_ascii_uppercase() && !stem.is_empty() {
                stem.push('_');
            }
            stem.extend(c.to_lowercase());
        }
        let word = match kind {
            "mapped" => "unsigned char *",
            kind => kind,
        };
        if word == kind {
            self.handles.insert(kind.to_owned());
        }
        let variable = self.declarations.variable(word, &stem);
        self.objects
            .insert((kind.to_owned(), number), variable.clone());
        variable
    }

    /// Returns the expression of an argument.
    fn value(&mut self, call: &RecordedCall, argument: &Argument) -> Result<String, BundleError> {
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
            Argument::Bytes(bytes) => self.declarations.bytes(bytes, WORDS),
            Argument::Array(elements) => {
                let kind = element_of(elements);
                let values = self.values(call, elements)?;
                format!("(const {kind}[]){{ {values} }}")
            }
            Argument::Values(members) => format!("{{ {} }}", self.values(call, members)?),
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
                if values.is_empty() {
                    format!("{{ {zero} }}")
                } else {
                    format!("{{ {} }}", values.join(", "))
                }
            }
            Argument::Text(text) => c::string(text),
            Argument::Offset(0) | Argument::Null => "NULL".to_owned(),
            Argument::Output(number, bytes) => self.declarations.memory(*number, *bytes),
            _ => return Err(BundleError::Call(call.function.clone())),
        })
    }

    fn values(
        &mut self,
        call: &RecordedCall,
        arguments: &[Argument],
    ) -> Result<String, BundleError> {
        let mut values = Vec::new();
        for value in arguments {
            values.push(self.value(call, value)?);
        }
        Ok(values.join(", "))
    }

    /// Declares a structure, unless it is already declared.
    fn declare(&mut self, kind: &str, size: u64, members: &[Member]) -> Result<(), BundleError> {
        if !c::is_identifier(kind) || self.structures.iter().any(|(name, _)| name == kind) {
            return Ok(());
        }
        let mut text = String::from("typedef struct {\n");
        let mut nested = Vec::new();
        for member in members {
            if !c::is_identifier(&member.name) {
                return Err(BundleError::Call(kind.to_owned()));
            }
            let first = match &member.value {
                Argument::Values(values) => values.first(),
                value => Some(value),
            };
            if let Some(Argument::Struct {
                kind,
                size,
                members,
            }) = first
            {
                nested.push((kind.clone(), *size, members.clone()));
            }
            let declaration = match &member.value {
                Argument::Values(values) => {
                    format!("{} {}[{}]", element_of(values), member.name, values.len())
                }
                Argument::Struct { kind, .. } => format!("{kind} {}", member.name),
                value => {
                    if let Argument::Object(kind, _) = value {
                        self.handles.insert(kind.clone());
                    }
                    let value_kind = kind_of(value);
                    let space = if value_kind.ends_with('*') { "" } else { " " };
                    format!("{value_kind}{space}{}", member.name)
                }
            };
            let _ = writeln!(text, "    {declaration};");
        }
        for (kind, size, members) in nested {
            self.declare(&kind, size, &members)?;
        }
        let _ = writeln!(text, "}} {kind};");
        // The declaration does not compile if the layout is wrong.
        let _ = writeln!(
            text,
            "typedef char size_of_{kind}[sizeof({kind}) == {size} ? 1 : -1];"
        );
        self.structures.push((kind.to_owned(), text));
        Ok(())
    }
}

/// Returns true if a value is zero, which is C's value of an omitted member.
fn is_zero(value: &Argument) -> bool {
    match value {
        Argument::Integer(0)
        | Argument::Unsigned(0)
        | Argument::Size(0)
        | Argument::Float(0)
        | Argument::Object(_, 0)
        | Argument::Null => true,
        Argument::Constant(constant) => constant.value == 0,
        Argument::Values(values) => values.iter().all(is_zero),
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
    if name.is_empty() || name == value || constant.value == 0 {
        value
    } else {
        format!("{value} /* {name} */")
    }
}

/// Returns the type of an argument. All pointers have the same type.
fn kind_of(argument: &Argument) -> String {
    match argument {
        Argument::Integer(_) => "int32_t",
        Argument::Unsigned(_) | Argument::Constant(_) => "uint32_t",
        Argument::Size(_) => "uint64_t",
        Argument::Float(_) => "float",
        Argument::Object(kind, _) if c::is_identifier(kind) => kind,
        Argument::Created(..) | Argument::Output(..) => "void *",
        _ => "const void *",
    }
    .to_owned()
}

/// Returns the type of the values of an array.
fn element_of(values: &[Argument]) -> String {
    match values.first() {
        Some(Argument::Struct { kind, .. }) if c::is_identifier(kind) => kind.clone(),
        Some(Argument::Text(_)) => "char *const".to_owned(),
        Some(value) => kind_of(value),
        None => "char".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_backend::Phase;

    #[test]
    fn structures_are_declared_before_arrays_of_them() {
        let structure = |kind: &str, size, name: &str, value| Argument::Struct {
            kind: kind.to_owned(),
            size,
            members: vec![Member {
                name: name.to_owned(),
                value,
            }],
        };
        let offset = || structure("VkOffset", 4, "x", Argument::Integer(1));
        let offsets = Argument::Values(vec![offset(), offset()]);
        let mut printer = Printer::new();
        let call = RecordedCall {
            phase: Phase::Prepare,
            function: "vkCmdBlit".to_owned(),
            arguments: vec![Argument::Array(vec![structure(
                "VkBlit", 8, "offsets", offsets,
            )])],
            result: None,
        };
        let body = printer.body(&[call]).unwrap();
        let value = "(const VkBlit[]){ { .offsets = { { .x = 1 }, { .x = 1 } } } }";
        assert!(body.definitions.contains(value), "{}", body.definitions);
        let types = printer.types();
        let [first, second] = ["} VkOffset;", "    VkOffset offsets[2];\n} VkBlit;"]
            .map(|text| types.find(text).unwrap());
        assert!(first < second, "{types}");
    }
}
