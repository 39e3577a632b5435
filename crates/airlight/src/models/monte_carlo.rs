//! The solver `monte-carlo`: path tracing, without approximation.

use super::orders::PreparedOrders;
use crate::atmosphere::Atmosphere;
use crate::control::{Cancelled, Control};
use crate::math::parallel;
use crate::monte_carlo::{
    Estimate, MonteCarlo, MonteCarloSettings, ORDERS, PolarisedEstimate, SunShape,
};
use crate::scene::{
    Capabilities, Channels, Input, PreparedModel, RadianceModel, RadianceSampler, RadianceView,
    ResolvedScene, SceneError, SolvedView, SunState,
};
use crate::sky::{LineOfSight, Scattering, SunCoverage};
use crate::spectrum::WavelengthGrid;
use crate::sun::SunDisc;
use glam::DVec3;
use std::sync::Arc;

/// Default number of paths for each direction.
const PATHS: u64 = 256;

/// Monte Carlo path tracing as a [`RadianceModel`]: no approximation, slow, with noise of known size.
///
/// Radiance has noise; irradiances and the sun's disc are those of [`Orders`](super::orders::Orders).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct MonteCarloModel;

impl RadianceModel for MonteCarloModel {
    fn name(&self) -> &'static str {
        "monte-carlo"
    }

    fn summary(&self) -> &'static str {
        "Monte Carlo (path tracing): no approximation, slow, with noise of known size"
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
                Input::Fog,
                Input::Wavelengths,
                Input::Scattering,
                Input::PolarisationCorrection,
                Input::Paths,
                Input::NoiseMap,
                Input::Polarisation,
                Input::Spectra,
                Input::Distances,
            ],
            variants: &[],
            twilight: true,
            parts: true,
        }
    }

    fn prepare(
        &self,
        scene: &ResolvedScene,
        suns: SunCoverage,
        control: Control<'_>,
    ) -> Result<Arc<dyn PreparedModel>, SceneError> {
        let solver = &scene.solver;
        let scattering = solver.scattering.unwrap_or(Scattering::All);
        if scattering == Scattering::Single && scene.set_inputs.contains(&Input::Polarisation) {
            return Err(SceneError::value(
                "output.polarisation",
                "all orders of scattering",
                "scattering = \"single\"",
                "leaving it out",
            ));
        }
        let settings = MonteCarloSettings {
            paths: solver.paths.unwrap_or(PATHS),
            seed: solver.seed.unwrap_or(1),
            sun: SunShape::Disc,
        };
        let mut atmosphere = scene.atmosphere.clone();
        let ground_m = atmosphere.planet.ground_altitude_m;
        if let Some(fog) = &scene.fog {
            let layers = fog.in_air(ground_m, scene.grid.wavelengths_nm(), control)?;
            atmosphere.constituents.extend(layers);
        }
        // Check the air before solving for the preview.
        MonteCarlo::new(&atmosphere, &scene.grid, settings)?;
        Ok(Arc::new(PreparedMonteCarlo {
            polarised: solver.polarisation_correction.unwrap_or(true)
                && scattering == Scattering::All
                && polarises(&atmosphere),
            preview: PreparedOrders::new(scene, &solver.sky_settings(suns), control)?,
            atmosphere,
            settings,
            orders: match scattering {
                Scattering::All => ORDERS,
                Scattering::Single => 1,
            },
        }))
    }
}

/// True if a constituent is known to polarise the light that it scatters.
fn polarises(atmosphere: &Atmosphere) -> bool {
    let mut constituents = atmosphere.constituents.iter();
    constituents.any(|part| part.phase.knows_polarisation())
}

/// Air with fog for path tracing, and its deterministic solution.
#[derive(Debug)]
struct PreparedMonteCarlo {
    preview: PreparedOrders,
    atmosphere: Atmosphere,
    settings: MonteCarloSettings,
    /// Whether light is polarised by scattering.
    polarised: bool,
    /// Number of orders of scattering that are summed.
    orders: usize,
}

impl PreparedModel for PreparedMonteCarlo {
    fn grid(&self) -> Option<&WavelengthGrid> {
        self.preview.grid()
    }

