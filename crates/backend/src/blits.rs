//! Blits that move the texels of an attachment, and the copies that move them back to their positions.
//!
//! The copies move texels without scaling, so a blit that works differently leaves a different picture. Each
//! aspect has copies of its own, so a blit of one aspect that also affects the other is noticed.

use crate::halves;
use etalon_frame::{Aspect, ChannelEncoding, PathEnd};

/// One blit: two corners of the source and of the destination. Reversed corners mirror.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Blit {
    /// The aspects that the blit copies.
    pub aspects: Vec<Aspect>,
    /// Two opposite corners of the source.
    pub from: [[u32; 2]; 2],
    /// Two opposite corners of the destination.
    pub to: [[u32; 2]; 2],
}

/// A copy of texels to their positions in the attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlitPiece {
    /// The first texel after the blits.
    pub from: [u32; 2],
    /// The position in the attachment, in texels.
    pub to: [u32; 2],
    /// The width and the height.
    pub size: [u32; 2],
}

/// The blits of an attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blits {
    end: PathEnd,
    /// The size of the attachment.
    size: [u32; 2],
}

/// The factors by which a blit scales.
const SCALE: [u32; 2] = [2, 3];

impl Blits {
    /// Returns the blits of an attachment of this size, or `None` if the path's end moves no texels.
    pub fn new(end: PathEnd, size: [u32; 2]) -> Option<Self> {
        let moves = matches!(
            end,
            PathEnd::BlitMirrored | PathEnd::BlitScaled | PathEnd::BlitPart
        );
        moves.then_some(Self { end, size })
    }

    /// Returns the size of the destination.
    pub fn size(&self) -> [u32; 2] {
        let [width, height] = self.size;
        match self.end {
            PathEnd::BlitScaled => [width * SCALE[0], height * SCALE[1]],
            _ => self.size,
        }
    }

    /// Returns the blits in the order of their execution.
    pub fn blits(&self, aspects: &[Aspect]) -> Vec<Blit> {
        let [width, height] = self.size;
        let full = [[0, 0], self.size];
        let blit = |from, to| {
            vec![Blit {
                aspects: aspects.to_vec(),
                from,
                to,
            }]
        };
        match self.end {
            // The source mirrors one direction, the destination the other.
            PathEnd::BlitMirrored => blit([[0, height], [width, 0]], [[width, 0], [0, height]]),
            PathEnd::BlitScaled => blit(full, [[0, 0], self.size()]),
            _ => self.parts(aspects),
        }
    }

    /// Returns the blits of parts, each of one aspect. The order of the aspects alternates.
    fn parts(&self, aspects: &[Aspect]) -> Vec<Blit> {
        let mut blits = Vec::new();
        let each: Vec<Vec<BlitPiece>> = aspects.iter().map(|aspect| self.pieces(*aspect)).collect();
        for number in 0..each.first().map_or(0, Vec::len) {
            let mut some: Vec<Blit> = aspects
                .iter()
                .zip(&each)
                .map(|(aspect, pieces)| {
                    let BlitPiece { from, to, size } = pieces[number];
                    let corners = |[x, y]: [u32; 2]| [[x, y], [x + size[0], y + size[1]]];
                    Blit {
                        aspects: vec![*aspect],
                        from: corners(to),
                        to: corners(from),
                    }
                })
                .collect();
            if number % 4 == 1 || number % 4 == 2 {
                some.reverse();
            }
            blits.extend(some);
        }
        blits
    }

    /// Returns the copies that move an aspect's texels back to their positions.
    pub fn pieces(&self, aspect: Aspect) -> Vec<BlitPiece> {
        let [width, height] = self.size;
        if self.end == PathEnd::BlitPart {
            // The blits mirrored the positions of the parts: always the columns, and the rows unless the
            // aspect is stencil.
            let place = |side: u32, (start, length): (u32, u32)| side - start - length;
            let rows = aspect != Aspect::Stencil;
            let mut pieces = Vec::new();
            for down in halves(height) {
                for across in halves(width) {
                    let top = if rows { place(height, down) } else { down.0 };
                    pieces.push(BlitPiece {
                        from: [place(width, across), top],
                        to: [across.0, down.0],
                        size: [across.1, down.1],
                    });
                }
            }
            return pieces;
        }
        let texels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        texels
            .map(|[x, y]| BlitPiece {
                from: match self.end {
                    PathEnd::BlitScaled => [
                        x * SCALE[0] + (x + y) % SCALE[0],
                        y * SCALE[1] + (x / SCALE[0] + y) % SCALE[1],
                    ],
                    _ => [width - 1 - x, height - 1 - y],
                },
                to: [x, y],
                size: [1, 1],
            })
            .collect()
    }
}

