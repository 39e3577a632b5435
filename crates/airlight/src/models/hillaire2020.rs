//! S. Hillaire, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique", Computer Graphics Forum 39(4),
//! 2020, on the CPU at any wavelengths.
//!
//! A view ray is marched in few steps. Sunlight is attenuated through a table of transmittances (eqs. 1 to 4); multiple
//! scattering is assumed isotropic and a geometric series (eqs. 5 to 10), stored in a second table and added at each step
//! (eq. 11). The published engine also tabulates the sky in 200 x 100 directions and aerial perspective; here each ray is
//! marched.
//!
//! Steps are denser near the eye: step k of n begins at the fraction `(k / n)^2` of the ray, as in the author's published
//! shaders; the paper does not mention it. Samples are at the midpoints of steps. As there, the ground is lit by direct
//! sunlight only, and black for later orders.
//!
//! The variant `even-steps` marches view rays as the atmosphere of Bevy 0.20 does (`raymarch_atmosphere`): 16 samples at even
//! distances, the first at 0.3 of one, each for the way from the sample before. Only the march differs from the paper: Bevy's own
//! air is not that of the paper, and its table of multiple scattering is filled with steps of that kind as well.

use super::PublishedModel;
use super::lut::{
    AirLanes, MultipleScatteringSettings, MultipleScatteringTable, Steps, TransmittanceTable,
    add_scaled,
};
use super::prepared::Prepared;
use crate::atmosphere::{Atmosphere, AtmosphereError};
use crate::control::{Cancelled, Control};
use crate::debug::debug_fields;
use crate::scene::{Capabilities, Input, PreparedModel, RadianceModel, ResolvedScene, SceneError};
use crate::sky::{LineOfSight, Scattering, SunCoverage};
use crate::spectrum::WavelengthGrid;
use crate::sun::{SunDisc, SunState};
use crate::transfer::ray::Ray;
use glam::DVec3;
use std::sync::Arc;

/// Sizes of the tables and numbers of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Settings {
    /// Zenith angles and altitudes of the transmittance table, at least 2 each.
    pub transmittance_size: [usize; 2],
    /// Number of steps along each ray of the transmittance table, at least 1.
    pub transmittance_steps: usize,
    /// Settings of the multiple-scattering table; `None` for single scattering.
    pub multiple: Option<MultipleScatteringSettings>,
    /// Steps along each view ray, at least 1.
    pub steps: Steps,
}

impl Default for Settings {
    /// Values of the paper (table 2): 256 x 64 transmittances of 40 steps, 32 x 32 of multiple scattering, 30 steps per ray.
    fn default() -> Self {
        Self {
            transmittance_size: [256, 64],
            transmittance_steps: 40,
            multiple: Some(MultipleScatteringSettings::default()),
            steps: PAPER_STEPS,
        }
    }
}

/// Steps along a view ray in the paper (table 2).
const PAPER_STEPS: Steps = Steps::Midpoints {
    count: 30,
    power: 2,
};
/// Steps along a view ray of the variant `even-steps`.
const EVEN_STEPS: Steps = Steps::Ends {
    count: 16,
    place: 0.3,
};
/// Names of the variants, the default first.
const VARIANTS: [&str; 2] = ["paper", "even-steps"];

