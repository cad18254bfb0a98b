//! The pictures of a scene: the truth, and the picture of each method at each setting.

use super::data::{SceneSetting, SeriesPoint, ShownScene};
use crate::chart::color;
use crate::numbers::{digits, share};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use etalon_record::Run;
use maud::{Markup, html};
use std::path::Path;

/// The maximum number of bytes of one picture, and of all pictures of the page together.
const PICTURE: u64 = 256 << 10;
const PICTURES: usize = 12 << 20;

/// Returns the PNG file of a path below the run folder.
type PictureReader<'a> = dyn Fn(&str) -> Option<Vec<u8>> + 'a;

/// Pictures of a run, up to the number of bytes that the page has room for.
pub(super) struct PagePictures<'a> {
    read: Box<PictureReader<'a>>,
    room: usize,
}

/// A picture that could be read.
struct Shot<'s, 'a> {
    method: &'a str,
    point: &'s SeriesPoint<'a>,
    data: String,
}

impl<'f> PagePictures<'f> {
    /// Returns the pictures that `read` finds.
    pub(super) fn new(read: impl Fn(&str) -> Option<Vec<u8>> + 'f) -> Self {
        Self {
            read: Box::new(read),
            room: PICTURES,
        }
    }

    /// Returns the pictures of a run folder.
    pub(super) fn in_folder(folder: &'f Path) -> Self {
        Self::new(|path| Run::read_picture(folder, path, PICTURE).ok()?)
    }

    /// Returns the truth and each method's picture at each setting, from the first adapter that has a
    /// picture. The page computes the differences.
    pub(super) fn of(&mut self, shown: &ShownScene<'_, '_>) -> Markup {
        let mut groups = Vec::new();
        for (index, setting) in shown.settings.iter().enumerate() {
            let mut truth = None;
            let mut shots: Vec<Shot<'_, '_>> = Vec::new();
            for (series, point) in shown.scene.at(setting) {
                let m = point.measured;
                if shots.iter().any(|s| s.method == series.method) {
                    continue;
                }
                let Some(path) = m.picture.as_deref() else {
                    continue;
                };
                if truth.is_none() {
                    truth = m.truth_picture.as_deref().and_then(|t| self.read(t));
                }
                if let Some(data) = self.read(path) {
                    shots.push(Shot {
                        method: series.method,
                        point,
                        data,
                    });
                }
            }
            if truth.is_some() || !shots.is_empty() {
                groups.push((index, setting, truth, shots));
            }
        }
        html! {
            @for (index, setting, truth, shots) in &groups {
                div class=(shown.class("pictures", *index)) data-at=(index) data-setting=(setting.text()) {
                    @if let Some(truth) = truth {
                        figure.truth { img src=(truth) alt={ "Picture: truth" (setting.at()) } width="128"; figcaption { "truth" } }
                    }
                    @for shot in shots { (figure(shown, setting, shot)) }
                }
            }
        }
    }

    /// Returns a picture as a `data:` URL, or `None` if it cannot be read or the page has no room for it.
    fn read(&mut self, path: &str) -> Option<String> {
        let bytes = (self.read)(path)?;
        self.room = self.room.checked_sub(bytes.len())?;
        Some(format!("data:image/png;base64,{}", STANDARD.encode(bytes)))
    }
}

fn figure(shown: &ShownScene<'_, '_>, setting: &SceneSetting<'_>, shot: &Shot<'_, '_>) -> Markup {
    let distance = &shot.point.measured.distance;
    let adapter = shown.methods.adapters[shot.point.adapter].name;
    let name = format!("{}{}", shot.method, setting.at());
    html! {
        figure class={ "shot " (color(shown.style(shot.method))) } data-method=(shot.method) data-adapter=(adapter)
            data-case=(shot.point.record.case) {
            img src=(shot.data) alt={ "Picture: " (name) } width="128";
            figcaption {
                (shot.method)
                small { " RMSE " (share(distance.rmse)) ", FLIP " (digits(distance.flip, 2)) }
            }
        }
    }
}
