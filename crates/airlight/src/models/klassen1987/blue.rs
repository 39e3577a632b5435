//! The sky behind the haze.

use super::lanes::{Lanes, to_xyz, wavelengths_nm};
use super::settings::{BaseBlue, Klassen1987Error, Klassen1987Settings};
use crate::axes;
use crate::control::Control;
use crate::sky::{Sky, SkyError, SkySettings, SkyTable, SunCoverage, TableChannels};
use crate::spectrum::WavelengthGrid;
use crate::sun::SunState;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// Source of the blue for all suns.
pub(super) enum BaseSky {
    /// One colour, with a luminance under a sun in the zenith.
    Constant {
        /// cd/m^2.
        noon_luminance_cd_m2: f64,
    },
    /// The solved sky of the clear air.
    Solved(Sky),
}

/// Radiance behind the haze, W m^-2 sr^-1 nm^-1.
pub(super) enum Blue {
    /// The same in all directions.
    Constant(Lanes),
    /// Table by direction, with the sun in the south, and its azimuth-independent solar elevation.
    Table(Box<SkyTable>, f64),
}

impl Blue {
    /// Blue for checked settings and an elevation of the sun (rad), at a distance relative to the mean distance; `grid` has the
    /// solar irradiance at that distance.
    ///
    /// # Errors
    /// [`SkyError::NotConverged`] for a sun that the base is not prepared for; [`SkyError::Cancelled`].
    pub fn new(
        settings: &Klassen1987Settings,
        grid: &WavelengthGrid,
        (sun_elevation, sun_distance_ratio): (f64, f64),
        base: &BaseSky,
        control: Control<'_>,
    ) -> Result<Self, SkyError> {
        Ok(match base {
            BaseSky::Solved(sky) => {
                let ground_m = sky.atmosphere().planet.ground_altitude_m;
                let sun = SunState::from(axes::direction(180.0, sun_elevation.to_degrees()));
                let sun = sun.at_distance_ratio(sun_distance_ratio);
                let view = sky.view_with(ground_m, sun, control)?;
                let table = view.table_with(TableChannels::Spectral, control)?;
                Self::Table(Box::new(table), sun_elevation)
            }
            BaseSky::Constant {
                noon_luminance_cd_m2,
            } => {
                let scattered = |density: f64| {
                    let mut lanes = Lanes::ZERO;
                    for (lane, nm) in wavelengths_nm().enumerate() {
                        let depth =
                            density * settings.air_thickness_m * settings.air_extinction_per_m(nm)
                                / settings.air_density;
                        lanes.0[lane] = (-(-depth).exp_m1() * grid.solar_irradiance()[lane]) as f32;
                    }
                    lanes
                };
                let brightness = 0.01 + 0.99 * sun_elevation.sin();
                let unit = noon_luminance_cd_m2 / to_xyz(grid, &scattered(1.0))[1];
                Self::Constant(scattered(settings.air_density) * (unit * brightness) as f32)
            }
        })
    }

    /// Radiance behind the haze along a view ray.
    pub fn along(&self, sin_elevation: f64, cos_sun: f64) -> Lanes {
        match self {
            Self::Constant(lanes) => *lanes,
            Self::Table(table, sun_elevation) => {
                let elevation = sin_elevation.clamp(0.0, 1.0).asin();
                let azimuth = azimuth_from_sun(elevation, *sun_elevation, cos_sun);
                let (sin, cos) = elevation.sin_cos();
                // The sun is in the south, +z.
                let direction = DVec3::new(cos * azimuth.sin(), sin, cos * azimuth.cos());
                let mut lanes = Lanes::ZERO;
                table.sample(direction, &mut lanes.0);
                lanes
            }
        }
    }
}

impl BaseSky {
    /// Solves for the clear air of checked settings under a range of suns, for [`BaseBlue::Solver`].
    ///
    /// # Errors
    /// [`Klassen1987Error::Sky`] if the solver fails.
    pub fn prepare(
        settings: &Klassen1987Settings,
        suns: SunCoverage,
        control: Control<'_>,
    ) -> Result<Self, Klassen1987Error> {
        if let BaseBlue::Constant {
            noon_luminance_cd_m2,
        } = settings.base_blue
        {
            return Ok(Self::Constant {
                noon_luminance_cd_m2,
            });
        }
        let air = settings.dense_clear_air();
        let suns = match suns {
            // The eye is on the ground.
            SunCoverage::Near {
                sun_elevation_deg, ..
            } => SunCoverage::near(sun_elevation_deg.max(0.0), air.planet.ground_altitude_m),
            all => all,
        };
        let settings = SkySettings {
            suns,
            ..SkySettings::default()
        };
        let grid = super::wavelength_grid();
        Ok(Self::Solved(Sky::prepare_with(
            &air, &grid, &settings, control,
        )?))
    }
}

/// Azimuth from the sun (rad, 0 to pi) of a direction with this elevation and angle from the sun, clamped to valid values.
fn azimuth_from_sun(elevation: f64, sun_elevation: f64, cos_sun: f64) -> f64 {
    let across = elevation.cos() * sun_elevation.cos();
    match across > 1e-12 {
        true => {
            let cos = (cos_sun - elevation.sin() * sun_elevation.sin()) / across;
            cos.clamp(-1.0, 1.0).acos()
        }
        false => FRAC_PI_2,
    }
}
