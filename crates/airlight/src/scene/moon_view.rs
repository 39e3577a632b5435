//! [`MoonView`]: a view lit by the moon.

use super::{Channels, RadianceView, RowSampler, SolvedView};
use crate::night::MoonState;
use crate::sky::LineOfSight;
use crate::spectrum::WavelengthGrid;
use crate::sun::SunDisc;
use glam::DVec3;

/// A view lit by the moon as a second sun, whose disc shows its phase.
#[derive(Debug)]
pub(super) struct MoonView {
    lit: SolvedView,
    moon: MoonState,
}

impl MoonView {
    /// A view that is solved under the moon's light.
    pub fn new(lit: SolvedView, moon: MoonState) -> Self {
        Self { lit, moon }
    }
}

impl RadianceView for MoonView {
    fn channels(&self) -> Channels {
        RadianceView::channels(&self.lit)
    }

    fn grid(&self) -> Option<&WavelengthGrid> {
        self.lit.grid()
    }

    fn sun(&self) -> DVec3 {
        self.lit.sun()
    }

    fn disc(&self) -> &SunDisc {
        self.lit.disc()
    }

    fn horizon_elevation_rad(&self) -> f64 {
        self.lit.horizon_elevation_rad()
    }

    fn averages_horizon(&self) -> bool {
        true
    }

    fn radiance(&self, directions: &[DVec3], out: &mut [f32]) {
        self.lit.radiance(directions, out);
    }

    fn row_sampler(&self, azimuths_rad: &[f64]) -> Option<Box<dyn RowSampler>> {
        self.lit.row_sampler(azimuths_rad)
    }

    fn sun_disc(&self, directions: &[DVec3], out: &mut [f32]) {
        self.lit.sun_disc(directions, out);
        let values = out.chunks_exact_mut(self.channel_count());
        for (&direction, values) in directions.iter().zip(values) {
            // Refraction moves the disc by more than its size near the horizon, but hardly turns it.
            let relative = self.moon.relative_radiance(direction) as f32;
            values.iter_mut().for_each(|v| *v *= relative);
        }
    }

    fn irradiance(&self, normals: &[DVec3], out: &mut [f32]) {
        self.lit.irradiance(normals, out);
    }

    fn horizontal_irradiance(&self, out: &mut [f32]) {
        self.lit.horizontal_irradiance(out);
    }

    fn sun_irradiance(&self, out: &mut [f32]) {
        self.lit.sun_irradiance(out);
    }

    fn sunlight(&self, height_m: f64, out: &mut [f32]) {
        self.lit.sunlight(height_m, out);
    }

    fn path(
        &self,
        direction: DVec3,
        distance_m: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        self.lit
            .path(direction, distance_m, transmittance, path_radiance);
    }

    fn line_of_sight(&self, direction: DVec3, limit_m: Option<f64>) -> Option<LineOfSight> {
        self.lit.line_of_sight(direction, limit_m)
    }
}
