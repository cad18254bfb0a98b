//! "Did you mean": the known words that are most similar to an unknown word.

/// The largest number of suggested words.
const PROPOSED: usize = 3;

/// Returns `; did you mean …?` with the nearest known words; empty if no word is near.
pub fn did_you_mean<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let most = (word.chars().count() / 3).clamp(1, 8);
    let distances = known
        .into_iter()
        .map(|other| (distance(word, other, most), other));
    let mut near: Vec<(usize, &str)> = distances
        .filter(|(distance, _)| *distance <= most)
        .collect();
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

/// Returns the number of letters to insert, remove or replace, or of neighbours to exchange; a number above
/// `most` if it exceeds `most`.
fn distance(a: &str, b: &str, most: usize) -> usize {
    let [a, b] = [a, b].map(|text| text.to_lowercase().chars().collect::<Vec<char>>());
    if a.len().abs_diff(b.len()) > most {
        return most + 1;
    }
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 0..a.len() {
        let mut row = vec![i + 1];
        for j in 0..b.len() {
            let replaced = last[j] + usize::from(a[i] != b[j]);
            let mut best = replaced.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                best = best.min(before[j - 1] + 1);
            }
            row.push(best);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
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
