//! Writing texts and numbers as C.

/// Returns a text as a string literal, quotes included. Bytes beyond ASCII and trigraphs are escaped.
pub(crate) fn string(text: &str) -> String {
    let mut literal = String::from("\"");
    let mut before = None;
    for byte in text.bytes() {
        match byte {
            b'"' => literal.push_str("\\\""),
            b'\\' => literal.push_str("\\\\"),
            b'\n' => literal.push_str("\\n"),
            b'\t' => literal.push_str("\\t"),
            b'?' if before == Some(b'?') => literal.push_str("\\?"),
            b' '..=b'~' => literal.push(char::from(byte)),
            // An octal escape of three digits never includes the next character.
            byte => literal.push_str(&format!("\\{byte:03o}")),
        }
        before = Some(byte);
    }
    literal.push('"');
    literal
}

/// Returns a text as string literals, one per line.
pub(crate) fn lines(text: &str, indent: &str) -> String {
    let lines: Vec<String> = text.split_inclusive('\n').map(string).collect();
    if lines.is_empty() {
        "\"\"".to_owned()
    } else {
        lines.join(&format!("\n{indent}"))
    }
}

/// Returns true if a name is a valid C identifier.
pub(crate) fn is_identifier(name: &str) -> bool {
    let first = name.chars().next();
    first.is_some_and(|c| c.is_ascii_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// Returns a text that is safe in a comment: it neither ends nor starts a comment, and continues no line.
pub(crate) fn comment(text: &str) -> String {
    let printable = |c: char| match c {
        '\\' => '/',
        c if c.is_ascii_graphic() || c == ' ' => c,
        _ => ' ',
    };
    let text: String = text.chars().map(printable).collect();
    text.replace("*/", "* /")
        .replace("/*", "/ *")
        .replace("??", "? ?")
}

/// Returns a text as lines of a comment, wrapped at a readable width.
pub(crate) fn paragraph(text: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for word in comment(text).split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.len() + word.len() < 96 => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines.iter().map(|line| format!(" * {line}\n")).collect()
}

/// Returns a constant with the value of a float.
pub(crate) fn float(bits: u32) -> String {
    let value = f32::from_bits(bits);
    match value {
        v if v.is_nan() => "NAN".to_owned(),
        v if v.is_infinite() => if v > 0.0 { "INFINITY" } else { "-INFINITY" }.to_owned(),
        v => format!("{v:?}f"),
    }
}

/// Returns a constant with exactly the value of a double.
pub(crate) fn double(value: f64) -> String {
    match value {
        v if v == f64::INFINITY => "INFINITY".to_owned(),
        v if v == f64::NEG_INFINITY => "-INFINITY".to_owned(),
        v => format!("{v:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_texts_stay_in_their_literal() {
        assert_eq!(
            string("a\"; system(\"rm\\\n??/é"),
            "\"a\\\"; system(\\\"rm\\\\\\n?\\?/\\303\\251\""
        );
        assert_eq!(lines("a\nb", "  "), "\"a\\n\"\n  \"b\"");
        assert_eq!(lines("", ""), "\"\"");
    }

    #[test]
    fn hostile_texts_stay_in_their_comment() {
        for hostile in ["*/ int main", "*\u{0}/", "a\\\nb", "/* */", "??/", "*/*/"] {
            let text = comment(hostile);
            assert!(!text.contains("*/") && !text.contains("/*"), "{text}");
            assert!(
                !text.contains('\\') && !text.contains('\n') && !text.contains("??"),
                "{text}"
            );
        }
        assert!(
            paragraph(&"word ".repeat(100))
                .lines()
                .all(|l| l.len() < 100 && l.starts_with(" * "))
        );
    }

    #[test]
    fn floats_keep_their_value() {
        assert_eq!(float(1.0_f32.to_bits()), "1.0f");
        assert_eq!(float((-0.0_f32).to_bits()), "-0.0f");
        assert_eq!(float(0.1_f32.to_bits()), "0.1f");
        assert_eq!(float(0x7fc0_0001), "NAN");
        assert_eq!(double(1e-40), "1e-40");
    }
}
