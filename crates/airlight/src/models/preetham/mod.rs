//! A. J. Preetham, P. Shirley and B. Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999.
//!
//! Luminance and chromaticity each follow Perez' formula (eq. 3) relative to the zenith, with five coefficients that are
//! linear in turbidity (appendix A.2); the sun is attenuated by Iqbal's formulas for molecules, haze, ozone, mixed gases and
//! water (appendix A.1).
//!
//! Fitted to Nishita's model for turbidities from 2 to 6 and suns above the horizon. Limitations:
//! - No light below the horizon: black here.
//! - No twilight. The luminance of the zenith at sunset is still 2000 cd/m^2 and hardly decreases after it; scenes with a sun below
//!   the horizon are refused. Negative values of the formula are clamped to 0.
//! - The formula is singular for clear air: `1 + A e^B`, by which the sky is divided, is 0.17 at turbidity 2, 0.03 at 1.7
//!   and 0 near 1.6, so that everything but the zenith becomes unboundedly bright. Turbidities from 2 to 10 are accepted.
//! - In daylight it is up to three times as bright as the solver, mostly near the horizon; the book has a table.

mod sun;

use super::PublishedModel;
use super::prepared::{Prepared, turbidity};
use crate::axes;
use crate::control::Control;
use crate::debug::debug_fields;
use crate::math::rounded::rounded;
use crate::scene::{Capabilities, Input, PreparedModel, RadianceModel, ResolvedScene, SceneError};
use crate::sky::SunCoverage;
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::Arc;
pub(super) use sun::DimmedSun;
pub use sun::transmittance;

/// Coefficients A to E of luminance Y: factor of the turbidity, and constant.
const PEREZ_Y: [[f64; 2]; 5] = [
    [0.1787, -1.4630],
    [-0.3554, 0.4275],
    [-0.0227, 5.3251],
    [0.1206, -2.5771],
    [-0.0670, 0.3703],
];
/// Coefficients of chromaticity x.
const PEREZ_CHROMA_X: [[f64; 2]; 5] = [
    [-0.0193, -0.2592],
    [-0.0665, 0.0008],
    [-0.0004, 0.2125],
    [-0.0641, -0.8989],
    [-0.0033, 0.0452],
];
/// Coefficients of chromaticity y.
const PEREZ_CHROMA_Y: [[f64; 2]; 5] = [
    [-0.0167, -0.2608],
    [-0.0950, 0.0092],
    [-0.0079, 0.2102],
    [-0.0441, -1.6537],
    [-0.0109, 0.0529],
];
/// Chromaticity x of the zenith: rows for the squared turbidity, the turbidity and 1; columns for the cube of the sun's
/// zenith angle, its square, the angle and 1.
const ZENITH_CHROMA_X: [[f64; 4]; 3] = [
    [0.00166, -0.00375, 0.00209, 0.0],
    [-0.02903, 0.06377, -0.03202, 0.00394],
    [0.11693, -0.21196, 0.06052, 0.25886],
];
/// Chromaticity y of the zenith, likewise.
const ZENITH_CHROMA_Y: [[f64; 4]; 3] = [
    [0.00275, -0.00610, 0.00317, 0.0],
    [-0.04214, 0.08970, -0.04153, 0.00516],
    [0.15346, -0.26756, 0.06670, 0.26688],
];

/// Error of [`Preetham::new`], and of scenes with this model.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PreethamError {
    /// The turbidity is out of range.
    #[error(
        "expected a turbidity from 2 to 10, got {} (the model is fitted to 2 to 6)",
        rounded(*.0)
    )]
    Turbidity(f64),
    /// The sun of a scene is below the horizon. [`Preetham::new`] continues the formula there.
    #[error(
        "expected a sun at the horizon or above, got an elevation of {} degrees; the model has no twilight",
        rounded(*.0)
    )]
    SunBelowHorizon(f64),
    /// The sun's direction is zero or not finite.
    #[error("expected a finite sun direction that is not zero, got {0}")]
    Sun(DVec3),
}

/// The sky above an eye on the ground, for one turbidity and one sun direction.
pub struct Preetham {
    sun: DVec3,
    /// Formulas for Y, x and y.
    perez: [Perez; 3],
    /// Y (cd/m^2), x and y of the zenith.
    zenith: [f64; 3],
    disc: DimmedSun,
}

debug_fields! { Preetham { sun, zenith } }

/// Perez' formula, relative to its value at the zenith.
struct Perez {
    coefficients: [f64; 5],
    in_zenith: f64,
}

impl Perez {
    fn new(table: &[[f64; 2]; 5], turbidity: f64, sun_zenith_rad: f64) -> Self {
        let mut perez = Self {
            coefficients: table.map(|[slope, constant]| slope * turbidity + constant),
            in_zenith: 1.0,
        };
        perez.in_zenith = perez.at(1.0, sun_zenith_rad, sun_zenith_rad.cos());
        perez
    }

