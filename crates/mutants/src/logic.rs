//! Bugs of logic operations.

use crate::fields::{FieldPlaces, LOGIC};
use crate::hooks::{code, logic};
use crate::list::bugs;
use crate::permission::under;
use crate::plant::{draws, set};
use crate::tables::logic_neighbours;
use etalon_frame::ChannelEncoding;
use etalon_pipeline::logic_operation;
use etalon_reference::rules::SrgbLogic;
use etalon_scene::LogicOperation;

/// Returns the correct result of an operation.
fn right(obeys: bool, encoding: ChannelEncoding, operation: LogicOperation, s: u32, d: u32) -> u32 {
    if obeys {
        logic_operation(encoding, operation, s, d)
    } else {
        s
    }
}

/// Returns the result of an operation on this number of bits.
fn bits(bits: u8, operation: LogicOperation, s: u32, d: u32) -> u32 {
    logic_operation(ChannelEncoding::Unorm(bits), operation, s, d)
}

bugs! {
    class "logic", "blend";
    let field: FieldPlaces<LogicOperation> = |d| d.logic.iter_mut().collect();
    swaps "", "The operation ", field, logic_neighbours();
    "off: Logic operations are off." => set(LOGIC, None), source "lavapipe: logic operations lost";
    "write-mask-ignored: Logic operations write all channels." =>
        draws(|draw| draw.targets.iter_mut().for_each(|t| t.write_mask = 0xf)), when |draw| draw.logic.is_some();
    "off-for-partial-masks: Logic operations are off where not all channels are written." =>
        set(LOGIC, None), when |draw| draw.targets.iter().any(|t| t.write_mask != 0xf);
    source "logic operations where there are none";
    "applied-to-srgb: Logic operations work on the bits of sRGB formats." =>
        logic(|obeys, encoding, operation, s, d| match encoding {
            ChannelEncoding::Srgb8 => bits(8, operation, s, d),
            _ => right(obeys, encoding, operation, s, d),
        });
    "applied-to-srgb-and-alpha: Logic operations work on all bits of sRGB formats." =>
        logic(|obeys, encoding, operation, s, d| match encoding {
            ChannelEncoding::Srgb8 | ChannelEncoding::Unorm(8) => bits(8, operation, s, d),
            _ => right(obeys, encoding, operation, s, d),
        }), source "drivers of OpenGL 3.3",
        permitted vec![under!(srgb_logic: SrgbLogic::Applies | SrgbLogic::Either)];
    "applied-to-srgb-alpha: Logic operations work on the alpha of sRGB formats." =>
        logic(|obeys, encoding, operation, s, d| match encoding {
            ChannelEncoding::Unorm(8) => bits(8, operation, s, d),
            _ => right(obeys, encoding, operation, s, d),
        });
    "applied-to-float: Logic operations work on the bits of float formats." =>
        logic(|obeys, encoding, operation, s, d| match encoding {
            ChannelEncoding::Float16 => bits(16, operation, s, d),
            _ => right(obeys, encoding, operation, s, d),
        });
    "float-untouched: On float formats, logic operations leave the destination." =>
        logic(|obeys, encoding, operation, s, d| {
            if encoding.is_float() { d } else { right(obeys, encoding, operation, s, d) }
        });
    source "logic operations on too few bits";
    "ten-bits-in-8: On formats of 10 bits, the lowest two keep the source's." =>
        logic(|obeys, encoding, operation, s, d| match encoding {
            ChannelEncoding::Unorm(10) => (bits(10, operation, s, d) & !3) | (s & 3),
            _ => right(obeys, encoding, operation, s, d),
        });
    "highest-bit-lost: The highest of 8 bits keeps the destination's." =>
        logic(|obeys, encoding, operation, s, d| match encoding {
            ChannelEncoding::Unorm(8) if obeys => (bits(8, operation, s, d) & 0x7f) | (d & 0x80),
            _ => right(obeys, encoding, operation, s, d),
        });
    "source-as-all-or-nothing: A source that is not 0 counts as all ones." =>
        logic(|obeys, encoding, operation, s, d| {
            let ones = code(encoding, 1.0);
            right(obeys, encoding, operation, if s == 0 { 0 } else { ones }, d)
        });
    class "logic", "combined";
    "off-while-blending: Logic operations are off where blending is on." =>
        set(LOGIC, None), source "blending wins", when |draw| draw.targets.iter().any(|t| t.blend.is_some());
}
