//! R. V. Klassen, "Modeling the Effect of the Atmosphere on Light", ACM Transactions on Graphics 6(3), 215-237, July 1987:
//! colours of sun and sky (sections 2 to 8, eqs. 1 to 33); as a model of the registry also its naturally lit fog (sections 9 to 12).
//!
//! The air consists of two spherical shells above the ground at `R_E`: molecules and haze up to `R_H`, molecules alone up to
//! `R_A`, both with their density at the ground; `R_A` is lowered to give the air the right column. Sunlight is attenuated on
//! `d_1` through air and `d_2` through haze, scattered once by the haze, and attenuated on `d_3` to the eye:
//!
//! ```text
//! haze(psi, theta) = I_0 beta_sc(psi) int_0^l_max exp(-beta_m d_1 - (beta_m + beta_p)(d_2 + d_3)) dl         (23)
//! sky = blue (1 - O) + haze,   O = 1 - exp(-beta_p l_max)                                                      (31)
//! sun = I_0 exp(-beta_m (d_1 + d_2) - beta_p d_2)                                                              (13), (22)
//! ```
//!
//! # As printed and as corrected
//! - (1): `1 - g^2` for `(1 - g)^2`, and `1 / (4 pi)` ([`HazePhase`]).
//! - The text includes a factor `sin psi` in `beta_sc`, for light that crosses a line at an angle. Radiance has no such
//!   factor: a beam that crosses a view ray obliquely puts less light on each metre of its side, by `sin psi`, but stays
//!   inside for longer, by `1 / sin psi`; a volume scatters `E beta` for any direction of light. With the factor the aureole
//!   would have a dark hole at the sun, which no figure shows, so both forms omit it.
//! - (13), (22): the exponents lack their minus signs; (27): `l = l_max (r - R_E) / (R_H - R_E)`, without effect, because
//!   only (28) is used.
//! - (27) to (29) take the distance along the ray as linear in the radius: [`HazePath`].
//! - (20), (24), (25) take the sun at the same elevation above every sphere: [`SunRay`].
//! - The blue is one constant colour, chosen by eye: [`BaseBlue`].
//!
//! Wavelengths: 33 at intervals of 10 nm as in section 8, 380 to 700 nm (the paper gives the number and the interval; these
//! ends cover the visible range).
//!
//! The model has no light below the horizon; there it repeats the horizon's
//! ([`PublishedModel::has_ground`] is false). It has no twilight, no ozone in the colour of the
//! sun, and no multiple scattering. The book compares it with the solver.

mod blue;
mod coherence;
#[cfg(test)]
mod errata;
mod fog;
mod geometry;
mod haze;
mod lanes;
mod layers;
mod model;
mod scene;
mod settings;
mod simpson;
#[cfg(test)]
mod tests;

pub use fog::{RgbSlab1987, SunDepth};
pub use geometry::{HazePath, SunRay};
pub use lanes::wavelength_grid;
pub(crate) use model::Klassen1987Model;
pub use settings::{BaseBlue, Haze, HazePhase, Klassen1987Error, Klassen1987Settings};

use super::PublishedModel;
use crate::axes;
use crate::control::Control;
use crate::debug::debug_fields;
use crate::sky::SunCoverage;
use crate::spectrum::WavelengthGrid;
use crate::sun::{SunDisc, SunState};
use blue::{BaseSky, Blue};
use coherence::{Cells, Walker};
use geometry::{RaySegment, Spheres};
use glam::DVec3;
use haze::HazeTables;
use lanes::{Lanes, exp_neg, f64s, to_xyz, wavelengths_nm};
use simpson::Simpson;
use std::sync::{Arc, OnceLock};

/// Sun and sky of 1987 for one sun direction.
pub struct Klassen1987 {
    settings: Klassen1987Settings,
    grid: WavelengthGrid,
    spheres: Spheres,
    sun: DVec3,
    sin_sun: f64,
    disc: SunDisc,
    /// Solar irradiance outside the atmosphere, `I_0`, W m^-2 nm^-1.
    sunlight: Lanes,
    /// `beta_m`, m^-1.
    air_per_m: Lanes,
    haze: Arc<HazeTables>,
    blue: Blue,
    cells: OnceLock<Cells>,
}

debug_fields! { Klassen1987 { settings, sun } }

/// Parts that do not depend on the sun.
struct Base {
    sky: BaseSky,
    haze: Arc<HazeTables>,
}

impl Base {
    /// Solves for the clear air of checked settings under a range of suns, and tabulates the haze.
    fn prepare(
        settings: &Klassen1987Settings,
        suns: SunCoverage,
        control: Control<'_>,
    ) -> Result<Self, Klassen1987Error> {
        Ok(Self {
            sky: BaseSky::prepare(settings, suns, control)?,
            haze: Arc::new(HazeTables::new(settings, control)?),
        })
    }
}

