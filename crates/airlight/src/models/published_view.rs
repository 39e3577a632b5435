//! [`PublishedModel`]: sky and sun of a published model, and its view, with the ground that it lights, as a
//! [`RadianceView`].

use crate::axes;
use crate::math::parallel;
use crate::scene::{Channels, IrradianceMap, RadianceView, SceneError, horizontal_irradiance};
use crate::sky::LineOfSight;
use crate::spectrum::rgb::{self, DOMINANT_NM};
use crate::spectrum::{RgbSpace, SpectralCurve, WavelengthGrid};
use crate::sun::SunDisc;
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use std::fmt;
use std::sync::{Arc, LazyLock, OnceLock};

/// A published model of the sky for one eye and one sun, symmetric about the vertical plane of the sun.
///
/// Colours are CIE 1931 XYZ with `Y` in cd/m^2. Directions are unit vectors that point away from the eye
/// ([`crate::axes`]).
pub trait PublishedModel: Send + Sync {
    /// Unit vector towards the sun's centre.
    fn sun(&self) -> DVec3;

    /// Size and limb darkening of the sun's disc.
    fn disc(&self) -> &SunDisc {
        static SUN: LazyLock<SunDisc> = LazyLock::new(SunDisc::default);
        &SUN
    }

    /// Angle from the sun's centre beyond which its disc has no light, rad.
    fn disc_edge_rad(&self) -> f64 {
        self.disc().angular_radius_rad
    }

    /// True if the radiance below the horizon includes the model's own ground and the air in front of it. For other models the
    /// renderer draws the ground.
    fn has_ground(&self) -> bool {
        false
    }

    /// Colour of the sky along a direction, without the sun's disc.
    fn sky_xyz(&self, direction: DVec3) -> [f64; 3];

    /// Colour of the sun's disc along a direction, attenuated by the air; black outside the disc.
    fn disc_xyz(&self, direction: DVec3) -> [f64; 3];

    /// Evaluates the sky along one direction after another, for models that reuse results of neighbouring directions: equal to
    /// [`Self::sky_xyz`] within the tolerance that such a model states.
    fn walk(&self) -> Box<dyn FnMut(DVec3) -> [f64; 3] + '_> {
        Box::new(|direction| self.sky_xyz(direction))
    }

    /// Wavelengths of the model's spectra, with their solar spectrum; `None` for models of colours only.
    fn grid(&self) -> Option<&WavelengthGrid> {
        None
    }

    /// Wavelengths of the model's spectra, nm; empty for models of colours only.
    fn wavelengths_nm(&self) -> &[f64] {
        self.grid().map_or(&[], WavelengthGrid::wavelengths_nm)
    }

    /// Spectral radiance of the sky (W m^-2 sr^-1 nm^-1) along a direction, at [`Self::wavelengths_nm`]; its colour is
    /// [`Self::sky_xyz`].
    fn sky_spectrum(&self, _direction: DVec3) -> Vec<f64> {
        Vec::new()
    }

    /// Spectral radiance of the sun's disc along a direction; its colour is [`Self::disc_xyz`].
    fn disc_spectrum(&self, _direction: DVec3) -> Vec<f64> {
        Vec::new()
    }

    /// Light along a direction over at most `limit_m` metres (`None`: to the ground or to space), by parts, at
    /// [`Self::wavelengths_nm`]; `None` for models that do not separate path radiance, ground and orders of scattering.
    fn line(&self, _direction: DVec3, _limit_m: Option<f64>) -> Option<LineOfSight> {
        None
    }

    /// Transmittance and path radiance at [`Self::wavelengths_nm`] between the eye and a point at a distance (m), for models
    /// that light objects through air and fog.
    fn path(&self, _direction: DVec3, _distance_m: f64) -> Option<(Vec<f32>, Vec<f64>)> {
        None
    }

    /// Irradiance of the sun's disc at a height above the ground (m), on a surface that faces it, for the same models.
    fn sunlight(&self, _height_m: f64) -> Option<Vec<f64>> {
        None
    }
}

/// A published model in the channels of a picture.
///
/// Internally, light is in the lanes of the model: radiances at its wavelengths, or CIE 1931 XYZ in cd/m^2 for models of
/// colours only. Irradiances are sums over bands of equal weight, accurate to 1 % unless haze has a narrow aureole.
pub(super) struct PublishedView {
    model: Arc<dyn PublishedModel>,
    channels: Channels,
    /// Wavelengths of spectral values; `None` for RGB.
    grid: Option<WavelengthGrid>,
    /// Radiance below the horizon; `None` if the model has its own ground.
    ground: Option<Vec<f64>>,
    /// Irradiance of the sun's disc on a surface that faces it.
    sun_normal: Vec<f64>,
    /// Irradiance of the sky on a horizontal surface.
    sky_horizontal: Vec<f64>,
    irradiance: OnceLock<IrradianceMap>,
}

