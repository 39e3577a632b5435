//! What the solver and each renderer see in pixels.

use super::case::{Case, FramesError};
use super::pixels::{Pixel, Wall, frames, wall_m};
use airlight::Control;
use airlight::atmosphere::Atmosphere;
use airlight::glam::DVec3;
use airlight::models::registry;
use airlight::scene::{Channels, PreparedModel, Scene};
use airlight::sky::{SunCoverage, View};
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight::sun::SunState;
use airlight_gpu::headless::{FORMAT, Geometry, Headless};
use airlight_gpu::{SkyPasses, SkySolver};
use std::sync::Arc;

/// XYZ of a pixel, cd/m^2.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Of the sky, or the ground below it.
    pub sky: [f64; 3],
    /// Of the wall behind air.
    pub wall: Option<[f64; 3]>,
}

/// What the solver sees.
pub fn solver(view: &View, wall: &Wall, pixels: &[Pixel]) -> Vec<Seen> {
    let grid = view.sky().grid();
    let directions: Vec<DVec3> = pixels.iter().map(|pixel| pixel.direction).collect();
    let walls_m: Vec<f64> = pixels
        .iter()
        .map(|pixel| pixel.wall_m.unwrap_or(f64::INFINITY))
        .collect();
    let mut sky = vec![0.0; pixels.len() * grid.len()];
    let (mut transmittance, mut path) = (sky.clone(), sky.clone());
    view.radiances(&directions, &mut sky);
    view.paths(&directions, &walls_m, &mut transmittance, &mut path);
    let seen = |(index, pixel): (usize, &Pixel)| {
        let of = |light: &[f32]| light[index * grid.len()..][..grid.len()].to_vec();
        let behind_air = || {
            let light = of(&transmittance).into_iter().zip(&wall.radiance);
            let light = light.zip(of(&path)).map(|((t, wall), s)| t * wall + s);
            grid.to_xyz(&light.collect::<Vec<f32>>())
        };
        Seen {
            sky: grid.to_xyz(&of(&sky)),
            wall: pixel.wall_m.map(|_| behind_air()),
        }
    };
    pixels.iter().enumerate().map(seen).collect()
}

/// `airlight-gpu` in an atmosphere.
pub struct Engine<'a> {
    device: &'a Headless,
    solver: SkySolver,
    passes: SkyPasses,
}

impl<'a> Engine<'a> {
    /// The renderer with its default settings.
    pub fn new(device: &'a Headless, air: &Atmosphere) -> Result<Self, FramesError> {
        Ok(Self {
            solver: SkySolver::new(air, &SkySolver::default_settings(), RgbSpace::Srgb)?,
            passes: SkyPasses::new(&device.device, &device.queue, FORMAT)?,
            device,
        })
    }

    /// Draws frames to all sides, and takes the pixels from them.
    pub fn draw(
        &mut self,
        case: &Case,
        wall: &Wall,
        pixels: &[Pixel],
    ) -> Result<Vec<Seen>, FramesError> {
        let (height_m, sun) = (case.height_m, case.sun());
        self.passes
            .set_tables(&self.solver.tables(height_m, sun, None)?);
        let view = self.solver.sky().view(height_m, sun);
        let exposure = (1.0 / wall.luminance) as f32;
        let xyz = |rgb: [f32; 3]| RgbSpace::Srgb.to_xyz(rgb.map(|v| f64::from(v / exposure)));
        let mut seen = vec![None; pixels.len()];
        for (index, frame) in frames().iter().enumerate() {
            if pixels.iter().all(|pixel| pixel.frame != index) {
                continue;
            }
            let camera = frame.camera(exposure)?;
            let draw = |geometry: Option<&Geometry<'_>>| {
                self.device.draw(frame, geometry, |encoder, target, depth| {
                    self.passes.record(encoder, target, depth, &camera);
                })
            };
            let sky = draw(None)?;
            let walls = draw(Some(&Geometry {
                colour: wall.rgb.map(|v| v * f64::from(exposure)),
                distance_m: &|x, y| wall_m(&view, frame.direction(x, y), (x, y)) as f32,
            }))?;
            let of_frame = pixels.iter().zip(&mut seen);
            for (pixel, seen) in of_frame.filter(|(pixel, _)| pixel.frame == index) {
                *seen = Some(Seen {
                    sky: xyz(sky[pixel.index]),
                    wall: pixel.wall_m.map(|_| xyz(walls[pixel.index])),
                });
            }
        }
        Ok(seen.into_iter().flatten().collect())
    }
}

/// A published model in an atmosphere.
pub struct Published {
    model: Arc<dyn PreparedModel>,
    grid: WavelengthGrid,
}

impl Published {
    /// A variant of `hillaire2020`.
    pub fn new(air: &Atmosphere, variant: &str) -> Result<Self, FramesError> {
        let mut scene = Scene::default();
        // Any sun: the model is prepared for all.
        scene.sun.elevation_deg = Some(0.0);
        scene.solver.name = Some("hillaire2020".into());
        scene.solver.variant = Some(variant.into());
        let mut scene = scene.resolve()?;
        scene.atmosphere = air.clone();
        scene.grid = WavelengthGrid::rgb();
        Ok(Self {
            model: registry::prepare(&scene, SunCoverage::All, Control::default())?,
            grid: scene.grid.with_solar(&air.solar_irradiance),
        })
    }

    /// What the model sees with the responses at its wavelengths as red, green and blue.
    pub fn march(
        &self,
        case: &Case,
        wall: &Wall,
        pixels: &[Pixel],
    ) -> Result<Vec<Seen>, FramesError> {
        let sun = SunState::from(case.sun());
        let view = self.model.view(case.height_m, &sun, Channels::Spectral)?;
        let solar = self.grid.solar_irradiance();
        // Wavelengths are in order: the last is red.
        let rgb = |spectrum: [f32; 3]| {
            let response = |k: usize| f64::from(spectrum[k]) / solar[k];
            std::array::from_fn(|c| response(2 - c) * wall.sunlight[c])
        };
        let seen = |pixel: &Pixel| {
            let mut sky = [0.0; 3];
            view.radiance(&[pixel.direction], &mut sky);
            Seen {
                sky: RgbSpace::Srgb.to_xyz(rgb(sky)),
                wall: None,
            }
        };
        Ok(pixels.iter().map(seen).collect())
    }
}
