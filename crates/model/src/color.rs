//! Colours: linear in files, and as they are displayed in pictures (IEC 61966-2-1).

/// Returns the linear value of an sRGB value.
pub(crate) fn linear(displayed: f64) -> f64 {
    if displayed <= 0.04045 {
        displayed / 12.92
    } else {
        ((displayed + 0.055) / 1.055).powf(2.4)
    }
}

/// Returns the sRGB value of a linear value.
pub(crate) fn displayed(linear: f64) -> f64 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 {
        linear * 12.92
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}
