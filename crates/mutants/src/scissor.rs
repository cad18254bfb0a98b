//! Bugs of scissor rectangles.

use crate::fields::{FACES, SCISSOR};
use crate::list::{CONFUSION, SMALL, bugs};
use crate::plant::{Plant, all_draws, draws, passes, scene, set, sized};
use crate::tables::ONE_TEXEL;
use etalon_scene::{
    AttachmentContents, CompareFunction, DepthState, Draw, Scene, StencilFace, StencilOperation,
};

/// The bits of fields that hold an edge, and their largest number.
const FIELDS: [(u32, u32); 3] = [(15, 0x7fff), (16, 0xffff), (24, 0x00ff_ffff)];

/// Changes scissor rectangles, given the size of the attachments.
fn scissors(bug: impl Fn([u32; 4], [u32; 2]) -> Option<[u32; 4]> + Send + Sync + 'static) -> Plant {
    sized(move |draw, size| draw.scissor = draw.scissor.and_then(|rect| bug(rect, size)))
}

/// Returns the length of an attachment after a rectangle's end.
fn before(size: u32, start: u32, length: u32) -> u32 {
    size.saturating_sub(start.saturating_add(length))
}

/// Returns the up to four rectangles around another.
fn around([x, y, w, h]: [u32; 4], size: [u32; 2]) -> Vec<[u32; 4]> {
    let (left, top) = (x.min(size[0]), y.min(size[1]));
    let (right, bottom) = ((x + w).min(size[0]), (y + h).min(size[1]));
    if left >= right || top >= bottom {
        return vec![[0, 0, size[0], size[1]]];
    }
    vec![
        [0, 0, size[0], top],
        [0, bottom, size[0], size[1] - bottom],
        [0, top, left, bottom - top],
        [right, top, size[0] - right, bottom - top],
    ]
}

/// Masks the writes of one kind of attachment.
type ScissorMask = fn(&mut Draw);

const COLOR: ScissorMask = |draw| draw.targets.iter_mut().for_each(|t| t.write_mask = 0);
const DEPTH: ScissorMask = |draw| draw.depth.iter_mut().for_each(|d| d.write = false);
const STENCIL: ScissorMask = |draw| FACES(draw).into_iter().for_each(|f| f.write_mask = 0);

/// Skips the scissor test for one kind of attachment: the draw is repeated around the rectangle with the
/// writes of the other two kinds masked.
fn beyond(others: [ScissorMask; 2]) -> Plant {
    passes(move |scene, number, pass| {
        let asked = &scene.passes[number];
        let size = scene.pass_size(asked);
        pass.draws.clear();
        for draw in &asked.draws {
            pass.draws.push(draw.clone());
            for rect in draw.scissor.map_or(Vec::new(), |rect| around(rect, size)) {
                let mut copy = draw.clone();
                copy.scissor = Some(rect);
                others.iter().for_each(|mask| mask(&mut copy));
                pass.draws.push(copy);
            }
        }
    })
}

/// Returns the first draw's rectangle, and the size of its attachments.
fn first_rect(scene: &Scene) -> Option<([u32; 4], [u32; 2])> {
    let pass = scene.passes.first()?;
    let rect = pass.draws.first()?.scissor?;
    Some((rect, scene.pass_size(pass)))
}

/// Returns a draw that fills a rectangle with depth 0 and stencil 0.
fn filler(first: &Draw, rect: [u32; 4]) -> Draw {
    let mut draw = first.clone();
    draw.scissor = Some(rect);
    draw.viewport.depth = [0.0, 0.0];
    draw.viewport.rect = [-64.0, -64.0, 256.0, 256.0];
    COLOR(&mut draw);
    for face in FACES(&mut draw) {
        *face = StencilFace {
            compare: CompareFunction::Always,
            pass_op: StencilOperation::Zero,
            write_mask: 0xff,
            ..*face
        };
    }
    let (compare, write) = (CompareFunction::Always, true);
    draw.depth = Some(DepthState { compare, write });
    draw
}

