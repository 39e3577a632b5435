//! A sky solved at the wavelengths of a table and evaluated in its directions.

use crate::check::At;
use airlight::atmosphere::Atmosphere;
use airlight::axes::direction;
use airlight::sky::{Sky, SkyError, SkySettings, SunCoverage, View};
use airlight::spectrum::WavelengthGrid;
use airlight::{Cancelled, Control};

/// One atmosphere with one position of the sun, seen from near the ground.
#[derive(Debug)]
pub struct Solved {
    sky: Sky,
    wavelengths_nm: Vec<f64>,
    /// Solar irradiance at the wavelengths, W m^-2 nm^-1; the solver uses means about them.
    solar: Vec<f64>,
    sun_zenith_deg: f64,
    altitude_m: f64,
    /// Distance of the sun relative to its mean.
    sun_distance: f64,
}

impl Solved {
    /// Solves for one position of the sun.
    ///
    /// # Errors
    /// [`SkyError`] for an atmosphere or settings that the solver refuses, and if the caller cancelled.
    pub fn new(
        air: &Atmosphere,
        wavelengths_nm: &[f64],
        sun_zenith_deg: f64,
        settings: &SkySettings,
        control: Control<'_>,
    ) -> Result<Self, SkyError> {
        let grid = WavelengthGrid::from_wavelengths_nm(wavelengths_nm.to_vec())
            .map_err(|_| SkyError::Setting("increasing wavelengths from 300 to 900 nm"))?;
        let suns = SunCoverage::near(90.0 - sun_zenith_deg, 0.0);
        let settings = SkySettings {
            suns,
            ..settings.clone()
        };
        Ok(Self {
            sky: Sky::prepare_with(air, &grid, &settings, control)?,
            wavelengths_nm: wavelengths_nm.to_vec(),
            solar: wavelengths_nm
                .iter()
                .map(|&nm| air.solar_irradiance.at(nm))
                .collect(),
            sun_zenith_deg,
            altitude_m: 0.0,
            sun_distance: 1.0,
        })
    }

    /// As [`Solved::new`], for air that is known to be right.
    ///
    /// # Errors
    /// [`Cancelled`].
    ///
    /// # Panics
    /// Where the solver refuses the air or the settings.
    pub fn of_table(
        air: &Atmosphere,
        wavelengths_nm: &[f64],
        sun_zenith_deg: f64,
        settings: &SkySettings,
        control: Control<'_>,
    ) -> Result<Self, Cancelled> {
        match Self::new(air, wavelengths_nm, sun_zenith_deg, settings, control) {
            Err(SkyError::Cancelled(cancelled)) => Err(cancelled),
            solved => Ok(solved.expect("the skies of the tables can be solved")),
        }
    }

    /// This sky under the mean solar irradiance around each wavelength, as Airlight's Monte Carlo has it, instead of that at the
    /// wavelengths themselves.
    pub fn with_mean_sunlight(self) -> Self {
        Self {
            solar: self.sky.grid().solar_irradiance().to_vec(),
            ..self
        }
    }

    /// This sky with the sun at `sun_distance` times its mean distance.
    pub fn at_sun_distance(self, sun_distance: f64) -> Self {
        Self {
            sun_distance,
            ..self
        }
    }

    /// This sky seen from an altitude, m.
    pub fn seen_from(self, altitude_m: f64) -> Self {
        Self { altitude_m, ..self }
    }

    /// Zenith angle of the sun, degrees.
    pub fn sun_zenith_deg(&self) -> f64 {
        self.sun_zenith_deg
    }

    /// Radiance in a direction.
    pub fn look(&self, view_zenith_deg: f64, relative_azimuth_deg: f64) -> Light {
        let view = self.view();
        let towards = direction(relative_azimuth_deg, 90.0 - view_zenith_deg);
        let line = view.along(towards, None);
        let lit = |light: &[f32]| self.under_this_sun(&view, light);
        Light {
            single: lit(&line.single),
            path: lit(&line.path_radiance()),
            all: lit(&line.radiance()),
        }
    }

    /// Q and U in a direction at each wavelength, W m^-2 sr^-1 nm^-1.
    pub fn linear(&self, view_zenith_deg: f64, relative_azimuth_deg: f64) -> [Vec<f64>; 2] {
        let view = self.view();
        let light = view.polarised(direction(relative_azimuth_deg, 90.0 - view_zenith_deg));
        [light.q, light.u].map(|part| self.under_this_sun(&view, &part))
    }

    /// Irradiance on the ground by sun and sky at each wavelength, W m^-2 nm^-1.
    pub fn ground_irradiance(&self) -> Vec<f64> {
        let view = self.sky.view(
            self.sky.atmosphere().planet.ground_altitude_m,
            direction(0.0, 90.0 - self.sun_zenith_deg),
        );
        let level = view.sun().y as f32;
        let sun = view.sun_irradiance().into_iter();
        let both = sun.zip(view.downwelling_irradiance());
        let both: Vec<f32> = both.map(|(sun, sky)| sun * level + sky).collect();
        self.under_this_sun(&view, &both)
    }

    /// Irradiance from below at each wavelength, W m^-2 nm^-1.
    pub fn upwelling_irradiance(&self) -> Vec<f64> {
        let view = self.view();
        self.under_this_sun(&view, &view.upwelling_irradiance())
    }

    /// Solar irradiance outside the air at each wavelength, W m^-2 nm^-1.
    pub fn solar(&self) -> Vec<f64> {
        let scale = self.sun_distance.powi(-2);
        self.solar.iter().map(|solar| solar * scale).collect()
    }

    /// The view from the altitude.
    fn view(&self) -> View {
        self.sky
            .view(self.altitude_m, direction(0.0, 90.0 - self.sun_zenith_deg))
    }

    /// Light of a view under the sun of this sky.
    fn under_this_sun(&self, view: &View, light: &[f32]) -> Vec<f64> {
        let solar = self.solar().into_iter().zip(view.solar_irradiance());
        light
            .iter()
            .zip(solar)
            .map(|(&light, (at, mean))| f64::from(light) * at / f64::from(mean))
            .collect()
    }

    /// Identifies the value at a direction and wavelength.
    pub fn at(&self, view_zenith_deg: f64, relative_azimuth_deg: f64, lane: usize) -> At {
        At {
            altitude_m: self.altitude_m,
            sun_zenith_deg: self.sun_zenith_deg,
            view_zenith_deg,
            relative_azimuth_deg,
            wavelength_nm: Some(self.wavelengths_nm[lane]),
            ..Default::default()
        }
    }
}

/// Radiance in a direction at each wavelength, W m^-2 sr^-1 nm^-1.
#[derive(Debug)]
pub struct Light {
    /// Single scattering.
    pub single: Vec<f64>,
    /// All orders, without the light of the ground that is seen.
    pub path: Vec<f64>,
    /// All orders.
    pub all: Vec<f64>,
}
