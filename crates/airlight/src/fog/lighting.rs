//! What shines on a fog, and the ground under it.

use super::layer::{FogError, check_light};
use crate::atmosphere::RaySegment;
use crate::spectrum::Spectrum;
use glam::DVec3;

/// The sun above the fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight<const N: usize> {
    /// Unit vector towards it.
    pub direction: DVec3,
    /// Irradiance on a surface that faces it, above the fog (W m^-2 nm^-1, lux, or any unit of one's own).
    pub irradiance: Spectrum<N>,
}

/// The light that a fog is in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogLighting<const N: usize> {
    /// The sun, if it shines.
    pub sun: Option<DirectionalLight<N>>,
    /// Radiance that comes evenly from all sides: the sky's, on average. With [`FogScattering::Multiple`] from above only.
    pub ambient: Spectrum<N>,
    /// What the ground sends back of the light on it, 0 to 1; matters with [`FogScattering::Multiple`] only.
    pub ground_albedo: Spectrum<N>,
}

/// The ground under a fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Its height, m.
    pub height_m: f64,
    /// Its radius, m; infinite where it is flat.
    pub radius_m: f64,
}

/// Which light a fog scatters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FogScattering {
    /// Sun and ambient light scattered once, neither dimmed by the fog on its way to where it is scattered: Ishiyama's
    /// model as printed. Right for thin fog; too bright in thick.
    Undimmed,
    /// Sunlight scattered once after its way through the fog; ambient light the same everywhere.
    #[default]
    Single,
    /// Light scattered any number of times: sun and sky enter at the top, the ground sends back its part. Solved for once
    /// when the fog is made. A fog without an upper end, which no light could enter, counts as lit evenly by the ambient
    /// light and by the undimmed sun.
    Multiple,
}

impl Ground {
    /// Flat ground at height 0.
    pub const FLAT: Self = Self {
        height_m: 0.0,
        radius_m: f64::INFINITY,
    };

    /// The Earth's mean radius, m, at height 0.
    pub const EARTH: Self = Self {
        height_m: 0.0,
        radius_m: 6.371e6,
    };

    /// Whether it is flat.
    #[inline]
    pub fn is_flat(&self) -> bool {
        self.radius_m == f64::INFINITY
    }

    /// Whether an endless line meets it.
    #[inline]
    pub(super) fn blocks(&self, line: &RaySegment) -> bool {
        if self.is_flat() {
            return line.sin_elevation <= 0.0;
        }
        line.sin_elevation < 0.0 && line.lowest_height_m() < self.height_m
    }

    pub(super) fn validate(&self) -> Result<(), FogError> {
        let number = |what, got: f64, right| Err(FogError::Number { what, got, right });
        if !self.height_m.is_finite() {
            return number("the height of the ground, m,", self.height_m, "finite");
        }
        match self.radius_m > 0.0 {
            true => Ok(()),
            false => number(
                "the radius of the ground, m,",
                self.radius_m,
                "above 0, or infinite for flat ground",
            ),
        }
    }
}

impl<const N: usize> FogLighting<N> {
    pub(super) fn validate(&self) -> Result<(), FogError> {
        check_light("ambient light", self.ambient)?;
        check_light("the albedo of the ground", self.ground_albedo)?;
        if let Some(&got) = self.ground_albedo.0.iter().find(|&&albedo| albedo > 1.0) {
            return Err(FogError::Number {
                what: "the albedo of the ground",
                got: f64::from(got),
                right: "from 0 to 1",
            });
        }
        if let Some(sun) = &self.sun {
            check_light("the sun's irradiance", sun.irradiance)?;
            let length = sun.direction.length();
            if (length - 1.0).abs() > 1e-6 || length.is_nan() {
                return Err(FogError::Number {
                    what: "the length of the direction to the sun",
                    got: length,
                    right: "1",
                });
            }
        }
        Ok(())
    }
}
