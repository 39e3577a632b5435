//! Objects in front of the sky: shapes and surfaces.

use crate::names::named;

/// Objects in front of the sky: a file, a list, or both.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ObjectsSpec {
    /// Whether objects cast shadows on each other. Default: true.
    pub shadows: Option<bool>,
    /// TOML file with a list of objects, `[[object]]`, relative to the scene file.
    pub file: Option<String>,
    /// List of objects, besides those of the file.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub object: Vec<ObjectSpec>,
}

impl ObjectsSpec {
    /// Whether a file or a list of objects is set.
    pub fn is_set(&self) -> bool {
        self.file.is_some() || !self.object.is_empty()
    }
}

/// Shape of an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObjectShape {
    /// The horizontal plane at height 0.
    Ground,
    /// A sphere, positioned by its centre.
    Sphere,
    /// A block, positioned by the centre of its base.
    Block,
    /// A vertical cylinder, positioned by the centre of its base.
    Cylinder,
    /// A vertical cone, positioned by the centre of its base.
    Cone,
}

named! { ObjectShape, "a shape", [
    ("ground", (Ground), "the horizontal plane at height 0"),
    ("sphere", (Sphere), "a sphere, positioned by its centre"),
    ("block", (Block), "a block, positioned by the centre of its base"),
    ("cylinder", (Cylinder), "a vertical cylinder, positioned by the centre of its base"),
    ("cone", (Cone), "a vertical cone, positioned by the centre of its base"),
] }

/// An object. Positions are in metres east, up and south of the point of the ground below the eye.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ObjectSpec {
    /// Shape, which determines the fields that are needed.
    pub shape: ObjectShape,
    /// Position of the shape's reference point, m.
    pub at_m: Option<[f64; 3]>,
    /// Radius of a sphere, cylinder or cone, m.
    pub radius_m: Option<f64>,
    /// Height of a cylinder or cone, m.
    pub height_m: Option<f64>,
    /// Size of a block east, up and south, m.
    pub size_m: Option<[f64; 3]>,
    /// Rotation about the vertical axis, degrees clockwise.
    pub turn_deg: Option<f64>,
    /// Diffuse reflectance. Default: 0.5.
    pub reflectance: Option<Reflectance>,
    /// Checker pattern with a second reflectance.
    pub checker: Option<CheckerSpec>,
    /// Glossy coat.
    pub gloss: Option<GlossSpec>,
    /// Copies at equal steps.
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
        /// Wavelengths, nm, increasing.
        wavelengths_nm: Vec<f64>,
        /// Reflectance at each wavelength, 0 to 1.
        values: Vec<f64>,
    },
}

/// Pattern of squares (or cubes) with two alternating reflectances.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CheckerSpec {
    /// Side of a square, m.
    pub size_m: f64,
    /// The second reflectance.
    pub reflectance: Reflectance,
}

/// A coat of mirroring microfacets.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GlossSpec {
    /// Root mean square slope of the facets.
    pub roughness: f64,
    /// Refractive index of the coat. Default: 1.5.
    pub index: Option<f64>,
}

/// Copies of an object at equal steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RepeatSpec {
    /// Number of objects, the first included.
    pub count: usize,
    /// Displacement from each object to the next, m.
    pub step_m: [f64; 3],
}
