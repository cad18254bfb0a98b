//! Recorded calls as C: statements, and the constants, functions, variables and data that they need.

use crate::c;
use crate::error::BundleError;
use etalon_backend::{Argument, Call, Constant, Phase};
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write;

/// The declarations that the statements so far need.
#[derive(Default)]
pub(super) struct Printer {
    constants: BTreeMap<String, u32>,
    /// The functions: result and parameters.
    functions: BTreeMap<String, (&'static str, Vec<String>)>,
    /// The variables that hold objects, with their types.
    variables: Vec<(&'static str, String)>,
    /// The variable of an object, by kind, number and program: numbers are used again.
    objects: HashMap<(String, u64, u64), String>,
    /// The objects of each kind so far.
    counts: HashMap<String, u32>,
    /// Data, as declarations.
    data: String,
    arrays: u32,
    /// Memory that the driver writes to: its size by its number.
    memories: BTreeMap<u32, u64>,
    program: u64,
    parts: Vec<String>,
}

impl Printer {
    /// Returns the functions that make the calls.
    pub(super) fn body(&mut self, calls: &[&Call]) -> Result<String, BundleError> {
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
            let statement = self.statement(call)?;
            let _ = writeln!(text, "    {statement}");
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
            .filter(|part| part.starts_with(name))
            .count();
        let name = match before {
            0 => name.to_owned(),
            n => format!("{name}_{}", n + 1),
        };
        self.parts.push(name.clone());
        name
    }

    /// Returns the calls of the functions that [`Printer::body`] made.
    pub(super) fn parts(&self) -> String {
        self.parts
            .iter()
            .map(|part| format!("    {part}();\n"))
            .collect()
    }

    /// Returns the definitions of the constants.
    pub(super) fn constants(&self) -> String {
        let lines = self.constants.iter();
        lines
            .map(|(name, value)| format!("#define {name} 0x{value:04X}\n"))
            .collect()
    }

    /// Returns the declarations of the functions.
    pub(super) fn functions(&self) -> String {
        let mut text = String::from("\n");
        for (name, (result, parameters)) in &self.functions {
            let parameters = match parameters.is_empty() {
                true => "void".to_owned(),
                false => parameters.join(", "),
            };
            let _ = writeln!(text, "static {result} (*{name})({parameters});");
        }
        text
    }

    /// Returns the function that finds the functions.
    pub(super) fn load(&self, own: &[&str]) -> String {
        let mut text = String::from("\nstatic void load(void)\n{\n");
        for name in own
            .iter()
            .copied()
            .chain(self.functions.keys().map(String::as_str))
        {
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
        if !is_identifier(name) {
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
            self.arrays += 1;
            let source = c::lines(source, "    ");
            let _ = write!(
                self.data,
                "static const char *const source_{} =\n    {source};\n",
                self.arrays
            );
            let parameters = ["GLuint", "GLint", "const char *const *", "const GLint *"];
            self.function(name, "void", parameters.map(str::to_owned).to_vec());
            return Ok(format!(
                "CALL(glShaderSource({shader}, 1, &source_{}, NULL));",
                self.arrays
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
                self.function(name, "GLenum", types);
                format!("complete({made}, __LINE__);")
            }
            ("glMapBufferRange", Some(Argument::Output(number, bytes))) => {
                self.function(name, "void *", types);
                self.memories.insert(*number, *bytes);
                format!("copy(memory_{number}, {made}, {bytes}, __LINE__);")
            }
            ("glCompileShader", _) => {
                self.function(name, "void", types);
                format!("CALL({made}), compiled({}, __LINE__);", values.join(", "))
            }
            ("glLinkProgram", _) => {
                self.function(name, "void", types);
                format!("CALL({made}), linked({}, __LINE__);", values.join(", "))
            }
            (_, Some(Argument::Object(kind, number))) => {
                let own = match kind.as_str() {
                    "location" => "GLint",
                    _ => "GLuint",
                };
                self.function(name, own, types);
                let program = self.program_of(call);
                let variable = self.define(kind, *number, program, own);
                format!("{variable} = {made}, check(\"{name}\", __LINE__);")
            }
            (_, Some(_)) => {
                self.function(name, "GLboolean", types);
                format!("CALL({made});")
            }
            (_, None) => {
                self.function(name, "void", types);
                format!("CALL({made});")
            }
        })
    }

    fn function(&mut self, name: &str, result: &'static str, parameters: Vec<String>) {
        self.functions
            .entry(name.to_owned())
            .or_insert((result, parameters));
    }

    /// Returns the program in which a call names uniforms.
    fn program_of(&self, call: &Call) -> u64 {
        match call.arguments.first() {
            Some(Argument::Object(kind, program)) if kind == "program" => *program,
            _ => self.program,
        }
    }

    /// Returns a new variable for an object.
    fn define(&mut self, kind: &str, number: u64, program: u64, own: &'static str) -> String {
        let count = self.counts.entry(kind.to_owned()).or_default();
        *count += 1;
        let variable = format!("{kind}_{count}");
        self.variables.push((own, variable.clone()));
        let key = key(kind, number, program);
        self.objects.insert(key, variable.clone());
        variable
    }

    /// Returns the expression of an argument.
    fn value(&mut self, call: &Call, argument: &Argument) -> Result<String, BundleError> {
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
            Argument::Bits(all) => {
                let all: Vec<String> = all.iter().map(|bit| self.constant(bit)).collect();
                all.join(" | ")
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
            Argument::Bytes(bytes) => self.bytes(bytes, holds_floats(call)),
            Argument::Array(all) => {
                let kind = element_of(all);
                let mut values = Vec::new();
                for value in all {
                    values.push(self.value(call, value)?);
                }
                format!("(const {kind}[]){{ {} }}", values.join(", "))
            }
            Argument::Text(text) => c::string(text),
            Argument::Offset(0) | Argument::Null => "NULL".to_owned(),
            Argument::Offset(offset) => format!("(const void *){offset}"),
            Argument::Output(number, bytes) => {
                self.memories.insert(*number, *bytes);
                format!("memory_{number}")
            }
            Argument::Values(_) | Argument::Struct { .. } => {
                return Err(BundleError::Call(call.function.clone()));
            }
        })
    }

    fn constant(&mut self, constant: &Constant) -> String {
        if !is_identifier(&constant.name) {
            return format!("0x{:04X}", constant.value);
        }
        self.constants.insert(constant.name.clone(), constant.value);
        constant.name.clone()
    }

    /// Returns the name of an array of these bytes: as floats, as words, or byte by byte.
    fn bytes(&mut self, bytes: &[u8], floats: bool) -> String {
        self.arrays += 1;
        let name = format!("data_{}", self.arrays);
        let words = || {
            bytes
                .chunks_exact(4)
                .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        };
        let whole = bytes.len().is_multiple_of(4);
        let (kind, values): (&str, Vec<String>) = if bytes.iter().all(|byte| *byte == 0) {
            let _ = writeln!(
                self.data,
                "static const unsigned char {name}[{}];",
                bytes.len().max(1)
            );
            return name;
        } else if whole && floats && words().all(|w| f32::from_bits(w).is_finite()) {
            ("GLfloat", words().map(c::float).collect())
        } else if whole {
            ("uint32_t", words().map(|w| format!("0x{w:08x}")).collect())
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

/// Returns the key of an object. Only uniforms belong to a program.
fn key(kind: &str, number: u64, program: u64) -> (String, u64, u64) {
    let of_program = ["location", "block"].contains(&kind);
    (
        kind.to_owned(),
        number,
        if of_program { program } else { 0 },
    )
}

/// True if the bytes of a call are floats: vertices, and blocks of uniforms.
fn holds_floats(call: &Call) -> bool {
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
        Argument::Array(all) => return format!("const {} *", element_of(all)),
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
fn element_of(all: &[Argument]) -> String {
    all.first().map_or_else(|| "GLenum".to_owned(), kind_of)
}

/// True for names that C takes.
fn is_identifier(name: &str) -> bool {
    let mut bytes = name.bytes();
    bytes
        .next()
        .is_some_and(|b| b.is_ascii_alphabetic() || b == b'_')
        && bytes.all(|b| b.is_ascii_alphanumeric() || b == b'_')
}
