//! [`RadianceModel`]: the interface of all solvers and published models.
//!
//! A model is used in three steps, each of which computes what later steps share:
//!
//! ```text
//! RadianceModel   --prepare(scene, suns, control)-->   PreparedModel   --view(altitude, sun, channels)-->   RadianceView
//! a registry entry                                     all suns of a sequence                              one eye, one sun
//! ```
//!
//! A [`RadianceView`] evaluates many directions at once and writes interleaved values, [`RadianceView::channel_count`] for
//! each direction. All three traits are `Send + Sync + 'static`, so that implementations can be stored in an [`Arc`].

use super::{Capabilities, Channels, FogLayers, ResolvedScene, SceneError};
use crate::axes;
use crate::control::{Cancelled, Control};
use crate::monte_carlo::{Estimate, PolarisedEstimate};
use crate::night::NightState;
use crate::sky::{LineOfSight, PolarisationTable, PolarisedLight, SunCoverage};
use crate::spectrum::WavelengthGrid;
use crate::sun::{SunDisc, SunState};
use glam::DVec3;
use std::fmt::Debug;
use std::sync::Arc;

/// A solver or a published model, which computes the light of a scene.
pub trait RadianceModel: Debug + Send + Sync + 'static {
    /// Name in scene files and on the command line, in kebab case.
    fn name(&self) -> &'static str;

    /// Description in one line, for help texts.
    fn summary(&self) -> &'static str;

    /// The inputs that the model honours and the results that it provides.
    fn capabilities(&self) -> Capabilities;

    /// Computes what all suns in `suns` share. `control` reports progress and cancels. The caller must have refused inputs
    /// that the model ignores ([`check_inputs`](super::check_inputs)).
    ///
    /// # Errors
    /// [`SceneError`] for an input outside the model's domain, and if the caller cancelled ([`SceneError::is_cancelled`]).
    fn prepare(
        &self,
        scene: &ResolvedScene,
        suns: SunCoverage,
        control: Control<'_>,
    ) -> Result<Arc<dyn PreparedModel>, SceneError>;
}

