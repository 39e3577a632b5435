//! Scenes as plain data, and the interface of all models that compute their light.
//!
//! - [`Scene`] and its parts: read from TOML ([`Scene::from_toml`]) or filled in by a program; [`Scene::resolve`] converts
//!   a scene to the physical quantities of a [`ResolvedScene`].
//! - [`RadianceModel`], [`PreparedModel`], [`RadianceView`]: traits that every solver and published model implements;
//!   [`Capabilities`] and [`check_inputs`]: the inputs that each honours.
//! - [`RgbFoggySky`]: a solved sky, aerial perspective and fog in red, green and blue, for real-time use.

mod aerial;
mod aerial_fill;
mod air;
mod capabilities;
mod check_inputs;
mod city_glow;
#[cfg(feature = "config")]
mod document;
mod error;
mod fog_in_sky;
mod fog_layers;
mod foggy;
mod glow_view;
mod input;
mod irradiance_map;
mod lane_channels;
mod light;
mod model;
mod night;
mod night_light;
mod night_sky;
mod night_state;
mod night_view;
mod places;
mod resolved;
mod rgb_foggy_sky;
mod solved_view;
mod spec;
mod sun_disc_table;
mod sun_source;
#[cfg(test)]
mod tests;
#[cfg(all(test, feature = "config"))]
mod toml_tests;
#[cfg(feature = "config")]
mod toml_value;

pub use crate::sky::TableChannels as Channels;
pub use crate::sun::SunState;
pub use capabilities::Capabilities;
pub use check_inputs::check_inputs;
#[cfg(feature = "config")]
pub use document::SceneDocument;
pub use error::SceneError;
pub use fog_layers::{FogLayer, FogLayers};
pub use input::Input;
pub(crate) use irradiance_map::{IrradianceMap, horizontal_irradiance};
pub use model::{
    PreparedModel, RadianceModel, RadianceSampler, RadianceView, RowSampler, StarField,
};
pub use night::{MoonSource, NightSettings};
pub use night_light::NightLight;
pub(crate) use night_sky::NightSky;
pub use resolved::ResolvedScene;
pub use rgb_foggy_sky::RgbFoggySky;
pub(crate) use solved_view::SolvedView;
pub use spec::{
    AirSpec, BaseBlueKind, CameraExposure, CameraExposureError, CameraSpec, CheckerSpec, Effort,
    Exposure, ExrCompression, FogLayerSpec, FogPatchesSpec, FogProfile, FogSpec, Gamut, GlossSpec,
    Klassen1987Spec, LightKind, LightSpec, MeteringMode, NightLights, NightSpec, ObjectShape,
    ObjectSpec, ObjectsSpec, ObserverSpec, Orientation, OutputSpec, Projection, Reflectance,
    RepeatSpec, SCENE_VERSION, SamplePrecision, Scene, SequenceSpec, SolverSpec, SunDiscPlacement,
    SunSpec, SunlightKind, ToneKind, WetHaze,
};
pub use sun_source::{SunAngles, SunSource};
