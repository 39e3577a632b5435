//! Pictures by published models.

use super::disc::Disc;
use super::rows::{Layer, pixel_reach};
use crate::args::SkyArgs;
use crate::error::CliError;
use crate::light::Illuminances;
use airlight::axes;
use airlight::classic::ClassicSky;
use airlight::spectrum::{RgbSpace, rgb};
use airlight_render::frame::FrameRows;
use airlight_render::{Frame, RowSource};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Refuses options that published models do not know.
///
/// # Errors
/// [`CliError::Usage`]: which.
pub fn check(args: &SkyArgs) -> Result<(), CliError> {
    args.classic.check(args.air.solver)?;
    if !args.air.solver.is_classic() {
        return Ok(());
    }
    if args.picture.spectral {
        return Err(CliError::usage(
            "published models are drawn in colours: leave out --spectral, or give --solver orders or monte-carlo",
        ));
    }
    if args.fog.fog_visibility_m.is_some() {
        return Err(CliError::usage(
            "published models of the sky know no fog: leave out the options --fog-..., or give --solver orders",
        ));
    }
    Ok(())
}

/// Light of sun and sky at the eye. The sky's is summed over bands of equal height and equal turns about the sun's
/// azimuth: within 1 % where haze does not crowd the light about the sun.
pub fn illuminances(model: &dyn ClassicSky) -> Illuminances {
    const BANDS: usize = 48;
    const TURNS: usize = 96;
    let azimuth_deg = axes::azimuth_deg(model.sun());
    let band = |i: usize| {
        // Equal parts of sin^2: each weighs the same on the horizontal.
        let elevation_deg = ((i as f64 + 0.5) / BANDS as f64).sqrt().asin().to_degrees();
        let at = |j: usize| azimuth_deg + 360.0 * (j as f64 + 0.5) / TURNS as f64;
        let mut walk = model.walk();
        (0..TURNS)
            .map(|j| walk(axes::direction(at(j), elevation_deg))[1])
            .sum::<f64>()
    };
    let sum: f64 = (0..BANDS).into_par_iter().map(band).sum();
    let sun_normal_lx = disc_lx(model);
    Illuminances {
        sun_normal_lx,
        sun_horizontal_lx: sun_normal_lx * model.sun().y.max(0.0),
        sky_horizontal_lx: PI * sum / (BANDS * TURNS) as f64,
    }
}

/// The disc's illuminance facing it, from rings of equal area.
fn disc_lx(model: &dyn ClassicSky) -> f64 {
    const RINGS: usize = 64;
    const SPOKES: usize = 32;
    let sun = model.sun();
    let across = sun.any_orthonormal_vector();
    let along = sun.cross(across);
    let edge = model.disc_edge_rad().sin();
    let mut sum = 0.0;
    for i in 0..RINGS {
        let s = edge * ((i as f64 + 0.5) / RINGS as f64).sqrt();
        for j in 0..SPOKES {
            let (sin, cos) = (TAU * (j as f64 + 0.5) / SPOKES as f64).sin_cos();
            let direction = sun * (1.0 - s * s).sqrt() + (across * cos + along * sin) * s;
            sum += model.disc_xyz(direction)[1];
        }
    }
    PI * edge * edge * sum / (RINGS * SPOKES) as f64
}

/// A published model in one frame, row by row.
pub struct ClassicRows<'a> {
    model: &'a dyn ClassicSky,
    disc: Option<&'a Disc>,
    draws_sky: bool,
    rows: FrameRows,
    rgb_from_xyz: [[f64; 3]; 3],
    scale: f32,
    pixel_reach: f64,
}

impl<'a> ClassicRows<'a> {
    /// Rows of `frame` in an RGB space; values are `scale` times those in cd/m^2.
    pub fn new(
        frame: &Frame,
        layer: Layer,
        model: &'a dyn ClassicSky,
        disc: Option<&'a Disc>,
        space: RgbSpace,
        scale: f32,
    ) -> Self {
        Self {
            model,
            disc: disc.filter(|_| layer != Layer::Sky),
            draws_sky: layer != Layer::Disc,
            rows: frame.rows(),
            rgb_from_xyz: space.from_xyz_matrix(),
            scale,
            pixel_reach: pixel_reach(frame),
        }
    }
}

impl RowSource for ClassicRows<'_> {
    fn channels(&self) -> usize {
        3
    }

    fn fill_row(&self, y: u32, out: &mut [f32]) {
        let frame = self.rows.frame();
        let mut directions = vec![DVec3::ZERO; frame.size().width() as usize];
        self.rows.fill(y, &mut directions);
        out.fill(0.0);
        if self.draws_sky {
            let mut walk = self.model.walk();
            for (&direction, pixel) in directions.iter().zip(out.chunks_exact_mut(3)) {
                if direction != DVec3::ZERO {
                    let rgb = rgb::apply(&self.rgb_from_xyz, walk(direction));
                    let values = rgb.map(|c| c as f32 * self.scale);
                    pixel.copy_from_slice(&values);
                }
            }
        }
        if let Some(disc) = self.disc {
            disc.add_row((frame, y), &directions, (self.pixel_reach, self.scale), out);
        }
    }
}
