//! The light along given directions, and that of sun and sky, in numbers.
//!
//! [`Probe`] asks a scene's solver; [`ProbeAnswer`] holds what it says; [`ProbeAnswer::to_json`] and
//! [`ProbeAnswer::to_csv`] write it. Directions are read from CSV by [`ProbeRay::list_from_csv`].

mod answer;
mod csv;
mod json;
mod monte_carlo;
mod rays;
mod solve;

pub use answer::{ObserverAnswer, PROBE_FORMAT, ProbeAnswer, RayAnswer, SkyAnswer, SunAnswer};
pub use monte_carlo::{MonteCarloAnswer, PolarisationAnswer};
pub use rays::ProbeRay;
pub use solve::Probe;
