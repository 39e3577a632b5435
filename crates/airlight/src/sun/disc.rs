//! The sun's disc: angular size, limb darkening and radiance.

use crate::math::interpolation::lerp;
use crate::names::named;
use std::f64::consts::PI;

/// Nominal solar radius, m (IAU 2015 resolution B3).
pub(crate) const SOLAR_RADIUS_M: f64 = 6.957e8;
/// Astronomical unit, m (IAU 2012).
pub(crate) const ASTRONOMICAL_UNIT_M: f64 = 149_597_870_700.0;

/// The disc of the sun as seen from the planet.
#[derive(Clone, Debug, PartialEq)]
pub struct SunDisc {
    /// Angular radius, rad.
    pub angular_radius_rad: f64,
    /// Decrease of the radiance towards the limb.
    pub limb_darkening: LimbDarkening,
}

/// Limb-darkening law: radiance as a function of `mu`, the cosine of the angle between the line of sight and the normal of
/// the sun's surface, which is 1 at the centre and 0 at the limb.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LimbDarkening {
    /// Uniform radiance.
    Uniform,
    /// A polynomial of degree 5 in `mu` by wavelength, fitted to the observed continuum (Neckel, Sol. Phys. 229, 13,
    /// 2005, after Neckel & Labs, Sol. Phys. 153, 91, 1994).
    Neckel,
    /// `I(mu) = I(1) mu^alpha(lambda)` (Hestroffer & Magnan, Astron. Astrophys. 333, 338, 1998).
    /// Differs from [`LimbDarkening::Neckel`] by less than 0.02 of the central radiance for `mu >= 0.4` and 0.05 for
    /// `mu >= 0.2`, from 440 to 1000 nm; at the limb it falls to 0, unlike the sun.
    PowerLaw,
}

named! { LimbDarkening, "a limb darkening", [
    ("neckel", (Neckel), "polynomials fitted to observations (Neckel 2005)"),
    ("power-law", (PowerLaw), "power law (Hestroffer & Magnan 1998)"),
    ("uniform", (Uniform), "none"),
] }

/// Error of [`SunDisc::at_distance_au`] and [`SunDisc::validate`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SunError {
    /// The angular radius is out of range.
    #[error("expected an angular radius of the sun strictly between 0 and pi/2 rad, got {0}")]
    AngularRadius(f64),
}

/// Exponent `alpha` of the limb darkening `mu^alpha`: `-0.023 + 0.292 / lambda` from 416 to 1099 nm and
/// `-0.507 + 0.441 / lambda` from 303 to 372 nm (lambda in um; Hestroffer & Magnan 1998), linear between, constant beyond.
pub(crate) fn limb_exponent(wavelength_nm: f64) -> f64 {
    let um = wavelength_nm.clamp(303.0, 1099.0) * 1e-3;
    let visible = |um: f64| -0.023 + 0.292 / um;
    let ultraviolet = |um: f64| -0.507 + 0.441 / um;
    if um >= 0.416 {
        visible(um)
    } else if um <= 0.372 {
        ultraviolet(um)
    } else {
        let t = (um - 0.372) / (0.416 - 0.372);
        lerp(ultraviolet(0.372), visible(0.416), t)
    }
}

/// Coefficients `A_k` of `I(mu) / I(1) = sum of A_k mu^k`, k = 0 to 5 (Neckel 2005, table 2). The fits cover 303 to 373,
/// 385 to 422.57 and 422.57 to 1099 nm; linear between 373 and 385 nm, constant beyond. The coefficients sum to 1.
pub(crate) fn limb_polynomial(wavelength_nm: f64) -> [f64; 6] {
    /// The constant terms, the factor of `1 / lambda` in `A_0` (and, negated, in `A_1`), and the factors of `1 / lambda^5`.
    type Fit = ([f64; 6], f64, [f64; 6]);
    const BELOW_BALMER: Fit = (
        [0.35601, 1.11529, -0.67237, 0.18696, 0.00038, 0.01373],
        -0.085217,
        [0.0, -0.001871, 0.003589, -0.002415, 0.000897, -0.000200],
    );
    const VIOLET: Fit = (
        [0.09900, 1.96884, -2.80511, 3.32780, -2.17878, 0.58825],
        0.010643,
        [0.0, -0.009166, 0.024873, -0.029317, 0.018273, -0.004663],
    );
    const VISIBLE: Fit = (
        [0.75267, 0.93874, -1.89287, 2.42234, -1.71150, 0.49062],
        -0.265577,
        [0.0, -0.004095, 0.012582, -0.017117, 0.011977, -0.003347],
    );
    let at = |(constant, slope, fifth): Fit, nm: f64| -> [f64; 6] {
        let um = nm * 1e-3;
        let mut a: [f64; 6] = std::array::from_fn(|k| constant[k] + fifth[k] / um.powi(5));
        a[0] += slope / um;
        a[1] -= slope / um;
        a
    };
    let nm = wavelength_nm.clamp(303.0, 1099.0);
    if nm >= 422.57 {
        at(VISIBLE, nm)
    } else if nm >= 385.0 {
        at(VIOLET, nm)
    } else if nm <= 373.0 {
        at(BELOW_BALMER, nm)
    } else {
        let (low, high, t) = (
            at(BELOW_BALMER, 373.0),
            at(VIOLET, 385.0),
            (nm - 373.0) / 12.0,
        );
        std::array::from_fn(|k| lerp(low[k], high[k], t))
    }
}