impl Klassen1987 {
    /// Model for an eye on the ground and a sun in the direction of a unit vector ([`crate::axes`]), at the horizon or above.
    /// With [`BaseBlue::Solver`] it first solves for the clear air, which takes about a second.
    ///
    /// # Errors
    /// [`Klassen1987Error`] if a setting is outside its domain or the sun is below the horizon.
    pub fn new(settings: &Klassen1987Settings, sun: DVec3) -> Result<Self, Klassen1987Error> {
        settings.validate()?;
        let suns = SunCoverage::near(axes::elevation_deg(sun), 0.0);
        let control = Control::default();
        let base = Base::prepare(settings, suns, control)?;
        let sun = SunState {
            direction: sun,
            distance_ratio: 1.0,
        };
        Self::over(settings, &base, &sun, control)
    }

    /// The model of checked settings with their prepared parts.
    fn over(
        settings: &Klassen1987Settings,
        base: &Base,
        sun: &SunState,
        control: Control<'_>,
    ) -> Result<Self, Klassen1987Error> {
        let direction = sun.direction.normalize_or_zero();
        let elevation_deg = axes::elevation_deg(direction);
        // Tolerates rounding below 0.
        if direction == DVec3::ZERO || elevation_deg < -1e-9 {
            return Err(Klassen1987Error::SunBelowHorizon(elevation_deg));
        }
        let grid = wavelength_grid()
            .with_solar(&settings.clear_air.solar_irradiance)
            .with_solar_factor(sun.irradiance_factor());
        let planet = &settings.clear_air.planet;
        let earth_m = planet.radius_m + planet.ground_altitude_m;
        let mut air_per_m = Lanes::ZERO;
        for (lane, nm) in wavelengths_nm().enumerate() {
            air_per_m.0[lane] = settings.air_extinction_per_m(nm) as f32;
        }
        let sin_sun = direction.y.max(0.0);
        Ok(Self {
            spheres: Spheres {
                earth_m,
                haze_m: earth_m + settings.haze_thickness_m,
                air_m: earth_m + settings.air_thickness_m,
            },
            sun: direction,
            sin_sun,
            disc: sun.disc(&settings.clear_air.sun),
            sunlight: Lanes::from_fn(|i| grid.solar_irradiance()[i] as f32),
            air_per_m,
            haze: base.haze.clone(),
            blue: Blue::new(
                settings,
                &grid,
                (sin_sun.asin(), sun.distance_ratio),
                &base.sky,
                control,
            )?,
            cells: OnceLock::new(),
            settings: settings.clone(),
            grid,
        })
    }

    /// The settings.
    pub fn settings(&self) -> &Klassen1987Settings {
        &self.settings
    }

    /// Wavelength grid with the solar spectrum.
    pub fn grid(&self) -> &WavelengthGrid {
        &self.grid
    }

    /// Irradiance of the sun at the eye on a surface that faces it, W m^-2 nm^-1 (eq. 22).
    pub fn sun_irradiance(&self) -> Vec<f64> {
        f64s(&self.attenuated_sun(self.sin_sun))
    }

    /// Radiance of the haze alone, W m^-2 sr^-1 nm^-1 (eq. 23 or 29).
    pub fn haze_spectrum(&self, direction: DVec3) -> Vec<f64> {
        let (sin_elevation, cos_sun) = self.angles(direction);
        f64s(&self.haze_along(sin_elevation, cos_sun, &mut Simpson::new(0.0)))
    }

    /// Opacity of the haze for light behind it (eq. 31).
    pub fn opacity(&self, direction: DVec3) -> Vec<f64> {
        let (sin_elevation, _) = self.angles(direction);
        let depth = self.haze_depth(sin_elevation);
        let opacity = |&depth: &f32| -(-f64::from(depth)).exp_m1();
        depth.0.iter().map(opacity).collect()
    }

    /// `I_0` attenuated along `d_1` and `d_2` (eqs. 20 to 22, 13).
    fn attenuated_sun(&self, sin_elevation: f64) -> Lanes {
        let lengths = self
            .spheres
            .sun_lengths(sin_elevation, self.settings.sun_ray);
        let air_m = (lengths.air_m + lengths.haze_m) as f32;
        let depth = self.air_per_m * air_m + self.haze.extinction_per_m * lengths.haze_m as f32;
        self.sunlight * exp_neg(depth)
    }

    /// Sine of the elevation, clamped to the horizon, and cosine of the angle to the sun.
    fn angles(&self, direction: DVec3) -> (f64, f64) {
        let level = match direction.y < 0.0 {
            true => DVec3::new(direction.x, 0.0, direction.z).normalize_or(DVec3::X),
            false => direction,
        };
        (level.y.min(1.0), level.dot(self.sun).clamp(-1.0, 1.0))
    }

