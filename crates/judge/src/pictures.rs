//! The pictures of methods that a run keeps.

use etalon_case::Case;
use etalon_frame::Image;
use etalon_record::Record;
use etalon_truth::{TruthPicture, rgb8};
use std::collections::{BTreeMap, HashSet};

/// Returns the indices of the cases whose pictures are kept: for each method in each scene, the case in the
/// middle of its parameter's range.
pub fn pictured<'a>(cases: impl IntoIterator<Item = &'a Case>) -> HashSet<usize> {
    type Family<'a> = (&'a str, &'a str, &'a str);
    let mut families: BTreeMap<Family<'_>, Vec<(f64, &str, usize)>> = BTreeMap::new();
    for (number, case) in cases.into_iter().enumerate() {
        if let Some(method) = &case.method {
            let family = (&*method.question, &*method.scene, &*method.name);
            let value = method.parameter.as_ref().map_or(0.0, |p| p.value);
            families
                .entry(family)
                .or_default()
                .push((value, &case.id, number));
        }
    }
    // The id decides between equal values, so that the drawing order does not matter.
    let middle = |mut pictures: Vec<(f64, &str, usize)>| {
        pictures.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(b.1)));
        pictures
            .get(pictures.len() / 2)
            .map(|(_, _, number)| *number)
    };
    families.into_values().filter_map(middle).collect()
}

/// Keeps the pictures of a method and of the truth. `write` gets a name, a size, and red, green and blue of each texel,
/// and returns the path of the file.
///
/// # Errors
/// If `write` fails.
pub fn keep_pictures<E>(
    record: &mut Record,
    truth: &TruthPicture,
    image: &Image,
    mut write: impl FnMut(&str, [u32; 2], &[u8]) -> Result<String, E>,
) -> Result<(), E> {
    if let Some(measured) = &mut record.measured {
        measured.picture = Some(write(&record.case, image.size, &rgb8(image))?);
        let name = format!("truth/{}", record.case);
        measured.truth_picture = Some(write(&name, truth.size, &truth.rgb8())?);
    }
    Ok(())
}
