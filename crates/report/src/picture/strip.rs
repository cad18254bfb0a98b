//! The pictures of an image side by side, with the first wrong texel marked and the values of every texel.
//!
//! The figure works without a script. `page/compare.js` adds a slider between the first two pictures, and the values
//! under the pointer.

use super::window::TexelWindow;
use crate::lists::Interner;
use crate::words::texel_values;
use etalon_record::FrameImage;
use maud::{Markup, Render, html};

/// The maximum number of bytes of the values of an image. Beyond it, only wrong texels have values.
const VALUE_BYTES: usize = 100_000;

/// One picture.
pub(crate) struct PagePicture {
    pub(crate) label: String,
    /// A `data:` URL.
    pub(crate) uri: String,
    /// Width and height on the page, in pixels.
    pub(crate) size: [u32; 2],
}

/// All pictures of one image of a frame.
pub(crate) struct Strip {
    pub(crate) title: String,
    /// The first picture, the second, and their difference.
    pub(crate) pictures: Vec<PagePicture>,
    /// The pictures that most images do not need: the bounds of what is allowed, and alpha.
    pub(crate) more: Vec<PagePicture>,
    pub(crate) caption: String,
    pub(super) place: StripPlace,
    pub(super) values: StripValues,
}

/// The texels that the pictures show.
#[derive(Clone, Copy)]
pub(super) struct StripPlace {
    pub(super) window: TexelWindow,
    pub(super) samples: u32,
    /// Column, row and sample of the first wrong texel within the window.
    pub(super) wrong: Option<[u32; 3]>,
}

/// The values of the texels of a window, as texts and as pairs of a text's index and the number of its repetitions.
#[derive(Default)]
pub(super) struct StripValues {
    texts: String,
    runs: String,
}

impl Strip {
    /// Returns the bytes of the pictures and values on a page.
    pub(crate) fn bytes(&self) -> usize {
        let pictures = self.pictures.iter().chain(&self.more);
        let pictures: usize = pictures.map(|p| p.uri.len()).sum();
        pictures + self.values.texts.len() + self.values.runs.len()
    }

    /// Returns true if a texel is wrong or imprecise.
    pub(crate) fn has_wrong(&self) -> bool {
        self.place.wrong.is_some()
    }

    fn picture(&self, picture: &PagePicture) -> Markup {
        let [width, height] = picture.size;
        html! {
            figure {
                div.shot style={ "width:" (width) "px" } {
                    img src=(picture.uri) width=(width) height=(height) alt={ (picture.label) " of " (self.title) };
                    @if let Some(ring) = self.place.ring() { i.ring style=(ring) {} }
                }
                figcaption { (picture.label) }
            }
        }
    }
}

impl Render for Strip {
    fn render(&self) -> Markup {
        let StripPlace {
            window, samples, ..
        } = self.place;
        html! {
            div.strip data-window={ (window.x) " " (window.y) " " (window.width) " " (window.height) " " (samples) }
                data-wrong=[self.place.wrong.map(|[x, y, sample]| format!("{x} {y} {sample}"))]
                data-values=(self.values.texts) data-runs=(self.values.runs) {
                h4 { (self.title) }
                div.shots { @for p in &self.pictures { (self.picture(p)) } }
                p.cap { (self.caption) }
                @if !self.more.is_empty() {
                    details {
                        summary { @for (i, p) in self.more.iter().enumerate() { @if i > 0 { ", " } (p.label) } }
                        div.shots { @for p in &self.more { (self.picture(p)) } }
                    }
                }
            }
        }
    }
}

impl StripPlace {
    /// Returns the place of the first wrong texel on a picture.
    fn ring(&self) -> Option<String> {
        let [x, y, sample] = self.wrong?;
        let TexelWindow { width, height, .. } = self.window;
        let tile = if self.samples > 1 { width + 1 } else { width };
        let columns = (tile * self.samples - (tile - width)).max(1);
        let percent = |part: u32, whole: u32| f64::from(part) * 100.0 / f64::from(whole.max(1));
        Some(format!(
            "left:{:.4}%;top:{:.4}%;width:{:.4}%;height:{:.4}%",
            percent(sample * tile + x, columns),
            percent(y, height),
            percent(1, columns),
            percent(1, height)
        ))
    }
}

impl StripValues {
    /// Returns the values of the texels in a window, with the names of the first and second picture.
    pub(super) fn of(image: &FrameImage, window: TexelWindow, names: [&str; 2]) -> Self {
        let mut texts: Interner<String> = Interner::default();
        let mut places: Vec<(usize, u32)> = Vec::new();
        let mut bytes = 0;
        // Neighbours mostly have the same codes.
        let mut last = (usize::MAX, 0);
        for index in window.samples(image) {
            let n = image.channels.len();
            let alike = |a: usize, b: usize| {
                let codes = [&image.low, &image.high, &image.actual];
                let same = |codes: &&Vec<u32>| codes[a * n..][..n] == codes[b * n..][..n];
                image.wrong[a] == image.wrong[b] && codes.iter().all(same)
            };
            let place = if last.0 != usize::MAX && alike(last.0, index) {
                last.1
            } else if bytes > VALUE_BYTES && image.wrong[index] == FrameImage::FINE {
                texts.place(String::new())
            } else {
                let text = texel_values(image, index, names);
                bytes += if texts.has(&text) { 0 } else { text.len() };
                texts.place(text)
            };
            last = (index, place);
            match places.last_mut() {
                Some((before, times)) if *before == place => *times += 1,
                _ => places.push((place, 1)),
            }
        }
        let runs = places
            .iter()
            .map(|(place, times)| format!("{place} {times}"));
        Self {
            texts: texts.values.join("\n"),
            runs: runs.collect::<Vec<_>>().join(" "),
        }
    }
}
