//! Dither of 8-bit pictures: triangular noise of one step to either side, the same on every run.
//!
//! Along a row each value is the difference of two successive hashes, so that most of its power is at high
//! frequencies, where it is least visible.

/// Noise of one row.
#[derive(Clone, Debug)]
pub(super) struct RowDither {
    seed: u32,
    column: u32,
    last: [f32; 3],
}

impl RowDither {
    /// Noise of row `y` from its first pixel.
    pub(super) fn new(y: u32) -> Self {
        let seed = hash(y ^ 0x5bd1_e995);
        Self {
            seed,
            column: 0,
            last: split(hash(seed)),
        }
    }

    /// Noise for the three components of the next N pixels, component by component, in steps of 8-bit values: in `(-1, 1)`,
    /// mean 0, variance 1/6.
    #[inline(always)]
    pub(super) fn next_pixels<const N: usize>(&mut self) -> [[f32; N]; 3] {
        let mut now = [[0.0; N]; 3];
        for i in 0..N {
            let column = self.column.wrapping_add(1 + i as u32);
            let bits = hash(self.seed.wrapping_add(column.wrapping_mul(0x9e37_79b9)));
            let values = split(bits);
            for (plane, value) in now.iter_mut().zip(values) {
                plane[i] = value;
            }
        }
        self.column = self.column.wrapping_add(N as u32);
        let mut noise = now;
        for ((noise, now), last) in noise.iter_mut().zip(&now).zip(&mut self.last) {
            for i in 0..N {
                noise[i] -= if i == 0 { *last } else { now[i - 1] };
            }
            if let Some(end) = now.last() {
                *last = *end;
            }
        }
        noise
    }
}

/// Hashes a number, so that neighbours are unrelated.
#[inline(always)]
fn hash(n: u32) -> u32 {
    let n = (n ^ (n >> 16)).wrapping_mul(0x21f0_aaad);
    let n = (n ^ (n >> 15)).wrapping_mul(0x735a_2d97);
    n ^ (n >> 15)
}

/// Three numbers in `[0, 1)` from the bits of a hash.
#[inline(always)]
fn split(bits: u32) -> [f32; 3] {
    [bits >> 22, (bits >> 11) & 0x3ff, bits & 0x3ff].map(|n| n as f32 * (1.0 / 1024.0))
}
