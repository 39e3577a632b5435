//! Sampling of the sun's disc.

use crate::math::random::Random;
use crate::names::named;
use crate::spectrum::Spectrum;
use crate::sun::SunDisc;
use glam::DVec3;
use std::f64::consts::PI;

/// Shape of the sun.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum SunShape {
    /// All light comes from the centre of the disc, as in the fast solvers.
    #[default]
    Point,
    /// Light comes from the whole disc, with limb darkening.
    Disc,
}

named! { SunShape, "a sun shape", [
    ("point", (Point), "all light from the centre of the disc"),
    ("disc", (Disc), "light from the whole disc, with limb darkening"),
] }

impl SunShape {
    /// Draws a direction, uniformly over the disc.
    #[inline(always)]
    pub(super) fn draw(self, sun: DVec3, disc: &SunDisc, random: &mut Random) -> DVec3 {
        match self {
            Self::Point => sun,
            Self::Disc => {
                // Uniform in the cosine: 1 - cos = 2 sin^2(radius / 2) * choice, without cancellation.
                let max_one_minus_cos = 2.0 * (0.5 * disc.angular_radius_rad).sin().powi(2);
                let one_minus_cos = max_one_minus_cos * random.unit();
                let sine = (one_minus_cos * (2.0 - one_minus_cos)).sqrt();
                let (sin, cos) = (2.0 * PI * random.unit()).sin_cos();
                let (across, up) = sun.any_orthonormal_pair();
                (sun * (1.0 - one_minus_cos) + across * (sine * cos) + up * (sine * sin))
                    .normalize()
            }
        }
    }

    /// `light` multiplied by the limb darkening in the sampled direction.
    #[inline(always)]
    pub(super) fn limb<const N: usize>(
        self,
        light: Spectrum<N>,
        sun: DVec3,
        drawn: DVec3,
        disc: &SunDisc,
        wavelengths_nm: &[f64; N],
    ) -> Spectrum<N> {
        match self {
            Self::Point => light,
            Self::Disc => {
                let angle = sun
                    .cross(drawn)
                    .length()
                    .asin()
                    .min(disc.angular_radius_rad);
                let whole = disc.solid_angle_sr();
                Spectrum::from_fn(|i| {
                    let darkened = disc.radiance_per_irradiance(angle, wavelengths_nm[i]) * whole;
                    light[i] * darkened as f32
                })
            }
        }
    }
}
