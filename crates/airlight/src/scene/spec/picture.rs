//! Picture of a scene: projection, file and sequence.

use super::{Exposure, Orientation};
use crate::names::named;
use crate::spectrum::RgbSpace;

/// Mapping of directions to pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Projection {
    /// The whole sphere: azimuth is horizontal, elevation vertical, north in the centre.
    #[default]
    Equirectangular,
    /// Six square files of a cube map: sky.px.exr, .nx, .py, .ny, .pz, .nz (x east, y up, z south).
    Cube,
    /// Equidistant fisheye: distance from the centre is proportional to the angle.
    Fisheye,
    /// Perspective (rectilinear) camera.
    Perspective,
}

named! { Projection, "a projection", [
    ("equirectangular", (Equirectangular), "the whole sphere, north in the centre"),
    ("cube", (Cube), "six square files of a cube map: sky.px.exr, .nx, .py, .ny, .pz, .nz (x east, y up, z south)"),
    ("fisheye", (Fisheye), "equidistant fisheye: distance from the centre is proportional to the angle"),
    ("perspective", (Perspective), "perspective (rectilinear) camera"),
] }

/// Projection and direction of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CameraSpec {
    /// Mapping of directions to pixels. Default: equirectangular.
    pub projection: Option<Projection>,
    /// Width and height, pixels, each from 1 to 65536. Default: 2048 x 1024; cube and fisheye 1024 x 1024; perspective
    /// 1920 x 1080.
    pub size: Option<[u32; 2]>,
    /// Azimuth of the centre, degrees clockwise from north. Default: 0; perspective: that of the sun at the start; fisheye:
    /// 180, which puts north at the top of a picture of the zenith.
    pub azimuth_deg: Option<f64>,
    /// Program for whose axes a panorama is oriented, instead of `azimuth_deg`; with three also a cube map. Default: airlight, with
    /// north in the centre.
    pub orientation: Option<Orientation>,
    /// Elevation of the centre of a perspective or fisheye picture, degrees, -90 to 90. Default: perspective 10, fisheye 90.
    pub elevation_deg: Option<f64>,
    /// Rotation of the perspective camera about its axis, degrees clockwise. Default: 0.
    pub roll_deg: Option<f64>,
    /// Field of view, degrees, above 0: left to right edge of a perspective picture, across the disc of a fisheye. Default:
    /// perspective 75, fisheye 180.
    pub fov_deg: Option<f64>,
}

/// Placement of the sun's disc.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SunDiscPlacement {
    /// In the picture.
    #[default]
    In,
    /// Omitted: the picture shows the sky without the disc.
    Out,
    /// In a second file: sky.sun.exr beside sky.exr.
    Separate,
}

named! { SunDiscPlacement, "a place for the sun's disc", [
    ("in", (In), "in the picture"),
    ("out", (Out), "omitted"),
    ("separate", (Separate), "in a second file: sky.sun.exr beside sky.exr"),
] }

/// What happens to colours outside the RGB space of .exr and .hdr.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Gamut {
    /// They keep their negative components, which .hdr stores as 0.
    #[default]
    Keep,
    /// They move towards grey of the same luminance until no component is negative.
    Desaturate,
}

named! { Gamut, "a treatment of colours outside the RGB space", [
    ("keep", (Keep), "negative components are kept (.hdr: 0)"),
    ("desaturate", (Desaturate), "moved towards grey of the same luminance until no component is negative"),
] }

/// Precision of EXR samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SamplePrecision {
    /// 32-bit floating point; infinite samples stay infinite.
    #[default]
    Float,
    /// 16-bit floating point: about 3 digits, up to 65504; larger samples are clamped and counted.
    Half,
}

named! { SamplePrecision, "a sample precision", [
    ("float", (Float), "32 bits"),
    ("half", (Half), "16 bits, up to 65504"),
] }

/// Lossless compression of EXR samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ExrCompression {
    /// No compression.
    None,
    /// Run-length encoding: fast, large files.
    Rle,
    /// Deflate of single rows.
    Zips,
    /// Deflate of blocks of 16 rows; of single rows where those would take more than 16 MiB.
    #[default]
    Zip,
    /// Wavelets over 32 rows: small for grainy pictures; deflate of single rows where they would take more than 16 MiB.
    Piz,
}

