//! Skies, aerial perspective, fog and the sun's disc for programs that use wgpu.
//!
//! [`SkyRenderer`] draws over a frame that a program has rendered: it reads the depth, dims what is behind the air, adds the light that
//! the air scatters, and fills the rest of the frame with the sky, the planet's ground and the sun. The colours come from tables of a
//! sky that the `airlight` solver computes with all orders of scattering, as does the light of a [`Fog`]; the
//! shader functions are those of `airlight-shaders`.
//! [`SkySolver`] and [`SkyPasses`] are its two halves, for programs that compute on a thread or in a worker of their own. [`TonePass`]
//! shows a frame on a display.
//! Nothing is computed again when only the camera turns. [`Lighting`] is the light of sun and sky for the program's own surfaces,
//! [`EnvironmentMap`] what they reflect. A second source, such as the moon, adds its light to all of these. [`TerrainPass`] draws ground of
//! given heights, whose [`SunShadows`] darken air and fog; [`TerrainPoint`] finds what a ray sees of it.
//!
//! The eye is the origin, y is up at the eye, distances are in metres, light is in cd/m^2 times an exposure.

mod camera;
mod device_loss;
mod disc;
mod environment;
mod error;
mod fog;
mod frame_tables;
mod gpu_tables;
#[cfg(feature = "headless")]
pub mod headless;
mod lighting;
mod lights;
mod pass;
mod pass_timers;
mod passes;
mod read;
mod renderer;
mod shadows;
mod sky;
mod terrain;
mod terrain_point;
mod tone;

pub use camera::{Camera, Projection};
pub use device_loss::is_device_lost;
pub use disc::DiscTable;
pub use environment::EnvironmentMap;
pub use error::SkyRendererError;
pub use fog::{Fog, FogFrame, MOST_FOG_LAYERS};
pub use frame_tables::{FrameTables, SkySolver, SourceTables};
pub use lighting::{DirectLight, Lighting};
pub use lights::MOST_LIGHTS;
pub use pass_timers::PassTimers;
pub use passes::SkyPasses;
pub use read::{PendingPixels, ReadTextureError};
#[cfg(not(target_arch = "wasm32"))]
pub use read::{read_rgb, read_texture};
pub use renderer::{SkyRenderer, SkyRendererSettings, Work};
pub use shadows::{ShadowMap, SunShadows};
pub use terrain::{HeightField, TerrainPass, TerrainView};
pub use terrain_point::TerrainPoint;
pub use tone::{ToneCurve, TonePass, ToneSettings};

/// The example of the README, compiled as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The examples of the book, compiled as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/src/gpu.md")]
struct Book;
