//! [`RadianceModel`]: the one interface through which light is requested from every solver and published model.
//!
//! A model is used in three steps, each of which does its own share of the work once:
//!
//! ```text
//! RadianceModel   --prepare(scene, suns, control)-->   PreparedModel   --view(altitude, sun, channels)-->   RadianceView
//! a registry entry                                     all suns of a sequence                              one eye, one sun
//! ```
//!
//! A [`RadianceView`] answers for many directions at once, into slices: values are interleaved,
//! [`RadianceView::channel_count`] values for each direction. Nothing here borrows: all three are
//! `Send + Sync + 'static` and can be kept behind an [`Arc`].

use super::{Capabilities, Channels, ResolvedScene, SceneError};
use crate::control::Control;
use crate::monte_carlo::{Estimate, PolarisedEstimate};
use crate::sky::{LineOfSight, SunCoverage};
use crate::spectrum::WavelengthGrid;
use crate::sun::{SunDisc, SunState};
use glam::DVec3;
use std::fmt::Debug;
use std::sync::Arc;

/// A way to compute the light of a scene: a solver or a published model.
pub trait RadianceModel: Debug + Send + Sync + 'static {
    /// Its name in scene files and on the command line, in kebab case.
    fn name(&self) -> &'static str;

    /// One sentence for help texts.
    fn summary(&self) -> &'static str;

    /// Which inputs it honours and which questions it answers.
    fn capabilities(&self) -> Capabilities;

    /// Does the work that all suns in `suns` share, followed and cancelled through `control`. Inputs of the scene that the
    /// model ignores have been refused before ([`check_inputs`](super::check_inputs)).
    ///
    /// # Errors
    /// [`SceneError`] for an input outside the model's domain, and where the caller cancelled
    /// ([`SceneError::is_cancelled`]).
    fn prepare(
        &self,
        scene: &ResolvedScene,
        suns: SunCoverage,
        control: Control<'_>,
    ) -> Result<Arc<dyn PreparedModel>, SceneError>;
}

/// A model prepared for a scene and a range of suns.
pub trait PreparedModel: Debug + Send + Sync + 'static {
    /// The wavelengths of its spectra; `None` for a model that knows colours only.
    fn grid(&self) -> Option<&WavelengthGrid>;

    /// Channels of the views in whose light objects are shaded, for a picture in `channels`.
    fn object_channels(&self, channels: Channels) -> Channels {
        channels
    }

    /// The light at an eye at an altitude (m above sea level) under a sun, in `channels`.
    ///
    /// # Errors
    /// [`SceneError`] for a sun, an altitude or channels outside the model's domain.
    fn view(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        channels: Channels,
    ) -> Result<Arc<dyn RadianceView>, SceneError>;
}

