//! Lamps in fog: the glow round a street lamp, a beam of light, a bulb seen through mist.
//!
//! Every function is **single scattering**: light goes straight from a lamp to a point of the fog, dimmed on its way, and
//! from there straight to the eye, dimmed again. Light scattered more than once is left out; in fog whose optical depth
//! around the lamp exceeds about 1 the true glow is wider and brighter.
//!
//! - [`PointLight`], [`SpotLight`], [`SphereLight`], [`Light`]: what shines. A radiant intensity `I` gives the irradiance
//!   `I / r^2`.
//! - [`LightSet::path_radiance`]: what all of them add to a line of sight, in any [`ParticipatingMedium`].
//! - [`Light::illumination`]: what reaches a surface.
//! - [`airlight_without_extinction`], [`airlight_isotropic`]: closed forms for uniform fog that scatters evenly, exact in
//!   f64; [`airlight_isotropic_lanes`] the same for all lanes at once. They need only the geometry, a [`LightRayGeometry`].
//! - [`LightForm`]: those, the split sum ([`airlight_split_sum`]) and the fog note's own form ([`airlight_printed`]), to choose
//!   from.
//!
//! Derivation, measured errors and speed: `docs/src/lights.md`.

mod airlight_integral;
mod check;
mod exponential_integral;
mod fast;
mod forms;
mod geometry;
mod kinds;
mod light_set;
mod march;
mod medium;
mod nodes;
mod panels;
mod point;
mod printed;
#[cfg(test)]
mod reference;
mod sphere;
mod split_sum;
mod spot;

pub use airlight_integral::{airlight_isotropic, airlight_without_extinction};
pub use fast::{CubeRoot, airlight_isotropic_lanes};
pub use forms::LightForm;
pub use geometry::LightRayGeometry;
pub use kinds::Light;
pub use light_set::{LightSet, LightSettings};
pub use medium::{ParticipatingMedium, ViewRay};
pub use nodes::Nodes;
pub use point::PointLight;
pub use printed::airlight_printed;
pub use sphere::SphereLight;
pub use split_sum::airlight_split_sum;
pub use spot::SpotLight;
