//! Recorded calls as C: statements, with the constants, functions, variables and data that they need.

use crate::c;
use crate::declarations::{Body, Declarations, Words};
use crate::error::BundleError;
use etalon_backend::{Argument, Constant, RecordedCall};
use std::collections::{BTreeMap, HashMap};

/// Prints calls.
#[derive(Default)]
pub(super) struct Printer {
    pub(super) declarations: Declarations,
    constants: BTreeMap<String, u32>,
    /// The variable of an object, by kind, number and program. Numbers can be reused.
    objects: HashMap<(String, u64, u64), String>,
    program: u64,
}

impl Printer {
    /// Returns the functions that make the calls.
    pub(super) fn body(&mut self, calls: &[&RecordedCall]) -> Result<Body, BundleError> {
        Body::of(calls.iter().copied(), |call| self.statement(call))
    }

    /// Returns the definitions of the constants.
    pub(super) fn constants(&self) -> String {
        let lines = self.constants.iter();
        lines
            .map(|(name, value)| format!("#define {name} 0x{value:04X}\n"))
            .collect()
    }

    fn statement(&mut self, call: &RecordedCall) -> Result<String, BundleError> {
        let name = call.function.as_str();
        if !c::is_identifier(name) {
            return Err(BundleError::Call(name.to_owned()));
        }
        if let ("glUseProgram", [Argument::Object(_, program)]) = (name, call.arguments.as_slice())
        {
            self.program = *program;
        }
        if let ("glShaderSource", [shader, _, Argument::Text(source)]) =
            (name, call.arguments.as_slice())
        {
            let shader = self.value(call, shader)?;
            let source = self.declarations.text(&c::lines(source, "    "));
            let parameters = ["GLuint", "GLint", "const char *const *", "const GLint *"];
            let parameters = parameters.map(str::to_owned).to_vec();
            self.declarations.function(name, "void", parameters);
            return Ok(format!(
                "CALL(glShaderSource({shader}, 1, &{source}, NULL));"
            ));
        }
        let mut values = Vec::new();
        for argument in &call.arguments {
            values.push(self.value(call, argument)?);
        }
        let types = call.arguments.iter().map(kind_of).collect();
        let made = format!("{name}({})", values.join(", "));
        Ok(match (name, &call.result) {
            ("glCheckFramebufferStatus", _) => {
                self.declarations.function(name, "GLenum", types);
                format!("complete({made}, __LINE__);")
            }
            ("glMapBufferRange", Some(Argument::Output(number, bytes))) => {
                self.declarations.function(name, "void *", types);
                let memory = self.declarations.memory(*number, *bytes);
                format!("copy({memory}, {made}, {bytes}, __LINE__);")
            }
            ("glCompileShader", _) => {
                self.declarations.function(name, "void", types);
                format!("CALL({made}), compiled({}, __LINE__);", values.join(", "))
            }
            ("glLinkProgram", _) => {
                self.declarations.function(name, "void", types);
                format!("CALL({made}), linked({}, __LINE__);", values.join(", "))
            }
            (_, Some(Argument::Object(kind, number))) => {
                let c_type = match kind.as_str() {
                    "location" => "GLint",
                    _ => "GLuint",
                };
                self.declarations.function(name, c_type, types);
                let program = self.program_of(call);
                let variable = self.define(kind, *number, program, c_type);
                format!("{variable} = {made}, check(\"{name}\", __LINE__);")
            }
            (_, Some(_)) => {
                self.declarations.function(name, "GLboolean", types);
                format!("CALL({made});")
            }
            (_, None) => {
                self.declarations.function(name, "void", types);
                format!("CALL({made});")
            }
        })
    }

    /// Returns the program whose uniforms a call names.
    fn program_of(&self, call: &RecordedCall) -> u64 {
        match call.arguments.first() {
            Some(Argument::Object(kind, program)) if kind == "program" => *program,
            _ => self.program,
        }
    }

    /// Declares a new variable for an object and returns its name.
    fn define(&mut self, kind: &str, number: u64, program: u64, type_name: &'static str) -> String {
        let variable = self.declarations.variable(type_name, kind);
        let key = key(kind, number, program);
        self.objects.insert(key, variable.clone());
        variable
    }

