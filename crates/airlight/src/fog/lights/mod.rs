//! Lights in fog: the glow around a street light, a beam of light, a bulb seen through mist.
//!
//! Every function is **single scattering**: light travels from a light straight to a point of the fog, and from there straight
//! to the eye, dimmed on both ways. Light scattered more than once is left out; in fog whose optical depth around the light
//! exceeds about 1 the true glow is wider and brighter.
//!
//! - [`PointLight`], [`SpotLight`], [`SphereLight`], [`Light`]: the lights. A radiant intensity `I` causes the irradiance
//!   `I / r^2`.
//! - [`LightSet`], [`RgbLightSet`]: lights in layers of fog, over the wavelengths of a grid and in red, green and blue: the light
//!   scattered into a view ray, and the irradiance on a surface.
//! - [`airlight_without_extinction`], [`airlight_isotropic`]: closed forms for uniform fog that scatters equally in all
//!   directions, exact in f64; [`airlight_isotropic_fast`] by a few nodes. They need only the geometry, a [`LightRayGeometry`].
//! - [`LightForm`]: those, the split sum ([`airlight_split_sum`]) and the fog note's own form ([`airlight_printed`]), to choose
//!   from.
//!
//! Derivation, measured errors and speed: `docs/src/lights.md`.

mod closed_form;
mod forms;
mod geometry;
mod light;
mod light_set;
mod march;
#[cfg(test)]
mod reference;

pub use closed_form::{airlight_isotropic, airlight_isotropic_fast, airlight_without_extinction};
pub use forms::{LightForm, airlight_printed, airlight_split_sum};
pub use geometry::{LightRayGeometry, ViewRay};
pub use light::{Light, PointLight, SphereLight, SpotLight};
pub use light_set::{LightSet, LightSettings, RgbLightSet};
pub use march::Nodes;