impl PublishedView {
    /// View of the model called `name` over ground with an albedo.
    ///
    /// # Errors
    /// [`SceneError::NoSpectra`] for spectral channels of a model of colours only.
    pub fn new(
        name: &'static str,
        model: Arc<dyn PublishedModel>,
        albedo: &SpectralCurve,
        channels: Channels,
    ) -> Result<Self, SceneError> {
        let grid = match channels {
            Channels::Rgb(_) => None,
            Channels::Spectral => Some(model.grid().ok_or(SceneError::NoSpectra(name))?.clone()),
        };
        let mut view = Self {
            sun_normal: sun_normal(model.as_ref()),
            sky_horizontal: sky_horizontal(model.as_ref()),
            ground: None,
            irradiance: OnceLock::new(),
            channels,
            grid,
            model,
        };
        if !view.model.has_ground() {
            view.ground = Some(view.reflected(albedo));
        }
        Ok(view)
    }

    /// Radiance of Lambertian ground. For models of colours only, its albedo is evaluated at the dominant wavelengths of the
    /// sRGB primaries, which is exact for grey ground.
    fn reflected(&self, albedo: &SpectralCurve) -> Vec<f64> {
        let sin_sun = self.model.sun().y.max(0.0);
        let lanes = self.sky_horizontal.iter().zip(&self.sun_normal);
        let falling: Vec<f64> = lanes.map(|(sky, sun)| sky + sin_sun * sun).collect();
        if let Some(grid) = self.model.grid() {
            let lanes = falling.iter().zip(grid.wavelengths_nm());
            return lanes.map(|(&e, &nm)| albedo.at(nm) * e / PI).collect();
        }
        let rgb = RgbSpace::Srgb.from_xyz([falling[0], falling[1], falling[2]]);
        let reflected = [0, 1, 2].map(|i| albedo.at(DOMINANT_NM[i]) * rgb[i] / PI);
        rgb::apply(&RgbSpace::Srgb.to_xyz_matrix(), reflected).to_vec()
    }

    /// Radiance along a direction in the lanes of the model, without the sun's disc.
    fn along(&self, direction: DVec3) -> Vec<f64> {
        match &self.ground {
            Some(ground) if direction.y < 0.0 => ground.clone(),
            _ => sky(self.model.as_ref(), direction),
        }
    }

    /// Converts lanes of the model to channels.
    fn put(&self, lanes: &[f64], out: &mut [f32]) {
        let space = match self.channels {
            Channels::Spectral => {
                out.iter_mut()
                    .zip(lanes)
                    .for_each(|(out, v)| *out = *v as f32);
                return;
            }
            Channels::Rgb(space) => space,
        };
        let xyz = match (self.model.grid(), lanes) {
            (Some(grid), lanes) => {
                let lanes: Vec<f32> = lanes.iter().map(|&v| v as f32).collect();
                grid.to_xyz(&lanes)
            }
            (None, &[x, y, z]) => [x, y, z],
            (None, _) => [0.0; 3],
        };
        put_xyz(space, xyz, out);
    }

    /// [`Self::put`] with negative values clamped to 0.
    fn put_light(&self, lanes: &[f64], out: &mut [f32]) {
        self.put(lanes, out);
        out.iter_mut().for_each(|v| *v = v.max(0.0));
    }

    /// Converts transmittance in lanes to channels, weighted by sunlight.
    fn put_transmittance(&self, lanes: &[f32], out: &mut [f32]) {
        let (Channels::Rgb(space), Some(grid)) = (self.channels, self.model.grid()) else {
            out.copy_from_slice(lanes);
            return;
        };
        let (mut through, mut whole) = ([0.0f64; 3], [0.0f64; 3]);
        let sun = grid.solar_irradiance();
        for ((weights, sun), lane) in grid.rgb_weights(space).iter().zip(sun).zip(lanes) {
            for c in 0..3 {
                let light = f64::from(weights[c]) * sun;
                through[c] += light * f64::from(*lane);
                whole[c] += light;
            }
        }
        for (c, out) in out.iter_mut().enumerate() {
            *out = (through[c] / whole[c]) as f32;
        }
    }
}

fn put_xyz(space: RgbSpace, xyz: [f64; 3], out: &mut [f32]) {
    let rgb = space.from_xyz(xyz);
    out.iter_mut().zip(rgb).for_each(|(out, v)| *out = v as f32);
}

impl RadianceView for PublishedView {
    fn channels(&self) -> Channels {
        self.channels
    }

    fn grid(&self) -> Option<&WavelengthGrid> {
        self.grid.as_ref()
    }

    fn sun(&self) -> DVec3 {
        self.model.sun()
    }

    fn disc(&self) -> &SunDisc {
        self.model.disc()
    }

    /// RGB values reuse results of neighbouring directions; spectra are computed for each direction.
    fn radiance(&self, directions: &[DVec3], out: &mut [f32]) {
        let values = out.chunks_exact_mut(self.channel_count());
        match self.channels {
            Channels::Rgb(space) => {
                let mut walk = self.model.walk();
                for (&direction, out) in directions.iter().zip(values) {
                    match &self.ground {
                        _ if direction == DVec3::ZERO => out.fill(0.0),
                        Some(ground) if direction.y < 0.0 => self.put(ground, out),
                        _ => put_xyz(space, walk(direction), out),
                    }
                }
            }
            Channels::Spectral => {
                for (&direction, out) in directions.iter().zip(values) {
                    match direction == DVec3::ZERO {
                        true => out.fill(0.0),
                        false => self.put(&self.along(direction), out),
                    }
                }
            }
        }
    }

