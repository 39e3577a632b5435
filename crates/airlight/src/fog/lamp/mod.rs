//! Lamps in fog: the glow round a street lamp, a beam of light, a bulb seen through mist.
//!
//! Every function is **single scattering**: light goes straight from a lamp to a point of the fog, dimmed on its way, and
//! from there straight to the eye, dimmed again. Light scattered more than once is left out; in fog whose optical depth
//! around the lamp exceeds about 1 the true glow is wider and brighter.
//!
//! - [`PointLamp`], [`SpotLamp`], [`SphereLamp`], [`Lamp`]: what shines. A radiant intensity `I` gives the irradiance
//!   `I / r^2`.
//! - [`Lamps::path_radiance`]: what all of them add to a line of sight, in any [`Murk`].
//! - [`Lamp::illumination`]: what reaches a surface.
//! - [`airlight_without_extinction`], [`airlight_isotropic`]: closed forms for uniform fog that scatters evenly, exact in
//!   f64; [`airlight_isotropic_lanes`] the same for all lanes at once. They need only the geometry, a [`Passage`].
//! - [`LampForm`]: those, the split sum ([`airlight_split_sum`]) and the fog note's own form ([`airlight_printed`]), to choose
//!   from.
//!
//! Derivation, measured errors and speed: `docs/src/lamps.md`.

mod airlight_integral;
mod check;
mod exponential_integral;
mod fast;
mod forms;
mod kinds;
mod lamps;
mod march;
mod murk;
mod nodes;
mod panels;
mod passage;
mod point;
mod printed;
#[cfg(test)]
mod reference;
mod sphere;
mod split_sum;
mod spot;

pub use airlight_integral::{airlight_isotropic, airlight_without_extinction};
pub use fast::{CubeRoot, airlight_isotropic_lanes};
pub use forms::LampForm;
pub use kinds::Lamp;
pub use lamps::{LampSettings, Lamps};
pub use murk::{Murk, Sight};
pub use nodes::Nodes;
pub use passage::Passage;
pub use point::PointLamp;
pub use printed::airlight_printed;
pub use sphere::SphereLamp;
pub use split_sum::airlight_split_sum;
pub use spot::SpotLamp;
