//! What air does to light: the colour of sky and sun, haze over distance.
//!
//! # World axes
//! Right-handed, metres: **x east, y up, z south** (north is -z). Azimuth is measured clockwise from north,
//! elevation up from the horizon; see [`axes`]. A view direction points away from the eye.
//!
//! # Rooms, each importing only from those above it
//! - [`spectrum`]: wavelength grids, spectra, the solar spectrum, colour.
//! - [`optics`]: what one particle does to light: Rayleigh, ozone, phase functions.
//! - [`light`]: what shines: the sun's position, disc and irradiance.
//! - [`medium`]: what fills the air and where: density profiles, constituents, [`medium::Atmosphere`], presets.
//! - [`path`]: [`path::PathOptics`] and its law of composition.
//! - [`fog`]: closed forms of fog, and lamps in it.
//! - [`sky`]: the solver for a spherical, multiply scattering atmosphere.
//! - [`outdoors`]: one lighting of sky, air, fog and ground.
//! - [`classic`]: published models of the sky, as printed and as corrected.

pub mod atmosphere;
pub mod axes;
mod control;
mod debug;
pub mod fog;
mod math;
pub mod models;
pub mod monte_carlo;
mod names;
pub mod optics;
pub mod scene;
pub mod sky;
pub mod spectrum;
pub mod sun;
pub mod transfer;

pub use control::{Cancelled, Control, Progress};
pub use names::{Named, UnknownName};

/// The example of the README, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
