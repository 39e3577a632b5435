//! Objects in front of the sky: solids and their surfaces.

use crate::names::named;

/// Objects in front of the sky: a file, a list, or both.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ObjectsSpec {
    /// Whether objects cast shadows on each other. Default: true.
    pub shadows: Option<bool>,
    /// TOML file beside the scene with a list of objects, `[[object]]`.
    pub file: Option<String>,
    /// The objects.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub object: Vec<ObjectSpec>,
}

impl ObjectsSpec {
    /// Whether there is any object.
    pub fn is_set(&self) -> bool {
        self.file.is_some() || !self.object.is_empty()
    }
}

/// Shape of a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObjectShape {
    /// The plane of the ground.
    Ground,
    /// A sphere, at its centre.
    Sphere,
    /// A block, at the middle of its base.
    Block,
    /// An upright cylinder, at the middle of its base.
    Cylinder,
    /// An upright cone, at the middle of its base.
    Cone,
}

named! { ObjectShape, "a shape", [
    ("ground", (Ground), "the plane of the ground"),
    ("sphere", (Sphere), "a sphere, placed by its centre"),
    ("block", (Block), "a block, placed by the middle of its base"),
    ("cylinder", (Cylinder), "an upright cylinder, placed by the middle of its base"),
    ("cone", (Cone), "an upright cone, placed by the middle of its base"),
] }

/// A solid. Positions are in metres east, up and south of the point of the ground under the eye.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ObjectSpec {
    /// Shape.
    pub shape: ObjectShape,
    /// Position, m.
    pub at_m: Option<[f64; 3]>,
    /// Radius of a sphere, cylinder or cone, m.
    pub radius_m: Option<f64>,
    /// Height of a cylinder or cone, m.
    pub height_m: Option<f64>,
    /// Size of a block east, up and south, m.
    pub size_m: Option<[f64; 3]>,
    /// Turn about the vertical, degrees clockwise.
    pub turn_deg: Option<f64>,
    /// Diffuse reflectance. Default: 0.5.
    pub reflectance: Option<Reflectance>,
    /// Squares of another reflectance.
    pub checker: Option<CheckerSpec>,
    /// A coat that mirrors.
    pub gloss: Option<GlossSpec>,
    /// Copies of it in a row.
    pub repeat: Option<RepeatSpec>,
}

/// A diffuse reflectance, 0 to 1.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        untagged,
        expecting = "expected a reflectance: a number from 0 to 1, [red, green, blue], or { wavelengths_nm = [..], values = [..] }"
    )
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Reflectance {
    /// The same at all wavelengths.
    Grey(f64),
    /// Red, green and blue.
    Rgb([f64; 3]),
    /// By wavelength, linear in between.
    Spectrum {
        /// Wavelengths, nm, rising.
        wavelengths_nm: Vec<f64>,
        /// Reflectance at each.
        values: Vec<f64>,
    },
}

/// Squares, or cubes, of two reflectances by turns.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CheckerSpec {
    /// Side of a square, m.
    pub size_m: f64,
    /// The other reflectance.
    pub reflectance: Reflectance,
}

/// A coat of rough facets that mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GlossSpec {
    /// Root mean square slope of the facets.
    pub roughness: f64,
    /// Refractive index. Default: 1.5.
    pub index: Option<f64>,
}

/// Copies of an object in a row.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RepeatSpec {
    /// Number of objects, the first included.
    pub count: usize,
    /// From each to the next, m.
    pub step_m: [f64; 3],
}
