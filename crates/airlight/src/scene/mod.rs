//! A scene and the one interface through which its light is requested.
//!
//! - [`RadianceModel`], [`PreparedModel`], [`RadianceView`]: what every solver and published model implements;
//!   [`Capabilities`] and [`check_inputs`]: what each honours.
//! - [`AerialPerspective`]: what clear air does between the eye and objects at any distance.
//! - [`FoggySky`]: a sky with fog in it: the light of the sky falls on the fog, air and fog lie along every line in their
//!   true order, and what is far away goes over into the drawn sky.
//! - [`IrradianceMap`]: the irradiance of all of that on surfaces.
//! - [`SceneLighting`]: light on objects, and the air before them.
//!
//! [`LaneChannels`] says what the N lanes of [`AerialPerspective`] and [`FoggySky`] are.

mod aerial;
mod aerial_fill;
mod capabilities;
mod error;
mod foggy;
mod irradiance_map;
mod lane_channels;
mod light;
mod lighting;
mod model;
mod places;
mod resolved;

pub use crate::sky::TableChannels as Channels;
pub use aerial::AerialPerspective;
pub use capabilities::{Capabilities, Input, check_inputs};
pub use error::SceneError;
pub use foggy::FoggySky;
pub use irradiance_map::IrradianceMap;
pub use lane_channels::LaneChannels;
pub use lighting::SceneLighting;
pub use model::{
    PreparedModel, RadianceModel, RadianceSampler, RadianceView, RowSampler, SunState,
};
pub use resolved::ResolvedScene;
