//! Options of `airlight fog`.

use super::fog::DropletsArg;
use crate::parse;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// How the fog thins with height, or which look it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ModelArg {
    /// The same everywhere.
    Uniform,
    /// Thinning exponentially from height 0.
    Height,
    /// The same up to --base-height-m, thinning above.
    Clamped,
    /// The same up to --top-m, nothing above.
    Slab,
    /// Exponential-squared, a look.
    Exp2,
    /// Linear from 0 to the visibility, a look.
    Linear,
    /// Uniform fog blended in encoded values, as the data set Foggy Cityscapes has it.
    FoggyCityscapes,
}

/// What the numbers of the depth file mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DepthKindArg {
    /// Depth along the camera's axis.
    Z,
    /// Distance along the ray of the pixel.
    Ray,
    /// Stereo disparity, pixels: needs --focal-px and --baseline-m.
    Disparity,
    /// One over depth.
    Inverse,
}

/// What becomes of pixels of unknown depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum HolesArg {
    /// Filled from their neighbours.
    Fill,
    /// Taken for sky.
    Far,
    /// Kept clear.
    Clear,
}

/// Options of `airlight fog`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES)]
pub struct OverlayArgs {
    /// The picture: EXR or HDR (linear), PNG or JPEG (decoded to light, encoded again)
    #[arg(value_name = "COLOUR")]
    pub colour: PathBuf,
    /// Its depth: EXR, PNG, NPY or PFM [default: the depth channel of COLOUR, if that is an EXR]
    #[arg(long, value_name = "DEPTH")]
    pub depth: Option<PathBuf>,
    /// File to write: .png, .jpg, .exr or .hdr
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Write transmittance, path radiance and distance as layers too (.exr)
    #[arg(long)]
    pub layers: bool,
    /// Say nothing on standard output
    #[arg(short, long)]
    pub quiet: bool,

    /// What the depth means
    #[arg(long, value_enum, default_value_t = DepthKindArg::Z, help_heading = "Depth")]
    pub depth_kind: DepthKindArg,
    /// Metres for each unit of depth: 0.001 for millimetres
    #[arg(long, value_name = "M", value_parser = parse::positive, default_value_t = 1.0, help_heading = "Depth")]
    pub depth_scale: f64,
    /// Channel of an EXR depth file
    #[arg(long, value_name = "NAME", help_heading = "Depth")]
    pub depth_channel: Option<String>,
    /// What becomes of pixels of unknown depth
    #[arg(long, value_enum, default_value_t = HolesArg::Fill, help_heading = "Depth")]
    pub holes: HolesArg,
    /// From this distance on there is sky, m
    #[arg(long, value_name = "M", value_parser = parse::length_m, help_heading = "Depth")]
    pub far_m: Option<f64>,
    /// Distance between the cameras of a disparity map, m
    #[arg(long, value_name = "M", value_parser = parse::length_m, help_heading = "Depth")]
    pub baseline_m: Option<f64>,
    /// Offset added to disparities, pixels
    #[arg(long, value_name = "PX", value_parser = parse::number, default_value_t = 0.0, help_heading = "Depth")]
    pub disparity_offset_px: f64,

    /// Field of view from left to right, degrees [default: 60]
    #[arg(long, value_name = "DEG", value_parser = parse::positive, help_heading = "Camera", conflicts_with = "focal_px")]
    pub fov: Option<f64>,
    /// Focal length, pixels, instead of --fov
    #[arg(long, value_name = "PX", value_parser = parse::positive, help_heading = "Camera")]
    pub focal_px: Option<f64>,
    /// Where the axis meets the picture, pixels, pixel centres at whole numbers [default: the middle]
    #[arg(long, value_name = "X,Y", value_parser = parse::two_numbers, help_heading = "Camera", requires = "focal_px")]
    pub principal_point: Option<(f64, f64)>,
    /// Elevation of the axis above the horizon, degrees
    #[arg(long, value_name = "DEG", value_parser = parse::elevation_deg, default_value_t = 0.0, help_heading = "Camera")]
    pub camera_elevation: f64,
    /// Azimuth of the axis, degrees clockwise from north
    #[arg(long, value_name = "DEG", value_parser = parse::number, default_value_t = 0.0, help_heading = "Camera")]
    pub camera_azimuth: f64,
    /// Turn about the axis, degrees clockwise
    #[arg(long, value_name = "DEG", value_parser = parse::number, default_value_t = 0.0, help_heading = "Camera")]
    pub camera_roll: f64,
    /// Height of the eye above the ground, m
    #[arg(long, value_name = "M", value_parser = parse::length_m, default_value_t = 1.6, help_heading = "Camera")]
    pub eye_height_m: f64,

