//! Options that say how a picture is laid out and stored.

use crate::parse::{self, PixelSize};
use clap::{Args, ValueEnum};

/// How directions are laid out in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ProjectionArg {
    /// The whole sphere, azimuth across and elevation down, north in the middle.
    #[value(alias = "equirect", alias = "latlong")]
    Equirectangular,
    /// Six square files for a cube map: sky.px.exr, .nx, .py, .ny, .pz, .nz (x east, y up, z south).
    Cube,
    /// Angle from the centre in proportion to distance: the sky as a disc.
    Fisheye,
    /// A camera that keeps straight lines straight.
    #[value(alias = "camera")]
    Perspective,
}

/// Where the sun's disc goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SunDiscArg {
    /// Into the picture.
    In,
    /// Nowhere: the sky alone.
    Out,
    /// Into a second file beside the picture: sky.sun.exr beside sky.exr.
    Separate,
}

/// RGB spaces of linear files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ColorSpaceArg {
    /// Primaries of sRGB and BT.709, white D65.
    Srgb,
    /// Primaries of BT.2020, white D65.
    Rec2020,
    /// ACEScg: AP1 primaries, white near D60.
    Acescg,
}

/// How EXR samples are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PrecisionArg {
    /// 32 bits.
    Float,
    /// 16 bits, up to 65504: the sun's disc, some 1e9 cd/m^2, is cut off there unless --scale makes it fit.
    Half,
}

/// How EXR samples are packed, without loss.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CompressionArg {
    None,
    Rle,
    Zips,
    Zip,
    Piz,
}

/// How light becomes what a display shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ToneArg {
    /// A curve like film's: bright light rolls off towards white.
    Filmic,
    /// Straight, cut off at white.
    Clip,
}

/// How a picture is laid out and stored.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Picture")]
pub struct PictureArgs {
    /// How directions are laid out
    #[arg(long, value_enum, default_value_t = ProjectionArg::Equirectangular)]
    pub projection: ProjectionArg,
    /// Size in pixels [default: 2048x1024; cube and fisheye 1024x1024; perspective 1920x1080]
    #[arg(long, value_name = "WxH", value_parser = parse::pixel_size)]
    pub size: Option<PixelSize>,
    /// Azimuth of the middle of the picture, degrees clockwise from north [default: 0; perspective: the sun's at the
    /// start; fisheye: 180, which puts north on top when it looks up]
    #[arg(long, value_name = "DEG", value_parser = parse::number)]
    pub camera_azimuth: Option<f64>,
    /// Elevation of the middle of a perspective or fisheye picture, degrees [default: perspective 10, fisheye 90]
    #[arg(long, value_name = "DEG", value_parser = parse::elevation_deg)]
    pub camera_elevation: Option<f64>,
    /// Turn of the perspective camera about its axis, degrees clockwise
    #[arg(long, value_name = "DEG", value_parser = parse::number)]
    pub camera_roll: Option<f64>,
    /// Field of view, degrees: left to right edge of a perspective picture [default: 75], across the disc of a
    /// fisheye [default: 180]
    #[arg(long, value_name = "DEG", value_parser = parse::positive)]
    pub fov: Option<f64>,
    /// The sun's disc in the picture, left out of it, or in a second file
    #[arg(long, value_enum, value_name = "WHERE", default_value_t = SunDiscArg::In)]
    pub sun_disc: SunDiscArg,
    /// Colour space of .exr and .hdr; .png and .jpg are always sRGB
    #[arg(long, value_enum, value_name = "SPACE", default_value_t = ColorSpaceArg::Srgb)]
    pub color_space: ColorSpaceArg,
    /// Factor on the values of .exr and .hdr, which are in cd/m^2 (spectral: W m^-2 sr^-1 nm^-1)
    #[arg(long, value_name = "FACTOR", value_parser = parse::positive, default_value_t = 1.0)]
    pub scale: f64,
    /// Write one channel a wavelength into the EXR, besides RGB; the same as a name ending in .spectral.exr
    #[arg(long)]
    pub spectral: bool,
    /// How .exr samples are stored
    #[arg(long, value_enum, default_value_t = PrecisionArg::Float)]
    pub precision: PrecisionArg,
    /// How .exr samples are packed
    #[arg(long, value_enum, default_value_t = CompressionArg::Zip)]
    pub compression: CompressionArg,
    /// Exposure of .png, .jpg and preview: auto, or a camera's exposure value at ISO 100 (sunny day 15, dusk 8)
    #[arg(long, value_name = "auto|EV100", default_value = "auto")]
    pub exposure: String,
    /// Stops by which to brighten .png, .jpg and preview (negative: darken)
    #[arg(long, value_name = "STOPS", value_parser = parse::number, default_value_t = 0.0)]
    pub brighten: f64,
    /// How light becomes what .png, .jpg and preview show
    #[arg(long, value_enum, default_value_t = ToneArg::Filmic)]
    pub tone: ToneArg,
    /// Bits of a component of .png
    #[arg(long, value_name = "8|16", default_value = "8", value_parser = ["8", "16"])]
    pub bits: String,
    /// Quality of .jpg, 1 to 100
    #[arg(long, value_name = "Q", default_value_t = 92, value_parser = clap::value_parser!(u8).range(1..=100))]
    pub quality: u8,
}
