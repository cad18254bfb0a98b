//! Bugs that only one format or one number of samples shows.

use crate::list::bugs;
use crate::plant::{Plant, contents, images_of};
use etalon_frame::{Image, TextureFormat};
use etalon_scene::{Attachment, AttachmentContents};

/// Makes some attachments start from 0.
fn uncleared(which: impl Fn(&Attachment) -> bool + Send + Sync + 'static) -> Plant {
    contents(move |attachment| {
        let strikes = which(attachment);
        match &mut attachment.contents {
            AttachmentContents::Color(color) if strikes => *color = [0.0; 4],
            AttachmentContents::DepthStencil { depth, stencil } if strikes => {
                (*depth, *stencil) = (0.0, 0)
            }
            _ => {}
        }
    })
}

/// Gives each texel the codes of the previous one.
fn shift_by_one_texel(image: &mut Image) {
    let texel = image.channels.len() * image.samples as usize;
    image.codes.rotate_right(texel);
}

/// Gives the second sample of each texel the codes of the first.
fn repeat_first_sample(image: &mut Image) {
    let n = image.channels.len();
    for texel in image.codes.chunks_exact_mut(n * image.samples as usize) {
        texel.copy_within(..n, n);
    }
}

bugs! {
    class "capability", "capabilities";
    let formats = TextureFormat::ALL;
    for format in formats {
        "{format}-not-cleared: Attachments of {format} start from 0." => uncleared(move |a| a.format == format);
        "{format}-read-one-texel-on: Texels of {format} are read one texel on." =>
            images_of(move |a| a.format == format, shift_by_one_texel);
    }
    for count in [2, 4, 8, 16] {
        "{count}-samples-not-cleared: Attachments with {count} samples start from 0." =>
            uncleared(move |a| a.samples == count);
        "{count}-samples-second-reads-as-first: The second of {count} samples is read as the first." =>
            images_of(move |a| a.samples == count, repeat_first_sample);
    }
}
