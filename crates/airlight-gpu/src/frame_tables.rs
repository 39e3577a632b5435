//! [`SkySolver`] and [`FrameTables`]: what frames are drawn with, computed without a device.

use crate::error::SkyRendererError;
use crate::fog::{Fog, FogFrame};
use crate::lighting::Lighting;
use airlight::atmosphere::Atmosphere;
use airlight::glam::DVec3;
use airlight::sky::{Sky, SkySettings, View};
use airlight::spectrum::RgbSpace;
use airlight::sun::SunState;
use airlight_shaders::twins::texture::Texture;
use airlight_shaders::{ColourFit, SkyTables, WAVELENGTHS_NM, wavelength_grid};
use glam::{Vec3, Vec4};
use std::sync::Arc;

/// Texels of the table of the sun's disc.
const DISC_TEXELS: usize = 64;

/// A solved sky that fills the tables of frames. It needs no device, so that a thread or a worker of a web page can hold it. Cloning is
/// cheap.
#[derive(Clone, Debug)]
pub struct SkySolver {
    sky: Sky,
    fit: Arc<ColourFit>,
    space: RgbSpace,
}

/// Tables of a frame for one eye and one sun: plain data, which [`SkyPasses`](crate::SkyPasses) uploads.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameTables {
    /// Sky and aerial perspective.
    pub sky: SkyTables,
    /// Radiance of the sun's disc outside the air, W m^-2 sr^-1 nm^-1, by the cosine at the sun's surface, 0 at the limb.
    pub disc: Texture,
    /// 1 minus the cosine of the angular radius of the sun's disc.
    pub disc_one_minus_cos: f32,
    /// Fog, with the light of this sky.
    pub fog: Option<FogFrame>,
    /// Light on surfaces at the eye.
    pub lighting: Lighting,
}

impl SkySolver {
    /// Solves for the light in an atmosphere, which takes a second or more.
    ///
    /// # Errors
    /// [`SkyRendererError`] if the sky cannot be solved.
    pub fn new(
        atmosphere: &Atmosphere,
        settings: &SkySettings,
        space: RgbSpace,
    ) -> Result<Self, SkyRendererError> {
        Ok(Self {
            sky: Sky::prepare(atmosphere, &wavelength_grid(), settings)?,
            fit: Arc::new(ColourFit::new(atmosphere, settings.suns)?),
            space,
        })
    }

    /// Tables for an eye at a height above sea level, m, a sun, by its direction or with its distance, and a fog.
    ///
    /// # Errors
    /// [`SkyRendererError`] for numbers that are no place or direction, for an invalid fog, and for a place that the sky is not
    /// prepared for and cannot be solved for.
    pub fn tables(
        &self,
        height_m: f64,
        sun: impl Into<SunState>,
        fog: Option<&Fog>,
    ) -> Result<FrameTables, SkyRendererError> {
        let sun = sun.into();
        let (height_m, direction) = checked(height_m, sun.direction)?;
        let sun = SunState { direction, ..sun };
        fog.map_or(Ok(()), Fog::validate)?;
        let view = self.sky.try_view(height_m, sun)?;
        let split = view.split();
        let sky = SkyTables::of(&split, &self.fit, self.space)?;
        let direct = self.fit.sun_illuminance_lx(&view, self.space)?;
        let lighting = Lighting::new(split.table(), &sky, direct);
        let (fog, lighting) = match fog {
            Some(fog) => {
                let lit = fog.lit(&lighting)?;
                let tables = fog.tables(height_m, &lit)?;
                let in_fog = lighting.in_fog(&lit, height_m, |d| sky.rgb_radiance(d));
                (Some(fog.frame(tables, height_m)), in_fog)
            }
            None => (None, lighting),
        };
        let half_sine = (0.5 * view.disc().angular_radius_rad).sin();
        Ok(FrameTables {
            sky,
            disc: disc(&view),
            disc_one_minus_cos: (2.0 * half_sine * half_sine) as f32,
            fog,
            lighting,
        })
    }

    /// The solved sky.
    pub fn sky(&self) -> &Sky {
        &self.sky
    }
}

impl FrameTables {
    /// Red, green and blue along a unit vector without geometry and without the sun's disc, cd/m^2: what the passes draw.
    pub fn rgb_radiance(&self, direction: Vec3) -> Vec3 {
        let behind = self.sky.rgb_radiance(direction);
        match &self.fog {
            Some(fog) => fog.in_front_of(behind, direction),
            None => behind,
        }
    }
}

/// A height that is a number, and a unit vector towards the sun.
pub(crate) fn checked(height_m: f64, sun: DVec3) -> Result<(f64, DVec3), SkyRendererError> {
    if !height_m.is_finite() {
        return Err(SkyRendererError::Height(height_m));
    }
    let sun = sun.try_normalize().ok_or(SkyRendererError::Sun(sun))?;
    Ok((height_m, sun))
}

/// The table of the sun's disc.
fn disc(view: &View) -> Texture {
    let solar = view.solar_irradiance();
    let disc = view.disc();
    let texels = (0..DISC_TEXELS).map(|k| {
        let mu = k as f64 / (DISC_TEXELS - 1) as f64;
        // The edge itself is outside the disc.
        let angle = disc.angular_radius_rad * (1.0 - mu * mu).sqrt().min(1.0 - 1e-9);
        Vec4::from_array(std::array::from_fn(|lane| {
            let relative = disc.radiance_per_irradiance(angle, WAVELENGTHS_NM[lane]);
            solar[lane] * relative as f32
        }))
    });
    Texture::new([DISC_TEXELS, 1, 1], texels.collect())
}