/// The light at one eye under one sun.
///
/// Radiances are in cd/m^2 of a linear RGB space (1, 1, 1 being 1 cd/m^2 of its white) or in W m^-2 sr^-1 nm^-1, irradiances
/// in lx or W m^-2 nm^-1, as [`Self::channels`] says. Directions are unit vectors that point away from the eye
/// ([`crate::axes`]); a zero vector stands for no direction and yields zero. Slices are interleaved:
/// `out.len() == directions.len() * channel_count()`.
pub trait RadianceView: Debug + Send + Sync + 'static {
    /// Meaning of the values.
    fn channels(&self) -> Channels;

    /// Wavelengths of a spectral view, under the sun's irradiance outside the air at its present distance; `None` for RGB.
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

    /// Size and limb darkening of the sun's disc at its present distance.
    fn disc(&self) -> &SunDisc;

    /// Elevation of the horizon, rad: below it the ground is seen.
    fn horizon_elevation_rad(&self) -> f64 {
        0.0
    }

    /// Whether pictures average over pixels that the horizon runs through. Published models are drawn as they were
    /// published, by the direction of a pixel's centre.
    fn averages_horizon(&self) -> bool {
        false
    }

    /// Radiance of sky, air, fog and ground without the sun's disc. Directions that are neighbours in a picture belong in
    /// one call: some models reuse what a neighbour needed, within the tolerance that they state.
    fn radiance(&self, directions: &[DVec3], out: &mut [f32]);

    /// A faster [`Self::radiance`] for pictures whose columns keep their azimuth and whose rows keep their elevation;
    /// `azimuths_rad` are those of the columns, clockwise from north. `None` for models without.
    fn row_sampler(&self, _azimuths_rad: &[f64]) -> Option<Box<dyn RowSampler>> {
        None
    }

    /// Radiance of the sun's disc as it arrives; zero beside the disc and behind the planet. Cheap enough for every point
    /// of a picture of the disc.
    fn sun_disc(&self, directions: &[DVec3], out: &mut [f32]);

    /// Irradiance of everything but the sun's disc, on surfaces at the eye with these unit normals: cheap enough for every
    /// pixel of a picture.
    fn irradiance(&self, normals: &[DVec3], out: &mut [f32]);

    /// The same on a level surface that faces up: integrated with more directions.
    fn horizontal_irradiance(&self, out: &mut [f32]);

    /// Irradiance of the sun's disc at the eye on a surface that faces it.
    fn sun_irradiance(&self, out: &mut [f32]);

    /// The same at a height above the ground (m) on the eye's vertical: what objects stand in.
    fn sunlight(&self, height_m: f64, out: &mut [f32]);

    /// Transmittance and path radiance between the eye and a point `distance_m` away (infinite: to the ground or space).
    /// Models that do not know the air before objects fill in clear air: 1 and 0.
    fn path(
        &self,
        direction: DVec3,
        distance_m: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    );

    /// The parts of the light along a ray at the model's wavelengths, over at most `limit_m` metres; `None` for models
    /// without [`Capabilities::parts`].
    fn line_of_sight(&self, _direction: DVec3, _limit_m: Option<f64>) -> Option<LineOfSight> {
        None
    }

    /// The estimator behind a view whose values are random, for progressive rendering; `None` for deterministic models.
    fn sampler(&self) -> Option<&dyn RadianceSampler> {
        None
    }
}

/// Radiance row by row for pictures whose columns keep their azimuth and whose rows keep their elevation.
pub trait RowSampler: Debug + Send + Sync {
    /// Radiance along a row of directions of one elevation, which have the azimuths that the sampler was made for.
    fn sample_row(&self, directions: &[DVec3], out: &mut [f32]);
}

/// Independent unbiased samples of radiance: how a Monte Carlo picture is accumulated pass by pass.
pub trait RadianceSampler: Debug + Send + Sync {
    /// Paths requested for each direction.
    fn paths(&self) -> u64;

    /// Adds the mean of one bundle of paths along a direction to `sum` (values as of [`RadianceView::radiance`]). Bundles
    /// of different numbers are independent; the same number always gives the same values.
    fn add_bundle(&self, direction: DVec3, bundle: u64, sum: &mut [f64]);

    /// The same with polarisation: adds the Stokes parameters I, Q and U of the bundle, weighted as luminance (cd/m^2), to
    /// `stokes`. `Q` is positive in the vertical plane through the ray.
    fn add_polarised_bundle(
        &self,
        direction: DVec3,
        bundle: u64,
        sum: &mut [f64],
        stokes: &mut [f64; 3],
    );

    /// Mean and standard error at each wavelength along a direction, over at most `limit_m` metres.
    fn estimate(&self, direction: DVec3, limit_m: Option<f64>) -> Estimate;

    /// The same with polarisation.
    fn polarised_estimate(&self, direction: DVec3, limit_m: Option<f64>) -> PolarisedEstimate;

    /// The same scene by a deterministic solver: for exposure and previews, and where noise must not be.
    fn preview(&self) -> Arc<dyn RadianceView>;
}
