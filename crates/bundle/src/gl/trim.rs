//! Removing state that no call reads from recorded calls.
//!
//! The backend sets all state before each pass, and sets parameters of disabled capabilities to values that
//! would be visible. A reader needs neither. By the specification, removing them changes no result (OpenGL
//! 4.6, 21: state has the initial values of its tables, and is read when a command draws, clears or
//! copies). But a driver's bug can depend on it, so a trimmed program must be run before it is trusted.

use etalon_backend::{Argument, RecordedCall};
use std::collections::BTreeMap;

/// The state that is removed from a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trim {
    /// Nothing: the program makes every recorded call.
    Nothing,
    /// State that is set to its current value, or set again before it is read.
    Redundant,
    /// Also the parameters of disabled capabilities.
    Idle,
}

impl Trim {
    /// Every variant, from the shortest program to the complete one.
    pub const ALL: [Self; 3] = [Self::Idle, Self::Redundant, Self::Nothing];
}

/// Returns the remaining calls, in their order.
pub(super) fn trimmed(calls: &[RecordedCall], trim: Trim) -> Vec<&RecordedCall> {
    if trim == Trim::Nothing {
        return calls.iter().collect();
    }
    let mut keep = vec![true; calls.len()];
    let mut slots: BTreeMap<StateKey, StateSlot> = BTreeMap::new();
    for (index, call) in calls.iter().enumerate() {
        if let Some(setter) = setter(call) {
            keep[index] = false;
            let slot = slots.entry(setter.key).or_insert_with(|| StateSlot {
                guards: setter.guards,
                active: setter.initial.into_iter().collect(),
                pending: Vec::new(),
            });
            if is_whole(&setter.value) {
                slot.pending.clear();
            }
            slot.pending.push((index, setter.value));
        } else if let Some(replaced) = replaced_family(&call.function) {
            for (key, slot) in &mut slots {
                if matches!(key, StateKey::State(family, _) if *family == replaced) {
                    for index in slot.flush() {
                        keep[index] = true;
                    }
                    slot.active = vec![(call.function.clone(), Vec::new())];
                }
            }
        } else if is_action(&call.function) {
            let on: Vec<u32> = slots
                .iter()
                .filter_map(|(key, slot)| match key {
                    StateKey::Capability(capability) => slot.is_on().then_some(*capability),
                    StateKey::State(..) => None,
                })
                .collect();
            for slot in slots.values_mut() {
                let guards = slot.guards;
                let idle = !guards.is_empty() && !guards.iter().any(|g| on.contains(g));
                if trim == Trim::Idle && idle {
                    continue;
                }
                for index in slot.flush() {
                    keep[index] = true;
                }
            }
        }
    }
    let kept = calls.iter().zip(keep).filter(|(_, keep)| *keep);
    kept.map(|(call, _)| call).collect()
}

/// A piece of state.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum StateKey {
    /// A capability, on or off.
    Capability(u32),
    /// State that a family of functions sets, by the target if their first argument is one.
    State(&'static str, Option<u64>),
}

/// A call that only sets state: the function and its arguments.
type Value = (String, Vec<u64>);

/// The known value of a piece of state.
struct StateSlot {
    guards: &'static [u32],
    /// The calls that set the value at the last action.
    active: Vec<Value>,
    /// The calls since then, with their indices.
    pending: Vec<(usize, Value)>,
}

impl StateSlot {
    /// Returns true if a capability is on, including the calls since the last action.
    fn is_on(&self) -> bool {
        let replaced = self.pending.first().is_some_and(|(_, v)| is_whole(v));
        let before = self.active.iter().filter(|_| !replaced);
        let mut since = before.chain(self.pending.iter().map(|(_, value)| value));
        since.any(|(function, _)| function.starts_with("glEnable"))
    }

