//! The heart: a stretch of air acts on light as an affine map, and maps compose.

use crate::spectrum::Spectrum;

/// What a stretch of air does to the radiance `L` behind it: `L' = transmittance * L + path_radiance`.
///
/// `transmittance` lies in `[0, 1]`; `path_radiance` is the radiance scattered into the line of sight,
/// in the unit of `L` (W m^-2 sr^-1 nm^-1 for spectra).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathOptics<const N: usize> {
    /// The part of the background's light that arrives.
    pub transmittance: Spectrum<N>,
    /// The light added on the way (airlight).
    pub path_radiance: Spectrum<N>,
}

impl<const N: usize> PathOptics<N> {
    /// No air at all: the identity of [`PathOptics::then`].
    pub const CLEAR: Self = Self {
        transmittance: Spectrum::ONE,
        path_radiance: Spectrum::ZERO,
    };

    /// The map of this stretch (nearer to the eye) followed by `far` (behind it):
    /// `T = T_near T_far`, `S = S_near + T_near S_far`.
    #[inline]
    pub fn then(self, far: Self) -> Self {
        Self {
            transmittance: self.transmittance * far.transmittance,
            path_radiance: self
                .path_radiance
                .mul_acc(self.transmittance, far.path_radiance),
        }
    }

    /// The radiance that reaches the eye from `background` behind this stretch.
    #[inline]
    pub fn apply(self, background: Spectrum<N>) -> Spectrum<N> {
        self.path_radiance.mul_acc(self.transmittance, background)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEAR: PathOptics<3> = PathOptics {
        transmittance: Spectrum([0.5, 0.25, 0.75]),
        path_radiance: Spectrum([1.0, 2.0, 3.0]),
    };
    const FAR: PathOptics<3> = PathOptics {
        transmittance: Spectrum([0.125, 0.5, 1.0]),
        path_radiance: Spectrum([4.0, 0.5, 0.25]),
    };

    #[test]
    fn composing_is_applying_one_after_the_other() {
        let background = Spectrum([7.0, 8.0, 9.0]);
        assert_eq!(
            NEAR.then(FAR).apply(background),
            NEAR.apply(FAR.apply(background))
        );
    }

    #[test]
    fn clear_air_is_the_identity() {
        assert_eq!(PathOptics::CLEAR.then(FAR), FAR);
        assert_eq!(FAR.then(PathOptics::CLEAR), FAR);
    }
}
