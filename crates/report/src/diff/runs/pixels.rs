//! Compares frames of two runs code by code.

use super::data::{FrameChange, ImageChange};
use super::pairs::Folder;
use crate::picture::{self, Strip};
use etalon_record::{FrameFile, FrameImage, Record, Run};
use std::path::Path;

/// Compares the frames of a case. Returns `None` if a run keeps no frame, and the reason if a frame cannot be
/// read.
pub(super) fn compare(
    folders: &[Folder<'_>; 2],
    both: &[&Record; 2],
) -> Option<Result<FrameChange, String>> {
    let [Some(before), Some(after)] = both.map(|r| r.frame.as_deref()) else {
        return None;
    };
    let files = [before, after];
    Some(
        read(&[folders[0].path, folders[1].path], files).map(|frames| {
            let (images, unlike) = matched(&frames);
            FrameChange {
                files: files.map(str::to_owned),
                images: images.into_iter().map(|[b, a]| image(b, a)).collect(),
                unlike,
            }
        }),
    )
}

/// Returns pictures of the images that differ: before, after, and the difference. The list is empty if the
/// files can no longer be read.
pub(super) fn strips(folders: &[&Path; 2], frame: &FrameChange) -> Vec<Strip> {
    let [before, after] = &frame.files;
    let Ok(frames) = read(folders, [before, after]) else {
        return Vec::new();
    };
    let (images, _) = matched(&frames);
    let strips = images.into_iter().filter_map(|[b, a]| between(b, a));
    strips.collect()
}

fn read(folders: &[&Path; 2], files: [&str; 2]) -> Result<[FrameFile; 2], String> {
    let frame = |i: usize| Run::read_frame(folders[i], files[i]).map_err(|e| e.to_string());
    Ok([frame(0)?, frame(1)?])
}

/// Returns pairs of images of the same attachment, and the names of images without a partner of the same
/// shape.
fn matched(frames: &[FrameFile; 2]) -> (Vec<[&FrameImage; 2]>, Vec<String>) {
    let [before, after] = frames;
    let name = |i: &FrameImage| format!("{} {}", i.attachment, i.aspect);
    let same =
        |a: &FrameImage, b: &FrameImage| a.attachment == b.attachment && a.aspect == b.aspect;
    let shape = |i: &FrameImage| (i.size, i.samples, i.channels.clone(), i.is_whole());
    let mut images = Vec::new();
    let mut unlike = Vec::new();
    for old in &before.images {
        match after.images.iter().find(|new| same(old, new)) {
            Some(new) if shape(old) == shape(new) && old.is_whole() => images.push([old, new]),
            _ => unlike.push(name(old)),
        }
    }
    let alone = |new: &&FrameImage| !before.images.iter().any(|old| same(old, new));
    unlike.extend(after.images.iter().filter(alone).map(name));
    (images, unlike)
}

/// Returns pairs of samples, each with the codes of all channels.
fn samples<'a>(
    before: &'a FrameImage,
    after: &'a FrameImage,
) -> impl Iterator<Item = (&'a [u32], &'a [u32])> {
    let n = before.channels.len().max(1);
    before
        .actual
        .chunks_exact(n)
        .zip(after.actual.chunks_exact(n))
}

fn image(before: &FrameImage, after: &FrameImage) -> ImageChange {
    let mut change = ImageChange {
        attachment: before.attachment.clone(),
        aspect: before.aspect,
        samples: before.wrong.len() as u64,
        differ: 0,
        largest: 0,
    };
    for (old, new) in samples(before, after).filter(|(old, new)| old != new) {
        change.differ += 1;
        for ((b, a), encoding) in old.iter().zip(new).zip(&before.channels) {
            let codes = encoding
                .order_of_code(*b)
                .abs_diff(encoding.order_of_code(*a));
            change.largest = change.largest.max(codes);
        }
    }
    change
}

/// Returns the pictures of one image. The first run's picture is used as the allowed one, so that the
/// difference picture compares the two runs.
fn between(before: &FrameImage, after: &FrameImage) -> Option<Strip> {
    let mark = |(old, new): (&[u32], &[u32])| {
        if old == new {
            FrameImage::FINE
        } else {
            FrameImage::FAIL
        }
    };
    let both = FrameImage {
        low: before.actual.clone(),
        high: before.actual.clone(),
        wrong: samples(before, after).map(mark).collect(),
        ..after.clone()
    };
    let same = both.wrong.iter().all(|w| *w == FrameImage::FINE);
    (!same).then(|| picture::named(&both, ["before", "after"], false))?
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::{Aspect, ChannelEncoding};

    fn one(actual: Vec<u32>) -> FrameImage {
        let n = actual.len();
        FrameImage {
            attachment: "color".to_owned(),
            aspect: Aspect::Color,
            size: [n as u32 / 2, 1],
            samples: 1,
            channels: vec![ChannelEncoding::Unorm(8); 2],
            low: vec![0; n],
            high: vec![255; n],
            wrong: vec![0; n / 2],
            actual,
        }
    }

    #[test]
    fn samples_are_counted_once_and_the_largest_distance_is_kept() {
        let (before, after) = (one(vec![0, 1, 2, 3, 4, 5]), one(vec![0, 1, 9, 0, 4, 6]));
        let change = image(&before, &after);
        assert_eq!((change.samples, change.differ, change.largest), (3, 2, 7));
        let strip = between(&before, &after).unwrap();
        let labels: Vec<_> = strip.pictures.iter().map(|p| &*p.label).collect();
        assert_eq!(labels, ["before", "after", "difference"]);
        assert!(!strip.caption.contains("allowed"), "{}", strip.caption);
        assert!(between(&before, &before).is_none());
    }

    #[test]
    fn images_of_different_shapes_are_not_compared() {
        let file = |images: Vec<FrameImage>| FrameFile {
            images,
            ..FrameFile::default()
        };
        let mut depth = one(vec![0; 4]);
        depth.aspect = Aspect::Depth;
        let mut short = one(vec![0; 6]);
        short.actual.pop();
        for (before, after) in [
            (vec![one(vec![0; 4])], vec![one(vec![0; 6])]),
            (vec![one(vec![0; 4])], Vec::new()),
            (Vec::new(), vec![depth]),
            (vec![short.clone()], vec![short]),
        ] {
            let frames = [file(before), file(after)];
            let (images, unlike) = matched(&frames);
            assert_eq!((images.len(), unlike.len()), (0, 1));
        }
    }
}
