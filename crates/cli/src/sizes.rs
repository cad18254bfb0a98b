//! The sizes of frames at which methods are timed.

use etalon_runner::FrameSizes;

/// The names of sizes.
const NAMES: [(&str, [u32; 2]); 3] = [
    ("720p", [1280, 720]),
    ("1080p", [1920, 1080]),
    ("4k", [3840, 2160]),
];

/// The longest side of a frame in texels.
const LONGEST: u32 = 16_384;

/// The value of `--sizes`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SizeList(Vec<[u32; 2]>);

/// Parses a list of names and of `WIDTHxHEIGHT`, or `none`.
pub(crate) fn parse(text: &str) -> Result<SizeList, String> {
    if text == "none" {
        return Ok(SizeList(Vec::new()));
    }
    let mut sizes = text.split(',').map(size).collect::<Result<Vec<_>, _>>()?;
    sizes.sort_by_key(|[width, height]| u64::from(*width) * u64::from(*height));
    sizes.dedup();
    Ok(SizeList(sizes))
}

fn size(text: &str) -> Result<[u32; 2], String> {
    if let Some((_, size)) = NAMES.iter().find(|(name, _)| *name == text) {
        return Ok(*size);
    }
    let sides = text.split_once('x').and_then(|(width, height)| {
        let side = |text: &str| text.parse().ok().filter(|n| (16..=LONGEST).contains(n));
        Some([side(width)?, side(height)?])
    });
    let names = NAMES.map(|(name, _)| name).join(", ");
    sides.ok_or_else(|| {
        format!("`{text}` is no size: expected {names}, WIDTHxHEIGHT (16 to {LONGEST}), or `none`")
    })
}

/// Returns the sizes of a run: those of the flag on every adapter, or else all names on hardware, and the smallest where
/// the processor draws.
pub(crate) fn frame_sizes(given: Option<&SizeList>) -> FrameSizes {
    match given {
        Some(SizeList(sizes)) => FrameSizes {
            software: sizes.clone(),
            hardware: sizes.clone(),
        },
        None => FrameSizes {
            software: vec![NAMES[0].1],
            hardware: NAMES.map(|(_, size)| size).to_vec(),
        },
    }
}

/// Returns the sizes that resuming a run must keep: those of the flag, or all that a run uses by default.
pub(crate) fn recorded(given: Option<&SizeList>) -> Vec<[u32; 2]> {
    frame_sizes(given).hardware
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_names_or_sides_and_come_in_ascending_order() {
        let sizes = |text| parse(text).map(|SizeList(sizes)| sizes);
        assert_eq!(sizes("4k,720p,720p"), Ok(vec![[1280, 720], [3840, 2160]]));
        assert_eq!(sizes("640x480"), Ok(vec![[640, 480]]));
        assert_eq!(sizes("none"), Ok(Vec::new()));
        for wrong in ["", "480p", "640x", "8x8", "1x99999", "720p,", "720p none"] {
            assert!(sizes(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn by_default_hardware_draws_larger_frames_than_the_processor() {
        let FrameSizes { software, hardware } = frame_sizes(None);
        assert_eq!((software.len(), hardware.len()), (1, 3));
        let given = frame_sizes(Some(&SizeList(vec![[640, 480]])));
        assert_eq!(given.software, given.hardware);
    }
}
