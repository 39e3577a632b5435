//! [`DiscTable`]: the disc of the sun or of the moon.

use airlight::glam::DVec3;
use airlight::night::MoonState;
use airlight::sky::{LightSource, View};
use airlight_shaders::WAVELENGTHS_NM;
use airlight_shaders::twins::texture::Texture;
use glam::{Vec3, Vec4};

/// Texels of the table.
const TEXELS: usize = 64;

/// Disc of a light source outside the air.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscTable {
    /// Radiance of the disc, W m^-2 sr^-1 nm^-1, by the cosine at its surface, 0 at the limb; for the moon, where it reflects twice
    /// [`airlight_shaders::twins::disc::moon_reflection`].
    pub radiance: Texture,
    /// 1 minus the cosine of the angular radius.
    pub one_minus_cos: f32,
    /// Unit vector from the moon to the sun, which lights a part of its disc; 0 for the sun itself.
    pub moon_to_sun: Vec3,
}

impl DiscTable {
    pub(crate) fn new(view: &View) -> Self {
        let (disc, source) = (view.disc(), view.source());
        let half_sine = (0.5 * disc.angular_radius_rad).sin();
        let (moon_to_sun, factor) = match source {
            LightSource::Moon(moon) => (moon.to_sun.as_vec3(), 2.0 * at_half_reflection(moon)),
            _ => (Vec3::ZERO, 1.0),
        };
        Self {
            radiance: radiance(view, factor),
            one_minus_cos: (2.0 * half_sine * half_sine) as f32,
            moon_to_sun,
        }
    }

    /// The numbers of the shader's struct `Disc`.
    pub(crate) fn numbers(&self) -> [f32; 8] {
        let [x, y, z] = self.moon_to_sun.to_array();
        let sin_radius = (self.one_minus_cos * (2.0 - self.one_minus_cos)).sqrt();
        [
            x,
            y,
            z,
            self.one_minus_cos,
            sin_radius,
            self.brightest(),
            0.0,
            0.0,
        ]
    }

    /// The texture relative to its largest value, as half floats resolve it for the moon, too.
    pub(crate) fn texture(&self) -> Texture {
        let brightest = self.brightest();
        let texels = self.radiance.texels().iter().map(|texel| texel / brightest);
        Texture::new(self.radiance.size(), texels.collect())
    }

    fn brightest(&self) -> f32 {
        let texels = self.radiance.texels().iter();
        texels
            .map(|texel| texel.max_element())
            .fold(f32::MIN_POSITIVE, f32::max)
    }
}

/// Radiance by the cosine at the surface, times a factor.
fn radiance(view: &View, factor: f64) -> Texture {
    let (disc, irradiance) = (view.disc(), view.solar_irradiance());
    let texels = (0..TEXELS).map(|k| {
        let mu = k as f64 / (TEXELS - 1) as f64;
        // The edge itself is outside the disc.
        let angle = disc.angular_radius_rad * (1.0 - mu * mu).sqrt().min(1.0 - 1e-9);
        Vec4::from_array(std::array::from_fn(|lane| {
            let relative = factor * disc.radiance_per_irradiance(angle, WAVELENGTHS_NM[lane]);
            irradiance[lane] * relative as f32
        }))
    });
    Texture::new([TEXELS, 1, 1], texels.collect())
}

/// Radiance of the moon relative to the mean of its disc where sun and eye are equally high above its ground, so that the law of Lommel
/// and Seeliger is one half.
fn at_half_reflection(moon: &MoonState) -> f64 {
    let normal = (moon.to_sun - moon.direction).normalize_or(DVec3::ZERO);
    let aside = normal - moon.direction * normal.dot(moon.direction);
    let place = moon.direction + aside * moon.angular_radius_rad().sin();
    moon.relative_radiance(place.normalize())
}
