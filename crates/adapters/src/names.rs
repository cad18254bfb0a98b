//! The names of adapters.

/// The maximum length of a name in characters.
pub(crate) const MAX_NAME: usize = 64;

/// Returns true if a text is a valid name.
pub(crate) fn is_name(text: &str) -> bool {
    let inside = |c: char| c.is_ascii_alphanumeric() || [':', '-', '_', '.', '@'].contains(&c);
    text.len() <= MAX_NAME
        && text.starts_with(|c: char| c.is_ascii_alphanumeric())
        && text.chars().all(inside)
}

/// Returns a driver's own name as a valid name that leaves room for a number.
pub(crate) fn sanitized(name: &str) -> String {
    let plain: String = name
        .chars()
        .map(|c| {
            if c != '@' && is_name(&format!("a{c}")) {
                c
            } else {
                '-'
            }
        })
        .take(MAX_NAME - 4)
        .collect();
    if is_name(&plain) {
        plain
    } else {
        "gpu".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_device_is_named_as_a_release() {
        assert_eq!(sanitized("gl:a@b"), "gl:a-b");
    }

    #[test]
    fn names_are_plain() {
        let longest = "a".repeat(MAX_NAME);
        for good in [
            "cpu",
            "gl:softpipe@26.2.6",
            "gl:es:llvmpipe-25",
            "vulkan:radv_1.2",
            "9",
            &longest,
        ] {
            assert!(is_name(good), "{good}");
        }
        let longer = "a".repeat(MAX_NAME + 1);
        for bad in [
            "", "-v", ":", ".", "..", "a b", "a/b", "a\n", "a,b", "ä", "a%", "<b>", &longer,
        ] {
            assert!(!is_name(bad), "{bad:?}");
        }
    }
}
