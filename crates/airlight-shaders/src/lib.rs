//! Shader functions for fog, haze and skies, in WGSL, each with a Rust twin.
//!
//! [`source`] returns the WGSL text of the [`Part`]s that a program needs, with the parts that these need. The functions take all
//! inputs as parameters and touch no bindings, so the text goes in front of any shader:
//!
//! ```
//! use airlight_shaders::{Part, source};
//!
//! let shader = source(&[Part::Fog]) + "
//! @fragment fn main(@location(0) distance_m: f32) -> @location(0) vec4<f32> {
//!     let medium = FogMedium(vec3<f32>(0.02), vec3<f32>(0.02));
//!     let light = FogLight(vec3<f32>(0.0), 0.5, vec3<f32>(0.3, 0.35, 0.4));
//!     let path = uniform_fog(medium, distance_m, light);
//!     return vec4<f32>(apply_path_optics(path, vec3<f32>(0.1)), 1.0);
//! }";
//! # assert!(shader.contains("fn mean_transmittance"));
//! ```
//!
//! Each function states its cost (exponentials, texture reads) and its largest error against f64 ([`functions`]); the tests count
//! the one and measure the other, on the CPU and on a Vulkan device. [`twins`] holds the functions in Rust.
//!
//! [`SkyTables`] fills the tables of [`Part::SkyTables`] from a sky that the library solves, [`FogTables`] those of
//! [`Part::FogTable`] from a fog.
//!
//! With the feature `translate`, `translate` gives the same functions in GLSL, HLSL and MSL (the folder `generated` holds them), and
//! `costs` counts what the functions of any WGSL shader evaluate at most, `counting` what its invocations evaluate.
//!
//! Only core WebGPU is used: f32, no extensions.

mod colour_fit;
#[cfg(feature = "translate")]
mod compute;
#[cfg(feature = "translate")]
mod cost;
#[cfg(feature = "translate")]
mod counting;
mod fog_tables;
mod function;
#[cfg(feature = "translate")]
mod interface;
mod jump;
#[cfg(feature = "translate")]
mod language;
mod part;
mod pass;
mod sky_tables;
#[cfg(feature = "translate")]
mod spirv;
#[cfg(feature = "translate")]
mod translate;
pub mod twins;
mod wavelengths;

pub use colour_fit::ColourFit;
#[cfg(feature = "translate")]
pub use compute::{ComputeEntryPoint, ComputeShader, ComputeTexture};
#[cfg(feature = "translate")]
pub use cost::{Cost, CostError, costs};
#[cfg(feature = "translate")]
pub use counting::{Counts, counting};
pub use fog_tables::{FogTables, FogTablesError};
pub use function::{ErrorBound, Function, functions};
#[cfg(feature = "translate")]
pub use language::{Language, TranslateError};
pub use part::{Part, Subject, source, with_required};
pub use pass::Pass;
pub use sky_tables::{SingleScatteringTable, SkyTables, SkyTablesError};
#[cfg(feature = "translate")]
pub use spirv::{SpirvModule, spirv_modules};
#[cfg(feature = "translate")]
pub use translate::{TranslatedFile, translate, translated_files};
pub use wavelengths::{WAVELENGTHS_NM, wavelength_grid};

/// The example of the book, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/src/shaders.md")]
struct Book;
