//! A scene of many draws, each with its own state, to measure the cost of changing state.
//!
//! Every draw has a cell of the attachment to itself, so that the picture shows each draw's state separately.

use crate::error::At;
use crate::wire::StatesWire;
use etalon_scene::{BlendFactor, CompareFunction};
use serde_json::{Value, json};

/// The number of cells across and down.
const CELLS: [u32; 2] = [25, 20];

/// The factors of the source.
const SOURCE: [BlendFactor; 10] = [
    BlendFactor::Zero,
    BlendFactor::One,
    BlendFactor::Src,
    BlendFactor::OneMinusSrc,
    BlendFactor::SrcAlpha,
    BlendFactor::OneMinusSrcAlpha,
    BlendFactor::Dst,
    BlendFactor::OneMinusDst,
    BlendFactor::DstAlpha,
    BlendFactor::OneMinusDstAlpha,
];

/// The factors of the destination.
const DESTINATION: [BlendFactor; 5] = [
    BlendFactor::Zero,
    BlendFactor::One,
    BlendFactor::OneMinusSrcAlpha,
    BlendFactor::Src,
    BlendFactor::OneMinusDst,
];

/// Depth tests that all pass; `None` turns the test off.
const DEPTH: [Option<(CompareFunction, bool)>; 5] = [
    None,
    Some((CompareFunction::Less, true)),
    Some((CompareFunction::LessEqual, false)),
    Some((CompareFunction::NotEqual, true)),
    Some((CompareFunction::Always, false)),
];

/// The maximum number of draws, which is the number of states.
const MOST: u32 = 500;

/// A number coprime to [`MOST`]. Steps of this size reach every state once, and each step changes several
/// parts of the state.
const STRIDE: u32 = 137;

/// Returns the scene with this many draws.
pub(crate) fn scene(wire: &StatesWire) -> Result<Value, At> {
    let StatesWire { count, size } = *wire;
    if !(1..=MOST).contains(&count) {
        return Err(At::new(format!(
            "the count must be 1 to {MOST}, the number of states"
        ))
        .key("count"));
    }
    if size[0] < CELLS[0] || size[1] < CELLS[1] {
        let message = format!("{} by {} cells do not fit", CELLS[0], CELLS[1]);
        return Err(At::new(message).key("size"));
    }
    let draws: Vec<Value> = (0..count).map(|i| draw(i, size)).collect();
    Ok(json!({
        "attachments": {
            "color": { "format": "rgba8unorm", "size": size, "clear": [0, 1, 0.5, 1] },
            "depth": {
                "format": "depth24plus-stencil8", "size": size,
                "clear": { "depth": 1, "stencil": 0 }
            }
        },
        "passes": [{ "color": ["color"], "depth_stencil": "depth", "draws": draws }],
        "read": ["color"]
    }))
}

fn draw(index: u32, size: [u32; 2]) -> Value {
    let mut state = index * STRIDE % MOST;
    let mut next = |choices: usize| {
        let choices = choices as u32;
        let choice = state % choices;
        state /= choices;
        choice as usize
    };
    let (source, destination) = (next(SOURCE.len()), next(DESTINATION.len()));
    let (depth, stencil) = (next(DEPTH.len()), next(2));
    let component = json!({
        "operation": "add",
        "src_factor": SOURCE[source],
        "dst_factor": DESTINATION[destination]
    });
    let [column, row] = [index % CELLS[0], index / CELLS[0]];
    // At most the size, since no cell is beyond the last.
    let line = |i: u32, axis: usize| {
        (u64::from(i) * u64::from(size[axis]) / u64::from(CELLS[axis])) as u32
    };
    let texels = [
        line(column, 0),
        line(row, 1),
        line(column + 1, 0),
        line(row + 1, 1),
    ];
    let stencil = (stencil == 1).then(|| {
        let front = json!({ "compare": "always", "pass_op": "increment-clamp" });
        json!({ "front": front })
    });
    json!({
        "mesh": { "kind": "rect", "texels": texels, "z": 0.5 },
        "shader": "uniform_color",
        "params": { "color": [1, 0.5, 0, 0.5] },
        "blend": { "color": component, "alpha": component },
        "depth": DEPTH[depth].map(|(compare, write)| json!({ "compare": compare, "write": write })),
        "stencil": stencil
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resolve::parse_scene;

    #[test]
    fn every_draw_has_a_state_and_a_cell_of_its_own() {
        let wire = StatesWire {
            count: MOST,
            size: [256, 256],
        };
        let scene = parse_scene(&scene(&wire).expect("fits")).expect("valid");
        let draws = &scene.passes[0].draws;
        assert_eq!(draws.len(), 500);
        for (i, a) in draws.iter().enumerate() {
            for b in &draws[..i] {
                let same = (&a.targets, a.depth, a.stencil) == (&b.targets, b.depth, b.stencil);
                assert!(!same);
                assert_ne!(a.mesh, b.mesh);
            }
        }
        for pair in draws.windows(2) {
            assert_ne!(pair[0].targets, pair[1].targets);
        }
    }

    #[test]
    fn counts_that_do_not_fit_the_size_are_refused() {
        for (count, size) in [(0, [64, 64]), (501, [64, 64]), (500, [64, 16])] {
            assert!(scene(&StatesWire { count, size }).is_err());
        }
    }
}
