//! Comments in case files: from `//` to the end of the line.
//!
//! The build script compiles this file too.

use std::borrow::Cow;

/// Replaces each comment by spaces, which keeps the lines and columns of everything else.
pub(crate) fn without_comments(json: &str) -> Cow<'_, str> {
    if !json.contains("//") {
        return Cow::Borrowed(json);
    }
    let (mut in_string, mut escaped, mut in_comment) = (false, false, false);
    let mut plain = String::with_capacity(json.len());
    let mut rest = json.chars().peekable();
    while let Some(c) = rest.next() {
        if in_comment {
            in_comment = c != '\n';
        } else if in_string {
            in_string = c != '"' || escaped;
            escaped = c == '\\' && !escaped;
        } else {
            in_string = c == '"';
            in_comment = c == '/' && rest.peek() == Some(&'/');
        }
        plain.push(if in_comment { ' ' } else { c });
    }
    Cow::Owned(plain)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CaseFile, Profile};

    #[test]
    fn a_comment_becomes_spaces_and_a_string_keeps_its_slashes() {
        for (text, plain) in [
            ("[1, // one\n2]", "[1,       \n2]"),
            ("// \u{e9} \"\r\n[]//", "       \n[]  "),
            (r#"["a//b", "\\"]// c"#, r#"["a//b", "\\"]    "#),
            (r#"["\"//", 1]"#, r#"["\"//", 1]"#),
            ("1 / /2", "1 / /2"),
        ] {
            assert_eq!(without_comments(text), plain);
        }
    }

    #[test]
    fn a_file_with_comments_has_the_same_scene_and_the_same_lines_in_errors() {
        let text = r#"{ "$schema": "../schema.json", "about": "t", "spec": ["t"],
  "axes": { "compare": ["less",
    "LAST"] },
  "scene": { "attachments": { "d": { "format": "depth32float" } }, "passes": [
    { "depth_stencil": "d", "draws": [
      { "each": { "value": [0, 1] },
        "mesh": { "kind": "full", "value": "$value" }, "shader": "flat_color_depth",
        "depth": { "compare": "$compare", "write": true } } ] } ], "read": ["d"] } }"#;
        let commented = format!("// \"{{\n{}// }}", text.replace('\n', " // \"each\": [\n"));
        let cases = |text: &str| {
            let file = CaseFile::parse("t.json", text).expect("parses");
            assert!(file.warnings().is_empty());
            let cases = file.cases(Profile::Full);
            let built = cases.map(|case| case.build().map(|case| (case.id, case.scene)));
            built.collect::<Vec<_>>()
        };
        let good = |text: &str| text.replace("LAST", "greater");
        assert_eq!(cases(&good(&commented)), cases(&good(text)));
        let plain = cases(text).pop().expect("a case").expect_err("is wrong");
        let moved = cases(&commented)
            .pop()
            .expect("a case")
            .expect_err("is wrong");
        assert_eq!((moved.line, &moved.key), (plain.line + 1, &plain.key));
    }
}
