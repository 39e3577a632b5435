//! A function of a positive number, tabulated evenly within each octave.

/// Straight lines between samples; the bits of a float are the address, so no logarithm is needed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OctaveTable {
    lowest: f32,
    highest: f32,
    first_bits: u32,
    /// Each sample, and how much greater the next one is.
    samples: Vec<[f32; 2]>,
}

/// Samples in each octave: 2^8.
const STEPS_LOG2: u32 = 8;
const SHIFT: u32 = 23 - STEPS_LOG2;

impl OctaveTable {
    /// Tabulates `f` from `lowest` to `highest`, both positive and normal, and up to a step beyond.
    pub(super) fn new(lowest: f32, highest: f32, f: impl Fn(f64) -> f64) -> Self {
        let first_bits = lowest.to_bits() >> SHIFT << SHIFT;
        let steps = (highest.to_bits() - first_bits).div_ceil(1 << SHIFT);
        let sample_at = |i: u32| f32::from_bits(first_bits + (i << SHIFT));
        Self {
            lowest: sample_at(0),
            highest: sample_at(steps),
            first_bits,
            samples: (0..=steps)
                .map(|i| {
                    let value = f(f64::from(sample_at(i))) as f32;
                    // Beyond the last sample nothing is read with any weight.
                    let next = f(f64::from(sample_at((i + 1).min(steps)))) as f32;
                    [value, next - value]
                })
                .collect(),
        }
    }

    /// The value at `x`, which is first brought into the table's range; not-a-number counts as the lowest.
    #[inline(always)]
    pub(super) fn at(&self, x: f32) -> f32 {
        let x = if x > self.lowest { x } else { self.lowest };
        let x = if x < self.highest { x } else { self.highest };
        let bits = x.to_bits() - self.first_bits;
        let step = (bits >> SHIFT) as usize;
        let part = (bits & ((1 << SHIFT) - 1)) as f32 * (1.0 / (1 << SHIFT) as f32);
        let [value, rise] = self.samples[step];
        value + rise * part
    }
}
