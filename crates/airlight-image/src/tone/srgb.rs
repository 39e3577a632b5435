//! The sRGB transfer function (IEC 61966-2-1) and luminance.

/// Luminance of a linear sRGB colour, in the unit of its components, with the rounded weights of Rec. ITU-R BT.709.
#[inline(always)]
pub fn luminance(rgb: [f32; 3]) -> f32 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

/// From linear light in `[0, 1]` to the encoded value.
pub fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

/// From the encoded value in `[0, 1]` to linear light.
pub fn decode(encoded: f64) -> f64 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}
