//! Pieces of a program in two languages: Rust, and the JavaScript of a page.

/// A piece of both programs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Code {
    pub(super) rust: String,
    /// `None` if WebGPU cannot express the code.
    pub(super) script: Option<String>,
}

impl Code {
    pub(super) fn new(rust: impl Into<String>, script: impl Into<String>) -> Self {
        Self {
            rust: rust.into(),
            script: Some(script.into()),
        }
    }

    /// Returns a piece that is the same in both languages.
    pub(super) fn same(text: impl Into<String>) -> Self {
        let text = text.into();
        Self::new(text.clone(), text)
    }

    /// Returns a piece that wgpu has and WebGPU lacks.
    pub(super) fn of_wgpu(rust: impl Into<String>) -> Self {
        Self {
            rust: rust.into(),
            script: None,
        }
    }

    /// Returns a borrowed value; in a script, the value itself.
    pub(super) fn borrowed(self) -> Self {
        Self {
            rust: format!("&{}", self.rust),
            ..self
        }
    }

    /// Returns a structure; in a script, its members without braces.
    pub(super) fn members(self) -> Self {
        let inner = |text: String| {
            let inner = text
                .strip_prefix('{')
                .and_then(|text| text.strip_suffix('}'));
            inner.unwrap_or(&text).trim().to_owned()
        };
        Self {
            script: self.script.map(inner),
            ..self
        }
    }

    /// Applies a change to both languages.
    pub(super) fn map(self, change: impl Fn(&str) -> String) -> Self {
        Self {
            rust: change(&self.rust),
            script: self.script.as_deref().map(change),
        }
    }

    /// Appends a piece.
    pub(super) fn push(&mut self, other: &Self) {
        self.rust.push_str(&other.rust);
        match (&mut self.script, &other.script) {
            (Some(text), Some(other)) => text.push_str(other),
            (text, _) => *text = None,
        }
    }
}

/// Returns the pieces, separated by commas.
pub(super) fn joined(pieces: impl IntoIterator<Item = Code>) -> Code {
    let mut code = Code::same("");
    for piece in pieces {
        if !code.rust.is_empty() {
            code.push(&Code::same(", "));
        }
        code.push(&piece);
    }
    code
}

/// Returns a list.
pub(super) fn list(values: impl IntoIterator<Item = Code>) -> Code {
    joined(values)
        .map(|values| format!("[{values}]"))
        .borrowed()
}

/// Returns an option; in a script, the value or `null`.
pub(super) fn option(value: Option<Code>) -> Code {
    match value {
        Some(value) => Code {
            rust: format!("Some({})", value.rust),
            ..value
        },
        None => Code::new("None", "null"),
    }
}

/// Returns a call of a WebGPU method; wgpu has the same method with its own spelling.
pub(super) fn call(on: &str, method: &str, arguments: impl IntoIterator<Item = Code>) -> Code {
    let arguments = joined(arguments);
    Code {
        rust: format!("{on}.{method}({})", arguments.rust),
        script: arguments
            .script
            .map(|arguments| format!("{on}.{}({arguments})", camel(method))),
    }
}

/// Returns a definition of a variable.
pub(super) fn defined(name: &str, value: Code) -> Code {
    Code {
        rust: format!("let {name} = {}", value.rust),
        script: value.script.map(|value| format!("const {name} = {value}")),
    }
}

/// Returns a definition of a variable that its methods change.
pub(super) fn defined_to_change(name: &str, value: Code) -> Code {
    Code {
        rust: format!("let mut {name} = {}", value.rust),
        ..defined(name, value)
    }
}

/// A structure of wgpu, and the corresponding dictionary of WebGPU.
pub(super) struct Structure {
    kind: String,
    rust: Vec<String>,
    script: Option<Vec<String>>,
}

impl Structure {
    /// Returns an empty structure of this type.
    pub(super) fn of(kind: &str) -> Self {
        Self {
            kind: kind.to_owned(),
            rust: Vec::new(),
            script: Some(Vec::new()),
        }
    }

    /// Adds a field that only wgpu has, with the value that corresponds to WebGPU.
    pub(super) fn of_wgpu(mut self, name: &str, value: &str) -> Self {
        self.rust.push(format!("{name}: {value}"));
        self
    }

    /// Adds a field.
    pub(super) fn with(self, name: &str, value: Code) -> Self {
        let script = value
            .script
            .map(|value| format!("{}: {value}", camel(name)));
        self.in_place(
            name,
            Code {
                rust: value.rust,
                script,
            },
        )
    }

    /// Adds a field that a script omits if it is `None`.
    pub(super) fn optional(self, name: &str, value: Option<Code>) -> Self {
        match value {
            None => self.of_wgpu(name, "None"),
            value => self.with(name, option(value)),
        }
    }

    /// Adds a field that corresponds to several members of the dictionary. The script's value includes their
    /// names; if it is empty, the field has no member.
    pub(super) fn in_place(mut self, name: &str, value: Code) -> Self {
        self.rust.push(format!("{name}: {}", value.rust));
        match (&mut self.script, value.script) {
            (_, Some(members)) if members.is_empty() => {}
            (Some(script), Some(members)) => script.push(members),
            (members, _) => *members = None,
        }
        self
    }

    pub(super) fn end(self) -> Code {
        Code {
            rust: if self.rust.is_empty() {
                format!("{} {{}}", self.kind)
            } else {
                format!("{} {{ {} }}", self.kind, self.rust.join(", "))
            },
            script: self.script.map(|members| {
                if members.is_empty() {
                    "{}".to_owned()
                } else {
                    format!("{{ {} }}", members.join(", "))
                }
            }),
        }
    }
}

/// Converts a name of wgpu to WebGPU's spelling.
fn camel(name: &str) -> String {
    let mut camel = String::new();
    let mut upper = false;
    for c in name.chars() {
        match c {
            '_' => upper = true,
            c if upper => {
                camel.extend(c.to_uppercase());
                upper = false;
            }
            c => camel.push(c),
        }
    }
    camel
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_structure_becomes_a_dictionary_in_the_script() {
        let size = Structure::of("wgpu::Extent3d")
            .with("width", Code::same("4"))
            .with("depth_or_array_layers", Code::same("1"));
        let texture = Structure::of("wgpu::TextureDescriptor")
            .of_wgpu("label", "None")
            .with("size", size.end())
            .optional("format", None)
            .optional(
                "view",
                Some(Code::new("wgpu::TextureFormat::R8Unorm", "\"r8unorm\"")),
            )
            .end();
        assert_eq!(
            texture.rust,
            "wgpu::TextureDescriptor { label: None, size: wgpu::Extent3d { width: 4, depth_or_array_layers: 1 }, format: None, \
             view: Some(wgpu::TextureFormat::R8Unorm) }"
        );
        assert_eq!(
            texture.script.unwrap(),
            "{ size: { width: 4, depthOrArrayLayers: 1 }, view: \"r8unorm\" }"
        );
    }

    #[test]
    fn code_that_webgpu_lacks_leaves_no_script() {
        let part = Structure::of("A").with("b", Code::of_wgpu("wgpu::B"));
        assert_eq!(part.end().script, None);
        let code = joined([Code::same("1"), Code::of_wgpu("x"), Code::same("2")]);
        assert_eq!((code.rust.as_str(), code.script), ("1, x, 2", None));
    }
}