    fn view_with(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<Arc<dyn RadianceView>, SceneError> {
        let preview = self
            .preview
            .solved_view(observer_altitude_m, sun, channels, control)?;
        let grid = preview.sky_view().sky().grid();
        let air = self.atmosphere.under(sun);
        let weights = match channels {
            Channels::Rgb(space) => grid.rgb_weights(space),
            Channels::Spectral => Vec::new(),
        };
        Ok(Arc::new(MonteCarloView {
            paths: MonteCarlo::new(&air, grid, self.settings)?,
            eye_altitude_m: observer_altitude_m,
            weights,
            polarised: self.polarised,
            orders: self.orders,
            preview: Arc::new(preview),
        }))
    }
}

/// View of one eye under one sun by path tracing.
#[derive(Debug)]
struct MonteCarloView {
    /// Path tracer with the solar irradiance at the sun's distance.
    paths: MonteCarlo,
    eye_altitude_m: f64,
    /// Weights of the wavelengths in red, green and blue; empty for spectral values.
    weights: Vec<[f32; 3]>,
    /// Whether light is polarised by scattering.
    polarised: bool,
    orders: usize,
    preview: Arc<SolvedView>,
}

impl MonteCarloView {
    /// Adds radiance at each wavelength to the values of a direction.
    fn put(&self, radiance: impl Iterator<Item = f64>, sum: &mut [f64]) {
        match self.weights.is_empty() {
            true => sum.iter_mut().zip(radiance).for_each(|(sum, v)| *sum += v),
            false => {
                let mut rgb = [0.0; 3];
                for (radiance, weights) in radiance.zip(&self.weights) {
                    for (c, weight) in rgb.iter_mut().zip(weights) {
                        *c += f64::from(*weight) * radiance;
                    }
                }
                sum.iter_mut().zip(rgb).for_each(|(sum, v)| *sum += v);
            }
        }
    }

    /// The limit if the ray reaches it before the ground; otherwise `None`, so that light of the ground is included.
    fn limit_before_ground(&self, direction: DVec3, limit_m: Option<f64>) -> Option<f64> {
        limit_m.filter(|_| {
            !self
                .preview
                .sky_view()
                .along(direction, limit_m)
                .meets_ground
        })
    }
}

impl RadianceView for MonteCarloView {
    fn channels(&self) -> Channels {
        self.preview.channels()
    }

    fn grid(&self) -> Option<&WavelengthGrid> {
        RadianceView::grid(self.preview.as_ref())
    }

    fn sun(&self) -> DVec3 {
        RadianceView::sun(self.preview.as_ref())
    }

    fn disc(&self) -> &SunDisc {
        RadianceView::disc(self.preview.as_ref())
    }

    fn horizon_elevation_rad(&self) -> f64 {
        self.preview.horizon_elevation_rad()
    }

    /// Mean over all paths of each direction.
    fn radiance(&self, directions: &[DVec3], out: &mut [f32]) {
        self.radiance_with(directions, out, Control::default())
            .expect("nothing cancels it");
    }

    fn radiance_with(
        &self,
        directions: &[DVec3],
        out: &mut [f32],
        control: Control<'_>,
    ) -> Result<(), Cancelled> {
        let count = self.channel_count();
        parallel::try_for_each_chunk(out, count, |i, out| {
            let mut sum = vec![0.0; count];
            if directions[i] != DVec3::ZERO {
                let estimate = self.estimate_with(directions[i], None, control)?;
                self.put(estimate.mean.into_iter(), &mut sum);
            }
            out.iter_mut()
                .zip(sum)
                .for_each(|(out, sum)| *out = sum as f32);
            Ok(())
        })
    }

    fn sun_disc(&self, directions: &[DVec3], out: &mut [f32]) {
        self.preview.sun_disc(directions, out);
    }

    fn irradiance(&self, normals: &[DVec3], out: &mut [f32]) {
        self.preview.irradiance(normals, out);
    }

    fn horizontal_irradiance(&self, out: &mut [f32]) {
        self.preview.horizontal_irradiance(out);
    }

    fn sun_irradiance(&self, out: &mut [f32]) {
        self.preview.sun_irradiance(out);
    }

