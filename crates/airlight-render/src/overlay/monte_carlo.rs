//! Fog over a picture by Monte Carlo, in passes. Each traces as many paths as all earlier passes together, so that a first
//! complete picture is available early.

use super::{ExistingAerial, FogSource, Overlay};
use crate::RenderError;
use crate::canvas::{Canvas, Passes};
use crate::channels::PixelChannels;
use airlight::atmosphere::Atmosphere;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings};
use airlight::scene::{RgbFoggySky, SunState};
use airlight::spectrum::{RgbSpace, WavelengthGrid, rgb};
use airlight_image::{Control, ImageError};
use glam::DVec3;
use rayon::prelude::*;

/// Monte Carlo estimate of the path radiance of a picture's fog.
#[derive(Debug)]
pub struct MonteCarloFog {
    solver: MonteCarlo,
    /// Weights of the radiance at each wavelength in red, green and blue, in the picture's unit.
    weights: Vec<[f64; 3]>,
    eye_altitude_m: f64,
    sun: DVec3,
    /// The deterministic solution, for the fog's transmittance and the clear air that the picture shows.
    sky: RgbFoggySky,
    radiance_scale: f64,
    air: ExistingAerial,
    paths: u64,
}

/// The path radiance after a pass.
#[derive(Clone, Debug)]
pub struct MonteCarloPass {
    /// Number of paths for each pixel so far.
    pub paths: u64,
    /// Whether it is the last pass.
    pub is_last: bool,
    /// Red, green and blue of the path radiance of each pixel, row by row.
    pub path_radiance: Vec<f32>,
    /// Standard error of each value of `path_radiance`.
    pub standard_error: Vec<f32>,
}

impl MonteCarloPass {
    /// Root mean square of the standard error of green divided by that of the path radiance.
    pub fn relative_noise(&self) -> f64 {
        let squares = |values: &[f32]| -> f64 {
            let greens = values.iter().skip(1).step_by(3);
            greens.map(|v| f64::from(*v).powi(2)).sum()
        };
        let mean = squares(&self.path_radiance).max(f64::MIN_POSITIVE);
        (squares(&self.standard_error) / mean).sqrt()
    }
}

/// Ray of a pixel, and corrections of its path radiance.
struct PixelRay {
    direction: DVec3,
    /// Length of the ray, m.
    distance_m: f64,
    /// Path radiance that the picture already contains, subtracted from the mean.
    shown: [f64; 3],
    /// Factor for the part of the ray below the ground.
    below_ground: [f64; 3],
}

impl MonteCarloFog {
    /// Prepares Monte Carlo for a fog lit by a solved sky. `foggy_air` is the sky's atmosphere with the fog among its
    /// constituents.
    ///
    /// # Errors
    /// [`RenderError::Setting`] for a fog without a solved sky, or an invalid atmosphere.
    pub fn new(
        fog: &FogSource,
        foggy_air: &Atmosphere,
        eye_altitude_m: f64,
        sun: &SunState,
        settings: MonteCarloSettings,
    ) -> Result<Self, RenderError> {
        let FogSource::Sky {
            sky,
            radiance_scale,
            air,
        } = fog
        else {
            return Err(RenderError::setting(
                "solver monte-carlo: expected fog lit by a solved sky, got fog in the picture's ambient light; try sky-light",
            ));
        };
        let solver = MonteCarlo::new(foggy_air, &WavelengthGrid::fast(), settings)
            .map_err(|error| RenderError::setting(error.to_string()))?;
        let from_xyz = RgbSpace::Srgb.from_xyz_matrix();
        // The Monte Carlo solver uses the sun's mean distance.
        let scale = f64::from(*radiance_scale) * sun.irradiance_factor();
        let xyz = solver.grid().xyz_weights().iter();
        Ok(Self {
            weights: xyz
                .map(|&w| rgb::apply(&from_xyz, w).map(|v| scale * v))
                .collect(),
            solver,
            eye_altitude_m,
            sun: sun.direction,
            sky: sky.clone(),
            radiance_scale: f64::from(*radiance_scale),
            air: *air,
            paths: settings.paths,
        })
    }

