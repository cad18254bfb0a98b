//! Bugs of one format or of one number of samples, which no other format or number shows.

use super::list::{CONFUSION, List};
use super::plant::{Plant, scene};
use etalon_frame::{Image, TextureFormat};
use etalon_scene::{Attachment, Contents, Scene};

/// Sample counts above 1.
const COUNTS: [u32; 4] = [2, 4, 8, 16];

/// Some attachments start from 0.
fn uncleared(which: impl Fn(&Attachment) -> bool + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        for attachment in scene.attachments.iter_mut().filter(|a| which(a)) {
            match &mut attachment.contents {
                Contents::Color(color) => *color = [0.0; 4],
                Contents::DepthStencil { depth, stencil } => (*depth, *stencil) = (0.0, 0),
                Contents::Texels(_) => {}
            }
        }
    })
}

/// Changes the images of some attachments.
fn images_of(
    which: impl Fn(&Attachment) -> bool + Send + Sync + 'static,
    bug: impl Fn(&mut Image) + Send + Sync + 'static,
) -> Plant {
    Plant::Frame(Box::new(move |scene: &Scene, frame| {
        for image in &mut frame.images {
            let of = |a: &&Attachment| a.name == image.attachment;
            if scene.attachments.iter().find(of).is_some_and(&which) {
                bug(image);
            }
        }
    }))
}

/// Each texel gets the codes of the one before.
fn moved(image: &mut Image) {
    let texel = image.channels.len() * image.samples as usize;
    image.codes.rotate_right(texel);
}

/// The second sample of each texel gets the codes of the first.
fn repeated(image: &mut Image) {
    let n = image.channels.len();
    for texel in image.codes.chunks_exact_mut(n * image.samples as usize) {
        let (first, rest) = texel.split_at_mut(n);
        rest[..n].copy_from_slice(first);
    }
}

pub(super) fn add(list: &mut List) {
    list.class("capability", "capabilities");
    for format in TextureFormat::ALL {
        list.add(
            &format!("{format}-not-cleared"),
            CONFUSION,
            format!("Attachments of {format} start from 0."),
            uncleared(move |a| a.format == format),
        );
        list.add(
            &format!("{format}-read-one-texel-on"),
            CONFUSION,
            format!("Each texel of {format} is read in the place of the next."),
            images_of(move |a| a.format == format, moved),
        );
    }
    for count in COUNTS {
        list.add(
            &format!("{count}-samples-not-cleared"),
            CONFUSION,
            format!("Attachments with {count} samples start from 0."),
            uncleared(move |a| a.samples == count),
        );
        list.add(
            &format!("{count}-samples-second-reads-as-first"),
            CONFUSION,
            format!("The second of {count} samples is read as the first."),
            images_of(move |a| a.samples == count, repeated),
        );
    }
}