    /// Makes the pending calls active. Returns the indices of the calls that must be kept; empty if they
    /// change nothing.
    fn flush(&mut self) -> Vec<usize> {
        let pending = std::mem::take(&mut self.pending);
        let values: Vec<Value> = pending.iter().map(|(_, value)| value.clone()).collect();
        let replaced = values.first().is_some_and(is_whole);
        if values.is_empty()
            || self.active.ends_with(&values) && (!replaced || self.active == values)
        {
            return Vec::new();
        }
        if replaced {
            self.active = values;
        } else {
            self.active.extend(values);
        }
        pending.into_iter().map(|(index, _)| index).collect()
    }
}

/// A call that sets state.
struct Setter {
    key: StateKey,
    value: Value,
    /// The call that would set the initial value.
    initial: Option<Value>,
    /// The capabilities that enable reading the state; empty if it is always read.
    guards: &'static [u32],
}

const BLEND: u32 = 0x0BE2;
const CULL_FACE: u32 = 0x0B44;
const SCISSOR_TEST: u32 = 0x0C11;
const STENCIL_TEST: u32 = 0x0B90;
const DEPTH_TEST: u32 = 0x0B71;
const DEPTH_BOUNDS_TEST: u32 = 0x8890;
const SAMPLE_COVERAGE: u32 = 0x80A0;
const SAMPLE_MASK: u32 = 0x8E51;
const SAMPLE_SHADING: u32 = 0x8C36;
const COLOR_LOGIC_OP: u32 = 0x0BF2;
const DITHER: u32 = 0x0BD0;
const MULTISAMPLE: u32 = 0x809D;
const POLYGON_OFFSET_POINT: u32 = 0x2A01;
const POLYGON_OFFSET_LINE: u32 = 0x2A02;
const POLYGON_OFFSET_FILL: u32 = 0x8037;
const OFFSETS: &[u32] = &[
    POLYGON_OFFSET_FILL,
    POLYGON_OFFSET_LINE,
    POLYGON_OFFSET_POINT,
];
/// The capabilities that are on initially.
const INITIALLY_ON: [u32; 2] = [DITHER, MULTISAMPLE];

/// A function that sets state.
struct StateFunction {
    function: &'static str,
    family: &'static str,
    /// True if each value of the first argument has its own state.
    by_target: bool,
    /// True if the function sets all state of the family.
    whole: bool,
    /// The arguments after the target that set the initial values.
    initial: Option<&'static [u64]>,
    guards: &'static [u32],
}

const fn known(
    function: &'static str,
    family: &'static str,
    whole: bool,
    initial: Option<&'static [u64]>,
    guards: &'static [u32],
) -> StateFunction {
    StateFunction {
        function,
        family,
        by_target: false,
        whole,
        initial,
        guards,
    }
}

const fn by_target(function: &'static str, initial: Option<&'static [u64]>) -> StateFunction {
    StateFunction {
        function,
        family: function,
        by_target: true,
        whole: true,
        initial,
        guards: &[],
    }
}

/// The bits of 1 as an `f32`.
const F1: u64 = 0x3f80_0000;
/// The bits of 1 as an `f64`.
const D1: u64 = 0x3ff0_0000_0000_0000;

