//! Sun, sky and air of the scene in linear sRGB: cd/m^2 and lux.

use airlight::{
    axes,
    sky::{SkyTable, TableChannels, View},
    spectrum::RgbSpace,
};
use glam::DVec3;

/// Light on the ground and behind it.
pub struct Light {
    /// Unit vector towards the sun.
    pub sun: DVec3,
    /// Angle from the middle of the sun to its edge, rad.
    pub sun_radius: f64,
    /// Of the sun on a surface that faces it, lux, low and high in the scene.
    sun_illuminance: [DVec3; 2],
    /// Heights of those, metres above sea level.
    heights: [f64; 2],
    sky: SkyTable,
    /// Of sky and land around on a surface, lux, by the elevation and azimuth of its normal.
    illuminance: Vec<DVec3>,
}

/// Normals tabulated from the horizon to the zenith, and round.
const ELEVATIONS: usize = 10;
const AZIMUTHS: usize = 24;

impl Light {
    /// Tabulates the light of a view; `ends` are the lowest and highest ground's
    /// heights and the views from there.
    pub fn new(view: &View, ends: [(f64, View); 2]) -> Self {
        use rayon::prelude::*;
        let sky = view.table(TableChannels::Rgb(RgbSpace::Srgb));
        let illuminance = (0..ELEVATIONS * AZIMUTHS)
            .into_par_iter()
            .map(|i| {
                let azimuth = 360.0 * (i % AZIMUTHS) as f64 / AZIMUTHS as f64;
                let elevation = 90.0 * (i / AZIMUTHS) as f64 / (ELEVATIONS - 1) as f64;
                let e = sky.irradiance(axes::direction(azimuth, elevation));
                DVec3::from_array([0, 1, 2].map(|c| f64::from(e[c])))
            })
            .collect();
        Self {
            sun: view.sun(),
            sun_radius: view.disc().angular_radius_rad,
            sun_illuminance: ends
                .each_ref()
                .map(|(_, view)| rgb(view, &view.sun_irradiance())),
            heights: ends.map(|(height, _)| height),
            sky,
            illuminance,
        }
    }

    /// Of the sun on a surface that faces it at a height above sea level, lux.
    pub fn sun_illuminance(&self, height: f64) -> DVec3 {
        let [low, high] = self.heights;
        let t = ((height - low) / (high - low)).clamp(0.0, 1.0);
        self.sun_illuminance[0].lerp(self.sun_illuminance[1], t)
    }

    /// Of sky and land on a surface with this normal, lux.
    pub fn sky_illuminance(&self, normal: DVec3) -> DVec3 {
        let elevation = axes::elevation_deg(normal).max(0.0) / 90.0 * (ELEVATIONS - 1) as f64;
        let azimuth = axes::azimuth_deg(normal) / 360.0 * AZIMUTHS as f64;
        let row = (elevation as usize).min(ELEVATIONS - 2);
        let column = azimuth as usize % AZIMUTHS;
        let next = (column + 1) % AZIMUTHS;
        let line = |row: usize| {
            let values = &self.illuminance[row * AZIMUTHS..][..AZIMUTHS];
            values[column].lerp(values[next], azimuth - azimuth.floor())
        };
        line(row).lerp(line(row + 1), elevation - row as f64)
    }

    /// Luminance of the sky in a direction, without the sun's disc, cd/m^2.
    pub fn sky(&self, direction: DVec3) -> DVec3 {
        let mut rgb = [0.0; 3];
        self.sky.sample(direction, &mut rgb);
        DVec3::from_array(rgb.map(f64::from))
    }
}

/// Linear sRGB of a spectrum on the grid of the view's sky.
pub fn rgb(view: &View, spectrum: &[f32]) -> DVec3 {
    DVec3::from_array(RgbSpace::Srgb.from_xyz(view.sky().grid().to_xyz(spectrum)))
}