/// A model prepared for a scene and a range of suns.
pub trait PreparedModel: Debug + Send + Sync + 'static {
    /// Wavelengths of the model's spectra; `None` for a model without spectra.
    fn grid(&self) -> Option<&WavelengthGrid>;

    /// Channels of the view that lights objects, for a picture in `channels`.
    fn object_channels(&self, channels: Channels) -> Channels {
        channels
    }

    /// The light for an eye at an altitude (m above sea level) under a sun, in `channels`.
    ///
    /// # Errors
    /// [`SceneError`] for a sun, an altitude or channels outside the model's domain.
    fn view(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        channels: Channels,
    ) -> Result<Arc<dyn RadianceView>, SceneError> {
        self.view_with(observer_altitude_m, sun, channels, Control::default())
    }

    /// As [`PreparedModel::view`], with cancellation.
    ///
    /// # Errors
    /// As [`PreparedModel::view`], and if the caller cancelled.
    fn view_with(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<Arc<dyn RadianceView>, SceneError>;

    /// As [`PreparedModel::view_with`], for a few rays: a view that tabulates nothing where that takes longer than the rays.
    ///
    /// # Errors
    /// As [`PreparedModel::view_with`].
    fn view_of_rays_with(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<Arc<dyn RadianceView>, SceneError> {
        self.view_with(observer_altitude_m, sun, channels, control)
    }

    /// As [`PreparedModel::view`], with the lights of the night. Models without
    /// [`Input::Night`](super::Input::Night), and those prepared for daylight only, return the view without them.
    ///
    /// # Errors
    /// As [`PreparedModel::view`].
    fn night_view(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        night: &NightState,
        channels: Channels,
    ) -> Result<Arc<dyn RadianceView>, SceneError> {
        let control = Control::default();
        self.night_view_with(observer_altitude_m, sun, night, channels, control)
    }

    /// As [`PreparedModel::night_view`], with cancellation.
    ///
    /// # Errors
    /// As [`PreparedModel::view_with`].
    fn night_view_with(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        _night: &NightState,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<Arc<dyn RadianceView>, SceneError> {
        self.view_with(observer_altitude_m, sun, channels, control)
    }

    /// The same air with another fog, as if it had been prepared with it; `None` for models that cannot exchange their fog.
    fn with_fog(&self, _fog: Option<&FogLayers>) -> Option<Arc<dyn PreparedModel>> {
        None
    }
}

/// Stars as points of light, in the channels of a view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StarField {
    /// Unit vectors towards the stars.
    pub directions: Vec<DVec3>,
    /// Irradiance of each star at the eye on a surface that faces it: one value for each channel, star by star.
    pub irradiance: Vec<f32>,
}

/// The light for one eye under one sun.
///
/// Depending on [`Self::channels`], radiances are in cd/m^2 of a linear RGB space (1, 1, 1 is 1 cd/m^2 of its white) or in
/// W m^-2 sr^-1 nm^-1, and irradiances in lx or W m^-2 nm^-1. Directions are unit vectors that point away from the eye
/// ([`crate::axes`]); a zero vector is no direction and yields zero. Slices are interleaved:
/// `out.len() == directions.len() * channel_count()`.
pub trait RadianceView: Debug + Send + Sync + 'static {
    /// Meaning of the values.
    fn channels(&self) -> Channels;

    /// Wavelengths of a spectral view, with the solar irradiance outside the air at the sun's distance; `None` for RGB.
    fn grid(&self) -> Option<&WavelengthGrid>;

    /// Number of values for each direction.
    fn channel_count(&self) -> usize {
        self.grid().map_or(3, WavelengthGrid::len)
    }

    /// Luminance (cd/m^2) or illuminance (lx) of the values of one direction.
    fn luminance(&self, values: &[f32]) -> f64 {
        match (self.channels(), self.grid(), values) {
            (Channels::Spectral, Some(grid), spectrum) => grid.to_xyz(spectrum)[1],
            (Channels::Rgb(space), _, &[r, g, b]) => space.luminance([r, g, b].map(f64::from)),
            _ => 0.0,
        }
    }

    /// Unit vector towards the sun's centre.
    fn sun(&self) -> DVec3;

    /// Size and limb darkening of the sun's disc at the sun's distance.
    fn disc(&self) -> &SunDisc;

    /// The view lit by the moon alone, as by a second sun: its [`RadianceView::sun_disc`] is the moon's disc and its
    /// [`RadianceView::sunlight`] direct moonlight. Its radiance is part of this view's. `None` without a moon.
    fn moon(&self) -> Option<&Arc<dyn RadianceView>> {
        None
    }

    /// Single stars, which are not part of the radiance; `None` without stars.
    fn stars(&self) -> Option<&StarField> {
        None
    }

    /// Elevation of the horizon, rad; the ground is visible below it.
    fn horizon_elevation_rad(&self) -> f64 {
        0.0
    }

    /// Whether pictures average over pixels that the horizon crosses. Published models are evaluated at the centre of each
    /// pixel only, as published.
    fn averages_horizon(&self) -> bool {
        false
    }

    /// Radiance of sky, air, fog and ground without the sun's disc. Pass neighbouring directions of a picture in one call:
    /// some models reuse results of neighbours, within the tolerance that they document.
    fn radiance(&self, directions: &[DVec3], out: &mut [f32]);

    /// As [`Self::radiance`], with cancellation, for views that take long for one direction.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn radiance_with(
        &self,
        directions: &[DVec3],
        out: &mut [f32],
        control: Control<'_>,
    ) -> Result<(), Cancelled> {
        control.check()?;
        self.radiance(directions, out);
        Ok(())
    }

    /// A faster [`Self::radiance`] for pictures with constant azimuth in each column and constant elevation in each row;
    /// `azimuths_rad` are those of the columns, clockwise from north. `None` if the model has none.
    fn row_sampler(&self, _azimuths_rad: &[f64]) -> Option<Box<dyn RowSampler>> {
        None
    }

    /// Radiance of the sun's disc at the eye; zero outside the disc and behind the planet. Cheap enough for every sample of a
    /// picture of the disc.
    fn sun_disc(&self, directions: &[DVec3], out: &mut [f32]);

    /// Irradiance of surfaces at the eye with these unit normals, by all light except the sun's disc. Cheap enough for every
    /// pixel of a picture.
    fn irradiance(&self, normals: &[DVec3], out: &mut [f32]);

    /// The same for an upward-facing horizontal surface, integrated over more directions.
    fn horizontal_irradiance(&self, out: &mut [f32]);

    /// Irradiance of the sun's disc at the eye on a surface that faces it.
    fn sun_irradiance(&self, out: &mut [f32]);

    /// The same at a height above the ground (m) on the vertical through the eye, for objects.
    fn sunlight(&self, height_m: f64, out: &mut [f32]);

    /// Transmittance and path radiance between the eye and a point `distance_m` away (infinite: to the ground or space).
    /// Models without [`Input::Distances`](super::Input::Distances) write 1 and 0.
    fn path(
        &self,
        direction: DVec3,
        distance_m: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    );

    /// As [`Self::path`], with cancellation, for views that take long for one direction.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn path_with(
        &self,
        direction: DVec3,
        distance_m: f64,
        (transmittance, path_radiance): (&mut [f32], &mut [f32]),
        control: Control<'_>,
    ) -> Result<(), Cancelled> {
        control.check()?;
        self.path(direction, distance_m, transmittance, path_radiance);
        Ok(())
    }

    /// Light along a ray by parts, at the model's wavelengths, over at most `limit_m` metres; `None` for models without
    /// [`Capabilities::parts`].
    fn line_of_sight(&self, _direction: DVec3, _limit_m: Option<f64>) -> Option<LineOfSight> {
        None
    }

    /// Light along a whole ray with its polarisation, at the model's wavelengths; `None` for models that do not compute it.
    fn polarised(&self, _direction: DVec3) -> Option<PolarisedLight> {
        None
    }

    /// Linear polarisation in all directions, for pictures; `None` for models that do not compute it without noise.
    fn polarisation_table(&self) -> Option<PolarisationTable> {
        None
    }

    /// The estimator of a Monte Carlo view, for progressive rendering; `None` for deterministic models.
    fn sampler(&self) -> Option<&dyn RadianceSampler> {
        None
    }
}

