//! "Did you mean": the known words that are most similar to an unknown word.

use strsim::osa_distance;

/// The largest number of suggested words.
const PROPOSED: usize = 3;

/// Returns `; did you mean …?` with the nearest known words; empty if no word is near.
pub fn did_you_mean<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let most = (word.chars().count() / 3).clamp(1, 8);
    let word = word.to_lowercase();
    let length = word.chars().count();
    let mut near = Vec::new();
    for other in known {
        let name = other.to_lowercase();
        // The difference of the lengths is a lower bound, and spares most distances.
        if name.chars().count().abs_diff(length) <= most {
            near.push((osa_distance(&word, &name), other));
        }
    }
    near.retain(|(distance, _)| *distance <= most);
    near.sort_unstable();
    near.dedup();
    // If one word is near, words that are much farther only confuse.
    let nearest = near.first().map_or(0, |(distance, _)| *distance);
    near.retain(|(distance, _)| *distance <= nearest + 1);
    let words: Vec<String> = near
        .iter()
        .take(PROPOSED)
        .map(|(_, other)| format!("`{other}`"))
        .collect();
    if words.is_empty() {
        String::new()
    } else {
        format!("; did you mean {}?", words.join(" or "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_words_are_proposed() {
        let known = ["depth", "stencil", "blend", "gl:softpipe", "gl:es:softpipe"];
        assert_eq!(did_you_mean("dpeth", known), "; did you mean `depth`?");
        assert_eq!(
            did_you_mean("GL:softpip", known),
            "; did you mean `gl:softpipe`?"
        );
        assert_eq!(
            did_you_mean("gl:s:softpipe", known),
            "; did you mean `gl:es:softpipe` or `gl:softpipe`?"
        );
        assert_eq!(did_you_mean("vulkan", known), "");
    }
}
