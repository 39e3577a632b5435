//! Operations on blocks of pixels, component by component and without branches, so that the compiler vectorises them.

/// Red, green and blue of N pixels.
pub(super) type Planes<const N: usize> = [[f32; N]; 3];

/// The smaller of two numbers other than NaN: one instruction, where `f32::min` takes several.
#[inline(always)]
pub(super) fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The greater of two numbers other than NaN.
#[inline(always)]
pub(super) fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// `keep * c + share * (weighted mean of c)` for each component.
#[inline(always)]
pub(super) fn mix<const N: usize>(
    planes: &mut Planes<N>,
    weights: [f32; 3],
    keep: f32,
    share: f32,
) {
    let [r, g, b] = planes;
    for i in 0..N {
        let mean = share * (weights[0] * r[i] + weights[1] * g[i] + weights[2] * b[i]);
        r[i] = keep * r[i] + mean;
        g[i] = keep * g[i] + mean;
        b[i] = keep * b[i] + mean;
    }
}

/// A colour with negative components (outside the gamut), moved towards grey of the same luminance until no component is
/// negative; black where the luminance is not positive. `weights` are the luminances of red, green and blue of 1, whose sum is 1.
#[inline(always)]
pub fn without_negatives(rgb: [f32; 3], weights: [f32; 3]) -> [f32; 3] {
    let bottom = min(min(rgb[0], rgb[1]), rgb[2]);
    let grey = weights[0] * rgb[0] + weights[1] * rgb[1] + weights[2] * rgb[2];
    let lit = if grey > 0.0 { grey } else { 0.0 };
    // Colours without negative components stay unchanged.
    let part = if bottom < 0.0 {
        lit / (lit - bottom)
    } else {
        1.0
    };
    rgb.map(|v| {
        let raised = max(lit + part * (v - lit), 0.0);
        if bottom < 0.0 { raised } else { v }
    })
}

/// Moves colours of sRGB into its gamut as [`without_negatives`] does.
#[inline(always)]
pub(super) fn into_gamut<const N: usize>(planes: &mut Planes<N>) {
    let [r, g, b] = planes;
    for i in 0..N {
        [r[i], g[i], b[i]] = without_negatives([r[i], g[i], b[i]], LUMINANCE);
    }
}

/// Moves colours towards grey of the same luminance until all components are in `[0, 1]`.
#[inline(always)]
pub(super) fn into_unit_cube<const N: usize>(planes: &mut Planes<N>) {
    into_gamut(planes);
    let [r, g, b] = planes;
    for i in 0..N {
        let top = max(max(r[i], g[i]), b[i]);
        let grey = min(luminance([r[i], g[i], b[i]]), 1.0);
        let part = if top > 1.0 {
            (1.0 - grey) / (top - grey)
        } else {
            1.0
        };
        let lower = |v: f32| {
            let lowered = min(grey + part * (v - grey), 1.0);
            if top > 1.0 { lowered } else { v }
        };
        (r[i], g[i], b[i]) = (lower(r[i]), lower(g[i]), lower(b[i]));
    }
}

/// Luminances of red, green and blue of linear sRGB: the rounded weights of ITU-R BT.709.
pub(super) const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// Luminance of a linear sRGB colour, in the unit of its components, with the rounded weights of ITU-R BT.709.
#[inline(always)]
pub fn luminance([r, g, b]: [f32; 3]) -> f32 {
    LUMINANCE[0] * r + LUMINANCE[1] * g + LUMINANCE[2] * b
}

/// A function of a positive number, tabulated evenly within each octave and interpolated linearly. The index is part of the bits of
/// the number, so that no logarithm is needed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OctaveTable {
    lowest: f32,
    highest: f32,
    first_bits: u32,
    /// Each sample and the difference to the next one.
    samples: Vec<[f32; 2]>,
}

/// Binary logarithm of the number of samples in each octave.
const STEPS_LOG2: u32 = 8;
const SHIFT: u32 = 23 - STEPS_LOG2;

impl OctaveTable {
    /// Tabulates `f` from `lowest` to `highest`, both positive and normal, rounded outwards to whole steps.
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
                    // The last sample has no successor: its difference is never used.
                    let next = f(f64::from(sample_at((i + 1).min(steps)))) as f32;
                    [value, next - value]
                })
                .collect(),
        }
    }

    /// The value at `x`, clamped to the range of the table; that at its lowest end for NaN.
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

/// The nearest of 256 levels of an increasing function on `[0, 1]`, exactly: a table by octaves, whose steps hold at most one border
/// of two levels each.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LevelTable {
    /// The level in the upper half; in the lower half what a number must add to reach the next level.
    steps: Vec<u32>,
}

/// Logarithm of the number of steps in each octave: in the steepest part of sRGB a level spans more than a step.
const LEVEL_STEPS_LOG2: u32 = 7;
const LEVEL_SHIFT: u32 = 23 - LEVEL_STEPS_LOG2;
/// Below it all is level 0.
const LOWEST: f32 = 1.0 / 8192.0;

impl LevelTable {
    /// Levels of a function by its inverse, which maps `[0, 1]` to `[0, 1]`.
    pub(super) fn new(inverse: impl Fn(f64) -> f64) -> Self {
        let first = LOWEST.to_bits() >> LEVEL_SHIFT;
        let last = 1f32.to_bits() >> LEVEL_SHIFT;
        // The least number of each level above 0.
        let borders = (1..256).map(|level| {
            let border = inverse((f64::from(level) - 0.5) / 255.0);
            let near = border as f32;
            let least = if f64::from(near) < border {
                near.next_up()
            } else {
                near
            };
            least.to_bits()
        });
        let borders: Vec<u32> = borders.collect();
        let steps = (first..=last).map(|step| {
            let start = step << LEVEL_SHIFT;
            let level = borders.partition_point(|&border| border <= start);
            let rest = match borders.get(level) {
                Some(border) if border >> LEVEL_SHIFT == step => {
                    (1 << LEVEL_SHIFT) - (border - start)
                }
                _ => 0,
            };
            (level as u32) << LEVEL_SHIFT | rest
        });
        Self {
            steps: steps.collect(),
        }
    }

    /// The level at `x`; that of the nearer end outside `[0, 1]`, 0 for NaN.
    #[inline(always)]
    pub(super) fn at(&self, x: f32) -> u8 {
        let x = if x > LOWEST { x } else { LOWEST };
        let x = if x < 1.0 { x } else { 1.0 };
        let bits = x.to_bits() - LOWEST.to_bits();
        let step = self.steps[(bits >> LEVEL_SHIFT) as usize];
        ((step + (bits & ((1 << LEVEL_SHIFT) - 1))) >> LEVEL_SHIFT) as u8
    }
}