/// The functions, with the initial values of the tables of OpenGL 4.6, chapter 23.
const KNOWN: [StateFunction; 39] = [
    known(
        "glCullFace",
        "cull_face",
        true,
        Some(&[0x0405]),
        &[CULL_FACE],
    ),
    known("glFrontFace", "front_face", true, Some(&[0x0901]), &[]),
    known(
        "glDepthFunc",
        "depth_func",
        true,
        Some(&[0x0201]),
        &[DEPTH_TEST],
    ),
    known("glDepthMask", "depth_mask", true, Some(&[1]), &[]),
    known("glColorMask", "color_mask", true, Some(&[1, 1, 1, 1]), &[]),
    known("glColorMaski", "color_mask", false, None, &[]),
    known("glStencilMask", "stencil_mask", true, None, &[]),
    known("glStencilMaskSeparate", "stencil_mask", false, None, &[]),
    known("glStencilFunc", "stencil_func", true, None, &[STENCIL_TEST]),
    known(
        "glStencilFuncSeparate",
        "stencil_func",
        false,
        None,
        &[STENCIL_TEST],
    ),
    known(
        "glStencilOp",
        "stencil_op",
        true,
        Some(&[0x1E00, 0x1E00, 0x1E00]),
        &[STENCIL_TEST],
    ),
    known(
        "glStencilOpSeparate",
        "stencil_op",
        false,
        None,
        &[STENCIL_TEST],
    ),
    known("glBlendFunc", "blend_func", true, Some(&[1, 0]), &[BLEND]),
    known("glBlendFuncSeparate", "blend_func", true, None, &[BLEND]),
    known("glBlendFunci", "blend_func", false, None, &[BLEND]),
    known("glBlendFuncSeparatei", "blend_func", false, None, &[BLEND]),
    known(
        "glBlendEquation",
        "blend_equation",
        true,
        Some(&[0x8006]),
        &[BLEND],
    ),
    known(
        "glBlendEquationSeparate",
        "blend_equation",
        true,
        None,
        &[BLEND],
    ),
    known("glBlendEquationi", "blend_equation", false, None, &[BLEND]),
    known(
        "glBlendEquationSeparatei",
        "blend_equation",
        false,
        None,
        &[BLEND],
    ),
    known(
        "glBlendColor",
        "blend_color",
        true,
        Some(&[0, 0, 0, 0]),
        &[BLEND],
    ),
    known(
        "glLogicOp",
        "logic_op",
        true,
        Some(&[0x1503]),
        &[COLOR_LOGIC_OP],
    ),
    known(
        "glPolygonOffset",
        "polygon_offset",
        true,
        Some(&[0, 0]),
        OFFSETS,
    ),
    known(
        "glPolygonOffsetClamp",
        "polygon_offset",
        true,
        None,
        OFFSETS,
    ),
    known(
        "glPolygonMode",
        "polygon_mode",
        true,
        Some(&[0x0408, 0x1B02]),
        &[],
    ),
    known("glLineWidth", "line_width", true, Some(&[F1]), &[]),
    known("glScissor", "scissor", true, None, &[SCISSOR_TEST]),
    known("glDepthRange", "depth_range", true, Some(&[0, D1]), &[]),
    known("glDepthRangef", "depth_range", true, Some(&[0, F1]), &[]),
    known(
        "glProvokingVertex",
        "provoking_vertex",
        true,
        Some(&[0x8E4E]),
        &[],
    ),
    known(
        "glClipControl",
        "clip_control",
        true,
        Some(&[0x8CA1, 0x935E]),
        &[],
    ),
    known(
        "glSampleCoverage",
        "sample_coverage",
        true,
        Some(&[F1, 0]),
        &[SAMPLE_COVERAGE],
    ),
    known("glSampleMaski", "sample_mask", true, None, &[SAMPLE_MASK]),
    known(
        "glMinSampleShading",
        "sample_shading",
        true,
        Some(&[0]),
        &[SAMPLE_SHADING],
    ),
    known(
        "glDepthBoundsEXT",
        "depth_bounds",
        true,
        Some(&[0, D1]),
        &[DEPTH_BOUNDS_TEST],
    ),
    by_target("glPixelStorei", None),
    by_target("glBindSampler", Some(&[0])),
    by_target("glClampColor", None),
    by_target("glViewportIndexedf", None),
];

fn known_of(function: &str) -> Option<&'static StateFunction> {
    // Functions of extensions set the same state as those of later versions.
    let core = |name: &str| {
        ["OES", "ARB", "ANGLE", "EXT"]
            .iter()
            .find_map(|suffix| function.strip_suffix(suffix))
            .is_some_and(|stem| stem == name)
    };
    let mut known = KNOWN.iter();
    known.find(|k| k.function == function || core(k.function))
}

/// Returns true if a call replaces the whole state that was set before.
fn is_whole((function, _): &Value) -> bool {
    !matches!(function.as_str(), "glEnablei" | "glDisablei")
        && known_of(function).is_none_or(|known| known.whole)
}

