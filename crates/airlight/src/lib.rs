//! Airlight computes light scattering in the air: the colour of the sky and the sun, aerial perspective, haze, mist and fog, and
//! the glow of lights in fog.
//!
//! A ray segment in air acts on light as an affine map: radiance `L` behind it reaches the eye as `T L + S`, with the transmittance
//! `T` and the in-scattered radiance `S`. Every model computes `T` and `S`, by wavelength into slices, or in red, green and blue as
//! [`transfer::RgbPathOptics`]; a renderer only applies them.
//!
//! ```
//! use airlight::prelude::*;
//!
//! // A clear day, the sun 30 degrees high in the south, seen from 2 m above the ground.
//! let settings = SkySettings { suns: SunCoverage::near(30.0, 2.0), ..Default::default() };
//! let sky = Sky::prepare(&Preset::Clear.atmosphere(), &WavelengthGrid::fast(), &settings)?;
//! let view = sky.view(2.0, axes::direction(180.0, 30.0)).rgb(RgbSpace::Srgb);
//! let [red, _, blue] = view.radiance(axes::direction(0.0, 60.0));
//! assert!(blue > 2.0 * red, "the sky is blue");
//! # Ok::<(), airlight::sky::SkyError>(())
//! ```
//!
//! # Where to start
//! - [`sky`]: [`sky::Sky`] solves a spherical atmosphere with all orders of scattering; a [`sky::View`] evaluates any ray.
//! - [`fog`]: [`fog::Fog`] and [`fog::RgbFog`], layers of fog without a sky; [`fog::lights`], lights in fog.
//! - [`scene`]: [`scene::Scene`] describes sun, air, fog, lights and camera as plain data; [`scene::RadianceModel`] is the
//!   interface of all solvers and published models ([`models::registry`]); [`scene::RgbFoggySky`] is a sky with fog for
//!   real-time use.
//! - [`atmosphere`]: presets, constituents, density profiles, aerosols and visibility; [`sun`]: its disc and position;
//!   [`night`]: moon, airglow, zodiacal light and stars.
//! - [`monte_carlo`]: unbiased reference results with standard errors.
//! - [`optics`], [`spectrum`]: scattering by one particle; wavelength grids, spectra and colour.
//!
//! # Conventions
//! SI units, radians and nanometres; names state any other unit. World axes are right-handed: **x east, y up, z south** (north is
//! -z). Azimuth is measured clockwise from north, elevation up from the horizon ([`axes`]). A view direction points away from
//! the eye. Phase functions integrate to 1. Results have the same bits for any number of threads.
//!
//! # Features
//! | feature | default | meaning |
//! |---|---|---|
//! | `parallel` | yes | computation on all threads |
//! | `config` | yes | scenes and atmospheres as TOML; includes `serde` |
//! | `ephemeris` | yes | position of the sun from place and time ([`sun`]) |
//! | `serde` | with `config` | scenes as serde data |
//! | `schema` | no | JSON Schema of scene files |
//! | `hosek-wilkie` | no | the published sky model of Hosek and Wilkie |

pub mod atmosphere;
pub mod axes;
mod control;
mod debug;
pub mod fog;
mod math;
pub mod models;
pub mod monte_carlo;
mod names;
pub mod night;
pub mod optics;
pub mod prelude;
pub mod scene;
pub mod sky;
pub mod spectrum;
pub mod sun;
pub mod transfer;

pub use control::{Cancelled, Control, Progress};
pub use glam;
/// For tests and random settings of the crates of this workspace.
#[doc(hidden)]
pub use math::split_mix::SplitMix64;
pub use names::{Named, UnknownName};

/// Crates that the code of macros names.
#[doc(hidden)]
pub mod dependencies {
    #[cfg(feature = "schema")]
    pub use schemars;
    #[cfg(feature = "serde")]
    pub use serde;
}

/// The example of the README, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// Examples of the book, compiled as tests.
#[cfg(doctest)]
mod book {
    #[doc = include_str!("../../../docs/src/getting-started.md")]
    struct GettingStarted;
    #[doc = include_str!("../../../docs/src/path-optics.md")]
    struct PathOptics;
}
