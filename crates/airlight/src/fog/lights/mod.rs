//! Point, spot and sphere lights in fog: glow, cones of light, and irradiance on surfaces.
//!
//! All functions compute **single scattering**, with extinction between light, point of scattering and eye. Multiple scattering
//! is neglected: around a light in fog with an optical depth above about 1 the true glow is wider and brighter.
//!
//! - [`PointLight`], [`SpotLight`], [`SphereLight`], [`Light`]: the lights. A radiant intensity `I` causes the irradiance
//!   `I / r^2`.
//! - [`LightSet`], [`RgbLightSet`]: lights in layers of fog, over the wavelengths of a grid and in red, green and blue, with the
//!   radiance scattered into view rays and the irradiance on surfaces.
//! - [`airlight_without_extinction`], [`airlight_isotropic`]: closed forms for uniform, isotropically scattering fog, exact in
//!   f64; [`airlight_isotropic_fast`]: a fast approximation. They depend on a [`LightRayGeometry`] only.
//! - [`LightForm`]: selects one of these, the split sum or the form printed in the fog note.
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
pub use forms::LightForm;
pub use geometry::{LightRayGeometry, ViewRay};
pub use light::{Light, PointLight, SphereLight, SpotLight};
pub use light_set::{LightSet, LightSettings, RgbLightSet};
pub use march::Nodes;
