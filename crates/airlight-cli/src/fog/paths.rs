//! Fog over a picture by random paths: in passes, each of as many paths as all before it, so that there is a whole picture
//! soon and a better one later. Ctrl-C leaves that of the last pass.

use super::layers;
use super::light::SolvedSky;
use super::picture::{Fogged, Subject};
use crate::args::OverlayArgs;
use crate::error::CliError;
use crate::interrupt::STOP;
use crate::progress::RowsBar;
use airlight::monte_carlo::{BUNDLE, MonteCarlo, MonteCarloSettings};
use airlight::scene::FoggySky;
use airlight::spectrum::{RgbSpace, WavelengthGrid, rgb};
use airlight_image::Control;
use airlight_image::output::exr::{self, ExrOptions, ExrSample};
use airlight_image::output::{Metadata, PictureFormat, Written};
use airlight_image::rows::StoredRows;
use airlight_render::canvas::{ColorMoments, Passes};
use airlight_render::overlay::{ExistingAerial, FogSource};
use airlight_render::pixels::tagged_path;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// What follows the paths of a picture.
pub struct Painter {
    solver: MonteCarlo,
    /// Red, green and blue of the radiance at each wavelength, in the picture's unit.
    weights: Vec<[f64; 3]>,
    eye_altitude_m: f64,
    sun: DVec3,
    /// The fast solution: what the fog lets through, and the clear air that a picture has already.
    sky: Arc<FoggySky<3>>,
    radiance_scale: f64,
    air: ExistingAerial,
    passes: Passes,
}

/// A pixel.
#[derive(Clone, Copy, Default)]
struct Pixel {
    colour: ColorMoments,
    /// What is taken off the mean.
    drawn: [f64; 3],
    /// Factor for what of the line lies under the ground.
    further: [f64; 3],
}

impl Painter {
    /// The fog of the options as part of the air of a solved sky.
    ///
    /// # Errors
    /// [`CliError::Usage`] for a fog that is none, or too many layers of it.
    pub fn new(
        args: &OverlayArgs,
        solved: &SolvedSky,
        fogged: &Fogged,
        settings: MonteCarloSettings,
    ) -> Result<Self, CliError> {
        let (
            Some(layers),
            Some(FogSource::Sky {
                sky,
                radiance_scale,
                air,
            }),
        ) = (layers::in_air(args), fogged.body())
        else {
            return Err(CliError::usage(
                "random paths need a fog that scatters light, in the light of the sky: give --sky-light",
            ));
        };
        let mut foggy = solved.scene().atmosphere.clone();
        let grid = WavelengthGrid::fast();
        for fog in layers {
            let ground_m = foggy.planet.ground_altitude_m;
            let part = fog.constituent(ground_m, grid.wavelengths_nm())?;
            foggy.constituents.push(part);
        }
        let solver = MonteCarlo::new(&foggy, &grid, settings)?;
        let from_xyz = RgbSpace::Srgb.from_xyz_matrix();
        // The Monte Carlo's sun is at its mean distance.
        let scale = f64::from(*radiance_scale) * solved.sun().distance_ratio.powi(-2);
        let xyz = solver.grid().xyz_weights().iter();
        Ok(Self {
            weights: xyz
                .map(|&w| rgb::apply(&from_xyz, w).map(|v| scale * v))
                .collect(),
            solver,
            eye_altitude_m: solved.scene().eye_altitude_m,
            sun: solved.sun().direction(),
            sky: sky.clone(),
            radiance_scale: f64::from(*radiance_scale),
            air: *air,
            passes: Passes::new(settings.paths),
        })
    }

