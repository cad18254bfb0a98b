//! Neighbouring states, which a mistake in a table would exchange.

use etalon_scene::{BlendFactor, CompareFunction, FrontFace, LogicOperation};

/// Returns pairs of functions that differ in one of the three results: below, equal or above.
pub(super) fn compare_neighbours() -> Vec<(CompareFunction, CompareFunction)> {
    // Bit 0: true when below, bit 1: when equal, bit 2: when above. The functions are declared in this
    // order here and in every API.
    let order = CompareFunction::ALL;
    let bits = |n: usize| [1, 2, 4].map(|bit| (order[n], order[n ^ bit]));
    (0..order.len()).flat_map(bits).collect()
}

/// Returns the pairs of different values.
pub(super) fn pairs<T: Copy + PartialEq>(values: &[T]) -> impl Iterator<Item = (T, T)> {
    let each = values.iter().copied();
    each.flat_map(|a| values.iter().map(move |b| (a, *b)))
        .filter(|(a, b)| a != b)
}

/// Returns pairs of values that are declared next to each other, cyclically, in both orders.
pub(super) fn round<T: Copy>(values: &[T]) -> Vec<(T, T)> {
    let n = values.len();
    let both = |i: usize| [1, n - 1].map(|by| (values[i], values[(i + by) % n]));
    (0..n).flat_map(both).collect()
}

/// Returns pairs of operations that are declared next to each other, cyclically, and pairs that differ in
/// which of source and destination is inverted.
pub(super) fn logic_neighbours() -> Vec<(LogicOperation, LogicOperation)> {
    use LogicOperation as L;
    let mut pairs = round(L::ALL);
    for (a, b) in [
        (L::AndReverse, L::AndInverted),
        (L::OrReverse, L::OrInverted),
        (L::Copy, L::Noop),
        (L::CopyInverted, L::Invert),
    ] {
        pairs.extend([(a, b), (b, a)]);
    }
    pairs
}

/// The factors: one row per operand, columns by channel or alpha, each with its complement.
const FACTORS: [[BlendFactor; 4]; 4] = {
    use BlendFactor as F;
    [
        [F::Src, F::OneMinusSrc, F::SrcAlpha, F::OneMinusSrcAlpha],
        [F::Dst, F::OneMinusDst, F::DstAlpha, F::OneMinusDstAlpha],
        [
            F::Constant,
            F::OneMinusConstant,
            F::ConstantAlpha,
            F::OneMinusConstantAlpha,
        ],
        [F::Src1, F::OneMinusSrc1, F::Src1Alpha, F::OneMinusSrc1Alpha],
    ]
};

/// Returns the operand of a factor (source, destination, constant or second source) and its column: 0 for
/// the channel, 2 for alpha, plus 1 for the complement. `None` if it takes no single value.
pub(super) fn place(factor: BlendFactor) -> Option<[usize; 2]> {
    let mut places = (0..4).flat_map(|row| (0..4).map(move |column| [row, column]));
    places.find(|[row, column]| FACTORS[*row][*column] == factor)
}

/// Returns pairs of factors that differ in one respect: the complement, channel or alpha, or the operand.
fn neighbours(row: usize, other: usize) -> impl Iterator<Item = (BlendFactor, BlendFactor)> {
    let (row, other) = (FACTORS[row], FACTORS[other]);
    (0..4).flat_map(move |c| [row[c ^ 1], row[c ^ 2], other[c]].map(|wrong| (row[c], wrong)))
}

/// Returns the neighbours of the second source's factors.
pub(super) fn second_source_neighbours() -> Vec<(BlendFactor, BlendFactor)> {
    neighbours(3, 0).collect()
}

/// Returns the neighbours of the other factors.
pub(super) fn factor_neighbours() -> Vec<(BlendFactor, BlendFactor)> {
    use BlendFactor as F;
    let mut pairs = vec![
        (F::Zero, F::One),
        (F::One, F::Zero),
        (F::SrcAlphaSaturated, F::Zero),
        (F::SrcAlphaSaturated, F::SrcAlpha),
        (F::SrcAlphaSaturated, F::OneMinusDstAlpha),
        (F::SrcAlphaSaturated, F::One),
    ];
    for row in 0..3 {
        pairs.extend(neighbours(row, (row + 1) % 3));
    }
    pairs
}

/// Returns true if two factors are equal in the alpha equation.
pub(super) fn same_for_alpha(a: BlendFactor, b: BlendFactor) -> bool {
    let meaning = |factor| match place(factor) {
        Some([row, column]) => FACTORS[row][column | 2],
        None if factor == BlendFactor::SrcAlphaSaturated => BlendFactor::One,
        None => factor,
    };
    meaning(a) == meaning(b)
}

/// Returns the opposite winding.
pub(super) fn turned(face: FrontFace) -> FrontFace {
    match face {
        FrontFace::Ccw => FrontFace::Cw,
        FrontFace::Cw => FrontFace::Ccw,
    }
}

/// Rectangles that are one texel off: the name, the effect, and the offsets.
pub(super) const ONE_TEXEL: [(&str, &str, [i32; 4]); 8] = [
    ("right", "lie one texel too far right", [1, 0, 0, 0]),
    ("left", "lie one texel too far left", [-1, 0, 0, 0]),
    ("down", "lie one texel too far down", [0, 1, 0, 0]),
    ("up", "lie one texel too far up", [0, -1, 0, 0]),
    ("wider", "are one texel too wide", [0, 0, 1, 0]),
    ("narrower", "are one texel too narrow", [0, 0, -1, 0]),
    ("higher", "are one texel too high", [0, 0, 0, 1]),
    ("lower", "are one texel too low", [0, 0, 0, -1]),
];

/// The names of channels.
pub(super) const CHANNELS: [&str; 4] = ["red", "green", "blue", "alpha"];