    /// Samples the pixels of an overlay in passes and calls `after_pass` after each. Each pass is a stage of the progress, in
    /// rows.
    ///
    /// # Errors
    /// The first error of `after_pass`, or [`ImageError::Cancelled`] if the caller cancelled.
    pub fn run(
        &self,
        overlay: &Overlay<'_>,
        control: Control<'_>,
        mut after_pass: impl FnMut(&MonteCarloPass) -> Result<(), RenderError>,
    ) -> Result<(), RenderError> {
        let size = overlay.size();
        let (width, height) = (size.width() as usize, u64::from(size.height()));
        let rows: Vec<Vec<PixelRay>> = (0..size.height())
            .into_par_iter()
            .map(|y| {
                control.check()?;
                let rays = overlay.rays(y).into_iter();
                Ok(rays.map(|ray| self.pixel_ray(ray)).collect())
            })
            .collect::<Result<_, ImageError>>()?;
        let mut canvas = Canvas::new(size, &PixelChannels::rgb(RgbSpace::Srgb), false);
        for pass in Passes::new(self.paths) {
            control.stage(&pass.to_string(), height);
            canvas.add_with(&pass, control, |x, y, bundle, rgb, _| {
                self.sample(&rows[y as usize][x as usize], bundle, rgb);
            })?;
            let mut path_radiance = Vec::with_capacity(3 * width * height as usize);
            let mut standard_error = Vec::with_capacity(path_radiance.capacity());
            for (ray, moments) in rows.iter().flatten().zip(canvas.moments()) {
                for (lane, (mean, error)) in moments.into_iter().enumerate() {
                    let factor = ray.below_ground[lane];
                    path_radiance.push((factor * mean - ray.shown[lane]) as f32);
                    standard_error.push((factor * error) as f32);
                }
            }
            after_pass(&MonteCarloPass {
                paths: pass.paths(),
                is_last: pass.is_last(),
                path_radiance,
                standard_error,
            })?;
        }
        Ok(())
    }

    fn pixel_ray(&self, (direction, distance_m): (DVec3, f64)) -> PixelRay {
        PixelRay {
            direction,
            distance_m,
            shown: self.shown(direction, distance_m),
            below_ground: self.below_ground(direction, distance_m),
        }
    }

    /// Adds the colour of a bundle of paths along a ray.
    fn sample(&self, ray: &PixelRay, bundle: u64, rgb: &mut [f64]) {
        let sample = self.solver.sample_path(
            self.eye_altitude_m,
            self.sun,
            ray.direction,
            ray.distance_m,
            bundle,
        );
        for (lane, weights) in self.weights.iter().enumerate() {
            let radiance: f64 = sample.iter().map(|order| order[lane]).sum();
            for (c, w) in rgb.iter_mut().zip(weights) {
                *c += w * radiance;
            }
        }
    }

    /// Path radiance that the picture already contains: that of the clear air, attenuated by the fog.
    fn shown(&self, direction: DVec3, distance_m: f64) -> [f64; 3] {
        if self.air == ExistingAerial::Missing && distance_m < f64::INFINITY {
            return [0.0; 3];
        }
        let fog = self
            .sky
            .path_over_clear(direction, distance_m)
            .transmittance;
        let air = self.sky.clear_path(direction, distance_m);
        std::array::from_fn(|i| self.radiance_scale * f64::from(fog[i] * air.path_radiance[i]))
    }

    /// Ratio of the path radiance to that up to the ground. Paths end at the ground, but according to its depth a point may lie
    /// below it: on a slope, or if the camera is not exactly level. There, path radiance is assumed proportional to opacity.
    fn below_ground(&self, direction: DVec3, distance_m: f64) -> [f64; 3] {
        let opacity = |distance_m: f64| {
            let optics = self.sky.path(direction, distance_m);
            optics.transmittance.map(|t| f64::from(1.0 - t))
        };
        match self.sky.ground_distance_m(direction) {
            Some(ground_m) if ground_m < distance_m => {
                let (whole, above) = (opacity(distance_m), opacity(ground_m));
                std::array::from_fn(|i| match above[i] > 0.0 {
                    true => whole[i] / above[i],
                    false => 1.0,
                })
            }
            _ => [1.0; 3],
        }
    }
}