    /// Writes the picture pass by pass; and says how noisy it is in the end. While it does, writing must have been announced.
    ///
    /// # Errors
    /// [`CliError`]: what failed; the picture of the pass before stays.
    pub fn write(
        &self,
        args: &OverlayArgs,
        subject: &Subject,
        fogged: &Fogged,
        format: PictureFormat,
    ) -> Result<(Written, String), CliError> {
        let size = subject.picture.size;
        let (width, height) = (size.width() as usize, size.height());
        let mut colours = vec![Pixel::default(); width * height as usize];
        let goal = self.passes.goal();
        let mut last = (Written::default(), String::new());
        for bundles in self.passes {
            let done = bundles.end;
            let bar = RowsBar::for_pass(u64::from(height), done, goal);
            let overlay = subject.overlay(fogged, args)?;
            colours
                .par_chunks_mut(width)
                .enumerate()
                .try_for_each(|(y, row)| {
                    for (colour, line) in row.iter_mut().zip(overlay.lines(y as u32)) {
                        if STOP.load(Ordering::Relaxed) {
                            return Err(CliError::Interrupted);
                        }
                        self.paint(colour, line, bundles.clone());
                    }
                    bar.advance(1);
                    Ok(())
                })?;
            let of = |value: &dyn Fn(&Pixel, usize) -> f64| -> Vec<f32> {
                let pixels = colours.iter();
                pixels
                    .flat_map(|colour| [0, 1, 2].map(|lane| value(colour, lane) as f32))
                    .collect()
            };
            let means = of(&|pixel, lane| pixel.mean(lane, done));
            let overlay = overlay.with_path_radiance(&means)?;
            let written = subject.write_overlay(&overlay, args, &args.output, format)?;
            let errors = of(&|pixel, lane| pixel.standard_error(lane, done));
            if args.random.noise_map {
                let path = tagged_path(&args.output, "noise").with_extension("exr");
                let rows = StoredRows::new(size.width(), 3, errors.clone())?;
                let options = ExrOptions {
                    sample: ExrSample::Float,
                    ..ExrOptions::default()
                };
                let control = Control::cancelled_by(&STOP);
                let metadata = Metadata::default();
                exr::write(
                    &path,
                    size,
                    &["R", "G", "B"],
                    &rows,
                    &options,
                    &metadata,
                    control,
                )?;
            }
            last = (written, self.noise(&means, &errors));
        }
        Ok(last)
    }

    /// Follows more bundles of paths along a line of sight of a direction and a length, m.
    fn paint(
        &self,
        pixel: &mut Pixel,
        (direction, distance_m): (DVec3, f64),
        bundles: std::ops::Range<u64>,
    ) {
        if bundles.start == 0 {
            pixel.drawn = self.drawn(direction, distance_m);
            pixel.further = self.further(direction, distance_m);
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
            pixel.colour.add(rgb);
        }
    }

    /// What of the path radiance is in the picture already: that of the clear air, as far as the fog lets it through.
    fn drawn(&self, direction: DVec3, distance_m: f64) -> [f64; 3] {
        if self.air == ExistingAerial::Missing && distance_m < f64::INFINITY {
            return [0.0; 3];
        }
        let fog = self.sky.over_clear(direction, distance_m).transmittance;
        let air = self.sky.aerial().optics(direction, distance_m);
        (fog * air.path_radiance)
            .0
            .map(|v| self.radiance_scale * f64::from(v))
    }

    /// Path radiance over that up to the ground. Paths end there, but by its depth a thing may lie under it, on a slope or
    /// before a camera that is not as level as its options: what is scattered for each part of the opacity is taken to go on
    /// the same.
    fn further(&self, direction: DVec3, distance_m: f64) -> [f64; 3] {
        let opacity = |distance_m: f64| {
            let optics = self.sky.optics(direction, distance_m);
            optics.transmittance.0.map(|t| f64::from(1.0 - t))
        };
        match self.sky.aerial().ground_distance_m(direction) {
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

    /// How noisy the picture is, in a line.
    fn noise(&self, means: &[f32], errors: &[f32]) -> String {
        let squares = |values: &[f32]| -> f64 {
            let greens = values.iter().skip(1).step_by(3);
            greens.map(|v| f64::from(*v).powi(2)).sum()
        };
        format!(
            "  noise         {:.2} % of the fog's green (root mean square over the picture), {} paths a pixel\n",
            100.0 * (squares(errors) / squares(means).max(f64::MIN_POSITIVE)).sqrt(),
            self.passes.goal() * BUNDLE as u64
        )
    }
}

impl Pixel {
    /// Path radiance over what is drawn already.
    fn mean(&self, lane: usize, bundles: u64) -> f64 {
        self.further[lane] * self.colour.moments(lane, bundles).0 - self.drawn[lane]
    }

    fn standard_error(&self, lane: usize, bundles: u64) -> f64 {
        self.further[lane] * self.colour.moments(lane, bundles).1
    }
}
