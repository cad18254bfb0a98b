//! Lines with too few fragments. The specifications leave open which texel of a column has a line's fragment,
//! so a missing line violates no single texel's legal set. The number of fragments is not open, though. A
//! column counts as having a fragment if any of its texels can contain what the line writes there.

use crate::notes::Notes;
use crate::primitive::{Edge, EdgeSide, Shape, SnappedPrimitive, line_times};
use crate::rules::Rules;
use crate::sample::Sample;
use crate::snap::SnapBox;
use crate::texels::Texels;
use crate::walk::{Forced, Walk, in_scissor};
use etalon_frame::{Frame, LegalSet, Limits, TexelSet, WrongTexel};
use etalon_pipeline::Point;
use etalon_scene::{Draw, PolygonMode, PrimitiveTopology, Scene};
use smallvec::SmallVec;
use std::ops::Range;

/// The maximum number of columns of a scene's lines that are checked.
const MOST_COLUMNS: usize = 4096;

/// A line with fewer fragments than any legal algorithm can produce.
#[derive(Clone, Debug)]
pub struct LineGap {
    /// The pass, the draw and the primitive, which is the line or has it as an edge.
    pub origin: [usize; 3],
    /// The least legal number of fragments, and the greatest number that the frame can contain.
    pub fragments: [usize; 2],
    /// A texel of each column without a fragment, with its values if the line covered it.
    pub wrong: Vec<WrongTexel>,
    /// The clause.
    pub citation: &'static str,
}

/// A line of a draw.
#[derive(Clone, Copy)]
struct DrawnLine<'a> {
    pass: usize,
    draw: usize,
    primitive: &'a SnappedPrimitive,
    ends: [SnapBox; 2],
}

/// Returns true if [`line_gap`] counts the fragments of any line of a scene.
pub fn counts_lines(scene: &Scene) -> bool {
    drawn_lines(scene).next().is_some()
}

/// Returns the passes and draws of all lines whose fragments can be counted.
fn drawn_lines(scene: &Scene) -> impl Iterator<Item = (usize, usize)> {
    let passes = scene.passes.iter().enumerate();
    passes
        .filter(|(_, pass)| scene.pass_samples(pass) == 1)
        .flat_map(|(p, pass)| {
            let draws = pass.draws.iter().enumerate();
            draws
                .filter(|(_, draw)| has_lines(draw))
                .map(move |(d, _)| (p, d))
        })
}

/// Returns the first line of a scene that has too few fragments in a frame of the legal set's images; `None`
/// if every line has enough.
pub fn line_gap(
    scene: &Scene,
    limits: &Limits,
    rules: &Rules,
    frame: &Frame,
    legal: &LegalSet,
) -> Option<LineGap> {
    let mut drawn = drawn_lines(scene).peekable();
    drawn.peek()?;
    let lack = rules.lines_lack.value()?;
    let walk = Walk::new(scene, limits, rules, Texels::All);
    let mut columns = 0;
    for (pass, draw) in drawn {
        for primitive in walk.setups[pass].primitives_of(draw) {
            for ends in segments(primitive) {
                let Some((axis, required)) = columns_of(ends, walk.units) else {
                    continue;
                };
                columns += required.clone().count();
                if required.clone().count() <= lack {
                    continue;
                }
                if columns > MOST_COLUMNS {
                    return None;
                }
                let line = DrawnLine {
                    pass,
                    draw,
                    primitive,
                    ends,
                };
                let least = required.clone().count() - lack;
                let lacking = walk.lacking(line, (axis, required), least, (frame, legal));
                if let Some((most, wrong)) = lacking {
                    return Some(LineGap {
                        origin: [pass, draw, primitive.index as usize],
                        fragments: [least, most],
                        wrong,
                        citation: rules.lines_lack.citation,
                    });
                }
            }
        }
    }
    None
}

/// Returns true if a draw's primitives are lines, or are drawn as lines.
fn has_lines(draw: &Draw) -> bool {
    let lines = [PrimitiveTopology::LineList, PrimitiveTopology::LineStrip];
    lines.contains(&draw.topology) || draw.polygon_mode == PolygonMode::Line
}

/// Returns the lines of a primitive. Cut edges are left out, since their ends are unknown.
fn segments(primitive: &SnappedPrimitive) -> Vec<[SnapBox; 2]> {
    match &primitive.shape {
        Shape::Line(ends) => vec![*ends],
        Shape::Outline(triangle) => {
            let ends = triangle.edges().into_iter().map(|edge| match edge {
                Edge::Between(ends) => Some(ends),
                Edge::Cut { .. } => None,
            });
            ends.flatten().collect()
        }
        Shape::Triangle(_) | Shape::Point { .. } => Vec::new(),
    }
}