    fn sunlight(&self, height_m: f64, out: &mut [f32]) {
        self.preview.sunlight(height_m, out);
    }

    /// Path radiance by path tracing, transmittance without noise.
    fn path(
        &self,
        direction: DVec3,
        distance_m: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        let out = (transmittance, path_radiance);
        self.path_with(direction, distance_m, out, Control::default())
            .expect("nothing cancels it");
    }

    fn path_with(
        &self,
        direction: DVec3,
        distance_m: f64,
        (transmittance, path_radiance): (&mut [f32], &mut [f32]),
        control: Control<'_>,
    ) -> Result<(), Cancelled> {
        self.preview
            .path(direction, distance_m, transmittance, path_radiance);
        if distance_m.is_finite() {
            let mut sum = vec![0.0; path_radiance.len()];
            let estimate = self.estimate_with(direction, Some(distance_m), control)?;
            self.put(estimate.mean.into_iter(), &mut sum);
            path_radiance
                .iter_mut()
                .zip(sum)
                .for_each(|(out, sum)| *out = sum as f32);
        }
        Ok(())
    }

    fn line_of_sight(&self, direction: DVec3, limit_m: Option<f64>) -> Option<LineOfSight> {
        self.preview.line_of_sight(direction, limit_m)
    }

    fn sampler(&self) -> Option<&dyn RadianceSampler> {
        Some(self)
    }
}

impl RadianceSampler for MonteCarloView {
    fn paths(&self) -> u64 {
        self.paths.settings().paths
    }

    fn add_bundle(&self, direction: DVec3, bundle: u64, sum: &mut [f64]) {
        if self.polarised {
            return self.add_polarised_bundle(direction, bundle, sum, &mut [0.0; 3]);
        }
        let sun = RadianceView::sun(self);
        let sample = self
            .paths
            .sample(self.eye_altitude_m, sun, direction, bundle);
        let orders = &sample[..self.orders];
        let lanes = self.paths.grid().len();
        let radiance = (0..lanes).map(|lane| orders.iter().map(|order| order[lane]).sum());
        self.put(radiance, sum);
    }

    fn add_polarised_bundle(
        &self,
        direction: DVec3,
        bundle: u64,
        sum: &mut [f64],
        stokes: &mut [f64; 3],
    ) {
        let (eye_m, sun) = (self.eye_altitude_m, RadianceView::sun(self));
        let sample = self
            .paths
            .sample_polarised(eye_m, sun, direction, None, bundle);
        for (lane, weights) in self.paths.grid().xyz_weights().iter().enumerate() {
            for (sum, part) in stokes.iter_mut().zip(&sample.stokes) {
                *sum += weights[1] * part[lane];
            }
        }
        let [intensity, _, _] = sample.stokes;
        self.put(intensity.into_iter(), sum);
    }

    fn estimate_with(
        &self,
        direction: DVec3,
        limit_m: Option<f64>,
        control: Control<'_>,
    ) -> Result<Estimate, Cancelled> {
        if self.polarised {
            let polarised = self.polarised_estimate_with(direction, limit_m, control)?;
            return Ok(polarised.radiance());
        }
        let (eye_m, sun) = (self.eye_altitude_m, RadianceView::sun(self));
        let paths = &self.paths;
        let found = match self.limit_before_ground(direction, limit_m) {
            Some(limit_m) => paths.path_radiance_with(eye_m, sun, direction, limit_m, control)?,
            None => paths.radiance_with(eye_m, sun, direction, control)?,
        };
        Ok(match self.orders {
            1 => found.first_order(),
            _ => found,
        })
    }

    fn polarised_estimate_with(
        &self,
        direction: DVec3,
        limit_m: Option<f64>,
        control: Control<'_>,
    ) -> Result<PolarisedEstimate, Cancelled> {
        let (eye_m, sun) = (self.eye_altitude_m, RadianceView::sun(self));
        let limit_m = self.limit_before_ground(direction, limit_m);
        self.paths
            .polarised_with(eye_m, sun, direction, limit_m, control)
    }

    fn preview(&self) -> Arc<dyn RadianceView> {
        self.preview.clone()
    }
}