named! { ExrCompression, "a compression", [
    ("none", (None), "no compression"),
    ("rle", (Rle), "run-length encoding"),
    ("zips", (Zips), "deflate of single rows"),
    ("zip", (Zip), "deflate of blocks of 16 rows"),
    ("piz", (Piz), "wavelets"),
] }

/// Tone curve from exposed light to display values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ToneKind {
    /// Camera-like: contrast, highlights that roll off to white, hue kept.
    #[default]
    Camera,
    /// The base look of AgX: low contrast, bright saturated colours turn white early.
    AgxBase,
    /// Linear, clipped at white.
    Clip,
}

named! { ToneKind, "a tone curve", [
    ("camera", (Camera), "camera-like: contrast, highlights that roll off to white, hue kept"),
    ("agx-base", (AgxBase), "base look of AgX: low contrast, bright saturated colours turn white early"),
    ("clip", (Clip), "linear, clipped at white"),
] }

/// Picture file and its encoding.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OutputSpec {
    /// File to write; its extension selects the format: .exr, .hdr, .png, .jpg, or .spectral.exr.
    pub file: Option<String>,
    /// Sun's disc in the picture, omitted, or in a second file. Default: in.
    pub sun_disc: Option<SunDiscPlacement>,
    /// RGB space of .exr and .hdr: srgb, rec2020, acescg or acescg-unadapted; .png and .jpg are always sRGB. Default: srgb.
    pub color_space: Option<RgbSpace>,
    /// Factor on the values of .exr and .hdr, which are in cd/m^2 (spectral: W m^-2 sr^-1 nm^-1), above 0. Default: 1.
    pub scale: Option<f64>,
    /// Colours outside the RGB space of .exr and .hdr, such as those of a low sun. Default: keep.
    pub gamut: Option<Gamut>,
    /// Whether the EXR has one channel for each wavelength besides RGB. Default: true for names that end in .spectral.exr.
    pub spectral: Option<bool>,
    /// Precision of .exr samples. Default: float.
    pub precision: Option<SamplePrecision>,
    /// Lossless compression of .exr samples. Default: zip.
    pub compression: Option<ExrCompression>,
    /// Exposure of .png, .jpg and preview: a metering mode, an exposure value at ISO 100 or the settings of a camera.
    /// Default: auto.
    pub exposure: Option<Exposure>,
    /// Stops by which .png, .jpg and preview are brightened (negative: darkened). Default: 0.
    pub brighten: Option<f64>,
    /// Tone curve of .png, .jpg and preview. Default: camera.
    pub tone: Option<ToneKind>,
    /// Contrast of the camera curve: its slope at middle grey on logarithmic axes, 0.5 to 3. Default: 1.2.
    pub tone_contrast: Option<f64>,
    /// Saturation of the camera curve: factor on the distance from grey, 0 to 3. Default: 1.
    pub saturation: Option<f64>,
    /// Colour temperature of the light that .png, .jpg and preview show as neutral, K, 1667 to 25000. Default: daylight, D65.
    pub white_balance_k: Option<f64>,
    /// Whether .png, .jpg and preview show dark scenes as the dark-adapted eye sees them: bluish grey. Default: false.
    pub scotopic: Option<bool>,
    /// Bits per component of .png, 8 or 16. Default: 8.
    pub bits: Option<u8>,
    /// Quality of .jpg, 1 to 100. Default: 92.
    pub quality: Option<u8>,
    /// Whether to write the depth of objects to NAME.depth.exr, in metres along the camera's axis (perspective) or along the
    /// ray. Default: false.
    pub depth_map: Option<bool>,
    /// Whether to write the standard error of each pixel's colour to NAME.noise.exr. Default: false.
    pub noise_map: Option<bool>,
    /// Whether to write degree and angle of polarisation to NAME.polarisation.exr. Default: false.
    pub polarisation: Option<bool>,
}

/// Sequence of pictures at equal intervals, starting at the sun's `time`.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SequenceSpec {
    /// Last time, or a duration after the first: "+6h".
    pub until: Option<String>,
    /// Interval between pictures: "10m", "1h30m", "45s".
    pub every: Option<String>,
    /// Whether every picture is metered by itself, rather than all exposed as the brightest of the first, the middle and the
    /// last. Default: false.
    pub meter_each: Option<bool>,
}
