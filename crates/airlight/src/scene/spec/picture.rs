//! The picture of a scene: projection, file and sequence.

use crate::names::named;
use crate::spectrum::RgbSpace;

/// How directions are laid out in a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Projection {
    /// The whole sphere, azimuth across and elevation down, north in the middle.
    #[default]
    Equirectangular,
    /// Six square files for a cube map: sky.px.exr, .nx, .py, .ny, .pz, .nz (x east, y up, z south).
    Cube,
    /// Angle from the centre in proportion to distance: the sky as a disc.
    Fisheye,
    /// A camera that keeps straight lines straight.
    Perspective,
}

named! { Projection, "a projection", [
    ("equirectangular", (Equirectangular), "the whole sphere, north in the middle"),
    ("cube", (Cube), "six square files for a cube map: sky.px.exr, .nx, .py, .ny, .pz, .nz (x east, y up, z south)"),
    ("fisheye", (Fisheye), "the sky as a disc: angle from the centre in proportion to distance"),
    ("perspective", (Perspective), "a camera that keeps straight lines straight"),
] }

/// Projection and direction of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CameraSpec {
    /// How directions are laid out. Default: equirectangular.
    pub projection: Option<Projection>,
    /// Width and height, pixels, each from 1 to 65536. Default: 2048 x 1024; cube and fisheye 1024 x 1024; perspective
    /// 1920 x 1080.
    pub size: Option<[u32; 2]>,
    /// Azimuth of the middle, degrees clockwise from north. Default: 0; perspective: the sun's at the start; fisheye: 180,
    /// which puts north on top when it looks up.
    pub azimuth_deg: Option<f64>,
    /// Elevation of the middle of a perspective or fisheye picture, degrees, -90 to 90. Default: perspective 10, fisheye 90.
    pub elevation_deg: Option<f64>,
    /// Turn of the perspective camera about its axis, degrees clockwise. Default: 0.
    pub roll_deg: Option<f64>,
    /// Field of view, degrees, above 0: left to right edge of a perspective picture, across the disc of a fisheye. Default:
    /// perspective 75, fisheye 180.
    pub fov_deg: Option<f64>,
}

/// Where the sun's disc goes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SunDiscPlacement {
    /// Into the picture.
    #[default]
    In,
    /// Nowhere: the sky alone.
    Out,
    /// Into a second file: sky.sun.exr beside sky.exr.
    Separate,
}

named! { SunDiscPlacement, "a place for the sun's disc", [
    ("in", (In), "in the picture"),
    ("out", (Out), "left out"),
    ("separate", (Separate), "in a second file: sky.sun.exr beside sky.exr"),
] }

/// How EXR samples are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SamplePrecision {
    /// 32 bits.
    #[default]
    Float,
    /// 16 bits, up to 65504.
    Half,
}

named! { SamplePrecision, "a sample precision", [
    ("float", (Float), "32 bits"),
    ("half", (Half), "16 bits, up to 65504"),
] }

/// How EXR samples are packed, without loss.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExrCompression {
    /// Not at all.
    None,
    /// Run lengths.
    Rle,
    /// Deflate, row by row.
    Zips,
    /// Deflate, 16 rows at a time.
    #[default]
    Zip,
    /// Wavelets.
    Piz,
}

named! { ExrCompression, "a compression", [
    ("none", (None), "no compression"),
    ("rle", (Rle), "run lengths"),
    ("zips", (Zips), "deflate, row by row"),
    ("zip", (Zip), "deflate, 16 rows at a time"),
    ("piz", (Piz), "wavelets"),
] }

/// How light becomes what a display shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneKind {
    /// A curve like film's: bright light rolls off towards white.
    #[default]
    Filmic,
    /// Linear, cut off at white.
    Clip,
}

named! { ToneKind, "a tone curve", [
    ("filmic", (Filmic), "a curve like that of film: bright light rolls off towards white"),
    ("clip", (Clip), "linear, clipped at white"),
] }

/// Exposure of PNG, JPEG and preview: "auto", or a camera's exposure value at ISO 100 (sunny day 15, dusk 8).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        untagged,
        expecting = "expected \"auto\" or an exposure value at ISO 100, such as 14.5"
    )
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Exposure {
    /// Metered.
    Metered(Metered),
    /// Exposure value at ISO 100.
    Ev100(f64),
}

impl Exposure {
    /// Metered.
    pub const AUTO: Self = Self::Metered(Metered::Auto);
}

/// The word for a metered exposure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Metered {
    /// From the picture's luminances.
    Auto,
}

/// A picture file and its encoding.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OutputSpec {
    /// File to write; its ending says the format: .exr, .hdr, .png, .jpg, or .spectral.exr.
    pub file: Option<String>,
    /// The sun's disc in the picture, left out of it, or in a second file. Default: in.
    pub sun_disc: Option<SunDiscPlacement>,
    /// RGB space of .exr and .hdr: srgb, rec2020 or acescg; .png and .jpg are always sRGB. Default: srgb.
    pub color_space: Option<RgbSpace>,
    /// Factor on the values of .exr and .hdr, which are in cd/m^2 (spectral: W m^-2 sr^-1 nm^-1), above 0. Default: 1.
    pub scale: Option<f64>,
    /// Whether to write one channel for each wavelength into the EXR, besides RGB. Default: for names ending in .spectral.exr.
    pub spectral: Option<bool>,
    /// How .exr samples are stored. Default: float.
    pub precision: Option<SamplePrecision>,
    /// How .exr samples are packed. Default: zip.
    pub compression: Option<ExrCompression>,
    /// Exposure of .png, .jpg and preview. Default: auto.
    pub exposure: Option<Exposure>,
    /// Stops by which to brighten .png, .jpg and preview (negative: darken). Default: 0.
    pub brighten: Option<f64>,
    /// How light becomes what .png, .jpg and preview show. Default: filmic.
    pub tone: Option<ToneKind>,
    /// Bits of a component of .png, 8 or 16. Default: 8.
    pub bits: Option<u8>,
    /// Quality of .jpg, 1 to 100. Default: 92.
    pub quality: Option<u8>,
    /// Whether to write the depth of objects into NAME.depth.exr: metres along the camera's axis (perspective) or along the
    /// ray. Default: false.
    pub depth_map: Option<bool>,
    /// Whether to write the standard error of each pixel's colour into NAME.noise.exr. Default: false.
    pub noise_map: Option<bool>,
    /// Whether to write degree and angle of polarisation into NAME.polarisation.exr. Default: false.
    pub polarisation: Option<bool>,
}

/// A picture for each of several times, from the sun's `time` on.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SequenceSpec {
    /// Last time, or a span of time after the first: "+6h".
    pub until: Option<String>,
    /// Time from picture to picture: "10m", "1h30m", "45s".
    pub every: Option<String>,
}
