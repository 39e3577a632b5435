//! Radiance of the sun's disc, tabulated for pictures.

use super::Channels;
use crate::axes;
use crate::math::interpolation::bilinear;
use crate::sky::View;
use glam::DVec3;

/// Numbers of elevations and of cosines of the emission angle at which the disc's radiance is tabulated.
const ELEVATIONS: usize = 129;
const COSINES: usize = 65;

/// Radiance of the sun's disc of a view, with bilinear interpolation in elevation (for the air's transmittance) and in the
/// cosine of the emission angle on the sun (for limb darkening).
#[derive(Debug)]
pub(super) struct SunDiscTable {
    sun: DVec3,
    radius_rad: f64,
    /// Lowest and highest elevation, rad; the lowest is at or above the horizon.
    elevations: (f64, f64),
    channels: usize,
    /// `[elevation][cosine][channel]`.
    values: Vec<f32>,
}

impl SunDiscTable {
    /// Tabulates the disc of a view, attenuated by the transmittance `fog` of a direction; `None` if the planet hides the disc.
    pub fn new(
        view: &View,
        channels: Channels,
        horizon_rad: f64,
        fog: impl Fn(DVec3) -> f32,
    ) -> Option<Self> {
        let sun = view.sun();
        let radius_rad = view.disc().angular_radius_rad;
        let centre = axes::elevation_rad(sun);
        let lowest = (centre - radius_rad).max(horizon_rad + 1e-7);
        let highest = centre + radius_rad;
        if lowest >= highest {
            return None;
        }
        let irradiance = view.solar_irradiance();
        let grid = view.sky().grid();
        let azimuth_deg = axes::azimuth_deg(sun);
        // Radiance per unit of irradiance at each cosine and wavelength.
        let shape: Vec<Vec<f64>> = (0..COSINES)
            .map(|m| {
                let mu = m as f64 / (COSINES - 1) as f64;
                // Just inside the limb, beyond which radiance is 0.
                let angle = (radius_rad.sin() * (1.0 - mu * mu).sqrt() * (1.0 - 1e-12)).asin();
                let nm = grid.wavelengths_nm().iter();
                nm.map(|&nm| view.disc().radiance_per_irradiance(angle, nm))
                    .collect()
            })
            .collect();
        let weights = match channels {
            Channels::Rgb(space) => Some(grid.rgb_weights(space)),
            Channels::Spectral => None,
        };
        let count = weights.as_ref().map_or(grid.len(), |_| 3);
        let mut values = Vec::with_capacity(ELEVATIONS * COSINES * count);
        for k in 0..ELEVATIONS {
            let part = k as f64 / (ELEVATIONS - 1) as f64;
            let elevation = lowest + (highest - lowest) * part;
            let direction = axes::direction(azimuth_deg, elevation.to_degrees());
            let transmittance = view.transmittance_to_space(direction);
            let fog = fog(direction);
            for shape in &shape {
                let arriving = |lane: usize| {
                    (f64::from(irradiance[lane] * transmittance[lane] * fog) * shape[lane]) as f32
                };
                match &weights {
                    None => values.extend((0..count).map(arriving)),
                    Some(weights) => {
                        let mut sum = [0.0f32; 3];
                        for (lane, weights) in weights.iter().enumerate() {
                            let arriving = arriving(lane);
                            for (sum, weight) in sum.iter_mut().zip(weights) {
                                *sum += weight * arriving;
                            }
                        }
                        values.extend(sum);
                    }
                }
            }
        }
        Some(Self {
            sun,
            radius_rad,
            elevations: (lowest, highest),
            channels: count,
            values,
        })
    }

    /// Radiance along a unit vector; zero outside the disc and below the horizon.
    pub fn sample(&self, direction: DVec3, out: &mut [f32]) {
        out.fill(0.0);
        let from_sun = 2.0 * (0.5 * direction.distance(self.sun)).min(1.0).asin();
        let s = from_sun.sin() / self.radius_rad.sin();
        let elevation = axes::elevation_rad(direction);
        let (lowest, highest) = self.elevations;
        // Down to the horizon, which is slightly below the lowest elevation.
        if from_sun >= self.radius_rad || s >= 1.0 || elevation < lowest - 2e-7 {
            return;
        }
        let along = (elevation - lowest) / (highest - lowest);
        let cosine = ((1.0 - s) * (1.0 + s)).sqrt();
        for (cell, weight) in bilinear(cosine, along, [COSINES, ELEVATIONS]) {
            let values = &self.values[cell * self.channels..][..self.channels];
            for (out, value) in out.iter_mut().zip(values) {
                *out += weight * value;
            }
        }
    }
}
