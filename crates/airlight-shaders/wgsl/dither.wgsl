// Dither of displays and files with few levels: triangular noise of one level to either side, whose power is at high frequencies,
// the same in every frame.

/// Hash of a number: neighbours are unrelated.
///
/// Cost: no exp. Error: 1e-7 relative.
fn dither_hash(n: u32) -> u32 {
    let once = (n ^ (n >> 16u)) * 0x21f0aaadu;
    let twice = (once ^ (once >> 15u)) * 0x735a2d97u;
    return twice ^ (twice >> 15u);
}

/// Three numbers from 0 to below 1 from the bits of a hash.
///
/// Cost: no exp. Error: 1e-7 relative.
fn numbers_from_bits(bits: u32) -> vec3<f32> {
    return vec3<f32>(f32(bits >> 22u), f32((bits >> 11u) & 0x3ffu), f32(bits & 0x3ffu)) / 1024.0;
}

/// Noise of a pixel, in levels: between -1 and 1, mean 0, variance 1/6. Along a row it is the difference of successive hashes.
///
/// Cost: no exp. Error: 1e-7 relative.
fn triangular_noise(column: u32, row: u32) -> vec3<f32> {
    let seed = dither_hash(row ^ 0x5bd1e995u);
    let before = numbers_from_bits(dither_hash(seed + column * 0x9e3779b9u));
    let here = numbers_from_bits(dither_hash(seed + (column + 1u) * 0x9e3779b9u));
    return here - before;
}

/// A signal from 0 to 1 with noise, to be stored in a target of `levels` levels above 0 (255 for 8 bits), which rounds to the
/// nearest. Black and white stay unchanged, and no noise exceeds them.
///
/// Cost: no exp. Error: 3e-7 relative plus 1e-7 absolute.
fn dithered(signal: vec3<f32>, levels: f32, column: u32, row: u32) -> vec3<f32> {
    let level = signal * levels;
    let room = min(min(level, levels - level), vec3<f32>(1.0));
    return (level + triangular_noise(column, row) * room) / levels;
}
