//! The fog between the camera and the objects of a picture.

use super::primaries::Primaries;
use airlight::fog::lights::{RgbLightSet, ViewRay};
use airlight::fog::{EvenFog, Ground, RgbFog, RgbFogTable, legacy};
use airlight::scene::RgbFoggySky;
use airlight::spectrum::rgb::{srgb_decode, srgb_encode};
use airlight::transfer::RgbPathOptics;
use glam::DVec3;
use std::sync::LazyLock;

/// The fog between the camera and the objects of a picture.
#[derive(Debug, Clone)]
pub enum FogOverlay {
    /// Fog that scatters light, and the lights in it.
    Fog(FogSource, Option<RgbLightSet>),
    /// Exponential-squared fog of one colour: density (1/m) and colour.
    ExponentialSquared(f64, [f32; 3]),
    /// Linear fog of one colour: start and end (m), and colour.
    Linear(f64, f64, [f32; 3]),
    /// Foggy Cityscapes (Sakaridis et al. 2018): uniform fog of an extinction (1/m) and one colour, blended in encoded
    /// (sRGB) values instead of light.
    Encoded(f64, [f32; 3]),
}

/// Fog that scatters daylight.
#[derive(Debug, Clone)]
pub enum FogSource {
    /// Fog in ambient light and sunlight.
    Alone(RgbFog),
    /// Fog in a solved sky.
    Sky {
        /// Sky and fog, with the eye at the camera's height.
        sky: RgbFoggySky,
        /// Units of the picture in one cd/m^2.
        radiance_scale: f32,
        /// Whether the picture shows the clear air.
        air: ExistingAerial,
    },
}

/// Whether a picture shows the clear air in front of its objects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ExistingAerial {
    /// It does, like photographs.
    #[default]
    Drawn,
    /// It does not, like many rendered pictures: the air is added, except in front of the sky.
    Missing,
}

airlight::named! { ExistingAerial, "drawn or missing air", [
    ("drawn", (Drawn), "it does, like photographs"),
    ("missing", (Missing), "it does not, like many rendered pictures: the air is added"),
] }

/// A fog overlay from one eye height, tabulated for the pixels of a picture.
#[derive(Debug)]
pub(super) struct FogSampler<'a> {
    overlay: &'a FogOverlay,
    eye_height_m: f64,
    /// Those of the picture, in which colours are given and returned.
    primaries: Primaries,
    /// Table of [`FogSource::Alone`].
    table: Option<RgbFogTable>,
    even: Option<EvenFog>,
    /// The encoded colour of [`FogOverlay::Encoded`] in the picture's primaries.
    encoded: Option<[f32; 3]>,
}

impl<'a> FogSampler<'a> {
    /// Prepares an overlay for an eye height, m, and the primaries of a picture.
    pub fn new(overlay: &'a FogOverlay, eye_height_m: f64, primaries: Primaries) -> Self {
        let table = match overlay {
            FogOverlay::Fog(FogSource::Alone(fog), _) => Some(fog.seen_from(eye_height_m)),
            _ => None,
        };
        let even = match overlay {
            FogOverlay::Fog(FogSource::Alone(fog), None) if primaries.are_srgb() => fog.even(),
            _ => None,
        };
        let encoded = match overlay {
            FogOverlay::Encoded(_, colour) => Some(primaries.in_picture(*colour).map(encode)),
            _ => None,
        };
        Self {
            overlay,
            eye_height_m,
            primaries,
            table,
            even,
            encoded,
        }
    }

    /// The whole overlay, if it is even fog in the primaries of the picture.
    pub fn even(&self) -> Option<&EvenFog> {
        self.even.as_ref()
    }

    /// Height of the eye and radius of the ground of the fog, m.
    pub fn place(&self) -> (f64, f64) {
        let ground = match self.overlay {
            FogOverlay::Fog(FogSource::Sky { sky, .. }, _) => *sky.ground(),
            _ => Ground::FLAT,
        };
        (self.eye_height_m, ground.radius_m)
    }

    /// Transmittance and path radiance of rays with directions up to distances (m; infinite: the sky). `factors`, if given, are
    /// those of patches on the optical depth of fog that scatters light; `path_radiance` replaces that of the fog.
    pub fn optics(
        &self,
        directions: &[DVec3],
        distances_m: &[f64],
        factors: Option<&[f32]>,
        path_radiance: Option<&[[f32; 3]]>,
        out: &mut [RgbPathOptics],
    ) {
        let rays = directions.iter().zip(distances_m);
        match self.overlay {
            FogOverlay::Fog(source, lights) => {
                match (source, &self.table) {
                    (FogSource::Alone(_), Some(table)) => {
                        table.paths(directions, distances_m, out);
                        for (optics, factor) in out.iter_mut().zip(factors.into_iter().flatten()) {
                            *optics = optics.at_density(*factor);
                        }
                    }
                    _ => {
                        for (i, (out, (&direction, &distance_m))) in
                            out.iter_mut().zip(rays.clone()).enumerate()
                        {
                            let factor = factors.map(|factors| factors[i]);
                            *out = source.optics(self.eye_height_m, direction, distance_m, factor);
                        }
                    }
                }
                for (optics, given) in out.iter_mut().zip(path_radiance.into_iter().flatten()) {
                    optics.path_radiance = *given;
                }
                if let Some(lights) = lights {
                    for (optics, (&direction, &distance_m)) in out.iter_mut().zip(rays) {
                        let glow = lights.path_radiance(&ViewRay {
                            eye: DVec3::Y * self.eye_height_m,
                            direction,
                            length_m: distance_m,
                        });
                        for (light, glow) in optics.path_radiance.iter_mut().zip(glow) {
                            *light += glow;
                        }
                    }
                }
            }
            FogOverlay::ExponentialSquared(density, colour) => {
                for (out, &distance_m) in out.iter_mut().zip(distances_m) {
                    *out = legacy::exponential_squared(*density, distance_m, *colour);
                }
            }
            FogOverlay::Linear(start, end, colour) => {
                for (out, &distance_m) in out.iter_mut().zip(distances_m) {
                    *out = legacy::linear(*start, *end, distance_m, *colour);
                }
            }
            FogOverlay::Encoded(extinction, colour) => {
                for (out, &distance_m) in out.iter_mut().zip(distances_m) {
                    let transmittance = (-extinction * distance_m).exp() as f32;
                    *out = RgbPathOptics {
                        transmittance: [transmittance; 3],
                        path_radiance: colour.map(|c| c * (1.0 - transmittance)),
                    };
                }
            }
        }
        if !self.primaries.are_srgb() {
            for optics in out {
                *optics = self.primaries.optics(*optics);
            }
        }
    }