/// Radiance by rows for pictures with constant azimuth in each column and constant elevation in each row.
pub trait RowSampler: Debug + Send + Sync {
    /// Radiance at an elevation (rad) and the azimuths for which the sampler was created.
    fn sample_row(&self, elevation_rad: f64, out: &mut [f32]);
}

/// Directions of rows with constant azimuth in each column, for samplers of what varies in any direction.
#[derive(Debug)]
pub(super) struct RowDirections {
    /// Sine and cosine of the azimuth of each column.
    azimuths: Vec<(f64, f64)>,
}

impl RowDirections {
    pub(super) fn new(azimuths_rad: &[f64]) -> Self {
        Self {
            azimuths: azimuths_rad
                .iter()
                .map(|azimuth| azimuth.sin_cos())
                .collect(),
        }
    }

    /// The directions of a row at an elevation (rad).
    pub(super) fn at(&self, elevation_rad: f64) -> impl Iterator<Item = DVec3> {
        let elevation = elevation_rad.sin_cos();
        let azimuths = self.azimuths.iter();
        azimuths.map(move |&azimuth| axes::from_sines(azimuth, elevation))
    }
}

/// Independent unbiased samples of radiance, from which a Monte Carlo picture is accumulated in passes.
pub trait RadianceSampler: Debug + Send + Sync {
    /// Number of paths requested for each direction.
    fn paths(&self) -> u64;

    /// Adds the mean of one bundle of paths along a direction to `sum` (units of [`RadianceView::radiance`]). Bundles with
    /// different numbers are independent; the same number always gives the same values.
    fn add_bundle(&self, direction: DVec3, bundle: u64, sum: &mut [f64]);

    /// [`Self::add_bundle`] with polarisation: adds the Stokes parameters I, Q and U of the bundle, weighted as luminance
    /// (cd/m^2), to `stokes`. `Q` is positive for polarisation in the vertical plane through the ray.
    fn add_polarised_bundle(
        &self,
        direction: DVec3,
        bundle: u64,
        sum: &mut [f64],
        stokes: &mut [f64; 3],
    );

    /// Mean and standard error at each wavelength along a direction, over at most `limit_m` metres.
    fn estimate(&self, direction: DVec3, limit_m: Option<f64>) -> Estimate {
        self.estimate_with(direction, limit_m, Control::default())
            .expect("nothing cancels it")
    }

    /// As [`Self::estimate`], with cancellation.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn estimate_with(
        &self,
        direction: DVec3,
        limit_m: Option<f64>,
        control: Control<'_>,
    ) -> Result<Estimate, Cancelled>;

    /// [`Self::estimate`] with polarisation.
    fn polarised_estimate(&self, direction: DVec3, limit_m: Option<f64>) -> PolarisedEstimate {
        self.polarised_estimate_with(direction, limit_m, Control::default())
            .expect("nothing cancels it")
    }

    /// As [`Self::polarised_estimate`], with cancellation.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn polarised_estimate_with(
        &self,
        direction: DVec3,
        limit_m: Option<f64>,
        control: Control<'_>,
    ) -> Result<PolarisedEstimate, Cancelled>;

    /// A view of the same scene by a deterministic solver, for exposure, previews and quantities that must be free of noise.
    fn preview(&self) -> Arc<dyn RadianceView>;
}
