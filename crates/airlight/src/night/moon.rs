//! The moon as a source of light: position, phase, irradiance and the radiance of its disc.

#[cfg(feature = "ephemeris")]
use super::ephemeris::moon_position;
use crate::sun::{ASTRONOMICAL_UNIT_M, LimbDarkening, SunDisc};
#[cfg(feature = "ephemeris")]
use crate::sun::{RefractingAir, raised};
use glam::DVec3;
use std::f64::consts::PI;

/// Mean radius of the moon, m, and the distance to which the albedo model refers, m (Kieffer & Stone 2005).
const MOON_RADIUS_M: f64 = 1_737_400.0;
const MEAN_DISTANCE_M: f64 = 384_400_000.0;
/// Solid angle of the moon at that distance, sr (Kieffer & Stone 2005).
const MEAN_SOLID_ANGLE_SR: f64 = 6.4177e-5;

/// The moon at one time, seen from one place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MoonState {
    /// Unit vector towards its centre (world axes: [`crate::axes`]).
    pub direction: DVec3,
    /// Unit vector from the moon towards the sun.
    pub to_sun: DVec3,
    /// Distance from the eye, m.
    pub distance_m: f64,
    /// Distance from the sun, m.
    pub sun_distance_m: f64,
    /// Angle at the moon between sun and eye, rad: 0 is full, pi is new.
    pub phase_angle_rad: f64,
}

/// Error of [`MoonState::with_phase`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MoonError {
    /// The phase angle is out of range.
    #[error("expected a phase angle of the moon from 0 (full) to 180 degrees (new), got {0}")]
    PhaseAngle(f64),
}

impl MoonState {
    /// The moon at mean distance in a direction (unit vector), lit by a distant sun in another. The phase follows from the angle
    /// between them.
    pub fn lit_by(direction: DVec3, sun: DVec3) -> Self {
        Self {
            direction,
            to_sun: sun,
            distance_m: MEAN_DISTANCE_M,
            sun_distance_m: ASTRONOMICAL_UNIT_M,
            phase_angle_rad: PI - direction.angle_between(sun),
        }
    }

    /// The moon of a time, seconds since 1970-01-01T00:00:00Z, over a place; raised by refraction for `Some` air.
    #[cfg(feature = "ephemeris")]
    pub fn at(
        unix_s: f64,
        latitude_deg: f64,
        longitude_deg: f64,
        refraction: Option<RefractingAir>,
    ) -> Self {
        let position = moon_position(unix_s, latitude_deg, longitude_deg);
        let direction = position.from_place_m.normalize();
        let to_sun = position.to_sun_m.normalize();
        Self {
            direction: raised(direction, refraction),
            to_sun,
            distance_m: position.from_place_m.length(),
            sun_distance_m: position.to_sun_m.length(),
            phase_angle_rad: to_sun.angle_between(-direction),
        }
    }

    /// The same moon with another phase angle, in degrees from 0 (full) to 180 (new); its lit side still faces the sun's side.
    ///
    /// # Errors
    /// [`MoonError::PhaseAngle`] outside this range.
    pub fn with_phase(self, phase_angle_deg: f64) -> Result<Self, MoonError> {
        if !(0.0..=180.0).contains(&phase_angle_deg) {
            return Err(MoonError::PhaseAngle(phase_angle_deg));
        }
        let angle = phase_angle_deg.to_radians();
        let across = self.to_sun - self.direction * self.to_sun.dot(self.direction);
        // Straight behind the eye the sun lights from no side: any will do.
        let aside = match across.length() > 1e-9 {
            true => across.normalize(),
            false => self.direction.any_orthonormal_vector(),
        };
        Ok(Self {
            to_sun: aside * angle.sin() - self.direction * angle.cos(),
            phase_angle_rad: angle,
            ..self
        })
    }

    /// Part of the disc that is lit, 0 to 1.
    pub fn lit_fraction(&self) -> f64 {
        0.5 * (1.0 + self.phase_angle_rad.cos())
    }

    /// Angular radius, rad.
    pub fn angular_radius_rad(&self) -> f64 {
        (MOON_RADIUS_M / self.distance_m).asin()
    }

