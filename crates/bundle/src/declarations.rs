//! The declarations and functions of a C program, for any API.

use crate::error::BundleError;
use etalon_backend::{Phase, RecordedCall};
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write;

/// The functions that make the recorded calls.
pub(crate) struct Body {
    /// The definitions of these functions.
    pub(crate) definitions: String,
    /// The statements that call them in order.
    pub(crate) calls: String,
}

impl Body {
    /// Returns one function per run of calls of the same phase. `statement` prints a call, in one or several
    /// lines.
    pub(crate) fn of<'a>(
        calls: impl IntoIterator<Item = &'a RecordedCall>,
        mut statement: impl FnMut(&RecordedCall) -> Result<String, BundleError>,
    ) -> Result<Self, BundleError> {
        let mut body = Self {
            definitions: String::new(),
            calls: String::new(),
        };
        let mut counts = HashMap::new();
        let mut phase = None;
        for call in calls {
            if phase != Some(call.phase) {
                body.end(phase);
                phase = Some(call.phase);
                let count = counts.entry(name_of(call.phase)).or_insert(0_u32);
                *count += 1;
                let name = match *count {
                    1 => name_of(call.phase).to_owned(),
                    n => format!("{}_{n}", name_of(call.phase)),
                };
                let _ = write!(body.definitions, "\nstatic void {name}(void)\n{{\n");
                let _ = writeln!(body.calls, "    {name}();");
            }
            for line in statement(call)?.lines() {
                let _ = writeln!(body.definitions, "    {line}");
            }
        }
        body.end(phase);
        Ok(body)
    }

    fn end(&mut self, phase: Option<Phase>) {
        if phase.is_some() {
            self.definitions.push_str("}\n");
        }
    }
}

/// Returns the name of the function that makes the calls of a phase.
fn name_of(phase: Phase) -> &'static str {
    match phase {
        Phase::Prepare => "prepare",
        Phase::Submit => "draw",
        Phase::Read => "read_back",
    }
}

/// A type, and the function that prints a word of data as a value of it, or returns `None` if the word has
/// no such value.
pub(crate) type Words = (&'static str, fn(u32) -> Option<String>);

/// The functions, variables and data that the statements printed so far need.
#[derive(Default)]
pub(crate) struct Declarations {
    /// The functions, with their results and parameters.
    functions: BTreeMap<String, (&'static str, Vec<String>)>,
    /// The variables, with their types.
    variables: Vec<(String, String)>,
    /// The number of variables per stem so far.
    counts: HashMap<String, u32>,
    /// Arrays, as declarations.
    data: String,
    arrays: u32,
    /// The memory that the driver writes to: sizes by number.
    memories: BTreeMap<u32, u64>,
}

impl Declarations {
    /// Declares a function of the API.
    pub(crate) fn function(&mut self, name: &str, result: &'static str, parameters: Vec<String>) {
        self.functions
            .entry(name.to_owned())
            .or_insert((result, parameters));
    }

    /// Declares a new variable and returns its name.
    pub(crate) fn variable(&mut self, kind: &str, stem: &str) -> String {
        let count = self.counts.entry(stem.to_owned()).or_default();
        *count += 1;
        let variable = format!("{stem}_{count}");
        self.variables.push((kind.to_owned(), variable.clone()));
        variable
    }

    /// Returns the name of memory that the driver writes to, and declares it.
    pub(crate) fn memory(&mut self, number: u32, bytes: u64) -> String {
        self.memories.insert(number, bytes);
        format!("memory_{number}")
    }

    /// Declares a new text and returns its name. `literals` are its string literals.
    pub(crate) fn text(&mut self, literals: &str) -> String {
        self.arrays += 1;
        let name = format!("source_{}", self.arrays);
        let _ = write!(
            self.data,
            "static const char *const {name} =\n    {literals};\n"
        );
        name
    }

    /// Declares a new array of `bytes` and returns its name. Writes zeros without an initializer, values of
    /// `print`'s type if it accepts all words, and otherwise 32-bit words or bytes.
    pub(crate) fn bytes(&mut self, bytes: &[u8], print: Option<Words>) -> String {
        self.arrays += 1;
        let name = format!("data_{}", self.arrays);
        if bytes.iter().all(|byte| *byte == 0) {
            let size = bytes.len().max(1);
            let _ = writeln!(self.data, "static const unsigned char {name}[{size}];");
            return name;
        }
        let is_words = bytes.len().is_multiple_of(4);
        let words = || {
            let each = bytes.chunks_exact(4);
            each.map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        };
        let printed = print
            .filter(|_| is_words)
            .and_then(|(kind, print)| Some((kind, words().map(print).collect::<Option<_>>()?)));
        let (kind, values): (&str, Vec<String>) = match printed {
            Some(printed) => printed,
            None if is_words => ("uint32_t", words().map(|w| format!("0x{w:08x}")).collect()),
            None => ("unsigned char", bytes.iter().map(u8::to_string).collect()),
        };
        let count = values.len();
        let _ = writeln!(self.data, "static const {kind} {name}[{count}] = {{");
        for line in values.chunks(12) {
            let _ = writeln!(self.data, "    {},", line.join(", "));
        }
        self.data.push_str("};\n");
        name
    }

    /// Returns the declarations of the functions.
    pub(crate) fn functions(&self) -> String {
        let mut text = String::from("\n");
        for (name, (result, parameters)) in &self.functions {
            let parameters = if parameters.is_empty() {
                "void".to_owned()
            } else {
                parameters.join(", ")
            };
            let _ = writeln!(text, "static {result} (*{name})({parameters});");
        }
        text
    }

    /// Returns a function with the signature `head` that loads the declared functions and `functions`.
    /// `find` is the code to which a name is appended.
    pub(crate) fn load(&self, head: &str, find: &str, functions: &[&str]) -> String {
        let mut text = format!("\nstatic void {head}\n{{\n");
        let called = self.functions.keys().map(String::as_str);
        for name in functions.iter().copied().chain(called) {
            let _ = writeln!(text, "    *(void **)&{name} = {find}\"{name}\");");
        }
        text + "}\n"
    }

    /// Returns the declarations of variables, memory and data.
    pub(crate) fn variables(&self) -> String {
        let mut text = String::from("\n");
        for (kind, name) in &self.variables {
            let _ = writeln!(text, "static {kind} {name};");
        }
        for (number, bytes) in &self.memories {
            let size = bytes.max(&1);
            let _ = writeln!(text, "static unsigned char memory_{number}[{size}];");
        }
        text.push_str(&self.data);
        text
    }
}
