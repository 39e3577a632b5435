//! Light along given directions, and light of sun and sky, as numbers.
//!
//! [`Probe`] evaluates a scene's solver; [`ProbeAnswer`] is the result, written by [`ProbeAnswer::to_json`] and
//! [`ProbeAnswer::to_csv`]. Directions are read from CSV by [`ProbeRay::list_from_csv`].

mod answer;
mod csv;
mod json;
mod monte_carlo;
mod rays;
mod solve;

pub use answer::{
    MoonAnswer, ObserverAnswer, PROBE_FORMAT, ProbeAnswer, RayAnswer, SkyAnswer, SunAnswer,
};
pub use monte_carlo::{MonteCarloAnswer, PolarisationAnswer};
pub use rays::ProbeRay;
pub use solve::Probe;
