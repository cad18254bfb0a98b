//! Neighbours of states: those that a mistake in a table would exchange.

use etalon_scene::{BlendFactor, CompareFunction, FrontFace, LogicOperation};

/// Returns functions that differ in one of the three outcomes below, equal and above.
pub(super) fn compare_neighbours() -> Vec<(CompareFunction, CompareFunction)> {
    // Bit 0: true when below, bit 1: when equal, bit 2: when above. This is the order in which the
    // functions are declared, and every API's.
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

/// Returns values and those declared before and after them, cyclically.
pub(super) fn round<T: Copy>(values: &[T]) -> Vec<(T, T)> {
    let n = values.len();
    let both = |i: usize| [1, n - 1].map(|by| (values[i], values[(i + by) % n]));
    (0..n).flat_map(both).collect()
}

/// Returns operations and those declared before and after them, cyclically; and those that differ in
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

/// Returns factors of the second source and those that differ in one thing: complement, channel or
/// alpha, which source.
pub(super) fn second_source_neighbours() -> Vec<(BlendFactor, BlendFactor)> {
    use BlendFactor as F;
    let first = [F::Src, F::OneMinusSrc, F::SrcAlpha, F::OneMinusSrcAlpha];
    let second = [F::Src1, F::OneMinusSrc1, F::Src1Alpha, F::OneMinusSrc1Alpha];
    (0..4)
        .flat_map(|c| [second[c ^ 1], second[c ^ 2], first[c]].map(|wrong| (second[c], wrong)))
        .collect()
}

/// Returns factors and those that differ in one thing: complement, channel or alpha, whose value.
pub(super) fn factor_neighbours() -> Vec<(BlendFactor, BlendFactor)> {
    use BlendFactor as F;
    // Rows: whose value. Columns: channel or alpha, each with its complement.
    let grid = [
        [F::Src, F::OneMinusSrc, F::SrcAlpha, F::OneMinusSrcAlpha],
        [F::Dst, F::OneMinusDst, F::DstAlpha, F::OneMinusDstAlpha],
        [
            F::Constant,
            F::OneMinusConstant,
            F::ConstantAlpha,
            F::OneMinusConstantAlpha,
        ],
    ];
    let mut pairs = vec![
        (F::Zero, F::One),
        (F::One, F::Zero),
        (F::SrcAlphaSaturated, F::Zero),
        (F::SrcAlphaSaturated, F::SrcAlpha),
        (F::SrcAlphaSaturated, F::OneMinusDstAlpha),
        (F::SrcAlphaSaturated, F::One),
    ];
    for (r, row) in grid.iter().enumerate() {
        for (c, factor) in row.iter().enumerate() {
            pairs.push((*factor, row[c ^ 1]));
            pairs.push((*factor, row[c ^ 2]));
            pairs.push((*factor, grid[(r + 1) % 3][c]));
        }
    }
    pairs
}

/// True if two factors are equal in the alpha equation.
pub(super) fn same_for_alpha(a: BlendFactor, b: BlendFactor) -> bool {
    use BlendFactor as F;
    let meaning = |factor| match factor {
        F::Src => F::SrcAlpha,
        F::OneMinusSrc => F::OneMinusSrcAlpha,
        F::Dst => F::DstAlpha,
        F::OneMinusDst => F::OneMinusDstAlpha,
        F::Constant => F::ConstantAlpha,
        F::OneMinusConstant => F::OneMinusConstantAlpha,
        F::Src1 => F::Src1Alpha,
        F::OneMinusSrc1 => F::OneMinusSrc1Alpha,
        F::SrcAlphaSaturated => F::One,
        other => other,
    };
    meaning(a) == meaning(b)
}

/// Returns the other order of vertices.
pub(super) fn turned(face: FrontFace) -> FrontFace {
    match face {
        FrontFace::Ccw => FrontFace::Cw,
        FrontFace::Cw => FrontFace::Ccw,
    }
}

/// Rectangles that are one texel off: the name, the effect, and what is added to them.
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