/// Returns a point's coordinate: x along axis 0, y along axis 1.
fn along(point: Point, axis: usize) -> i64 {
    if axis == 0 { point.x } else { point.y }
}

/// Returns the axis along which a line is longer, wherever its ends are snapped, and the columns (or rows)
/// that it crosses from side to side. The diamond-exit rule gives each of them a fragment. `None` if the axis
/// depends on the snapping.
fn columns_of([a, b]: [SnapBox; 2], units: i64) -> Option<(usize, Range<i64>)> {
    let inner = |axis: usize| {
        let (first, second) = if along(a.low, axis) <= along(b.low, axis) {
            (a, b)
        } else {
            (b, a)
        };
        (along(first.high, axis), along(second.low, axis))
    };
    let least = |axis: usize| inner(axis).1 - inner(axis).0;
    let most = |axis: usize| {
        let bounds = a.hull(b);
        along(bounds.high, axis) - along(bounds.low, axis)
    };
    let axis = [0, 1]
        .into_iter()
        .find(|axis| least(*axis) > most(1 - axis))?;
    let (low, high) = inner(axis);
    // An end on the border of its texel can be in the next texel's diamond.
    let (first, end) = (low.div_euclid(units) + 1, -(-high).div_euclid(units) - 1);
    Some((axis, first..end.max(first)))
}

impl Walk<'_> {
    /// Returns the number of columns in which a frame can have a fragment of a line, including invisible
    /// ones, and a texel of each column of `required` that has none; `None` if there are at least `least`
    /// columns, or if a part of the line may be clipped.
    fn lacking(
        &self,
        line: DrawnLine<'_>,
        (axis, required): (usize, Range<i64>),
        least: usize,
        (frame, legal): (&Frame, &LegalSet),
    ) -> Option<(usize, Vec<WrongTexel>)> {
        let [a, b] = line.ends;
        let bounds = a.hull(b);
        // A fragment is off by at most a texel, and an end on the border of a texel can count for the next
        // texel.
        let cells = |axis: usize| {
            let low = (along(bounds.low, axis) - 1).div_euclid(self.units);
            let high = along(bounds.high, axis).div_euclid(self.units);
            low - 1..high + 2
        };
        let (mut found, mut wrong) = (0, Vec::new());
        let beside = cells(axis).filter(|column| !required.contains(column));
        for column in required.clone().chain(beside) {
            let at = |row: i64| {
                if axis == 0 {
                    [column, row]
                } else {
                    [row, column]
                }
            };
            let mut rows: SmallVec<[i64; 8]> = SmallVec::new();
            for row in cells(1 - axis) {
                let [x, y] = at(row).map(|texel| texel * self.units + self.units / 2);
                let center = Point { x, y };
                if line_times(line.ends, center, self.units).1 == 0 {
                    continue;
                }
                let sides = [EdgeSide::Unknown; 3];
                let hit = self.hit((line.pass, line.draw), line.primitive, sides, center);
                hit.ok().filter(|hit| hit.is_certain())?;
                rows.push(row);
            }
            // The middle texel is nearest to the line.
            let middle = rows.len() / 2;
            rows.rotate_left(middle);
            let mut nearest = None;
            let is_possible = rows.into_iter().any(|row| {
                let Some((sample, set)) = self.covered_by(line, at(row)) else {
                    return true;
                };
                let position = [sample.x, sample.y, 0];
                match legal.refused(frame, (sample.size, 1), position, &set) {
                    None => true,
                    Some(texel) => {
                        nearest.get_or_insert(texel);
                        false
                    }
                }
            });
            if is_possible {
                found += 1;
                if found >= least {
                    return None;
                }
            } else if required.contains(&column) {
                wrong.extend(nearest);
            }
        }
        Some((found, wrong))
    }

    /// Returns a texel with its legal values if a line covers it; `None` if no fragment would be visible
    /// there.
    fn covered_by(&self, line: DrawnLine<'_>, texel: [i64; 2]) -> Option<(Sample, TexelSet)> {
        let pass = &self.scene.passes[line.pass];
        let size = self.scene.pass_size(pass);
        let [x, y] = texel.map(|v| u32::try_from(v).ok());
        let at = Sample {
            size,
            samples: 1,
            x: x.filter(|x| *x < size[0])?,
            y: y.filter(|y| *y < size[1])?,
            sample: 0,
        };
        if !in_scissor(&pass.draws[line.draw], at) {
            return None;
        }
        self.force(Forced {
            at,
            draw: self.draw_ids[line.pass] + line.draw as u32,
            primitive: line.primitive.index,
        });
        let worlds = self.worlds(at, self.scene.passes.len(), &mut Notes(None));
        let set = worlds.map(|worlds| self.finish(&worlds, at, &mut Notes(None)));
        Some((at, set.unwrap_or_default()))
    }
}