    /// `F(theta, gamma) / F(0, theta_s)` (eqs. 3 and 4).
    fn at(&self, cos_zenith: f64, gamma_rad: f64, cos_gamma: f64) -> f64 {
        let [a, b, c, d, e] = self.coefficients;
        // At the horizon the exponential is 0: `b` is negative for all three quantities at turbidities of 2 and above.
        let gradation = 1.0 + a * (b / cos_zenith.abs()).exp();
        let scattering = 1.0 + c * (d * gamma_rad).exp() + e * cos_gamma * cos_gamma;
        gradation * scattering / self.in_zenith
    }
}

impl Preetham {
    /// Sky for a turbidity (2 to 10) and a sun direction.
    ///
    /// # Errors
    /// [`PreethamError`] if an argument is outside its domain.
    pub fn new(turbidity: f64, sun_direction: DVec3) -> Result<Self, PreethamError> {
        if !(2.0..=10.0).contains(&turbidity) {
            return Err(PreethamError::Turbidity(turbidity));
        }
        let sun = sun_direction
            .try_normalize()
            .ok_or(PreethamError::Sun(sun_direction))?;
        let sun_zenith_rad = sun.angle_between(DVec3::Y);
        let tables = [&PEREZ_Y, &PEREZ_CHROMA_X, &PEREZ_CHROMA_Y];
        Ok(Self {
            sun,
            perez: tables.map(|table| Perez::new(table, turbidity, sun_zenith_rad)),
            zenith: zenith(turbidity, sun_zenith_rad),
            disc: DimmedSun::new(turbidity, sun),
        })
    }
}

/// Luminance (cd/m^2) and chromaticities x, y of the zenith (appendix A.2).
fn zenith(turbidity: f64, sun_zenith_rad: f64) -> [f64; 3] {
    let chi = (4.0 / 9.0 - turbidity / 120.0) * (PI - 2.0 * sun_zenith_rad);
    let luminance = (4.0453 * turbidity - 4.9710) * chi.tan() - 0.2155 * turbidity + 2.4192;
    let angles = [3, 2, 1, 0].map(|power| sun_zenith_rad.powi(power));
    let chroma = |table: &[[f64; 4]; 3]| -> f64 {
        let rows = table.iter().zip([turbidity * turbidity, turbidity, 1.0]);
        rows.map(|(row, t)| t * row.iter().zip(angles).map(|(c, a)| c * a).sum::<f64>())
            .sum()
    };
    [
        (1000.0 * luminance).max(0.0),
        chroma(&ZENITH_CHROMA_X),
        chroma(&ZENITH_CHROMA_Y),
    ]
}

impl PublishedModel for Preetham {
    fn sun(&self) -> DVec3 {
        self.sun
    }

    /// Black below the horizon.
    fn sky_xyz(&self, direction: DVec3) -> [f64; 3] {
        if direction.y < 0.0 {
            return [0.0; 3];
        }
        let gamma_rad = direction.angle_between(self.sun);
        let cos_gamma = direction.dot(self.sun);
        let [luminance, x, y] = std::array::from_fn(|i| {
            self.zenith[i] * self.perez[i].at(direction.y, gamma_rad, cos_gamma)
        });
        [x / y * luminance, luminance, (1.0 - x - y) / y * luminance]
    }

    /// The limb-darkened disc, attenuated by the paper's formulas ([`transmittance`]) at its centre.
    fn disc_xyz(&self, direction: DVec3) -> [f64; 3] {
        self.disc.xyz(direction)
    }
}

/// Preetham, Shirley & Smits 1999 as a [`RadianceModel`], with the turbidity derived from a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PreethamModel;

