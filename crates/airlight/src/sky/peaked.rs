//! Phase functions that are applied for each pixel instead of being tabulated with the light.

use crate::math::interpolation::Place;

/// Number of intervals of a sampled phase function, uniform in the sine of half the scattering angle.
pub(super) const PHASE_SAMPLES: usize = 4096;

/// Constituents whose phase function is too peaked to be tabulated with the light.
pub(crate) struct Peaked {
    /// Indices of the constituents.
    pub constituents: Vec<usize>,
    /// Phase function of each (1/sr), uniform in the sine of half the scattering angle. The same for all blocks, because pixels
    /// are multiplied by it: the mean over the lanes of the first block.
    pub phases: Vec<Vec<f32>>,
}

impl Peaked {
    /// Interpolates a sampled phase function at the sine of half the scattering angle.
    #[inline(always)]
    pub fn sampled(phase: &[f32], half_sine: f64) -> f32 {
        Place::evenly(half_sine, PHASE_SAMPLES + 1).value_in_f32(phase)
    }
}