/// Error of [`Hillaire2020::new`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HillaireError {
    /// The eye is below the ground, or its altitude is not finite.
    #[error(
        "expected a finite altitude of the eye, not below the ground at {ground_m} m, got {altitude_m} m"
    )]
    EyeAltitude {
        /// Altitude of the eye, m.
        altitude_m: f64,
        /// Altitude of the ground, m.
        ground_m: f64,
    },
    /// The sun's direction is zero or not finite.
    #[error("expected a finite sun direction that is not zero, got {0}")]
    Sun(DVec3),
    /// A size or a number of steps is out of range.
    #[error(
        "expected at least 2 entries in each dimension of a table, at least 1 step and at least 1 direction"
    )]
    Settings,
    /// The atmosphere is invalid.
    #[error(transparent)]
    Atmosphere(#[from] AtmosphereError),
    /// The caller cancelled the computation.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The sky for one eye and one sun.
pub struct Hillaire2020 {
    tables: Arc<Tables>,
    /// Wavelengths with the solar irradiance at the sun's distance.
    grid: WavelengthGrid,
    solar: Vec<f32>,
    disc: SunDisc,
    eye: DVec3,
    sun: DVec3,
}

/// The tables of an atmosphere: the same for all eyes and suns.
struct Tables {
    grid: WavelengthGrid,
    air: AirLanes,
    transmittance: TransmittanceTable,
    multiple: Option<MultipleScatteringTable>,
    steps: Steps,
    disc: SunDisc,
    ground_altitude_m: f64,
}

debug_fields! { Hillaire2020 { grid, disc, eye, sun } }

impl Hillaire2020 {
    /// Sky of `atmosphere` at the wavelengths of `grid`, with the atmosphere's solar spectrum and the paper's table sizes, for an
    /// eye at an altitude (m) and a sun direction.
    ///
    /// # Errors
    /// [`HillaireError`] if an argument is outside its domain.
    pub fn new(
        atmosphere: &Atmosphere,
        grid: &WavelengthGrid,
        eye_altitude_m: f64,
        sun_direction: DVec3,
    ) -> Result<Self, HillaireError> {
        Self::with_settings(
            atmosphere,
            grid,
            eye_altitude_m,
            sun_direction,
            &Settings::default(),
        )
    }

    /// As [`Self::new`], with other settings.
    ///
    /// # Errors
    /// As [`Self::new`], and for settings out of range.
    pub(crate) fn with_settings(
        atmosphere: &Atmosphere,
        grid: &WavelengthGrid,
        eye_altitude_m: f64,
        sun_direction: DVec3,
        settings: &Settings,
    ) -> Result<Self, HillaireError> {
        let tables = Tables::new(atmosphere, grid, settings, Control::default())?;
        let sun = SunState {
            direction: sun_direction,
            distance_ratio: 1.0,
        };
        Self::of(Arc::new(tables), eye_altitude_m, &sun)
    }

    /// Sky from prepared tables.
    fn of(tables: Arc<Tables>, eye_altitude_m: f64, sun: &SunState) -> Result<Self, HillaireError> {
        let ground_m = tables.ground_altitude_m;
        if !(eye_altitude_m.is_finite() && eye_altitude_m >= ground_m) {
            return Err(HillaireError::EyeAltitude {
                altitude_m: eye_altitude_m,
                ground_m,
            });
        }
        let direction = sun.direction;
        let grid = tables.grid.with_solar_factor(sun.irradiance_factor());
        Ok(Self {
            eye: DVec3::Y * (tables.air.planet_radius_m() + eye_altitude_m),
            solar: grid.solar_irradiance().iter().map(|&e| e as f32).collect(),
            disc: sun.disc(&tables.disc),
            grid,
            tables,
            sun: direction
                .try_normalize()
                .ok_or(HillaireError::Sun(direction))?,
        })
    }

    /// Spectral radiance along a unit vector, W m^-2 sr^-1 nm^-1, including the ground if the ray hits it.
    pub fn radiance(&self, direction: DVec3) -> Vec<f32> {
        self.along(direction, None).radiance()
    }

    /// Light along a unit vector over at most `limit_m` metres, by parts; `None` for the whole ray to the ground or to space. A
    /// shorter ray is marched in the same number of steps.
    pub fn along(&self, direction: DVec3, limit_m: Option<f64>) -> LineOfSight {
        let Tables {
            air,
            transmittance,
            multiple,
            steps,
            ..
        } = self.tables.as_ref();
        let lanes = air.lanes();
        let dark = || vec![0.0f32; lanes];
        let mut line = LineOfSight {
            transmittance: vec![1.0; lanes],
            single: dark(),
            multiple: dark(),
            ground: dark(),
            meets_ground: false,
        };
        let ray = Ray::new(self.eye, direction, self.sun);
        let limit_m = limit_m.unwrap_or(f64::INFINITY);
        let Some(segment) = air.segment(&ray, limit_m) else {
            return line;
        };
        line.meets_ground = segment.meets_ground;
        let scattered = air.scattered(ray.nu);
        let (mut sunlight, mut psi, mut once) = (dark(), dark(), dark());
        let span = (segment.start_m, segment.end_m);
        line.transmittance = air.march(&ray, span, *steps, |step| {
            let here = &step.here;
            air.transmittance_to_sun(transmittance, here.radius_m, here.mu_sun, &mut sunlight);
            if let Some(table) = multiple {
                table.look_up(here.radius_m, here.mu_sun, &mut psi);
            }
            once.fill(0.0);
            for (&density, scattered) in step.densities.iter().zip(&scattered) {
                add_scaled(&mut once, scattered, density as f32);
            }
            add_products(&mut line.single, [step.weight_m, &once, &sunlight]);
            add_products(
                &mut line.multiple,
                [step.weight_m, step.scattering_per_m, &psi],
            );
        });
        for light in [&mut line.single, &mut line.multiple] {
            light
                .iter_mut()
                .zip(&self.solar)
                .for_each(|(light, e)| *light *= e);
        }
        if line.meets_ground {
            let mu_sun = ray.advanced(segment.end_m).mu_sun;
            air.ground_radiance(transmittance, mu_sun, &mut sunlight);
            for lane in 0..lanes {
                line.ground[lane] = line.transmittance[lane] * sunlight[lane] * self.solar[lane];
            }
        }
        line
    }

    /// Spectral radiance of the sun's disc along a unit vector, attenuated by the air, W m^-2 sr^-1 nm^-1.
    pub(crate) fn disc_radiance(&self, direction: DVec3) -> Vec<f32> {
        let Tables {
            air, transmittance, ..
        } = self.tables.as_ref();
        let mut light = vec![0.0f32; air.lanes()];
        let angle = direction.angle_between(self.sun);
        let ray = Ray::new(self.eye, direction, self.sun);
        let (ground_m, top_m) = air.bounds_m();
        if angle >= self.disc.angular_radius_rad || ray.distance_to_ground(ground_m).is_some() {
            return light;
        }
        // From above the atmosphere the ray enters at its top, or misses it.
        let inside = match air.segment(&ray, f64::INFINITY) {
            Some(segment) if ray.radius_m > top_m => Some(ray.advanced(segment.start_m)),
            Some(_) => Some(ray),
            None => None,
        };
        match inside {
            Some(ray) => transmittance.look_up(ray.radius_m, ray.mu, &mut light),
            None => light.fill(1.0),
        }
        let lanes = self.solar.iter().zip(self.grid.wavelengths_nm());
        for (light, (e, &nm)) in light.iter_mut().zip(lanes) {
            *light *= e * self.disc.radiance_per_irradiance(angle, nm) as f32;
        }
        light
    }
}

/// Adds the products of three lists to a sum.
fn add_products(sum: &mut [f32], [a, b, c]: [&[f32]; 3]) {
    for (((sum, a), b), c) in sum.iter_mut().zip(a).zip(b).zip(c) {
        *sum += a * b * c;
    }
}

impl Tables {
    fn new(
        atmosphere: &Atmosphere,
        grid: &WavelengthGrid,
        settings: &Settings,
        control: Control<'_>,
    ) -> Result<Self, HillaireError> {
        atmosphere.validate()?;
        let multiple_fits = settings.multiple.is_none_or(|m| {
            m.size.iter().all(|&n| n >= 2) && m.root_of_directions >= 1 && m.steps >= 1
        });
        if settings.transmittance_size.iter().any(|&n| n < 2)
            || settings.transmittance_steps == 0
            || settings.steps.count() == 0
            || !multiple_fits
        {
            return Err(HillaireError::Settings);
        }
        let grid = grid.clone().with_solar(&atmosphere.solar_irradiance);
        let air = AirLanes::new(atmosphere, grid.wavelengths_nm());
        let transmittance =
            air.transmittance_table(settings.transmittance_size, settings.transmittance_steps);
        let multiple = settings
            .multiple
            .map(|m| MultipleScatteringTable::new(&air, &transmittance, &m, control))
            .transpose()?;
        Ok(Self {
            grid,
            air,
            transmittance,
            multiple,
            steps: settings.steps,
            disc: atmosphere.sun.clone(),
            ground_altitude_m: atmosphere.planet.ground_altitude_m,
        })
    }
}

/// The sky of Hillaire 2020 in the air of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Hillaire2020Model;

impl RadianceModel for Hillaire2020Model {
    fn name(&self) -> &'static str {
        "hillaire2020"
    }

    fn summary(&self) -> &'static str {
        "Hillaire 2020: ray marching in few steps with two small tables"
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities {
            inputs: &[
                Input::Atmosphere,
                Input::Haze,
                Input::Ozone,
                Input::GroundAlbedo,
                Input::ObserverHeight,
                Input::SunDistance,
                Input::Objects,
                Input::Wavelengths,
                Input::Scattering,
                Input::Spectra,
                Input::Distances,
                Input::Variant,
            ],
            variants: &VARIANTS,
            twilight: true,
            parts: true,
        }
    }

    fn prepare(
        &self,
        scene: &ResolvedScene,
        _suns: SunCoverage,
        control: Control<'_>,
    ) -> Result<Arc<dyn PreparedModel>, SceneError> {
        let name = self.name();
        let refused = move |error| match error {
            HillaireError::Cancelled(cancelled) => cancelled.into(),
            error => SceneError::model(name, error),
        };
        let mut settings = Settings::default();
        if scene.solver.scattering == Some(Scattering::Single) {
            settings.multiple = None;
        }
        if scene.solver.variant.as_deref() == Some(VARIANTS[1]) {
            settings.steps = EVEN_STEPS;
        }
        let tables = Tables::new(&scene.atmosphere, &scene.grid, &settings, control);
        let tables = Arc::new(tables.map_err(refused)?);
        let grid = Some(tables.grid.clone());
        let prepared = Prepared::new(name, scene, grid, move |altitude_m, sun, _| {
            let sky = Hillaire2020::of(tables.clone(), altitude_m, sun);
            Ok(Arc::new(sky.map_err(refused)?))
        });
        Ok(Arc::new(prepared))
    }
}

impl PublishedModel for Hillaire2020 {
    fn sun(&self) -> DVec3 {
        self.sun
    }

    fn disc(&self) -> &SunDisc {
        &self.disc
    }

    fn has_ground(&self) -> bool {
        true
    }

    fn sky_xyz(&self, direction: DVec3) -> [f64; 3] {
        self.grid.to_xyz(&self.radiance(direction))
    }

    fn disc_xyz(&self, direction: DVec3) -> [f64; 3] {
        self.grid.to_xyz(&self.disc_radiance(direction))
    }

    fn grid(&self) -> Option<&WavelengthGrid> {
        Some(&self.grid)
    }

    fn sky_spectrum(&self, direction: DVec3) -> Vec<f64> {
        f64s(self.radiance(direction))
    }

    fn disc_spectrum(&self, direction: DVec3) -> Vec<f64> {
        f64s(self.disc_radiance(direction))
    }

    fn line(&self, direction: DVec3, limit_m: Option<f64>) -> Option<LineOfSight> {
        Some(self.along(direction, limit_m))
    }
}

fn f64s(light: Vec<f32>) -> Vec<f64> {
    light.into_iter().map(f64::from).collect()
}

#[cfg(test)]
mod tests;