/// Returns the code of twice a code's value, for texels that a linear filter averaged with zeros. A double
/// within a quarter of a whole number becomes that number, since filters weigh texels with few bits. A
/// double beyond the encoding's range becomes 0.5: the texel was not halved.
pub fn doubled(encoding: ChannelEncoding, code: u32) -> u32 {
    let value = encoding.value_of_order(encoding.order_of_code(code));
    let (twice, rounded) = (2.0 * value, (2.0 * value).round());
    let is_near = (twice - rounded).abs() <= 0.25;
    match encoding.normalized_range() {
        Some((_, most)) if rounded > f64::from(most) => encoding.nearest_code(0.5),
        _ if is_near => encoding.nearest_code(rounded),
        _ => encoding.nearest_code(twice),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENDS: [PathEnd; 3] = [
        PathEnd::BlitMirrored,
        PathEnd::BlitScaled,
        PathEnd::BlitPart,
    ];

    /// Returns the source texel that a blit stores at a texel, if the blit reaches it.
    fn source(blit: &Blit, texel: [u32; 2]) -> Option<[u32; 2]> {
        let mut found = [0; 2];
        for side in 0..2 {
            let ends = |corners: [[u32; 2]; 2]| [corners[0][side], corners[1][side]].map(f64::from);
            let ([from, from_end], [to, to_end]) = (ends(blit.from), ends(blit.to));
            let share = (f64::from(texel[side]) + 0.5 - to) / (to_end - to);
            if !(0.0..1.0).contains(&share) {
                return None;
            }
            found[side] = (from + share * (from_end - from)).floor() as u32;
        }
        Some(found)
    }

    #[test]
    fn copies_undo_the_blits() {
        let aspects = [Aspect::Depth, Aspect::Stencil];
        for (end, size) in ENDS.iter().flat_map(|end| [(*end, [5, 4]), (*end, [1, 7])]) {
            let blits = Blits::new(end, size).expect("it moves texels");
            for aspect in aspects {
                let made = blits.blits(&aspects);
                let made = || made.iter().filter(|blit| blit.aspects.contains(&aspect));
                let mut reached = 0;
                for BlitPiece { from, to, size } in blits.pieces(aspect) {
                    for [x, y] in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y])) {
                        let stored = made()
                            .rev()
                            .find_map(|blit| source(blit, [from[0] + x, from[1] + y]));
                        assert_eq!(stored, Some([to[0] + x, to[1] + y]), "{end} {aspect:?}");
                        reached += 1;
                    }
                }
                assert_eq!(reached, size[0] * size[1], "{end}");
            }
        }
    }

    #[test]
    fn doubling_a_code_doubles_its_value() {
        let unorm = ChannelEncoding::Unorm(8);
        let found = [0, 127, 128, 64, 255].map(|code| doubled(unorm, code));
        assert_eq!(found, [0, 255, 255, 128, 128]);
        let float = ChannelEncoding::Float32;
        let found = [0.0_f32, 0.498, 1.0].map(|value| doubled(float, value.to_bits()));
        assert_eq!(found, [0.0_f32, 1.0, 2.0].map(f32::to_bits));
    }

    #[test]
    fn every_kind_of_blit_moves_texels() {
        for end in ENDS {
            let blits = Blits::new(end, [5, 4]).expect("it moves texels");
            let pieces = blits.pieces(Aspect::Depth);
            assert!(pieces.iter().any(|piece| piece.from != piece.to), "{end}");
        }
        let parts = Blits::new(PathEnd::BlitPart, [5, 4]).expect("it moves texels");
        assert_ne!(parts.pieces(Aspect::Depth), parts.pieces(Aspect::Stencil));
        assert_eq!(Blits::new(PathEnd::Blit, [5, 4]), None);
    }
}