    fn sun_disc(&self, directions: &[DVec3], out: &mut [f32]) {
        let values = out.chunks_exact_mut(self.channel_count());
        for (&direction, out) in directions.iter().zip(values) {
            match direction == DVec3::ZERO {
                true => out.fill(0.0),
                false => self.put(&disc(self.model.as_ref(), direction), out),
            }
        }
    }

    fn irradiance(&self, normals: &[DVec3], out: &mut [f32]) {
        let count = self.channel_count();
        let map = self.irradiance.get_or_init(|| {
            parallel::apart(|| {
                IrradianceMap::new(self.model.sun(), count, |directions, out| {
                    for (&direction, out) in directions.iter().zip(out.chunks_exact_mut(count)) {
                        self.put_light(&self.along(direction), out);
                    }
                })
            })
        });
        for (&normal, out) in normals.iter().zip(out.chunks_exact_mut(count)) {
            map.irradiance(normal, out);
        }
    }

    fn horizontal_irradiance(&self, out: &mut [f32]) {
        self.put(&self.sky_horizontal, out);
    }

    fn sun_irradiance(&self, out: &mut [f32]) {
        self.put(&self.sun_normal, out);
    }

    fn sunlight(&self, height_m: f64, out: &mut [f32]) {
        match self.model.sunlight(height_m) {
            Some(lanes) => self.put_light(&lanes, out),
            None => self.put_light(&self.sun_normal, out),
        }
    }

    fn path(
        &self,
        direction: DVec3,
        distance_m: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        match self.model.path(direction, distance_m) {
            Some((through, scattered)) => {
                self.put_transmittance(&through, transmittance);
                self.put_light(&scattered, path_radiance);
            }
            None => {
                transmittance.fill(1.0);
                path_radiance.fill(0.0);
            }
        }
    }

    fn line_of_sight(&self, direction: DVec3, limit_m: Option<f64>) -> Option<LineOfSight> {
        self.model.line(direction, limit_m)
    }
}

impl fmt::Debug for PublishedView {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PublishedView")
            .field("channels", &self.channels)
            .field("sun", &self.model.sun())
            .finish_non_exhaustive()
    }
}

/// Light of a model's sky along a direction, in its lanes.
fn sky(model: &dyn PublishedModel, direction: DVec3) -> Vec<f64> {
    match model.grid() {
        Some(_) => model.sky_spectrum(direction),
        None => model.sky_xyz(direction).to_vec(),
    }
}

/// Light of the sun's disc along a direction, in the lanes of a model.
fn disc(model: &dyn PublishedModel, direction: DVec3) -> Vec<f64> {
    match model.grid() {
        Some(_) => model.disc_spectrum(direction),
        None => model.disc_xyz(direction).to_vec(),
    }
}

fn dark(model: &dyn PublishedModel) -> Vec<f64> {
    vec![0.0; model.grid().map_or(3, WavelengthGrid::len)]
}

fn add(sum: &mut [f64], values: &[f64]) {
    sum.iter_mut().zip(values).for_each(|(sum, v)| *sum += v);
}

/// Irradiance of the sky, which is symmetric about the vertical plane of the sun, on a horizontal surface.
fn sky_horizontal(model: &dyn PublishedModel) -> Vec<f64> {
    /// Number of rings, and of directions in each.
    const DIRECTIONS: (usize, usize) = (48, 96);
    let azimuth_deg = axes::azimuth_deg(model.sun());
    let lanes = dark(model).len();
    horizontal_irradiance(DIRECTIONS, azimuth_deg, lanes, |directions, sum| {
        // One side of the sun's plane.
        for &direction in &directions[..directions.len() / 2] {
            add(sum, &sky(model, direction));
        }
        sum.iter_mut().for_each(|v| *v *= 2.0);
    })
}

/// Irradiance of the disc on a surface that faces it, from rings of equal area.
fn sun_normal(model: &dyn PublishedModel) -> Vec<f64> {
    const RINGS: usize = 64;
    const SPOKES: usize = 32;
    let sun = model.sun();
    let across = sun.any_orthonormal_vector();
    let along = sun.cross(across);
    let edge = model.disc().angular_radius_rad.sin();
    let mut sum = dark(model);
    for i in 0..RINGS {
        let s = edge * ((i as f64 + 0.5) / RINGS as f64).sqrt();
        for j in 0..SPOKES {
            let (sin, cos) = (TAU * (j as f64 + 0.5) / SPOKES as f64).sin_cos();
            let direction = sun * (1.0 - s * s).sqrt() + (across * cos + along * sin) * s;
            add(&mut sum, &disc(model, direction));
        }
    }
    sum.iter_mut()
        .for_each(|v| *v *= PI * edge * edge / (RINGS * SPOKES) as f64);
    sum
}