    /// Optical depth of the haze along a view ray.
    fn haze_depth(&self, sin_elevation: f64) -> Lanes {
        self.haze.extinction_per_m * self.spheres.haze_length_m(sin_elevation) as f32
    }

    fn haze_transmittance(&self, sin_elevation: f64) -> Lanes {
        exp_neg(self.haze_depth(sin_elevation))
    }

    /// Eq. 23, or eqs. 27 to 29.
    fn haze_along(&self, sin_elevation: f64, cos_sun: f64, simpson: &mut Simpson) -> Lanes {
        let line = RaySegment {
            sin_elevation,
            sin_sun: self.sin_sun,
            cos_sun,
        };
        let length_m = self.spheres.haze_length_m(sin_elevation);
        let (path, ray) = (self.settings.path, self.settings.sun_ray);
        let both_per_m = self.air_per_m + self.haze.extinction_per_m;
        let integral =
            simpson.integrate(
                |x| match self.spheres.lengths(&line, length_m, x, path, ray) {
                    Some(lengths) => {
                        let depth = self.air_per_m * lengths.air_m as f32
                            + both_per_m * lengths.haze_m as f32;
                        exp_neg(depth) * length_m as f32
                    }
                    None => Lanes::ZERO,
                },
            );
        self.sunlight * self.haze.scattered(cos_sun) * integral
    }

    fn radiance_along(&self, sin_elevation: f64, cos_sun: f64, simpson: &mut Simpson) -> Lanes {
        let behind = self.blue.along(sin_elevation, cos_sun);
        behind * self.haze_transmittance(sin_elevation)
            + self.haze_along(sin_elevation, cos_sun, simpson)
    }

    /// Radiance of the sun's disc along a direction.
    fn disc_along(&self, direction: DVec3) -> Lanes {
        let angle = direction.angle_between(self.sun);
        if direction.y < 0.0 || angle >= self.disc.angular_radius_rad {
            return Lanes::ZERO;
        }
        let mut radiance = self.attenuated_sun(direction.y.min(1.0));
        for (lane, nm) in wavelengths_nm().enumerate() {
            radiance.0[lane] *= self.disc.radiance_per_irradiance(angle, nm) as f32;
        }
        radiance
    }

    fn xyz_along(&self, sin_elevation: f64, cos_sun: f64, simpson: &mut Simpson) -> [f64; 3] {
        to_xyz(
            &self.grid,
            &self.radiance_along(sin_elevation, cos_sun, simpson),
        )
    }
}

impl PublishedModel for Klassen1987 {
    fn sun(&self) -> DVec3 {
        self.sun
    }

    fn disc(&self) -> &SunDisc {
        &self.disc
    }

    fn sky_xyz(&self, direction: DVec3) -> [f64; 3] {
        let (sin_elevation, cos_sun) = self.angles(direction);
        self.xyz_along(sin_elevation, cos_sun, &mut Simpson::new(0.0))
    }

    fn disc_xyz(&self, direction: DVec3) -> [f64; 3] {
        to_xyz(&self.grid, &self.disc_along(direction))
    }

    /// Within one step of a picture of [`Klassen1987Settings::bits_per_channel`] (test `coherence_changes_codes_by_at_most_one`), as long as
    /// no channel is exposed to more than 8 times white.
    fn walk(&self) -> Box<dyn FnMut(DVec3) -> [f64; 3] + '_> {
        let bits = self.settings.bits_per_channel;
        let colours = |alike| {
            let mut simpson = Simpson::new(alike);
            move |sin_elevation, cos_sun| self.xyz_along(sin_elevation, cos_sun, &mut simpson)
        };
        let cells = self.cells.get_or_init(|| Cells::new(bits, colours(0.0)));
        // An eighth of a step of the picture.
        let alike = 0.125 * 2.4 / 1.055 / (2f32.powi(bits as i32) - 1.0);
        let mut walker = Walker::new(cells, colours(alike));
        Box::new(move |direction| {
            let (sin_elevation, cos_sun) = self.angles(direction);
            walker.xyz(sin_elevation, cos_sun)
        })
    }

    fn grid(&self) -> Option<&WavelengthGrid> {
        Some(&self.grid)
    }

    fn sky_spectrum(&self, direction: DVec3) -> Vec<f64> {
        let (sin_elevation, cos_sun) = self.angles(direction);
        f64s(&self.radiance_along(sin_elevation, cos_sun, &mut Simpson::new(0.0)))
    }

    fn disc_spectrum(&self, direction: DVec3) -> Vec<f64> {
        f64s(&self.disc_along(direction))
    }
}
