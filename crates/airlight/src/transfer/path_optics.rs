//! Transmittance and path radiance of a ray segment, and their composition.

use crate::spectrum::Spectrum;

/// Transmittance and in-scattered radiance of a ray segment: `L' = transmittance * L + path_radiance` for the radiance `L`
/// behind it.
///
/// `transmittance` lies in `[0, 1]`; `path_radiance` is in the unit of `L` (W m^-2 sr^-1 nm^-1 for spectra).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathOptics<const N: usize> {
    /// Fraction of the background radiance that reaches the eye.
    pub transmittance: Spectrum<N>,
    /// Radiance scattered into the ray along the segment.
    pub path_radiance: Spectrum<N>,
}

impl<const N: usize> PathOptics<N> {
    /// No air: the identity of [`PathOptics::then`].
    pub const CLEAR: Self = Self {
        transmittance: Spectrum::ONE,
        path_radiance: Spectrum::ZERO,
    };

    /// Composition of this segment (nearer to the eye) with the segment `far` behind it: `T = T_near T_far`,
    /// `S = S_near + T_near S_far`.
    #[inline]
    pub fn then(self, far: Self) -> Self {
        Self {
            transmittance: self.transmittance * far.transmittance,
            path_radiance: self
                .path_radiance
                .mul_acc(self.transmittance, far.path_radiance),
        }
    }

    /// Radiance at the eye for the radiance `background` behind the segment.
    #[inline]
    pub fn apply(self, background: Spectrum<N>) -> Spectrum<N> {
        self.path_radiance.mul_acc(self.transmittance, background)
    }

    /// The same segment with `factor` times its optical depth and the same mean source function `S / (1 - T)`:
    /// `T^factor`, `S (1 - T^factor) / (1 - T)`. Exact if extinction and scattering change together and the light in the segment
    /// does not.
    #[inline]
    pub fn at_density(self, factor: f32) -> Self {
        let depth = self.transmittance.ln() * -1.0;
        let transmittance = (depth * -factor).exp();
        Self {
            transmittance: Spectrum::from_fn(|lane| match self.transmittance[lane] > 0.0 {
                true => transmittance[lane],
                false => 0.0,
            }),
            path_radiance: Spectrum::from_fn(|lane| {
                /// Depths below which `1 - e^-x` follows from its series: of the segment, and of the one of another density.
                const THIN: f32 = 1e-3;
                const SERIES: f32 = 0.1;
                let (depth, light) = (depth[lane], self.path_radiance[lane]);
                if depth >= THIN {
                    return light
                        * ((1.0 - transmittance[lane]) / (1.0 - self.transmittance[lane]));
                }
                let x = depth * factor;
                let mean = match x < SERIES {
                    true => 1.0 - x * (1.0 / 2.0 - x * (1.0 / 6.0 - x / 24.0)),
                    false => (1.0 - transmittance[lane]) / x,
                };
                light * factor * mean * (1.0 + 0.5 * depth)
            }),
        }
    }
}

/// Transmittance and in-scattered radiance of a ray segment, in red, green and blue: `L' = transmittance * L + path_radiance`
/// for the radiance `L` behind it. Spectral queries write the same two quantities into slices.
///
/// ```
/// use airlight::transfer::RgbPathOptics;
///
/// let near = RgbPathOptics { transmittance: [0.5; 3], path_radiance: [1.0; 3] };
/// let far = RgbPathOptics { transmittance: [0.25; 3], path_radiance: [4.0; 3] };
/// assert_eq!(near.then(far).apply([8.0; 3]), near.apply(far.apply([8.0; 3])));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbPathOptics {
    /// Fraction of the background radiance that reaches the eye.
    pub transmittance: [f32; 3],
    /// Radiance scattered into the ray, in the unit of the background's.
    pub path_radiance: [f32; 3],
}

impl RgbPathOptics {
    /// No air: the identity of [`RgbPathOptics::then`].
    pub const CLEAR: Self = Self {
        transmittance: [1.0; 3],
        path_radiance: [0.0; 3],
    };

    /// Composition of this segment (nearer to the eye) with the segment `far` behind it: `T = T_near T_far`,
    /// `S = S_near + T_near S_far`.
    #[inline]
    pub fn then(self, far: Self) -> Self {
        PathOptics::from(self).then(far.into()).into()
    }

    /// Radiance at the eye for the radiance `background` behind the segment.
    #[inline]
    pub fn apply(self, background: [f32; 3]) -> [f32; 3] {
        PathOptics::from(self).apply(Spectrum(background)).0
    }

    /// The same segment with `factor` times its optical depth and the same mean source function `S / (1 - T)`:
    /// `T^factor`, `S (1 - T^factor) / (1 - T)`. Exact if extinction and scattering change together and the light in the segment
    /// does not.
    #[inline]
    pub fn at_density(self, factor: f32) -> Self {
        PathOptics::from(self).at_density(factor).into()
    }
}

impl From<PathOptics<3>> for RgbPathOptics {
    #[inline]
    fn from(optics: PathOptics<3>) -> Self {
        Self {
            transmittance: optics.transmittance.0,
            path_radiance: optics.path_radiance.0,
        }
    }
}

impl From<RgbPathOptics> for PathOptics<3> {
    #[inline]
    fn from(optics: RgbPathOptics) -> Self {
        Self {
            transmittance: Spectrum(optics.transmittance),
            path_radiance: Spectrum(optics.path_radiance),
        }
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
    fn composition_equals_successive_application() {
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

    #[test]
    fn segments_of_another_density_keep_their_source() {
        for depth in [0.0f32, 1e-6, 5e-4, 2e-3, 0.3, 4.0, 60.0] {
            for factor in [0.0f32, 0.3, 1.0, 2.5] {
                let optics = |depth: f32| PathOptics {
                    transmittance: Spectrum([(-f64::from(depth)).exp() as f32; 3]),
                    path_radiance: Spectrum([-7.0 * f64::from(-depth).exp_m1() as f32; 3]),
                };
                let (got, right) = (optics(depth).at_density(factor), optics(depth * factor));
                let off = |a: Spectrum<3>, b: Spectrum<3>| (a[1] - b[1]).abs();
                assert!(off(got.transmittance, right.transmittance) < 3e-6);
                // Thin segments are limited by the rounding of their transmittance.
                assert!(off(got.path_radiance, right.path_radiance) < 3e-6 * 7.0);
            }
        }
        let opaque = PathOptics::<3> {
            transmittance: Spectrum::ZERO,
            path_radiance: Spectrum::ONE,
        };
        assert_eq!(opaque.at_density(0.02).transmittance, Spectrum::ZERO);
        assert_eq!(PathOptics::<3>::CLEAR.at_density(5.0), PathOptics::CLEAR);
    }
}
