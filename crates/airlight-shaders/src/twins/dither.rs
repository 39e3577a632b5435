//! Dither: `wgsl/dither.wgsl`.

use glam::Vec3;

/// Hash of a number.
pub fn dither_hash(n: u32) -> u32 {
    let once = (n ^ (n >> 16)).wrapping_mul(0x21f0_aaad);
    let twice = (once ^ (once >> 15)).wrapping_mul(0x735a_2d97);
    twice ^ (twice >> 15)
}

/// Three numbers from 0 to below 1 from the bits of a hash.
pub fn numbers_from_bits(bits: u32) -> Vec3 {
    let parts = [bits >> 22, (bits >> 11) & 0x3ff, bits & 0x3ff];
    Vec3::from(parts.map(|n| n as f32)) / 1024.0
}

/// Noise of a pixel, in levels.
pub fn triangular_noise(column: u32, row: u32) -> Vec3 {
    let seed = dither_hash(row ^ 0x5bd1_e995);
    let at = |column: u32| {
        numbers_from_bits(dither_hash(
            seed.wrapping_add(column.wrapping_mul(0x9e37_79b9)),
        ))
    };
    at(column.wrapping_add(1)) - at(column)
}

/// A signal from 0 to 1 with noise.
pub fn dithered(signal: Vec3, levels: f32, column: u32, row: u32) -> Vec3 {
    let level = signal * levels;
    let room = level.min(levels - level).min(Vec3::ONE);
    (level + triangular_noise(column, row) * room) / levels
}