/// Returns a call as a setter of state; `None` if it does anything else.
fn setter(call: &RecordedCall) -> Option<Setter> {
    if call.result.is_some() {
        return None;
    }
    let arguments: Option<Vec<u64>> = call.arguments.iter().map(number).collect();
    let arguments = arguments?;
    let function = call.function.as_str();
    if let ("glEnable" | "glDisable", [capability]) = (function, arguments.as_slice()) {
        let capability = u32::try_from(*capability).ok()?;
        let initial = if INITIALLY_ON.contains(&capability) {
            "glEnable"
        } else {
            "glDisable"
        };
        return Some(Setter {
            key: StateKey::Capability(capability),
            initial: Some((initial.to_owned(), arguments.clone())),
            value: (function.to_owned(), arguments),
            guards: &[],
        });
    }
    if let ("glEnablei" | "glDisablei", [capability, _]) = (function, arguments.as_slice()) {
        return Some(Setter {
            key: StateKey::Capability(u32::try_from(*capability).ok()?),
            initial: None,
            value: (function.to_owned(), arguments),
            guards: &[],
        });
    }
    let known = known_of(function)?;
    let target = if known.by_target {
        Some(*arguments.first()?)
    } else {
        None
    };
    let initial = match (known.family, target) {
        // Rows are aligned to 4 bytes, and nothing is skipped.
        ("glPixelStorei", Some(0x0D05 | 0x0CF5)) => Some(vec![4]),
        ("glPixelStorei", _) => Some(vec![0]),
        _ => known.initial.map(<[u64]>::to_vec),
    };
    let with_target = |values: Vec<u64>| target.into_iter().chain(values).collect();
    Some(Setter {
        key: StateKey::State(known.family, target),
        initial: initial.map(|values| (function.to_owned(), with_target(values))),
        value: (function.to_owned(), arguments),
        guards: known.guards,
    })
}

/// Returns the family whose state a function replaces in a way that is not tracked.
fn replaced_family(function: &str) -> Option<&'static str> {
    match function {
        "glScissorArrayv" => Some("scissor"),
        "glDepthRangeArrayv" => Some("depth_range"),
        "glViewport" | "glViewportArrayv" => Some("glViewportIndexedf"),
        _ => None,
    }
}

/// Returns true if a function reads state: it draws, clears or copies.
fn is_action(function: &str) -> bool {
    const PREFIXES: [&str; 7] = [
        "glDraw",
        "glClear",
        "glReadPixels",
        "glBlit",
        "glCopy",
        "glTexImage",
        "glTexSubImage",
    ];
    function != "glDrawBuffers" && PREFIXES.iter().any(|p| function.starts_with(p))
}