    /// A disc of this size and uniform radiance.
    pub fn disc(&self) -> SunDisc {
        SunDisc {
            angular_radius_rad: self.angular_radius_rad(),
            limb_darkening: LimbDarkening::Uniform,
        }
    }

    /// Irradiance by the moon relative to the solar irradiance at one astronomical unit, outside the air, at a wavelength in nm
    /// (Kieffer & Stone, Astron. J. 129, 2887, 2005, eq. 7 and 8).
    ///
    /// `A(g, lambda) Omega / pi`, scaled with the distances, where `A` is the albedo of the whole disc
    /// (`disc_albedo`).
    pub fn irradiance_ratio(&self, wavelength_nm: f64) -> f64 {
        let from_sun = ASTRONOMICAL_UNIT_M / self.sun_distance_m;
        let from_eye = MEAN_DISTANCE_M / self.distance_m;
        disc_albedo(self.phase_angle_rad, wavelength_nm) * MEAN_SOLID_ANGLE_SR / PI
            * (from_sun * from_eye).powi(2)
    }

    /// Radiance at a place on the disc relative to the mean radiance of the disc: the law of Lommel and Seeliger,
    /// `mu_0 / (mu_0 + mu)` with the cosines of incidence and emission, which describes dark dusty ground. `direction` is a unit
    /// vector; 0 outside the disc and on the night side. Without maria and craters.
    pub fn relative_radiance(&self, direction: DVec3) -> f64 {
        lommel_seeliger(self.normal_at(direction), self.direction, self.to_sun)
            / mean_lommel_seeliger(self.phase_angle_rad)
    }

    /// Normal of the surface that a direction meets, if it meets the disc.
    fn normal_at(&self, direction: DVec3) -> Option<DVec3> {
        let aside = (direction - self.direction * direction.dot(self.direction))
            / self.angular_radius_rad().sin();
        let toward = 1.0 - aside.length_squared();
        (toward > 0.0 && direction.dot(self.direction) > 0.0)
            .then(|| aside - self.direction * toward.sqrt())
    }
}

fn lommel_seeliger(normal: Option<DVec3>, direction: DVec3, to_sun: DVec3) -> f64 {
    let Some(normal) = normal else {
        return 0.0;
    };
    let (incidence, emission) = (normal.dot(to_sun), -normal.dot(direction));
    match incidence > 0.0 && emission > 0.0 {
        true => incidence / (incidence + emission),
        false => 0.0,
    }
}

/// Mean over the disc of `mu_0 / (mu_0 + mu)` at a phase angle `g`:
/// `(1 + sin(g/2) tan(g/2) ln tan(g/4)) / 2`, the phase law of Lommel and Seeliger.
fn mean_lommel_seeliger(phase_angle_rad: f64) -> f64 {
    let half = 0.5 * phase_angle_rad.clamp(1e-9, PI - 1e-6);
    0.5 * (1.0 + half.sin() * half.tan() * (0.5 * half).tan().ln())
}