    /// Returns the expression of an argument.
    fn value(&mut self, call: &RecordedCall, argument: &Argument) -> Result<String, BundleError> {
        Ok(match argument {
            Argument::Integer(value) if *value == i32::MIN => "INT32_MIN".to_owned(),
            Argument::Integer(value) => value.to_string(),
            Argument::Unsigned(value) if *value > 0xffff => format!("0x{value:x}u"),
            Argument::Unsigned(value) => value.to_string(),
            Argument::Boolean(value) => u8::from(*value).to_string(),
            Argument::Size(value) => value.to_string(),
            Argument::Float(bits) => c::float(*bits),
            Argument::Double(bits) => c::double(f64::from_bits(*bits)),
            Argument::Constant(constant) => self.constant(constant),
            Argument::Bits(bits) => {
                let names: Vec<String> = bits.iter().map(|bit| self.constant(bit)).collect();
                names.join(" | ")
            }
            Argument::Object(_, 0) => "0".to_owned(),
            Argument::Object(kind, number) => {
                let key = key(kind, *number, self.program_of(call));
                let known = self.objects.get(&key).cloned();
                known.ok_or_else(|| BundleError::Unknown {
                    function: call.function.clone(),
                    kind: kind.clone(),
                    number: *number,
                })?
            }
            Argument::Created(kind, numbers) => match numbers.as_slice() {
                [number] => format!("&{}", self.define(kind, *number, 0, "GLuint")),
                _ => return Err(BundleError::Call(call.function.clone())),
            },
            Argument::Bytes(bytes) => {
                let floats = holds_floats(call).then_some(FLOATS);
                self.declarations.bytes(bytes, floats)
            }
            Argument::Array(elements) => {
                let kind = element_of(elements);
                let mut values = Vec::new();
                for value in elements {
                    values.push(self.value(call, value)?);
                }
                format!("(const {kind}[]){{ {} }}", values.join(", "))
            }
            Argument::Text(text) => c::string(text),
            Argument::Offset(0) | Argument::Null => "NULL".to_owned(),
            Argument::Offset(offset) => format!("(const void *){offset}"),
            Argument::Output(number, bytes) => self.declarations.memory(*number, *bytes),
            Argument::Values(_) | Argument::Struct { .. } => {
                return Err(BundleError::Call(call.function.clone()));
            }
        })
    }

    fn constant(&mut self, constant: &Constant) -> String {
        if !c::is_identifier(&constant.name) {
            return format!("0x{:04X}", constant.value);
        }
        self.constants.insert(constant.name.clone(), constant.value);
        constant.name.clone()
    }
}

/// Returns the key of an object. Only uniform locations and blocks belong to a program.
fn key(kind: &str, number: u64, program: u64) -> (String, u64, u64) {
    let of_program = ["location", "block"].contains(&kind);
    (
        kind.to_owned(),
        number,
        if of_program { program } else { 0 },
    )
}

/// Prints words as floats.
const FLOATS: Words = ("GLfloat", finite);

/// Returns a word as a float, if it is finite.
fn finite(word: u32) -> Option<String> {
    f32::from_bits(word).is_finite().then(|| c::float(word))
}

/// Returns true if the bytes of a call are floats: vertices or uniform blocks.
fn holds_floats(call: &RecordedCall) -> bool {
    let targets = ["GL_ARRAY_BUFFER", "GL_UNIFORM_BUFFER"];
    matches!(call.arguments.first(), Some(Argument::Constant(c)) if targets.contains(&c.name.as_str()))
}

/// Returns the type of an argument.
fn kind_of(argument: &Argument) -> String {
    match argument {
        Argument::Integer(_) => "GLint",
        Argument::Unsigned(_) => "GLuint",
        Argument::Boolean(_) => "GLboolean",
        Argument::Size(_) => "GLsizeiptr",
        Argument::Float(_) => "GLfloat",
        Argument::Double(_) => "GLdouble",
        Argument::Constant(_) | Argument::Bits(_) => "GLenum",
        Argument::Object(kind, _) if kind == "location" => "GLint",
        Argument::Object(..) => "GLuint",
        Argument::Created(..) => "GLuint *",
        Argument::Array(values) => return format!("const {} *", element_of(values)),
        Argument::Text(_) => "const char *",
        Argument::Bytes(_)
        | Argument::Offset(_)
        | Argument::Null
        | Argument::Values(_)
        | Argument::Struct { .. } => "const void *",
        Argument::Output(..) => "void *",
    }
    .to_owned()
}

/// Returns the type of an array's elements.
fn element_of(values: &[Argument]) -> String {
    values.first().map_or_else(|| "GLenum".to_owned(), kind_of)
}