    /// Distance at which a contrast of 5 % is left, where the fog is thickest, m
    #[arg(long, value_name = "M", value_parser = parse::length_m, help_heading = "Fog")]
    pub visibility_m: f64,
    /// Contrast that visibility means: 0.05 (meteorological optical range) or 0.02
    #[arg(long, value_name = "C", default_value = "0.05", value_parser = ["0.05", "0.02"], help_heading = "Fog")]
    pub contrast: String,
    /// How it thins with height
    #[arg(long, value_enum, default_value_t = ModelArg::Uniform, help_heading = "Fog")]
    pub model: ModelArg,
    /// Height over which it thins to 1/e, m (height, clamped)
    #[arg(long, value_name = "M", value_parser = parse::length_m, default_value_t = 30.0, help_heading = "Fog")]
    pub scale_height_m: f64,
    /// Height from which on it thins, m (clamped)
    #[arg(long, value_name = "M", value_parser = parse::number, default_value_t = 0.0, help_heading = "Fog")]
    pub base_height_m: f64,
    /// Height of its top, m (slab)
    #[arg(long, value_name = "M", value_parser = parse::length_m, default_value_t = 50.0, help_heading = "Fog")]
    pub top_m: f64,
    /// Drops that it consists of
    #[arg(long, value_enum, default_value_t = DropletsArg::Radiation, help_heading = "Fog")]
    pub droplets: DropletsArg,

    /// Colour of the light that the fog is in, linear, in the picture's units [default: estimated from the picture]
    #[arg(
        long,
        value_name = "auto|R,G,B",
        default_value = "auto",
        help_heading = "Light"
    )]
    pub ambient: String,
    /// Elevation of the sun, degrees [default: no sun]
    #[arg(long, value_name = "DEG", value_parser = parse::elevation_deg, help_heading = "Light")]
    pub sun_elevation: Option<f64>,
    /// Azimuth of the sun, degrees clockwise from north
    #[arg(long, value_name = "DEG", value_parser = parse::number, default_value_t = 180.0, help_heading = "Light", requires = "sun_elevation")]
    pub sun_azimuth: f64,
    /// Irradiance facing the sun over that of the ambient light on the level (pi times its radiance)
    #[arg(long, value_name = "RATIO", value_parser = parse::not_negative, default_value_t = 3.0, help_heading = "Light", requires = "sun_elevation")]
    pub sun_strength: f64,
    /// Albedo of the ground under fog that has a top [default: 0.2; that of the atmosphere with --sky-light]
    #[arg(long, value_name = "ALBEDO", value_parser = parse::fraction, help_heading = "Light")]
    pub ground_albedo: Option<f64>,
    #[command(flatten)]
    pub light: super::OverlayLightArgs,
}

const EXAMPLES: &str = "\
Examples:
  Fog of 12 m visibility over a photograph with depth in millimetres:
    airlight fog photo.png --depth depth_mm.png --depth-scale 0.001 --fov 41 --visibility-m 12 -o fogged.png
  Ground fog in a rendered valley, with layers for a compositor:
    airlight fog render.exr --visibility-m 400 --model height --scale-height-m 40 --eye-height-m 60 \\
      --camera-elevation -7 --layers -o fogged.exr
  What Foggy Cityscapes would have made of it:
    airlight fog photo.png --depth depth_mm.png --depth-scale 0.001 --visibility-m 12 --model foggy-cityscapes -o fogged.png";
