//! Bugs of logic operations.

use super::hooks::{code, logic};
use super::list::{CONFUSION, List, Row};
use super::plant::{Plant, draws};
use super::tables;
use etalon_frame::ChannelEncoding;
use etalon_pipeline::logic_operation;
use etalon_scene::LogicOperation;

pub(super) fn add(list: &mut List) {
    list.class("logic", "blend");
    for (right, wrong) in tables::logic_neighbours() {
        list.add(
            &format!("{}-as-{}", right.name(), wrong.name()),
            CONFUSION,
            format!("{} acts as {}.", right.name(), wrong.name()),
            draws(move |draw| {
                if draw.logic == Some(right) {
                    draw.logic = Some(wrong);
                }
            }),
        );
    }
    list.add(
        "off",
        "lavapipe: logic operations lost",
        "Logic operations are off.",
        draws(|draw| draw.logic = None),
    );
    list.add(
        "write-mask-ignored",
        CONFUSION,
        "Logic operations write all channels.",
        draws(|draw| {
            if draw.logic.is_some() {
                draw.targets.iter_mut().for_each(|t| t.write_mask = 0xf);
            }
        }),
    );
    list.add(
        "off-for-partial-masks",
        CONFUSION,
        "Logic operations are off where not all channels are written.",
        draws(|draw| {
            if draw.targets.iter().any(|t| t.write_mask != 0xf) {
                draw.logic = None;
            }
        }),
    );
    type Bug = fn(bool, ChannelEncoding, LogicOperation, u32, u32) -> u32;
    let rows: [Row<Bug>; 7] = [
        (
            "applied-to-srgb",
            "Logic operations work on the bits of sRGB formats.",
            |obeys, encoding, operation, s, d| match encoding {
                ChannelEncoding::Srgb8 => bits(8, operation, s, d),
                _ => right(obeys, encoding, operation, s, d),
            },
        ),
        (
            "applied-to-srgb-alpha",
            "Logic operations work on the alpha of sRGB formats.",
            |obeys, encoding, operation, s, d| match encoding {
                ChannelEncoding::Unorm(8) => bits(8, operation, s, d),
                _ => right(obeys, encoding, operation, s, d),
            },
        ),
        (
            "applied-to-float",
            "Logic operations work on the bits of float formats.",
            |obeys, encoding, operation, s, d| match encoding {
                ChannelEncoding::Float16 => bits(16, operation, s, d),
                _ => right(obeys, encoding, operation, s, d),
            },
        ),
        (
            "float-untouched",
            "On float formats, logic operations leave the destination.",
            |obeys, encoding, operation, s, d| {
                if encoding.is_float() {
                    d
                } else {
                    right(obeys, encoding, operation, s, d)
                }
            },
        ),
        (
            "ten-bits-in-8",
            "On formats of 10 bits, the lowest two keep the source's.",
            |obeys, encoding, operation, s, d| match encoding {
                ChannelEncoding::Unorm(10) => (bits(10, operation, s, d) & !3) | (s & 3),
                _ => right(obeys, encoding, operation, s, d),
            },
        ),
        (
            "highest-bit-lost",
            "The highest of 8 bits keeps the destination's.",
            |obeys, encoding, operation, s, d| match encoding {
                ChannelEncoding::Unorm(8) if obeys => {
                    (bits(8, operation, s, d) & 0x7f) | (d & 0x80)
                }
                _ => right(obeys, encoding, operation, s, d),
            },
        ),
        (
            "source-as-all-or-nothing",
            "A source that is not 0 counts as all ones.",
            |obeys, encoding, operation, s, d| {
                let all = code(encoding, 1.0);
                right(obeys, encoding, operation, if s == 0 { 0 } else { all }, d)
            },
        ),
    ];
    fn plant(bug: Bug) -> Plant {
        logic(bug)
    }
    list.rows("logic operations where there are none", plant, &rows[..4]);
    list.rows("logic operations on too few bits", plant, &rows[4..]);
}

/// Returns the correct result of an operation.
fn right(obeys: bool, encoding: ChannelEncoding, operation: LogicOperation, s: u32, d: u32) -> u32 {
    if obeys {
        logic_operation(encoding, operation, s, d)
    } else {
        s
    }
}

/// Returns the result of an operation on a number of bits.
fn bits(bits: u8, operation: LogicOperation, s: u32, d: u32) -> u32 {
    logic_operation(ChannelEncoding::Unorm(bits), operation, s, d)
}
