//! Linear polarisation of the light along a view ray.

use super::view::View;
use crate::math::interpolation::bilinear;
use crate::math::parallel;
use crate::optics::plane_of_polarisation_deg;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Light along a view ray as a Stokes vector, without the direct light of the sun's disc: W m^-2 sr^-1 nm^-1, one entry per
/// wavelength of the sky's grid.
///
/// `Q` is positive for light polarised in the vertical plane through the view ray (for a vertical ray, in the north-south plane), `U`
/// for light polarised at 45 degrees from there, anticlockwise as seen by the eye: as in
/// [`PolarisedEstimate`](crate::monte_carlo::PolarisedEstimate). Circular polarisation is neglected.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PolarisedLight {
    /// Radiance `I`.
    pub intensity: Vec<f32>,
    /// Stokes parameter `Q`.
    pub q: Vec<f32>,
    /// Stokes parameter `U`.
    pub u: Vec<f32>,
}

impl PolarisedLight {
    /// Degree of linear polarisation, `sqrt(Q^2 + U^2) / I`, 0 to 1.
    pub fn degree(&self) -> Vec<f32> {
        let linear = self.q.iter().zip(&self.u).map(|(q, u)| q.hypot(*u));
        let of = |(linear, &i): (f32, &f32)| if i > 0.0 { linear / i } else { 0.0 };
        linear.zip(&self.intensity).map(of).collect()
    }

    /// Angle of the plane of polarisation from the vertical plane, anticlockwise as seen by the eye, degrees in `[0, 180)`;
    /// meaningless where the degree is 0.
    pub fn angle_deg(&self) -> Vec<f32> {
        let planes = self.q.iter().zip(&self.u);
        planes
            .map(|(&q, &u)| plane_of_polarisation_deg(q.into(), u.into()) as f32)
            .collect()
    }
}

impl View {
    /// Light along the unit vector `direction` to the ground or to space as a Stokes vector. Molecules and spheres from Lorenz-Mie
    /// theory polarise the light that they scatter ([`crate::optics::PhaseFunction::matrix_ratios`]); constituents known only by
    /// their phase function, and the ground, do not. A sky prepared without
    /// [`polarisation_correction`](super::SkySettings::polarisation_correction) polarises only light that is scattered once.
    pub fn polarised(&self, direction: DVec3) -> PolarisedLight {
        let direction = direction.normalize();
        let ray = self.ray(direction);
        let (cos_azimuth, side) = azimuth(direction, self.sun());
        let solar = self.solar_irradiance();
        let mut linear: [Vec<f32>; 2] = Default::default();
        for block in self.sky().blocks() {
            for (all, part) in linear.iter_mut().zip(block.linear(&ray, cos_azimuth)) {
                all.extend(part);
            }
        }
        let lit = |part: &[f32], sign: f32| -> Vec<f32> {
            part.iter().zip(&solar).map(|(l, e)| sign * l * e).collect()
        };
        PolarisedLight {
            intensity: self.along(direction, None).radiance(),
            q: lit(&linear[0], 1.0),
            u: lit(&linear[1], side),
        }
    }
}

/// Number of azimuth steps of a table from that of the sun to the opposite one.
const AZIMUTHS: usize = 60;
/// Number of steps from the horizon to the zenith, and to the nadir.
const STEPS: [usize; 2] = [64, 32];

/// Table of the linear polarisation of a view's luminance in all directions, without the sun's disc: for pictures. Values are linear
/// between its directions, which are 3 degrees of azimuth and, at the zenith, 2.8 degrees of elevation apart, and denser towards the
/// horizon.
#[derive(Clone, Debug)]
pub struct PolarisationTable {
    sun: DVec3,
    horizon_rad: f64,
    /// `Q / I` and `U / I` on the left of the sun, above and below the horizon: `[row][azimuth]`.
    halves: [Vec<[f32; 2]>; 2],
}

impl PolarisationTable {
    /// Computes the table.
    pub fn new(view: &View) -> Self {
        let horizon_rad = view.horizon_elevation_rad();
        let sun = view.sun();
        let towards = level(sun);
        let left = DVec3::Y.cross(towards);
        let luminance: Vec<f32> = view
            .sky()
            .grid()
            .xyz_weights()
            .iter()
            .map(|w| w[1] as f32)
            .collect();
        let weighted =
            |values: &[f32]| -> f32 { values.iter().zip(&luminance).map(|(v, w)| v * w).sum() };
        let half = |below: usize| {
            // The horizon itself belongs to neither half, and at the zenith the azimuth must not be lost.
            let end = [1.0, -1.0][below] * (FRAC_PI_2 - 1e-6);
            let directions: Vec<(f64, f64)> = (0..=STEPS[below])
                .flat_map(|row| {
                    let x = (row as f64 / STEPS[below] as f64).powi(2).max(1e-9);
                    let elevation = horizon_rad + (end - horizon_rad) * x;
                    (0..=AZIMUTHS).map(move |k| (elevation, PI * k as f64 / AZIMUTHS as f64))
                })
                .collect();
            parallel::map(directions.len(), |index| {
                let (elevation, azimuth) = directions[index];
                let flat = towards * azimuth.cos() + left * azimuth.sin();
                let light = view.polarised(flat * elevation.cos() + DVec3::Y * elevation.sin());
                let intensity = weighted(&light.intensity).max(f32::MIN_POSITIVE);
                [
                    weighted(&light.q) / intensity,
                    weighted(&light.u) / intensity,
                ]
            })
        };
        Self {
            sun,
            horizon_rad,
            halves: [half(0), half(1)],
        }
    }

    /// `Q / I` and `U / I` of the luminance along a unit vector, in the frame of [`PolarisedLight`].
    pub fn sample(&self, direction: DVec3) -> [f32; 2] {
        let (cos_azimuth, side) = azimuth(direction, self.sun);
        let elevation = direction.y.atan2(direction.x.hypot(direction.z));
        let below = usize::from(elevation < self.horizon_rad);
        let span = [1.0, -1.0][below] * FRAC_PI_2 - self.horizon_rad;
        let x = ((elevation - self.horizon_rad) / span)
            .clamp(0.0, 1.0)
            .sqrt();
        let shape = [AZIMUTHS + 1, STEPS[below] + 1];
        let mut sum = [0.0; 2];
        for (cell, weight) in bilinear(cos_azimuth.acos() / PI, x, shape) {
            for (sum, value) in sum.iter_mut().zip(self.halves[below][cell]) {
                *sum += weight * value;
            }
        }
        let [q, u] = sum;
        [q, side * u]
    }
}

/// Cosine of the azimuth between a view ray and the sun, and 1 if the ray is to the left of the sun, otherwise -1. A vertical ray
/// counts as one that has just been tilted in the north-south plane, such that its frame's first axis points south.
fn azimuth(view: DVec3, sun: DVec3) -> (f64, f32) {
    let flat = match view.x.hypot(view.z) > 1e-9 {
        true => level(view),
        false => DVec3::Z * -view.y.signum(),
    };
    let sun = level(sun);
    let side = if sun.cross(flat).y < 0.0 { -1.0 } else { 1.0 };
    (flat.dot(sun).clamp(-1.0, 1.0), side)
}

/// Horizontal direction of a vector; any for a vertical one.
fn level(direction: DVec3) -> DVec3 {
    DVec3::new(direction.x, 0.0, direction.z)
        .try_normalize()
        .unwrap_or(DVec3::X)
}
