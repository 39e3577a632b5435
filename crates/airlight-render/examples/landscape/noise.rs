//! Chance that is the same every time: hashes of whole numbers, and smooth noise made of them.

/// Evenly spread over `[0, 1)`.
pub fn hash(x: i64, z: i64, salt: u32) -> f64 {
    let mut h = (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ (z as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f)
        ^ u64::from(salt).wrapping_mul(0x1656_67b1_9e37_79f9);
    h = (h ^ (h >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h = (h ^ (h >> 32)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (h >> 40) as f64 / (1u64 << 24) as f64
}

/// Smooth noise in `[0, 1]`, mean 1/2, with values chosen on a grid of step 1.
pub fn smooth(x: f64, z: f64, salt: u32) -> f64 {
    let (fx, fz) = (x.floor(), z.floor());
    let (ix, iz) = (fx as i64, fz as i64);
    let (u, v) = (ease(x - fx), ease(z - fz));
    let line = |iz: i64| {
        let (a, b) = (hash(ix, iz, salt), hash(ix + 1, iz, salt));
        a + u * (b - a)
    };
    let (a, b) = (line(iz), line(iz + 1));
    a + v * (b - a)
}

/// From 0 at 0 to 1 at 1 without a kink in the slope's slope.
fn ease(t: f64) -> f64 {
    t * t * t * (t * (6.0 * t - 15.0) + 10.0)
}

/// From 0 at `from` to 1 at `to`, level beyond both.
pub fn step(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