    /// A colour through the fog.
    #[inline]
    pub fn apply(&self, optics: &RgbPathOptics, colour: [f32; 3]) -> [f32; 3] {
        match &self.encoded {
            Some(fog) => blended(colour, optics.transmittance[0], fog),
            None => optics.apply(colour),
        }
    }

    /// Colours through the fog.
    pub fn apply_all(&self, optics: &[RgbPathOptics], colours: &[[f32; 3]], out: &mut [[f32; 3]]) {
        let pixels = out.iter_mut().zip(optics).zip(colours);
        match &self.encoded {
            Some(fog) => {
                for ((out, optics), colour) in pixels {
                    *out = blended(*colour, optics.transmittance[0], fog);
                }
            }
            None => {
                for ((out, optics), colour) in pixels {
                    for c in 0..3 {
                        out[c] = optics.path_radiance[c] + optics.transmittance[c] * colour[c];
                    }
                }
            }
        }
    }
}

/// A part of a colour and the rest of an encoded one, blended in encoded values.
#[inline]
fn blended(colour: [f32; 3], part: f32, fog: &[f32; 3]) -> [f32; 3] {
    if part == 1.0 {
        return colour;
    }
    let mut out = [0.0; 3];
    for c in 0..3 {
        out[c] = decode(encode(colour[c]) * part + fog[c] * (1.0 - part));
    }
    out
}

impl FogSource {
    fn optics(
        &self,
        eye_height_m: f64,
        direction: DVec3,
        distance_m: f64,
        factor: Option<f32>,
    ) -> RgbPathOptics {
        match self {
            Self::Alone(fog) => {
                let even = fog.path(eye_height_m, direction, distance_m);
                factor.map_or(even, |factor| even.at_density(factor))
            }
            Self::Sky {
                sky,
                radiance_scale,
                air,
            } => {
                let optics = match air {
                    ExistingAerial::Missing if distance_m < f64::INFINITY => {
                        sky.path_at_density(direction, distance_m, factor)
                    }
                    _ => sky.path_over_clear_at_density(direction, distance_m, factor),
                };
                RgbPathOptics {
                    path_radiance: optics.path_radiance.map(|s| s * *radiance_scale),
                    ..optics
                }
            }
        }
    }
}

/// Steps of the tables of the sRGB curve.
const STEPS: usize = 4096;

/// The sRGB signal for the square of each step.
static SIGNALS: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let step = |k| f64::from(k) / STEPS as f64;
    (0..=STEPS as u32)
        .map(|k| srgb_encode(step(k).powi(2)) as f32)
        .collect()
});

/// The linear value of each step.
static LINEAR: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let step = |k| f64::from(k) / STEPS as f64;
    (0..=STEPS as u32)
        .map(|k| srgb_decode(step(k)) as f32)
        .collect()
});

/// [`srgb_encode`] to 1e-6.
#[inline]
fn encode(linear: f32) -> f32 {
    match linear {
        0.004..=1.0 => interpolate(&SIGNALS, linear.sqrt()),
        _ => srgb_encode(f64::from(linear)) as f32,
    }
}

/// [`srgb_decode`] to 1e-6.
#[inline]
fn decode(signal: f32) -> f32 {
    match signal {
        0.0..=1.0 => interpolate(&LINEAR, signal),
        _ => srgb_decode(f64::from(signal)) as f32,
    }
}

/// A table over 0 to 1, interpolated linearly.
#[inline]
fn interpolate(table: &[f32], at: f32) -> f32 {
    let x = at * STEPS as f32;
    let k = (x as usize).min(STEPS - 1);
    let part = x - k as f32;
    table[k] + part * (table[k + 1] - table[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_match_the_srgb_curve() {
        for k in -100..=20_000 {
            let x = k as f32 / 17_000.0;
            let (signal, linear) = (srgb_encode(f64::from(x)), srgb_decode(f64::from(x)));
            assert!((f64::from(encode(x)) - signal).abs() < 1e-6, "{x}");
            assert!((f64::from(decode(x)) - linear).abs() < 1e-6, "{x}");
        }
        assert!(encode(f32::NAN).is_nan() && encode(f32::INFINITY) == f32::INFINITY);
    }
}
