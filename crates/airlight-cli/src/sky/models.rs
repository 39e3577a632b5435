//! Pictures by published models.

use super::disc::Disc;
use super::rows::Layer;
use crate::args::{FogScatteringArg, SkyArgs, SolverArg};
use crate::error::CliError;
use crate::models::Lit;
use airlight::spectrum::{RgbSpace, rgb};
use airlight_image::frame::FrameRows;
use airlight_image::{Frame, RowSource};
use airlight_render::pixels::pixel_reach;
use glam::DVec3;

/// Refuses options that published models do not know.
///
/// # Errors
/// [`CliError::Usage`]: which.
pub fn check(args: &SkyArgs, spectral: bool) -> Result<(), CliError> {
    let solver = args.air.solver;
    args.model.check(solver)?;
    if !solver.is_published_model() {
        return Ok(());
    }
    if spectral && !solver.has_spectra() {
        return Err(CliError::usage(format!(
            "--solver {} knows colours and no spectra: leave out --spectral and the ending .spectral.exr, or give one of {}",
            solver.name(),
            SolverArg::names(SolverArg::has_spectra)
        )));
    }
    if args.fog.fog_visibility_m.is_some() && args.air.solver != SolverArg::Klassen1987 {
        return Err(CliError::usage(
            "of the published models of the sky klassen1987 alone knows fog: leave out the options --fog-..., or give --solver \
             orders",
        ));
    }
    if args.fog.fog_scattering == FogScatteringArg::Undimmed {
        return Err(CliError::usage(
            "the fog of 1987 scatters light once, and dims the sun: leave out --fog-scattering undimmed, or give --solver orders",
        ));
    }
    Ok(())
}

/// A published model in one frame, row by row.
pub struct ModelRows<'a> {
    lit: &'a Lit,
    disc: Option<&'a Disc>,
    /// Channels of the spectrum after red, green and blue.
    lanes: usize,
    draws_sky: bool,
    rows: FrameRows,
    rgb_from_xyz: [[f64; 3]; 3],
    scale: f32,
    pixel_reach: f64,
}

impl<'a> ModelRows<'a> {
    /// Rows of `frame` in an RGB space, where `spectral` with the radiance at each of the model's wavelengths after it;
    /// values are `scale` times those in cd/m^2.
    pub fn new(
        frame: &Frame,
        layer: Layer,
        (lit, disc): (&'a Lit, Option<&'a Disc>),
        spectral: bool,
        space: RgbSpace,
        scale: f32,
    ) -> Self {
        Self {
            lit,
            disc: disc.filter(|_| layer != Layer::Sky),
            lanes: match spectral {
                true => lit.model.wavelengths_nm().len(),
                false => 0,
            },
            draws_sky: layer != Layer::Disc,
            rows: frame.rows(),
            rgb_from_xyz: space.from_xyz_matrix(),
            scale,
            pixel_reach: pixel_reach(frame),
        }
    }

    /// Colours, by what the model remembers of its neighbours.
    fn fill_colours(&self, directions: &[DVec3], out: &mut [f32]) {
        let mut walk = self.lit.model.walk();
        for (&direction, pixel) in directions.iter().zip(out.chunks_exact_mut(3)) {
            if direction != DVec3::ZERO {
                let xyz = match &self.lit.ground {
                    Some(ground) if direction.y < 0.0 => ground.xyz,
                    _ => walk(direction),
                };
                pixel.copy_from_slice(&self.rgb(xyz));
            }
        }
    }

    /// Colours and spectra.
    fn fill_spectra(&self, directions: &[DVec3], out: &mut [f32]) {
        let pixels = out.chunks_exact_mut(self.channels());
        for (&direction, pixel) in directions.iter().zip(pixels) {
            if direction != DVec3::ZERO {
                let light = self.lit.along(direction);
                let (rgb, spectrum) = pixel.split_at_mut(3);
                rgb.copy_from_slice(&self.rgb(light.xyz));
                for (out, radiance) in spectrum.iter_mut().zip(light.spectrum) {
                    *out = radiance as f32 * self.scale;
                }
            }
        }
    }

    fn rgb(&self, xyz: [f64; 3]) -> [f32; 3] {
        rgb::apply(&self.rgb_from_xyz, xyz).map(|c| c as f32 * self.scale)
    }
}

impl RowSource for ModelRows<'_> {
    fn channels(&self) -> usize {
        3 + self.lanes
    }

    fn fill_row(&self, y: u32, out: &mut [f32]) {
        let frame = self.rows.frame();
        let mut directions = vec![DVec3::ZERO; frame.size().width() as usize];
        self.rows.fill(y, &mut directions);
        out.fill(0.0);
        match (self.draws_sky, self.lanes) {
            (false, _) => {}
            (true, 0) => self.fill_colours(&directions, out),
            (true, _) => self.fill_spectra(&directions, out),
        }
        if let Some(disc) = self.disc {
            disc.add_row((frame, y), &directions, (self.pixel_reach, self.scale), out);
        }
    }
}
