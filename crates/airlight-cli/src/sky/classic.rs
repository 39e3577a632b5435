//! Pictures by published models.

use super::disc::Disc;
use super::rows::{Layer, pixel_reach};
use crate::args::{SkyArgs, SolverArg};
use crate::error::CliError;
use crate::light::Illuminances;
use airlight::axes;
use airlight::classic::ClassicSky;
use airlight::spectrum::rgb::DOMINANT_NM;
use airlight::spectrum::{RgbSpace, SpectralCurve, rgb};
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
    if args.fog.fog_visibility_m.is_some() && args.air.solver != SolverArg::Klassen1987 {
        return Err(CliError::usage(
            "of the published models of the sky klassen1987 alone knows fog: leave out the options --fog-..., or give --solver \
             orders",
        ));
    }
    Ok(())
}

/// What a published model sheds on surfaces at the eye, in XYZ (lx).
#[derive(Clone, Copy, Debug)]
pub struct Shed {
    /// Of the sun's disc, facing it.
    sun_normal: [f64; 3],
    /// Of the sky, on the horizontal.
    sky_horizontal: [f64; 3],
    /// Sine of the sun's elevation, or 0.
    sin_sun: f64,
}

impl Shed {
    /// Sums over sun and sky. The sky's sum is over bands of equal weight and equal turns about the sun's azimuth: within
    /// 1 % where haze does not crowd the light about the sun.
    pub fn of(model: &dyn ClassicSky) -> Self {
        const BANDS: usize = 48;
        const TURNS: usize = 96;
        let azimuth_deg = axes::azimuth_deg(model.sun());
        let band = |i: usize| {
            // Equal parts of sin^2: each weighs the same on the horizontal.
            let elevation = ((i as f64 + 0.5) / BANDS as f64).sqrt().asin();
            let at = |j: usize| azimuth_deg + 360.0 * (j as f64 + 0.5) / TURNS as f64;
            (0..TURNS).fold([0.0; 3], |sum, j| {
                let direction = axes::direction(at(j), elevation.to_degrees());
                plus(sum, model.sky_xyz(direction))
            })
        };
        let bands: Vec<_> = (0..BANDS).into_par_iter().map(band).collect();
        let sum = bands.into_iter().fold([0.0; 3], plus);
        Self {
            sun_normal: disc(model),
            sky_horizontal: sum.map(|v| PI * v / (BANDS * TURNS) as f64),
            sin_sun: model.sun().y.max(0.0),
        }
    }

    /// Of the sun's disc, facing it, in XYZ (lx).
    pub fn sun_normal(&self) -> [f64; 3] {
        self.sun_normal
    }

    /// As illuminances.
    pub fn illuminances(&self) -> Illuminances {
        Illuminances {
            sun_normal_lx: self.sun_normal[1],
            sun_horizontal_lx: self.sun_normal[1] * self.sin_sun,
            sky_horizontal_lx: self.sky_horizontal[1],
        }
    }

    /// The light (XYZ, cd/m^2) of a ground that reflects it evenly. Its albedo is taken at the wavelengths that the sRGB
    /// primaries look like: exact for grey ground.
    pub fn ground_xyz(&self, albedo: &SpectralCurve) -> [f64; 3] {
        let horizontal = plus(
            self.sky_horizontal,
            self.sun_normal.map(|v| v * self.sin_sun),
        );
        let rgb = RgbSpace::Srgb.from_xyz(horizontal);
        let reflected = [0, 1, 2].map(|i| albedo.at(DOMINANT_NM[i]) * rgb[i] / PI);
        rgb::apply(&RgbSpace::Srgb.to_xyz_matrix(), reflected)
    }
}

fn plus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The disc's illuminance facing it, from rings of equal area.
fn disc(model: &dyn ClassicSky) -> [f64; 3] {
    const RINGS: usize = 64;
    const SPOKES: usize = 32;
    let sun = model.sun();
    let across = sun.any_orthonormal_vector();
    let along = sun.cross(across);
    let edge = model.disc_edge_rad().sin();
    let mut sum = [0.0; 3];
    for i in 0..RINGS {
        let s = edge * ((i as f64 + 0.5) / RINGS as f64).sqrt();
        for j in 0..SPOKES {
            let (sin, cos) = (TAU * (j as f64 + 0.5) / SPOKES as f64).sin_cos();
            let direction = sun * (1.0 - s * s).sqrt() + (across * cos + along * sin) * s;
            sum = plus(sum, model.disc_xyz(direction));
        }
    }
    sum.map(|v| PI * edge * edge * v / (RINGS * SPOKES) as f64)
}

/// A published model in one frame, row by row.
pub struct ClassicRows<'a> {
    model: &'a dyn ClassicSky,
    /// What lies below the horizontal (XYZ), where the model has nothing there.
    ground: Option<[f64; 3]>,
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
        (model, ground): (&'a dyn ClassicSky, [f64; 3]),
        disc: Option<&'a Disc>,
        space: RgbSpace,
        scale: f32,
    ) -> Self {
        Self {
            model,
            ground: (!model.has_ground()).then_some(ground),
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
                    let xyz = match self.ground {
                        Some(ground) if direction.y < 0.0 => ground,
                        _ => walk(direction),
                    };
                    let rgb = rgb::apply(&self.rgb_from_xyz, xyz);
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
