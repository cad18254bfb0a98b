//! Ids on a page, and links within it: to the view of a case, and to a filter of all cases.

use maud::{Markup, PreEscaped, html};

/// Returns an id that can break after each of its parts.
pub(crate) fn breakable_id(id: &str) -> Markup {
    html! {
        @for part in id.split_inclusive(['/', '=']) { (part) (PreEscaped("<wbr>")) }
    }
}

/// Returns the link to a case's view: `#case=` and its id. The script reads it with `decodeURIComponent`.
pub(crate) fn case(id: &str) -> String {
    format!("#case={}", encoded(id))
}

/// Returns the link to the cases of an area.
pub(crate) fn area(name: &str) -> String {
    format!("#area={}", encoded(name))
}

/// Returns the link to the cases of an adapter, of one area if it is named, and only to the bad ones if `bad` is true.
pub(crate) fn cell(area: Option<&str>, adapter: &str, bad: bool) -> String {
    let verdict = if bad { "&verdict=bad" } else { "" };
    let area = area.map_or(String::new(), |name| format!("&area={}", encoded(name)));
    format!("#on={}{area}{verdict}", encoded(adapter))
}

/// Returns the link to the bad cases of one adapter whose ids contain a text.
pub(crate) fn filter(text: &str, adapter: &str) -> String {
    format!("#q={}&on={}&verdict=bad", encoded(text), encoded(adapter))
}

/// Returns a text as part of a fragment. The characters of ids stay readable.
pub(crate) fn encoded(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~/=:,".contains(&byte) {
            result.push(char::from(byte));
        } else {
            result += &format!("%{byte:02X}");
        }
    }
    result
}

#[cfg(test)]
mod tests {
    #[test]
    fn only_harmless_characters_stay() {
        assert_eq!(super::case("depth/a=less,b=1"), "#case=depth/a=less,b=1");
        assert_eq!(
            super::case("a&b%\"<ä+ "),
            "#case=a%26b%25%22%3C%C3%A4%2B%20"
        );
        assert_eq!(super::filter("a/b", "gl:x"), "#q=a/b&on=gl:x&verdict=bad");
        let cell = super::cell(Some("a&b"), "gl:x", true);
        assert_eq!(cell, "#on=gl:x&area=a%26b&verdict=bad");
    }
}
