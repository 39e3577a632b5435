//! A scene as plain data: the content of a scene file, also set by flags of programs.
//!
//! A field that is `None` has the default that its documentation states. A field that is set is an explicit input, which
//! is refused if the solver would ignore it ([`Scene::set_inputs`]).

mod air;
mod exposure;
mod fog;
mod lights;
mod night;
mod objects;
mod orientation;
mod picture;
mod solver;
mod validate;

pub use air::AirSpec;
pub use exposure::{CameraExposure, CameraExposureError, Exposure, MeteringMode};
pub use fog::{FogLayerSpec, FogPatchesSpec, FogProfile, FogSpec};
pub use lights::{LightKind, LightSpec};
pub use night::{NightLights, NightSpec};
pub use objects::{
    CheckerSpec, GlossSpec, ObjectShape, ObjectSpec, ObjectsSpec, Reflectance, RepeatSpec,
};
pub use orientation::Orientation;
pub use picture::{
    CameraSpec, ExrCompression, Gamut, OutputSpec, Projection, SamplePrecision, SequenceSpec,
    SunDiscPlacement, ToneKind,
};
pub use solver::{BaseBlueKind, Effort, Klassen1987Spec, SolverSpec, SunlightKind, WetHaze};

/// Version of the scene format that this library reads and writes.
pub const SCENE_VERSION: u32 = 1;

/// A scene: sun (or place and time), observer, air, fog, lights, objects, solver, camera, output and sequence.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Scene {
    /// Version of the format: 1.
    pub version: u32,
    /// Position of the sun, or place and time that determine it.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_default"))]
    pub sun: SunSpec,
    /// Position of the eye.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_default"))]
    pub observer: ObserverSpec,
    /// Moon, stars and the other lights of the night.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_default"))]
    pub night: NightSpec,
    /// Gases, haze and ground.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_default"))]
    pub air: AirSpec,
    /// Fog near the ground.
    pub fog: Option<FogSpec>,
    /// Point, spot and sphere lights.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub lights: Vec<LightSpec>,
    /// Objects in front of the sky.
    pub objects: Option<ObjectsSpec>,
    /// Solver or published model, and its settings.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_default"))]
    pub solver: SolverSpec,
    /// Projection and direction of the picture.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_default"))]
    pub camera: CameraSpec,
    /// Picture file and its encoding.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_default"))]
    pub output: OutputSpec,
    /// Times of a sequence of pictures.
    pub sequence: Option<SequenceSpec>,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            version: SCENE_VERSION,
            sun: SunSpec::default(),
            observer: ObserverSpec::default(),
            night: NightSpec::default(),
            air: AirSpec::default(),
            fog: None,
            lights: Vec::new(),
            objects: None,
            solver: SolverSpec::default(),
            camera: CameraSpec::default(),
            output: OutputSpec::default(),
            sequence: None,
        }
    }
}

#[cfg(feature = "schema")]
impl Scene {
    /// JSON Schema of scene files, for completion and validation in editors.
    pub fn json_schema() -> String {
        let schema = schemars::schema_for!(Self);
        serde_json::to_string_pretty(&schema).expect("a schema is JSON")
    }
}

/// Position of the sun: either `elevation_deg`, or a place on the Earth and a time.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SunSpec {
    /// Elevation of the sun's centre above the horizontal, degrees, -90 to 90.
    pub elevation_deg: Option<f64>,
    /// Azimuth, degrees clockwise from north. Default: 180, south.
    pub azimuth_deg: Option<f64>,
    /// Distance of the sun relative to the planet's mean distance, with `elevation_deg`. Default: 1.
    pub distance_ratio: Option<f64>,
    /// Latitude of the place on the Earth, degrees north, -90 to 90.
    pub latitude_deg: Option<f64>,
    /// Longitude, degrees east, -180 to 360.
    pub longitude_deg: Option<f64>,
    /// Time with its offset from UTC or its time zone, as in 2026-06-21T21:15:00+02:00 and 2026-06-21T21:15[Europe/Paris], or "now".
    /// Default: now.
    pub time: Option<String>,
    /// Whether refraction raises the sun of a place and time, by half a degree at the horizon. Default: true.
    pub refraction: Option<bool>,
}

/// Position of the eye.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ObserverSpec {
    /// Altitude above sea level, m, -12000 to 1e9; at least `eye_height_m` above the ground. Default: 0.
    pub altitude_m: Option<f64>,
    /// Smallest height of the eye above the ground, m, above 0. Default: 2.
    pub eye_height_m: Option<f64>,
}

/// Whether no field of a part of a scene is set.
#[cfg(feature = "serde")]
fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
