//! Where on the sun a ray of sunlight comes from.

use crate::math::random::Random;
use crate::spectrum::Spectrum;
use crate::sun::SunDisc;
use glam::DVec3;
use std::f64::consts::PI;

/// The sun's shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SunShape {
    /// All light from the middle of the disc: what fast solvers assume.
    #[default]
    Point,
    /// From all over the disc, darker towards the limb.
    Disc,
}

impl SunShape {
    /// Draws a direction, evenly over the disc.
    #[inline(always)]
    pub(super) fn draw(self, sun: DVec3, disc: &SunDisc, random: &mut Random) -> DVec3 {
        match self {
            Self::Point => sun,
            Self::Disc => {
                // Even in the cosine: in 1 - cos = 2 sin^2(radius / 2) * choice, which keeps its digits.
                let most = 2.0 * (0.5 * disc.angular_radius_rad).sin().powi(2);
                let fall = most * random.unit();
                let sine = (fall * (2.0 - fall)).sqrt();
                let (sin, cos) = (2.0 * PI * random.unit()).sin_cos();
                let (across, up) = sun.any_orthonormal_pair();
                (sun * (1.0 - fall) + across * (sine * cos) + up * (sine * sin)).normalize()
            }
        }
    }

    /// Light of the direction drawn: `light`, and what the limb darkens it by.
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
