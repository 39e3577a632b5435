//! [`NightView`]: sunlight, moonlight and the glow of the night sky together.

use super::glow_view::GlowView;
use super::model::{RowDirections, StarField};
use super::{Channels, RadianceView, RowSampler, SolvedView};
use crate::math::slices::accumulate;
use crate::spectrum::WavelengthGrid;
use crate::sun::SunDisc;
use glam::DVec3;
use std::fmt;
use std::sync::Arc;

/// A sky by night: the sum of the light of the sun, of the moon and of the diffuse lights of the night. Light adds up, so each is
/// solved for by itself.
pub(crate) struct NightView {
    sunlit: SolvedView,
    moonlit: Option<Arc<dyn RadianceView>>,
    glow: Arc<GlowView>,
    stars: Option<StarField>,
}

impl NightView {
    pub(super) fn new(
        sunlit: SolvedView,
        moonlit: Option<Arc<dyn RadianceView>>,
        glow: GlowView,
        stars: Option<StarField>,
    ) -> Self {
        Self {
            sunlit,
            moonlit,
            glow: Arc::new(glow),
            stars,
        }
    }

    /// Adds the values that `fill` computes for the moonlit view.
    fn add_moonlit(&self, out: &mut [f32], fill: impl FnOnce(&dyn RadianceView, &mut [f32])) {
        if let Some(moonlit) = &self.moonlit {
            let mut values = vec![0.0; out.len()];
            fill(moonlit.as_ref(), &mut values);
            accumulate(&values, out);
        }
    }
}

impl RadianceView for NightView {
    fn channels(&self) -> Channels {
        RadianceView::channels(&self.sunlit)
    }

    fn grid(&self) -> Option<&WavelengthGrid> {
        self.sunlit.grid()
    }

    fn sun(&self) -> DVec3 {
        self.sunlit.sun()
    }

    fn disc(&self) -> &SunDisc {
        self.sunlit.disc()
    }

    fn moon(&self) -> Option<&Arc<dyn RadianceView>> {
        self.moonlit.as_ref()
    }

    fn stars(&self) -> Option<&StarField> {
        self.stars.as_ref()
    }

    fn horizon_elevation_rad(&self) -> f64 {
        self.sunlit.horizon_elevation_rad()
    }

    fn averages_horizon(&self) -> bool {
        true
    }

    fn radiance(&self, directions: &[DVec3], out: &mut [f32]) {
        self.sunlit.radiance(directions, out);
        self.add_moonlit(out, |moonlit, values| moonlit.radiance(directions, values));
        self.glow.add_to(directions.iter().copied(), out);
    }

    fn row_sampler(&self, azimuths_rad: &[f64]) -> Option<Box<dyn RowSampler>> {
        let sunlit = self.sunlit.row_sampler(azimuths_rad)?;
        let moonlit = match &self.moonlit {
            Some(moonlit) => Some(moonlit.row_sampler(azimuths_rad)?),
            None => None,
        };
        Some(Box::new(NightRows {
            sunlit,
            moonlit,
            glow: self.glow.clone(),
            directions: RowDirections::new(azimuths_rad),
        }))
    }

    fn sun_disc(&self, directions: &[DVec3], out: &mut [f32]) {
        self.sunlit.sun_disc(directions, out);
    }

    fn irradiance(&self, normals: &[DVec3], out: &mut [f32]) {
        self.sunlit.irradiance(normals, out);
        self.add_moonlit(out, |moonlit, values| moonlit.irradiance(normals, values));
        let values = out.chunks_exact_mut(self.channel_count());
        for (&normal, values) in normals.iter().zip(values) {
            self.glow.add_irradiance(normal, values);
        }
    }

    fn horizontal_irradiance(&self, out: &mut [f32]) {
        self.sunlit.horizontal_irradiance(out);
        self.add_moonlit(out, |moonlit, values| moonlit.horizontal_irradiance(values));
        let mut glow = vec![0.0; out.len()];
        self.glow.horizontal_irradiance(&mut glow);
        accumulate(&glow, out);
    }

    fn sun_irradiance(&self, out: &mut [f32]) {
        self.sunlit.sun_irradiance(out);
    }

    fn sunlight(&self, height_m: f64, out: &mut [f32]) {
        self.sunlit.sunlight(height_m, out);
    }

    fn path(
        &self,
        direction: DVec3,
        distance_m: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        self.sunlit
            .path(direction, distance_m, transmittance, path_radiance);
        let mut light = vec![0.0; transmittance.len()];
        if let Some(moonlit) = &self.moonlit {
            let mut same = vec![0.0; transmittance.len()];
            moonlit.path(direction, distance_m, &mut same, &mut light);
            accumulate(&light, path_radiance);
        }
        let [air, whole] = [distance_m, f64::INFINITY].map(|distance_m| {
            let mut air = vec![0.0; transmittance.len()];
            self.sunlit
                .air_transmittance(direction, distance_m, &mut air);
            air
        });
        let through = match self.sunlit.fog() {
            Some(fog) => fog.transmittance_to(direction, distance_m),
            None => 1.0,
        };
        light.fill(0.0);
        self.glow
            .add_path_radiance(direction, &air, &whole, &mut light);
        for (sum, light) in path_radiance.iter_mut().zip(light) {
            *sum += through * light;
        }
    }
}

impl fmt::Debug for NightView {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("NightView")
            .field("sunlit", &self.sunlit)
            .field("moonlit", &self.moonlit)
            .finish_non_exhaustive()
    }
}

/// Row sampler of a night sky.
#[derive(Debug)]
struct NightRows {
    sunlit: Box<dyn RowSampler>,
    moonlit: Option<Box<dyn RowSampler>>,
    glow: Arc<GlowView>,
    directions: RowDirections,
}

impl RowSampler for NightRows {
    fn sample_row(&self, elevation_rad: f64, out: &mut [f32]) {
        self.sunlit.sample_row(elevation_rad, out);
        if let Some(moonlit) = &self.moonlit {
            let mut values = vec![0.0; out.len()];
            moonlit.sample_row(elevation_rad, &mut values);
            accumulate(&values, out);
        }
        self.glow.add_to(self.directions.at(elevation_rad), out);
    }
}