bugs! {
    class "scissor", "scissor";
    source SMALL;
    for (name, about, by) in ONE_TEXEL {
        "one-texel-{name}: Rectangles {about}." =>
            draws(move |draw| {
                for (value, by) in draw.scissor.iter_mut().flatten().zip(by) {
                    *value = value.saturating_add_signed(by);
                }
            });
    }
    source "ANGLE: y flip; misread rectangles";
    "ignored: There is no scissor test." => set(SCISSOR, None);
    "empty-as-all: An empty rectangle counts as no scissor test." =>
        draws(|draw| draw.scissor = draw.scissor.filter(|[_, _, w, h]| *w > 0 && *h > 0));
    "empty-as-one-texel: An empty rectangle holds one texel." =>
        scissors(|[x, y, w, h], _| Some([x, y, w.max(1), h.max(1)]));
    "upside-down: Rectangles are counted from the bottom." =>
        scissors(|[x, y, w, h], [_, height]| Some([x, before(height, y, h), w, h]));
    "mirrored: Rectangles are counted from the right." =>
        scissors(|[x, y, w, h], [width, _]| Some([before(width, x, w), y, w, h]));
    "transposed: Columns and rows are exchanged." => scissors(|[x, y, w, h], _| Some([y, x, h, w]));
    "size-as-end: Width and height are read as the last column and row." =>
        scissors(|[x, y, w, h], _| Some([x, y, before(w, x, 0), before(h, y, 0)]));
    "from-the-origin: Rectangles begin at the origin." => scissors(|[_, _, w, h], _| Some([0, 0, w, h]));
    "lost-when-partly-outside: Rectangles that reach outside count as no scissor test." =>
        scissors(|[x, y, w, h], [all_w, all_h]| (x + w <= all_w && y + h <= all_h).then_some([x, y, w, h]));
    source "lavapipe and Mesa's OpenGL 22.3.6: scissor edges in 16 bits";
    for (bits, most) in FIELDS {
        "ends-in-{bits}-bits: The far edges of rectangles are kept in {bits} bits." =>
            scissors(move |[x, y, w, h], _| {
                let kept = |start: u32, length| (start.saturating_add(length) & most).saturating_sub(start);
                Some([x, y, kept(x, w), kept(y, h)])
            }), area "size";
        "begins-in-{bits}-bits: The beginnings of rectangles are kept in {bits} bits." =>
            scissors(move |[x, y, w, h], _| Some([x & most, y & most, w, h])), area "size";
    }
    "far-edges-even: The far edges of rectangles beyond 1,000 texels are rounded down to even numbers." =>
        scissors(|[x, y, w, h], _| {
            let kept = |start: u32, length: u32| match start.saturating_add(length) {
                end if end > 1000 => (end & !1).saturating_sub(start),
                _ => length,
            };
            Some([x, y, kept(x, w), kept(y, h)])
        }), area "size";
    source CONFUSION;
    "kept-where-none-is-set: Without a rectangle, the last one stays." =>
        scene(|scene| {
            let mut last = None;
            for draw in all_draws(scene) {
                draw.scissor = draw.scissor.or(last);
                last = draw.scissor;
            }
        });
    "ignored-for-color: Colour is written outside the rectangle." => beyond([DEPTH, STENCIL]);
    "ignored-for-depth: Depth is written outside the rectangle." => beyond([COLOR, STENCIL]);
    "ignored-for-stencil: Stencil is written outside the rectangle." => beyond([COLOR, DEPTH]);

    // The first draw's rectangle applies to the clears before it: outside it, attachments start from 0.
    source "clears that obey the scissor test";
    "clears-color: The first draw's rectangle also holds back the clear of colour." =>
        scene(|scene| {
            let Some(([left, top, w, h], [width, height])) = first_rect(scene) else { return; };
            for index in scene.passes[0].color.clone() {
                let attachment = &mut scene.attachments[index];
                if let (AttachmentContents::Color(color), 1) = (&attachment.contents, attachment.samples) {
                    let channels = attachment.format.color_channels().iter().zip(color);
                    let codes = channels.map(|(e, v)| e.nearest_code(f64::from(*v)));
                    let codes: Vec<u32> = codes.collect();
                    let texels = (0..width * height).flat_map(|texel| {
                        let (x, y) = (texel % width, texel / width);
                        let inside = (left..left + w).contains(&x) && (top..top + h).contains(&y);
                        codes.iter().map(move |c| c * u32::from(inside))
                    });
                    attachment.contents = AttachmentContents::Texels(texels.collect());
                }
            }
        });
    "clears-depth-and-stencil: The first draw's rectangle holds back clears of depth and stencil." =>
        scene(|scene| {
            if let Some((rect, size)) = first_rect(scene) {
                let draws = &mut scene.passes[0].draws;
                let rects = around(rect, size).into_iter();
                let fillers: Vec<Draw> = rects.map(|rect| filler(&draws[0], rect)).collect();
                draws.splice(0..0, fillers);
            }
        });
}