impl RadianceModel for PreethamModel {
    fn name(&self) -> &'static str {
        "preetham"
    }

    fn summary(&self) -> &'static str {
        "Preetham, Shirley & Smits 1999: an analytic sky by turbidity, for the sun above the horizon"
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities {
            inputs: &[
                Input::Atmosphere,
                Input::Haze,
                Input::GroundAlbedo,
                Input::Objects,
            ],
            variants: &[],
            twilight: false,
            parts: false,
        }
    }

    fn prepare(
        &self,
        scene: &ResolvedScene,
        _suns: SunCoverage,
        _control: Control<'_>,
    ) -> Result<Arc<dyn PreparedModel>, SceneError> {
        let (name, turbidity) = (self.name(), turbidity(&scene.atmosphere));
        let refused = move |error| SceneError::model(name, error);
        let prepared = Prepared::new(name, scene, None, move |_, sun, _| {
            let elevation_deg = axes::elevation_deg(sun.direction);
            // Tolerates rounding.
            if elevation_deg < -1e-9 {
                return Err(refused(PreethamError::SunBelowHorizon(elevation_deg)));
            }
            let sky = Preetham::new(turbidity, sun.direction);
            Ok(Arc::new(sky.map_err(refused)?))
        });
        Ok(Arc::new(prepared))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sky(turbidity: f64, sun_deg: f64) -> Preetham {
        Preetham::new(turbidity, axes::direction(180.0, sun_deg)).unwrap()
    }

    #[test]
    fn zenith_values_match_hand_computed_polynomials() {
        // By hand, turbidity 2, sun at the zenith: chi = (4/9 - 1/60) pi.
        let chi: f64 = 0.427_777_777_8 * PI;
        let want = 1000.0 * (3.1196 * chi.tan() - 0.431 + 2.4192);
        let [luminance, x, y] = zenith(2.0, 0.0);
        assert!((luminance / want - 1.0).abs() < 1e-9, "{luminance} {want}");
        assert!((x - (2.0 * 0.00394 + 0.25886)).abs() < 1e-12);
        assert!((y - (2.0 * 0.00516 + 0.26688)).abs() < 1e-12);
        // Sun at the horizon: theta^k of pi / 2, turbidity 3.
        let [luminance, x, y] = zenith(3.0, 0.5 * PI);
        assert!((luminance - 1772.7).abs() < 1e-6, "{luminance}");
        assert!(
            (x - 0.28373).abs() < 1e-5 && (y - 0.30531).abs() < 1e-5,
            "{x} {y}"
        );
    }

    #[test]
    fn sky_at_the_zenith_matches_the_zenith_value() {
        for (turbidity, sun_deg) in [(2.0, 60.0), (3.0, 20.0), (6.0, 5.0)] {
            let sky = sky(turbidity, sun_deg);
            let [x, y, z] = sky.sky_xyz(DVec3::Y);
            let [luminance, cx, cy] = zenith(turbidity, (90.0f64 - sun_deg).to_radians());
            assert!((y / luminance - 1.0).abs() < 1e-9);
            assert!((x / (x + y + z) - cx).abs() < 1e-9 && (y / (x + y + z) - cy).abs() < 1e-9);
        }
    }

    #[test]
    fn sky_is_blue_and_brighter_near_the_sun() {
        let sky = sky(2.5, 40.0);
        let at = |azimuth, elevation| sky.sky_xyz(axes::direction(azimuth, elevation));
        assert!(at(0.0, 60.0)[2] > 1.3 * at(0.0, 60.0)[0]);
        assert!(at(180.0, 35.0)[1] > 3.0 * at(0.0, 60.0)[1]);
        // Continuous down to the horizon, black below.
        let (low, lower) = (at(90.0, 0.1)[1], at(90.0, 0.01)[1]);
        assert!((low / lower - 1.0).abs() < 0.01 && lower > 0.0);
        for turbidity in [2.0, 2.5, 10.0] {
            let sky = self::sky(turbidity, 40.0);
            for horizon in [DVec3::X, DVec3::new(1.0, -0.0, 0.0)] {
                let (limit, above) = (
                    sky.sky_xyz(horizon),
                    sky.sky_xyz(axes::direction(90.0, 1e-6)),
                );
                for (limit, above) in limit.iter().zip(above) {
                    assert!(
                        (limit / above - 1.0).abs() < 1e-6,
                        "{turbidity}: {limit} {above}"
                    );
                }
            }
        }
        assert_eq!(at(90.0, -0.01), [0.0; 3]);
    }

    #[test]
    fn dusk_is_too_bright_as_documented() {
        let sky = sky(2.0, 0.0);
        let luminance = sky.sky_xyz(DVec3::Y)[1];
        assert!((luminance - 1988.2).abs() < 0.1, "{luminance}");
    }

    #[test]
    fn disc_is_attenuated_and_reddened() {
        let disc = |sun_deg| sky(2.5, sun_deg).disc_xyz(axes::direction(180.0, sun_deg));
        let (high, low) = (disc(60.0), disc(5.0));
        assert!(high[1] > 1.2e9 && high[1] < 2.2e9, "{high:?}");
        assert!(low[1] < 0.5 * high[1] && low[0] / low[2] > 2.0 * high[0] / high[2]);
        assert_eq!(sky(2.5, 60.0).disc_xyz(DVec3::Y), [0.0; 3]);
    }

    #[test]
    fn invalid_arguments_are_refused() {
        for turbidity in [1.9, 10.5, f64::NAN] {
            let error = Preetham::new(turbidity, DVec3::Y).err().unwrap();
            assert!(matches!(error, PreethamError::Turbidity(_)));
            assert!(error.to_string().contains("from 2 to 10"));
        }
        assert!(Preetham::new(3.0, DVec3::ZERO).is_err());
        // 1.7 by way of an optical depth.
        let error = Preetham::new(1.6999999999999997, DVec3::Y).err().unwrap();
        assert!(error.to_string().contains("got 1.7 ("), "{error}");
    }
}
