//! What is looked at, from where, under which sun: from options to a prepared sky.

use crate::args::{AirArgs, EffortArg, PlaceArgs, ScatteringArg, SolverArg};
use crate::atmosphere;
use crate::error::CliError;
use crate::progress::Busy;
use airlight::atmosphere::Atmosphere;
use airlight::models::klassen1987;
use airlight::scene::{self, AirSpec, ObserverSpec, SolverSpec, SunSpec};
pub use airlight::scene::{SunAngles as Sun, SunSource};
use airlight::sky::{Scattering, Sky, SkySettings, SunCoverage, View};
use airlight::spectrum::WavelengthGrid;
use std::time::{Duration, Instant};

/// Where the eye is, what the air is and how the sun is found.
pub struct Scene {
    /// The air asked for.
    pub atmosphere: Atmosphere,
    /// Its wavelengths.
    pub grid: WavelengthGrid,
    /// Altitude of the eye above sea level, m.
    pub eye_altitude_m: f64,
    /// How the sun is found.
    pub sun: SunSource,
    scattering: Scattering,
    effort: EffortArg,
}

impl Scene {
    /// Puts the options together.
    ///
    /// # Errors
    /// [`CliError`] where they do not fit together or a file cannot be read.
    pub fn new(place: &PlaceArgs, air: &AirArgs) -> Result<Self, CliError> {
        let mut spec = spec(place, air);
        atmosphere::inline_file(&mut spec)?;
        let resolved = spec.resolve()?;
        let grid = match air.solver {
            // It has its own.
            SolverArg::Klassen1987 => klassen1987::wavelength_grid(),
            _ => resolved.grid,
        };
        let scattering = match air.scattering {
            ScatteringArg::All => Scattering::All,
            ScatteringArg::Single => Scattering::Single,
        };
        Ok(Self {
            atmosphere: resolved.atmosphere,
            grid,
            eye_altitude_m: resolved.observer_altitude_m,
            sun: resolved.sun,
            scattering,
            effort: air.effort,
        })
    }

    /// Solves for the light inside the air; tells how long it took.
    ///
    /// # Errors
    /// [`CliError::Usage`] where the solver refuses the atmosphere.
    pub fn prepare(&self, suns: SunCoverage) -> Result<(Sky, Duration), CliError> {
        let start = Instant::now();
        let _busy = Busy::with("solving for the light in the air");
        let settings = SkySettings {
            suns,
            scattering: self.scattering,
            ..match self.effort {
                EffortArg::Standard => SkySettings::default(),
                EffortArg::Fine => SkySettings::fine(),
            }
        };
        let sky = Sky::prepare(&self.atmosphere, &self.grid, &settings)?;
        Ok((sky, start.elapsed()))
    }

    /// Which light is computed, as on the command line.
    pub fn scattering_name(&self) -> &'static str {
        match self.scattering {
            Scattering::All => "all",
            Scattering::Single => "single",
        }
    }

    /// The fastest preparation for one position of the sun.
    pub fn near(&self, sun: &Sun) -> SunCoverage {
        SunCoverage::near(sun.elevation_deg, self.eye_altitude_m)
    }

    /// What is seen under a sun.
    pub fn view(&self, sky: &Sky, sun: &Sun) -> View {
        sky.view(self.eye_altitude_m, sun.direction())
            .at_sun_distance(sun.distance_ratio)
    }
}

/// The scene of the options.
fn spec(place: &PlaceArgs, air: &AirArgs) -> scene::Scene {
    scene::Scene {
        sun: SunSpec {
            elevation_deg: place.sun_elevation,
            azimuth_deg: place.sun_azimuth.filter(|_| place.sun_elevation.is_some()),
            latitude_deg: place.at.map(|at| at.latitude_deg),
            longitude_deg: place.at.map(|at| at.longitude_deg),
            time: place.when.clone(),
            refraction: Some(place.refraction),
            distance_ratio: None,
        },
        observer: ObserverSpec {
            altitude_m: Some(place.altitude_m),
            eye_height_m: Some(place.eye_height_m),
        },
        air: AirSpec {
            atmosphere: Some(air.atmosphere.clone()),
            atmosphere_toml: None,
            aerosol: air.aerosol.clone(),
            humidity: air.humidity,
            aod_550: air.aod_550,
            turbidity: air.turbidity,
            haze_visibility_m: air.visibility_m,
            contrast: Some(atmosphere::contrast(&air.contrast).value()),
            ozone_du: air.ozone_du,
            ground_albedo: air.ground_albedo,
            ground_altitude_m: air.ground_altitude_m,
        },
        solver: SolverSpec {
            wavelengths: Some(air.wavelengths.clone()),
            ..SolverSpec::default()
        },
        ..scene::Scene::default()
    }
}

/// Computes with `count` threads.
///
/// # Errors
/// [`CliError::Failure`] where the system refuses.
pub fn use_threads(count: Option<u32>) -> Result<(), CliError> {
    let Some(count) = count else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(count as usize)
        .build_global()
        .map_err(|error| CliError::failure(format!("cannot start {count} threads: {error}")))
}