/// Albedo of the moon's disc at a phase angle (rad) and a wavelength (nm), without the part that depends on libration (below
/// 7 %).
///
/// At 549 nm the mean of the coefficients of the bands at 544, 549 and 554 nm in table 4 of Kieffer & Stone 2005, for a waning
/// and a waxing moon alike. In wavelength a power law, `(lambda / 550 nm)^p`, with `p` from 0.76 (full) to 1.14 (quarter): the 18
/// bands from 405 to 830 nm scatter about it by 3 % (root mean square). Measured for phase angles from 1.55 to 97 degrees; beyond,
/// the formula is extrapolated. With the visual magnitudes of Allen 1976 it agrees to 4 % from 7 to 120 degrees, to 15 % at 150. Eclipses are not
/// included.
fn disc_albedo(phase_angle_rad: f64, wavelength_nm: f64) -> f64 {
    const A: [f64; 4] = [-2.123_833, -1.644_397, 0.359_973, -0.197_023];
    const D: [f64; 3] = [0.370_700, -0.103_963, 0.005_917];
    let g = phase_angle_rad;
    let deg = g.to_degrees();
    let polynomial = A[0] + g * (A[1] + g * (A[2] + g * A[3]));
    let surge = D[0] * (-deg / 4.060_54).exp() + D[1] * (-deg / 12.880_2).exp();
    let wave = D[2] * ((deg + 30.585_8) / 16.749_8).cos();
    let red = deg.min(90.0);
    let exponent = 0.76 + (8.45e-3 - 4.75e-5 * red) * red;
    (polynomial + surge + wave).exp() * (wavelength_nm / 550.0).powf(exponent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes;
    use crate::spectrum::WavelengthGrid;

    fn at_phase(deg: f64) -> MoonState {
        MoonState::lit_by(axes::direction(180.0, 40.0), axes::direction(0.0, -40.0))
            .with_phase(deg)
            .unwrap()
    }

    /// Illuminance outside the air, lx.
    fn illuminance_lx(moon: &MoonState) -> f64 {
        let grid = WavelengthGrid::standard();
        let light: Vec<f32> = grid
            .wavelengths_nm()
            .iter()
            .zip(grid.solar_irradiance())
            .map(|(&nm, e)| (e * moon.irradiance_ratio(nm)) as f32)
            .collect();
        grid.to_xyz(&light)[1]
    }

    #[test]
    fn illuminance_matches_the_visual_magnitudes_of_allen() {
        // V = -12.73 + 0.026 g + 4e-9 g^4 (Allen, Astrophysical Quantities, 1976), a star of magnitude 0 gives 2.54e-6 lx. At
        // full moon the formula has no opposition surge.
        for (deg, within) in [
            (7.0, 0.05),
            (20.0, 0.05),
            (60.0, 0.05),
            (90.0, 0.05),
            (120.0, 0.05),
            (150.0, 0.2),
        ] {
            let magnitude = -12.73 + 0.026 * deg + 4e-9 * f64::powi(deg, 4);
            let want = 2.54e-6 * f64::powf(10.0, -0.4 * magnitude);
            let got = illuminance_lx(&at_phase(deg));
            assert!(
                (got / want - 1.0).abs() < within,
                "{deg}: {got} against {want} lx"
            );
        }
        assert!((0.3..0.45).contains(&illuminance_lx(&at_phase(0.0))));
    }

    #[test]
    fn light_falls_and_reddens_from_full_to_new() {
        let mut before = f64::INFINITY;
        for deg in 0..=180 {
            let moon = at_phase(f64::from(deg));
            let light = moon.irradiance_ratio(550.0);
            assert!(light > 0.0 && light < before, "{deg}");
            before = light;
        }
        let color =
            |deg| at_phase(deg).irradiance_ratio(650.0) / at_phase(deg).irradiance_ratio(450.0);
        assert!(color(60.0) > color(5.0) && color(5.0) > 1.2);
        assert!((at_phase(90.0).lit_fraction() - 0.5).abs() < 1e-12);
    }

    #[test]
    fn relative_radiance_has_a_mean_of_1_and_a_lit_side() {
        for deg in [0.0, 30.0, 90.0, 140.0] {
            let moon = at_phase(deg);
            let radius = moon.angular_radius_rad();
            let across = moon.direction.any_orthonormal_vector();
            let up = moon.direction.cross(across);
            let (mut sum, mut count) = (0.0, 0.0);
            const STEPS: i32 = 400;
            for i in -STEPS..STEPS {
                for j in -STEPS..STEPS {
                    let at = |k: i32| (f64::from(k) + 0.5) / f64::from(STEPS);
                    let (x, y) = (at(i), at(j));
                    if x * x + y * y < 1.0 {
                        let aside = (across * x + up * y) * radius.sin();
                        sum += moon.relative_radiance((moon.direction + aside).normalize());
                        count += 1.0;
                    }
                }
            }
            assert!((sum / count - 1.0).abs() < 0.01, "{deg}: {}", sum / count);
        }
        let half = at_phase(90.0);
        let sunny = half.to_sun * 0.5 * half.angular_radius_rad();
        assert!(half.relative_radiance((half.direction + sunny).normalize()) > 1.0);
        assert_eq!(
            half.relative_radiance((half.direction - sunny).normalize()),
            0.0
        );
        assert_eq!(half.relative_radiance(-half.direction), 0.0);
    }

    #[test]
    fn invalid_phases_are_refused() {
        let moon = at_phase(10.0);
        for deg in [-1.0, 181.0, f64::NAN] {
            assert!(matches!(
                moon.with_phase(deg),
                Err(MoonError::PhaseAngle(_))
            ));
        }
    }
}
