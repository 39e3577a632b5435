//! Fog: what it does to light, in closed form or nearly.
//!
//! Each model yields [`PathOptics`](crate::transfer::PathOptics) for a stretch of a line, on RGB or any spectral grid. The book's
//! chapters on fog and on lamps derive what is here.
//!
//! ```
//! use airlight::axes::direction;
//! use airlight::fog::{Fog, Ground, DirectionalLight, FogLighting, FogScattering, Layer, DensityProfile};
//! use airlight::fog::{droplets::Droplets, visibility::{Contrast, extinction_per_m}};
//! use airlight::spectrum::Spectrum;
//!
//! // Radiation fog 30 m deep, 200 m of visibility, under a morning sun.
//! let fog = Fog::new(
//!     &[Layer {
//!         profile: DensityProfile::Exponential { reference_height_m: 0.0, scale_height_m: 30.0 },
//!         matter: Droplets::Radiation.matter(extinction_per_m(200.0, Contrast::FivePercent)),
//!     }],
//!     Ground::EARTH,
//!     Light {
//!         sun: Some(Sun { direction: direction(110.0, 12.0), irradiance: Spectrum([3.0, 2.4, 1.8]) }),
//!         ambient: Spectrum([0.2, 0.25, 0.35]),
//!         ground_albedo: Spectrum::splat(0.2),
//!     },
//!     Scattering::Multiple,
//! )?;
//! // A red wall 80 m away, seen from 1.7 m.
//! let seen = fog.along(1.7, direction(80.0, 0.0), 80.0).apply(Spectrum([0.3, 0.05, 0.04]));
//! assert!(seen[1] > 0.05);
//! # Ok::<(), airlight::fog::FogError>(())
//! ```
//!
//! From the ground up: [`line`](mod@line) and [`profile`] (how much fog lies along a line); [`medium`] and [`droplets`];
//! [`lanes`] and [`scatter`] (the formulas); light and ground; the fog itself ([`Fog`]) with light scattered once and many
//! times; [`lamp`]s; and beside it [`slab1987`], [`legacy`] looks, [`approximation`]s.

pub mod approximation;
pub mod droplets;
mod height_breakpoints;
pub mod lanes;
pub mod layer;
pub mod legacy;
mod lighting;
pub mod lights;
mod merged_layers;
mod model;
mod multiple;
pub mod scatter;
mod single_scattering;
mod split_at_heights;

pub use crate::atmosphere::{DensityError, DensityProfile, RaySegment, visibility};
pub use layer::{FogError, Layer, Medium};
pub use lighting::{DirectionalLight, FogLighting, FogScattering, Ground};
pub use model::{Fog, FogTable};
