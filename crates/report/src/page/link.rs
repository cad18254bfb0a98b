//! Links within the page: to the view of a case, and to a filter of all cases.

/// Returns the link to a case's view: `#case=` and its id. The script reads it with `decodeURIComponent`.
pub(crate) fn case(id: &str) -> String {
    format!("#case={}", encoded(id))
}

/// Returns the link to the cases of one adapter whose ids contain a text.
pub(crate) fn filter(text: &str, adapter: &str) -> String {
    format!("#q={}&on={}", encoded(text), encoded(adapter))
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
        assert_eq!(super::filter("a/b", "gl:x"), "#q=a/b&on=gl:x");
    }
}
