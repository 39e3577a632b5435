//! What lies between camera and scene.

use super::glow::Glow;
use airlight::fog::{Fog, legacy};
use airlight::outdoors::FoggySky;
use airlight::path::PathOptics;
use airlight::spectrum::Spectrum;
use airlight::spectrum::rgb::{srgb_decode, srgb_encode};
use glam::DVec3;
use std::sync::Arc;

/// What lies between camera and scene.
#[derive(Clone)]
pub enum Veil<'a> {
    /// A fog, and the lamps in it.
    Fog(Body<'a>, Option<Glow>),
    /// Exponential-squared fog, a look: density (1/m) and colour.
    ExponentialSquared(f64, Spectrum<3>),
    /// Linear fog, a look: where it starts and ends (m), and colour.
    Linear(f64, f64, Spectrum<3>),
    /// Foggy Cityscapes (Sakaridis et al. 2018): uniform fog of an extinction (1/m) and one colour, blended in encoded
    /// (sRGB) values instead of light.
    Encoded(f64, Spectrum<3>),
}

/// A fog and the light of the day that it is in.
#[derive(Clone)]
pub enum Body<'a> {
    /// A fog in a light of its own.
    Alone(Box<Fog<3>>),
    /// A fog in a solved sky.
    Sky {
        /// Both, with the eye at the camera's height.
        sky: Arc<FoggySky<'a, 3>>,
        /// Units of the picture in one cd/m^2.
        radiance_scale: f32,
        /// Whether the picture has the air.
        air: AirBefore,
    },
}

/// Whether a picture shows the clear air before its things.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirBefore {
    /// It does.
    Drawn,
    /// It does not, but before its sky: the air is added.
    Missing,
}

impl Body<'_> {
    fn optics(&self, eye_height_m: f64, direction: DVec3, distance_m: f64) -> PathOptics<3> {
        match self {
            Self::Alone(fog) => fog.along(eye_height_m, direction, distance_m),
            Self::Sky {
                sky,
                radiance_scale,
                air,
            } => {
                let optics = match air {
                    AirBefore::Missing if distance_m < f64::INFINITY => {
                        sky.optics(direction, distance_m)
                    }
                    _ => sky.over_clear(direction, distance_m),
                };
                PathOptics {
                    path_radiance: optics.path_radiance * *radiance_scale,
                    ..optics
                }
            }
        }
    }
}

impl Veil<'_> {
    /// What it does up to a distance (m; infinite: the sky) in a direction from an eye at a height (m).
    pub fn optics(&self, eye_height_m: f64, direction: DVec3, distance_m: f64) -> PathOptics<3> {
        match self {
            Self::Fog(body, glow) => {
                let mut optics = body.optics(eye_height_m, direction, distance_m);
                if let Some(glow) = glow {
                    optics.path_radiance += glow.path_radiance(eye_height_m, direction, distance_m);
                }
                optics
            }
            Self::ExponentialSquared(density, colour) => {
                legacy::exponential_squared(*density, distance_m, *colour)
            }
            Self::Linear(start, end, colour) => legacy::linear(*start, *end, distance_m, *colour),
            Self::Encoded(extinction, colour) => {
                let transmittance = (-extinction * distance_m).exp() as f32;
                PathOptics {
                    transmittance: Spectrum::splat(transmittance),
                    path_radiance: *colour * (1.0 - transmittance),
                }
            }
        }
    }

    /// A colour seen through it.
    pub(super) fn apply(&self, optics: &PathOptics<3>, colour: Spectrum<3>) -> Spectrum<3> {
        let Self::Encoded(_, fog) = self else {
            return optics.apply(colour);
        };
        let part = f64::from(optics.transmittance[0]);
        if part == 1.0 {
            return colour;
        }
        Spectrum::from_fn(|i| {
            let of = |value: f32| srgb_encode(f64::from(value));
            srgb_decode(of(colour[i]) * part + of(fog[i]) * (1.0 - part)) as f32
        })
    }
}
