//! Fog over a picture by Monte Carlo: pass by pass, each with as many paths as all before it, so that there is a complete picture
//! soon and a better one later.

use super::{ExistingAerial, FogSource, Overlay};
use crate::RenderError;
use crate::canvas::{ColorMoments, Passes};
use airlight::atmosphere::Atmosphere;
use airlight::monte_carlo::{BUNDLE, MonteCarlo, MonteCarloSettings};
use airlight::scene::{RgbFoggySky, SunState};
use airlight::spectrum::{RgbSpace, WavelengthGrid, rgb};
use airlight_image::{Control, ImageError};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// The path radiance of a picture's fog by Monte Carlo.
#[derive(Debug)]
pub struct MonteCarloFog {
    solver: MonteCarlo,
    /// Red, green and blue of the radiance at each wavelength, in the picture's unit.
    weights: Vec<[f64; 3]>,
    eye_altitude_m: f64,
    sun: DVec3,
    /// The fast solution: the fog's transmittance, and the clear air that the picture shows.
    sky: RgbFoggySky,
    radiance_scale: f64,
    air: ExistingAerial,
    paths: u64,
}

/// The path radiance after a pass.
#[derive(Clone, Debug)]
pub struct MonteCarloPass {
    /// Paths a pixel so far.
    pub paths: u64,
    /// Whether it is the last pass.
    pub is_last: bool,
    /// Red, green and blue of the path radiance of each pixel, row after row.
    pub path_radiance: Vec<f32>,
    /// Its standard error, the same way.
    pub standard_error: Vec<f32>,
}

impl MonteCarloPass {
    /// Root mean square of the standard error of green over that of the path radiance.
    pub fn relative_noise(&self) -> f64 {
        let squares = |values: &[f32]| -> f64 {
            let greens = values.iter().skip(1).step_by(3);
            greens.map(|v| f64::from(*v).powi(2)).sum()
        };
        let mean = squares(&self.path_radiance).max(f64::MIN_POSITIVE);
        (squares(&self.standard_error) / mean).sqrt()
    }
}

#[derive(Clone, Copy, Default)]
struct Pixel {
    radiance: ColorMoments,
    /// Path radiance that the picture shows already, subtracted from the mean.
    shown: [f64; 3],
    /// Factor for the part of the ray below the ground.
    below_ground: [f64; 3],
}

impl MonteCarloFog {
    /// Prepares the Monte Carlo of a fog that a solved sky lights. `foggy_air` is the sky's atmosphere with the fog among its
    /// constituents.
    ///
    /// # Errors
    /// [`RenderError::Setting`] for a fog without a solved sky, or an atmosphere that the solver refuses.
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
                "solver monte-carlo: expected fog in the light of a solved sky, got fog in the picture's ambient light; try \
                 sky-light",
            ));
        };
        let solver = MonteCarlo::new(foggy_air, &WavelengthGrid::fast(), settings)
            .map_err(|error| RenderError::setting(error.to_string()))?;
        let from_xyz = RgbSpace::Srgb.from_xyz_matrix();
        // The Monte Carlo's sun is at its mean distance.
        let scale = f64::from(*radiance_scale) * sun.distance_ratio.powi(-2);
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

    /// Samples the pixels of an overlay pass by pass and calls `after_pass` after each. Each pass is a stage of the progress,
    /// in rows.
    ///
    /// # Errors
    /// The first error of `after_pass`, or [`ImageError::Cancelled`] once the caller cancels.
    pub fn run(
        &self,
        overlay: &Overlay<'_>,
        control: Control<'_>,
        mut after_pass: impl FnMut(&MonteCarloPass) -> Result<(), RenderError>,
    ) -> Result<(), RenderError> {
        let size = overlay.size();
        let (width, height) = (size.width() as usize, u64::from(size.height()));
        let mut pixels = vec![Pixel::default(); width * height as usize];
        let passes = Passes::new(self.paths);
        let (goal, bundle) = (passes.goal(), BUNDLE as u64);
        for bundles in passes {
            let paths = format!(
                "{} of {} paths a pixel",
                bundles.end * bundle,
                goal * bundle
            );
            control.stage(&paths, height);
            let rows = AtomicU64::new(0);
            pixels
                .par_chunks_mut(width)
                .enumerate()
                .try_for_each(|(y, row)| {
                    for (pixel, ray) in row.iter_mut().zip(overlay.rays(y as u32)) {
                        control.check()?;
                        self.sample(pixel, ray, bundles.clone());
                    }
                    control.report(1 + rows.fetch_add(1, Ordering::Relaxed), height);
                    Ok::<(), ImageError>(())
                })?;
            let done = bundles.end;
            let values = |value: &dyn Fn(&Pixel, usize) -> f64| -> Vec<f32> {
                let lanes = |pixel| [0, 1, 2].map(|lane| value(pixel, lane) as f32);
                pixels.iter().flat_map(lanes).collect()
            };
            after_pass(&MonteCarloPass {
                paths: done * bundle,
                is_last: done == goal,
                path_radiance: values(&|pixel, lane| pixel.mean(lane, done)),
                standard_error: values(&|pixel, lane| pixel.standard_error(lane, done)),
            })?;
        }
        Ok(())
    }

    /// Follows more bundles of paths along a ray of a direction and a length, m.
    fn sample(
        &self,
        pixel: &mut Pixel,
        (direction, distance_m): (DVec3, f64),
        bundles: std::ops::Range<u64>,
    ) {
        if bundles.start == 0 {
            pixel.shown = self.shown(direction, distance_m);
            pixel.below_ground = self.below_ground(direction, distance_m);
        }
        for bundle in bundles {
            let sample = self.solver.sample_path(
                self.eye_altitude_m,
                self.sun,
                direction,
                distance_m,
                bundle,
            );
            let mut rgb = [0.0; 3];
            for (lane, weights) in self.weights.iter().enumerate() {
                let radiance: f64 = sample.iter().map(|order| order[lane]).sum();
                for (c, w) in rgb.iter_mut().zip(weights) {
                    *c += w * radiance;
                }
            }
            pixel.radiance.add(rgb);
        }
    }

    /// Path radiance that the picture shows already: that of the clear air, dimmed by the fog.
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

    /// Path radiance over that up to the ground. Paths end at the ground, but by its depth a point may lie below it: on a slope,
    /// or if the camera is not as level as its description. Path radiance is taken to grow with opacity there.
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

impl Pixel {
    /// Path radiance beyond what the picture shows already.
    fn mean(&self, lane: usize, bundles: u64) -> f64 {
        self.below_ground[lane] * self.radiance.moments(lane, bundles).0 - self.shown[lane]
    }

    fn standard_error(&self, lane: usize, bundles: u64) -> f64 {
        self.below_ground[lane] * self.radiance.moments(lane, bundles).1
    }
}
