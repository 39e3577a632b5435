//! A published model over the ground that it lights, and what it sheds on surfaces at the eye.

use crate::illuminance::Illuminances;
use airlight::axes;
use airlight::models::PublishedModel;
use airlight::spectrum::rgb::DOMINANT_NM;
use airlight::spectrum::{RgbSpace, SpectralCurve, WavelengthGrid, rgb};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Light as a colour and, of models that know them, as a spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// CIE 1931 XYZ, cd/m^2 (of irradiance: lx).
    pub xyz: [f64; 3],
    /// W m^-2 sr^-1 nm^-1 (of irradiance: W m^-2 nm^-1) at the model's wavelengths; empty for models that know colours only.
    pub spectrum: Vec<f64>,
}

/// A published model of the sky over its ground.
pub struct Lit {
    /// The model.
    pub model: Arc<dyn PublishedModel>,
    /// What lies below the horizontal; none where the model has ground of its own.
    pub ground: Option<Light>,
    /// Irradiance of the sun's disc on a surface that faces it.
    pub sun_normal: Light,
    /// Irradiance of the sky on the horizontal.
    pub sky_horizontal: Light,
}

impl Lit {
    /// A model over ground of an albedo. The sky's irradiance is summed over bands of equal weight and equal turns about
    /// the sun's azimuth: within 1 % where haze does not crowd the light about the sun.
    pub fn new(model: Arc<dyn PublishedModel>, albedo: &SpectralCurve) -> Self {
        let (sun_normal, sky_horizontal) = (sun(model.as_ref()), sky(model.as_ref()));
        let mut lit = Self {
            ground: None,
            sun_normal,
            sky_horizontal,
            model,
        };
        if !lit.model.has_ground() {
            lit.ground = Some(lit.reflected(albedo));
        }
        lit
    }

    /// Sine of the sun's elevation, or 0.
    pub fn sin_sun(&self) -> f64 {
        self.model.sun().y.max(0.0)
    }

    /// What is shed on surfaces, as illuminances.
    pub fn illuminances(&self) -> Illuminances {
        Illuminances {
            sun_normal_lx: self.sun_normal.xyz[1],
            sun_horizontal_lx: self.sun_normal.xyz[1] * self.sin_sun(),
            sky_horizontal_lx: self.sky_horizontal.xyz[1],
        }
    }

    /// Light along a direction, without the sun's disc.
    pub fn along(&self, direction: DVec3) -> Light {
        match &self.ground {
            Some(ground) if direction.y < 0.0 => ground.clone(),
            _ => along(self.model.as_ref(), direction),
        }
    }

    /// Light of ground that reflects evenly what falls on it. Where there is no spectrum, its albedo is taken at the
    /// wavelengths that the sRGB primaries look like: exact for grey ground.
    fn reflected(&self, albedo: &SpectralCurve) -> Light {
        let falling = self
            .sky_horizontal
            .clone()
            .plus(self.sun_normal.clone().times(self.sin_sun()));
        if let Some(grid) = self.model.grid() {
            let lanes = falling.spectrum.iter().zip(grid.wavelengths_nm());
            let reflected = lanes.map(|(&e, &nm)| albedo.at(nm) * e / PI).collect();
            return Light::of_spectrum(grid, reflected);
        }
        let rgb = RgbSpace::Srgb.from_xyz(falling.xyz);
        let reflected = [0, 1, 2].map(|i| albedo.at(DOMINANT_NM[i]) * rgb[i] / PI);
        Light {
            xyz: rgb::apply(&RgbSpace::Srgb.to_xyz_matrix(), reflected),
            spectrum: Vec::new(),
        }
    }
}

impl Light {
    fn of_spectrum(grid: &WavelengthGrid, spectrum: Vec<f64>) -> Self {
        let lanes: Vec<f32> = spectrum.iter().map(|&v| v as f32).collect();
        Self {
            xyz: grid.to_xyz(&lanes),
            spectrum,
        }
    }

    fn dark(lanes: usize) -> Self {
        Self {
            xyz: [0.0; 3],
            spectrum: vec![0.0; lanes],
        }
    }

    fn plus(mut self, other: Self) -> Self {
        let add = |(sum, v): (&mut f64, f64)| *sum += v;
        self.xyz.iter_mut().zip(other.xyz).for_each(add);
        self.spectrum.iter_mut().zip(other.spectrum).for_each(add);
        self
    }

    fn times(mut self, factor: f64) -> Self {
        let values = self.xyz.iter_mut().chain(&mut self.spectrum);
        values.for_each(|v| *v *= factor);
        self
    }
}

/// Light of a model's sky along a direction.
fn along(model: &dyn PublishedModel, direction: DVec3) -> Light {
    match model.grid() {
        Some(grid) => Light::of_spectrum(grid, model.sky_spectrum(direction)),
        None => Light {
            xyz: model.sky_xyz(direction),
            spectrum: Vec::new(),
        },
    }
}

/// Light of the sun's disc along a direction.
pub fn disc(model: &dyn PublishedModel, direction: DVec3) -> Light {
    match model.grid() {
        Some(grid) => Light::of_spectrum(grid, model.disc_spectrum(direction)),
        None => Light {
            xyz: model.disc_xyz(direction),
            spectrum: Vec::new(),
        },
    }
}

/// Irradiance of the sky on the horizontal.
fn sky(model: &dyn PublishedModel) -> Light {
    const BANDS: usize = 48;
    const TURNS: usize = 96;
    let dark = || Light::dark(model.wavelengths_nm().len());
    let azimuth_deg = axes::azimuth_deg(model.sun());
    let band = |i: usize| {
        // Equal parts of sin^2: each weighs the same on the horizontal.
        let elevation = ((i as f64 + 0.5) / BANDS as f64).sqrt().asin();
        let at = |j: usize| azimuth_deg + 360.0 * (j as f64 + 0.5) / TURNS as f64;
        (0..TURNS).fold(dark(), |sum, j| {
            sum.plus(along(model, axes::direction(at(j), elevation.to_degrees())))
        })
    };
    let bands: Vec<_> = (0..BANDS).into_par_iter().map(band).collect();
    let sum = bands.into_iter().fold(dark(), Light::plus);
    sum.times(PI / (BANDS * TURNS) as f64)
}

/// Irradiance of the disc on a surface that faces it, from rings of equal area.
fn sun(model: &dyn PublishedModel) -> Light {
    const RINGS: usize = 64;
    const SPOKES: usize = 32;
    let sun = model.sun();
    let across = sun.any_orthonormal_vector();
    let along = sun.cross(across);
    let edge = model.disc_edge_rad().sin();
    let mut sum = Light::dark(model.wavelengths_nm().len());
    for i in 0..RINGS {
        let s = edge * ((i as f64 + 0.5) / RINGS as f64).sqrt();
        for j in 0..SPOKES {
            let (sin, cos) = (TAU * (j as f64 + 0.5) / SPOKES as f64).sin_cos();
            let direction = sun * (1.0 - s * s).sqrt() + (across * cos + along * sin) * s;
            sum = sum.plus(disc(model, direction));
        }
    }
    sum.times(PI * edge * edge / (RINGS * SPOKES) as f64)
}