/// Returns an argument's value as a number; `None` if it has none.
fn number(argument: &Argument) -> Option<u64> {
    Some(match argument {
        Argument::Integer(value) => u64::from(value.cast_unsigned()),
        Argument::Unsigned(value) => u64::from(*value),
        Argument::Boolean(value) => u64::from(*value),
        Argument::Size(value) => value.cast_unsigned(),
        // Both zeros have the same key.
        Argument::Float(bits) => match f32::from_bits(*bits) {
            0.0 => 0,
            _ => u64::from(*bits),
        },
        Argument::Double(bits) => match f64::from_bits(*bits) {
            0.0 => 0,
            _ => *bits,
        },
        Argument::Constant(constant) => u64::from(constant.value),
        Argument::Object(_, number) => *number,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_backend::{Constant, Phase};

    fn call(function: &str, values: &[u32]) -> RecordedCall {
        RecordedCall {
            phase: Phase::Submit,
            function: function.to_owned(),
            arguments: values
                .iter()
                .map(|value| {
                    Argument::Constant(Constant {
                        name: String::new(),
                        value: *value,
                    })
                })
                .collect(),
            result: None,
        }
    }

    /// Returns the remaining calls, as text.
    fn left(calls: &[(&str, &[u32])], trim: Trim) -> Vec<String> {
        let calls: Vec<RecordedCall> = calls
            .iter()
            .map(|(name, values)| call(name, values))
            .collect();
        let text = |call: &&RecordedCall| {
            let values: Vec<u64> = call.arguments.iter().filter_map(number).collect();
            format!("{}{values:?}", call.function)
        };
        trimmed(&calls, trim).iter().map(text).collect()
    }

    const CALLS: [(&str, &[u32]); 12] = [
        ("glDisable", &[BLEND]),
        ("glDepthFunc", &[0x0200]),
        ("glDepthMask", &[1]),
        ("glEnable", &[STENCIL_TEST]),
        ("glDisable", &[STENCIL_TEST]),
        ("glLogicOp", &[0x1500]),
        ("glClearBufferfv", &[0]),
        ("glEnable", &[DEPTH_TEST]),
        ("glDepthMask", &[0]),
        ("glDrawArrays", &[4, 0, 3]),
        ("glDepthMask", &[0]),
        ("glDrawArrays", &[4, 3, 3]),
    ];

    #[test]
    fn state_that_changes_nothing_is_removed() {
        assert_eq!(left(&CALLS, Trim::Nothing).len(), CALLS.len());
        assert_eq!(
            left(&CALLS, Trim::Redundant),
            [
                "glDepthFunc[512]",
                "glLogicOp[5376]",
                "glClearBufferfv[0]",
                "glEnable[2929]",
                "glDepthMask[0]",
                "glDrawArrays[4, 0, 3]",
                "glDrawArrays[4, 3, 3]",
            ]
        );
        assert_eq!(
            left(&CALLS, Trim::Idle),
            [
                "glDepthFunc[512]",
                "glClearBufferfv[0]",
                "glEnable[2929]",
                "glDepthMask[0]",
                "glDrawArrays[4, 0, 3]",
                "glDrawArrays[4, 3, 3]",
            ]
        );
    }

    #[test]
    fn state_of_one_target_is_kept_until_state_of_all_targets_overrides_it() {
        let calls: [(&str, &[u32]); 7] = [
            ("glColorMask", &[1, 1, 1, 1]),
            ("glColorMaski", &[1, 0, 0, 0, 0]),
            ("glDrawArrays", &[]),
            ("glColorMask", &[1, 1, 1, 1]),
            ("glDrawArrays", &[]),
            ("glColorMask", &[1, 1, 1, 1]),
            ("glDrawArrays", &[]),
        ];
        assert_eq!(
            left(&calls, Trim::Idle),
            [
                "glColorMask[1, 1, 1, 1]",
                "glColorMaski[1, 0, 0, 0, 0]",
                "glDrawArrays[]",
                "glColorMask[1, 1, 1, 1]",
                "glDrawArrays[]",
                "glDrawArrays[]",
            ]
        );
    }

    #[test]
    fn an_enabled_target_makes_the_parameters_read() {
        let calls: [(&str, &[u32]); 4] = [
            ("glBlendFunc", &[0, 1]),
            ("glDisable", &[BLEND]),
            ("glEnablei", &[BLEND, 1]),
            ("glDrawArrays", &[]),
        ];
        assert_eq!(
            left(&calls, Trim::Idle),
            [
                "glBlendFunc[0, 1]",
                "glDisable[3042]",
                "glEnablei[3042, 1]",
                "glDrawArrays[]"
            ]
        );
    }

    #[test]
    fn a_target_that_is_disabled_alone_leaves_the_parameters_of_the_others_read() {
        let calls: [(&str, &[u32]); 6] = [
            ("glEnable", &[BLEND]),
            ("glBlendFunc", &[0, 1]),
            ("glDrawArrays", &[]),
            ("glDisablei", &[BLEND, 1]),
            ("glBlendFunc", &[1, 1]),
            ("glDrawArrays", &[]),
        ];
        assert_eq!(
            left(&calls, Trim::Idle),
            [
                "glEnable[3042]",
                "glBlendFunc[0, 1]",
                "glDrawArrays[]",
                "glDisablei[3042, 1]",
                "glBlendFunc[1, 1]",
                "glDrawArrays[]",
            ]
        );
    }
}
