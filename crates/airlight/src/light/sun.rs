//! The sun's disc.

use std::f64::consts::PI;

/// The sun as seen from the planet: how large, and how it dims towards its limb.
#[derive(Clone, Debug, PartialEq)]
pub struct SunDisc {
    /// Half the angle that the disc spans, rad.
    pub angular_radius_rad: f64,
    /// How the radiance falls towards the limb.
    pub limb_darkening: LimbDarkening,
}

/// How the radiance falls from the centre to the limb; `mu = cos` of the angle between the line of sight and the
/// normal of the sun's surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimbDarkening {
    /// The same radiance all over.
    Uniform,
    /// `I(mu) = I(1) mu^alpha(lambda)` (Hestroffer & Magnan, Astron. Astrophys. 333, 338, 1998, table 1).
    PowerLaw,
}

/// Why numbers do not make a sun.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SunError {
    /// The angular radius is out of range.
    #[error("the sun's angular radius must lie strictly between 0 and pi/2 rad, got {0}")]
    AngularRadius(f64),
}

/// The sun's radius, m (nominal, IAU 2015 resolution B3).
pub const SOLAR_RADIUS_M: f64 = 6.957e8;
/// The astronomical unit, m (IAU 2012).
pub const ASTRONOMICAL_UNIT_M: f64 = 149_597_870_700.0;

impl SunDisc {
    /// The sun, limb darkened, from a distance in astronomical units (positive): `sin(radius) = R / distance`.
    ///
    /// # Errors
    /// [`SunError::AngularRadius`] for a distance that is not positive and finite, or lies within the sun.
    pub fn at_distance_au(distance_au: f64) -> Result<Self, SunError> {
        let disc = Self {
            angular_radius_rad: (SOLAR_RADIUS_M / (distance_au * ASTRONOMICAL_UNIT_M)).asin(),
            limb_darkening: LimbDarkening::PowerLaw,
        };
        disc.validate()?;
        Ok(disc)
    }

    /// Checks the angular radius.
    ///
    /// # Errors
    /// [`SunError::AngularRadius`] unless it lies strictly between 0 and pi/2.
    pub fn validate(&self) -> Result<(), SunError> {
        match self.angular_radius_rad > 0.0 && self.angular_radius_rad < 0.5 * PI {
            true => Ok(()),
            false => Err(SunError::AngularRadius(self.angular_radius_rad)),
        }
    }

    /// Solid angle of the disc, sr: `4 pi sin^2(radius / 2)`.
    pub fn solid_angle_sr(&self) -> f64 {
        4.0 * PI * (0.5 * self.angular_radius_rad).sin().powi(2)
    }
}

impl Default for SunDisc {
    /// The limb-darkened sun from one astronomical unit: 4.6505e-3 rad, 0.2665 degrees.
    fn default() -> Self {
        Self {
            angular_radius_rad: (SOLAR_RADIUS_M / ASTRONOMICAL_UNIT_M).asin(),
            limb_darkening: LimbDarkening::PowerLaw,
        }
    }
}
