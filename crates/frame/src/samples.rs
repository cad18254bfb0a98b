//! Standard sample positions.

/// Returns the standard sample positions in 1/256 texel from the top left corner; the centre for any count
/// that is not in the table (Vulkan, Multisampling; Direct3D 11.3, 19.2.4).
pub fn standard_sample_positions(samples: u32) -> Vec<[u16; 2]> {
    let sixteenths: &[[u16; 2]] = match samples {
        2 => &[[12, 12], [4, 4]],
        4 => &[[6, 2], [14, 6], [2, 10], [10, 14]],
        8 => &[
            [9, 5],
            [7, 11],
            [13, 9],
            [5, 3],
            [3, 13],
            [1, 7],
            [11, 15],
            [15, 1],
        ],
        16 => &[
            [9, 9],
            [7, 5],
            [5, 10],
            [12, 7],
            [3, 6],
            [10, 13],
            [13, 11],
            [11, 3],
            [6, 14],
            [8, 1],
            [4, 2],
            [2, 12],
            [0, 8],
            [15, 4],
            [14, 15],
            [1, 0],
        ],
        _ => &[[8, 8]],
    };
    sixteenths.iter().map(|p| p.map(|v| v * 16)).collect()
}