impl SunDisc {
    /// The limb-darkened disc at a distance in astronomical units: `sin(radius) = R / distance`.
    ///
    /// # Errors
    /// [`SunError::AngularRadius`] if the distance is not positive and finite, or not larger than the solar radius.
    pub fn at_distance_au(distance_au: f64) -> Result<Self, SunError> {
        let disc = Self {
            angular_radius_rad: (SOLAR_RADIUS_M / (distance_au * ASTRONOMICAL_UNIT_M)).asin(),
            limb_darkening: LimbDarkening::Neckel,
        };
        disc.validate()?;
        Ok(disc)
    }

    /// The same sun from `ratio` times the distance.
    pub fn at_distance_ratio(&self, ratio: f64) -> Self {
        Self {
            angular_radius_rad: (self.angular_radius_rad.sin() / ratio).asin(),
            ..self.clone()
        }
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

    /// Solid angle, sr: `4 pi sin^2(radius / 2)`.
    pub fn solid_angle_sr(&self) -> f64 {
        4.0 * PI * (0.5 * self.angular_radius_rad).sin().powi(2)
    }

    /// Radiance at an angle (rad) from the centre of the disc, divided by the irradiance on a surface that faces the centre,
    /// sr^-1; 0 outside the disc.
    ///
    /// With `sin(angle) = sin(radius) sqrt(1 - mu^2)` the irradiance of `mu^k` is exactly `pi sin^2(radius) * 2 / (k + 2)`, so
    /// the radiance integrates to the irradiance.
    pub fn radiance_per_irradiance(&self, angle_rad: f64, wavelength_nm: f64) -> f64 {
        self.radiance_of_sine(angle_rad.abs().min(0.5 * PI).sin(), wavelength_nm)
    }

    /// As [`SunDisc::radiance_per_irradiance`], for the cosine of the angle. The resolution of the cosine, 1e-16, corresponds
    /// to 1e-8 rad near the centre of the sun as seen from the Earth.
    pub fn radiance_per_irradiance_at_cos(&self, cos_angle: f64, wavelength_nm: f64) -> f64 {
        match cos_angle > 0.0 {
            true => self.radiance_of_sine(
                ((1.0 - cos_angle) * (1.0 + cos_angle)).max(0.0).sqrt(),
                wavelength_nm,
            ),
            false => 0.0,
        }
    }

    fn radiance_of_sine(&self, sine: f64, wavelength_nm: f64) -> f64 {
        let edge = self.angular_radius_rad.sin();
        if sine > edge || sine.is_nan() {
            return 0.0;
        }
        let uniform = 1.0 / (PI * edge * edge);
        match self.limb_darkening {
            LimbDarkening::Uniform => uniform,
            LimbDarkening::Neckel => {
                let mu = ((1.0 - sine / edge) * (1.0 + sine / edge)).sqrt();
                let a = limb_polynomial(wavelength_nm);
                let mean: f64 = a.iter().zip(2..).map(|(a, k)| 2.0 * a / f64::from(k)).sum();
                uniform * a.iter().rev().fold(0.0, |sum, a| sum * mu + a) / mean
            }
            LimbDarkening::PowerLaw => {
                let alpha = limb_exponent(wavelength_nm);
                let mu2 = (1.0 - sine / edge) * (1.0 + sine / edge);
                uniform * (1.0 + 0.5 * alpha) * mu2.powf(0.5 * alpha)
            }
        }
    }
}

impl Default for SunDisc {
    /// The limb-darkened disc at one astronomical unit: 4.6505e-3 rad, 0.2665 degrees.
    fn default() -> Self {
        Self {
            angular_radius_rad: (SOLAR_RADIUS_M / ASTRONOMICAL_UNIT_M).asin(),
            limb_darkening: LimbDarkening::Neckel,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::GaussRule;

    #[test]
    fn radiance_integrates_to_the_irradiance() {
        for limb_darkening in [
            LimbDarkening::Uniform,
            LimbDarkening::Neckel,
            LimbDarkening::PowerLaw,
        ] {
            for angular_radius_rad in [4.65e-3, 0.3] {
                let disc = SunDisc {
                    angular_radius_rad,
                    limb_darkening,
                };
                for nm in [330.0, 400.0, 550.0, 1000.0] {
                    // angle = radius (1 - t^4): nodes cluster at the limb, where mu^alpha has its root.
                    let sum = GaussRule::new(64).integrate(0.0, 1.0, |t| {
                        let angle = angular_radius_rad * (1.0 - t.powi(4));
                        let ring = 2.0
                            * PI
                            * angle.sin()
                            * angle.cos()
                            * angular_radius_rad
                            * 4.0
                            * t.powi(3);
                        disc.radiance_per_irradiance(angle, nm) * ring
                    });
                    assert!((sum - 1.0).abs() < 1e-6, "{disc:?} {nm} nm: {sum}");
                }
            }
        }
    }

    #[test]
    fn limb_darkening_laws_agree() {
        for nm in [440.0, 550.0, 700.0, 1000.0] {
            let a = limb_polynomial(nm);
            for (mu, most) in [
                (0.2f64, 0.05),
                (0.4, 0.02),
                (0.6, 0.02),
                (0.8, 0.02),
                (1.0, 1e-12),
            ] {
                let (power, neckel) = (
                    mu.powf(limb_exponent(nm)),
                    a.iter().rev().fold(0.0, |sum, a| sum * mu + a),
                );
                assert!(
                    (power - neckel).abs() < most,
                    "{nm} nm, mu {mu}: {power} against {neckel}"
                );
            }
        }
        assert!(limb_exponent(400.0) > limb_exponent(700.0));
    }

    #[test]
    fn limb_polynomials_are_continuous_positive_and_normalised() {
        let mut before = limb_polynomial(290.0);
        for i in 2900..11_500 {
            let a = limb_polynomial(0.1 * f64::from(i));
            assert!((a.iter().sum::<f64>() - 1.0).abs() < 1e-9);
            for k in 0..=20 {
                let mu = 0.05 * f64::from(k);
                let value = |a: &[f64; 6]| a.iter().rev().fold(0.0, |sum, a| sum * mu + a);
                assert!(value(&a) > 0.05);
                assert!((value(&a) - value(&before)).abs() < 2e-3, "{i} {mu}");
            }
            before = a;
        }
    }

    #[test]
    fn radiance_by_angle_and_by_cosine_agree() {
        let disc = SunDisc::default();
        for part in [0.0f64, 0.3, 0.9, 0.999] {
            let angle = part * disc.angular_radius_rad;
            let (a, b) = (
                disc.radiance_per_irradiance(angle, 550.0),
                disc.radiance_per_irradiance_at_cos(angle.cos(), 550.0),
            );
            assert!((a / b - 1.0).abs() < 1e-8, "{part}: {a} {b}");
        }
        for angle in [1.001 * disc.angular_radius_rad, 1.0, 2.0, 3.1] {
            assert_eq!(disc.radiance_per_irradiance(angle, 550.0), 0.0);
            assert_eq!(disc.radiance_per_irradiance_at_cos(angle.cos(), 550.0), 0.0);
        }
    }

    #[test]
    fn angular_diameter_from_the_earth_is_half_a_degree() {
        let disc = SunDisc::default();
        assert!((disc.angular_radius_rad.to_degrees() - 0.26645).abs() < 1e-4);
        assert!((disc.solid_angle_sr() / 6.794e-5 - 1.0).abs() < 1e-3);
        let mars = SunDisc::at_distance_au(1.5237).unwrap();
        assert!((mars.angular_radius_rad / disc.angular_radius_rad * 1.5237 - 1.0).abs() < 1e-4);
        for bad in [0.0, -1.0, f64::NAN, 1e-3, f64::INFINITY] {
            assert!(SunDisc::at_distance_au(bad).is_err(), "{bad}");
        }
    }
}
