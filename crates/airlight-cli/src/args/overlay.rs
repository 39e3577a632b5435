//! Options of `airlight fog`.

use super::fog::{DropletsArg, FogScatteringArg};
use super::overlay_batch::BatchArgs;
use crate::parse;
use clap::{Args, ValueEnum};
use serde::Serialize;
use std::path::PathBuf;

/// How the fog thins with height, or which look it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ModelArg {
    /// The same everywhere.
    Uniform,
    /// Thinning exponentially from height 0.
    Height,
    /// The same up to --base-height-m, thinning above.
    Clamped,
    /// Thinning from --base-height-m as clamped does, and as much thicker below it: the fog note's formula as printed.
    Unclamped,
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum HolesArg {
    /// Filled from their neighbours.
    Fill,
    /// Taken for sky.
    Far,
    /// Kept clear.
    Clear,
}

/// Options of `airlight fog`. Serialized, they are what a picture was made with: all that bears upon it.
#[derive(Clone, Debug, Args, Serialize)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES)]
pub struct OverlayArgs {
    /// The picture: EXR or HDR (linear), PNG or JPEG (decoded to light, encoded again); many: a folder, or 'rgb/*.png'
    #[arg(value_name = "COLOUR")]
    #[serde(skip)]
    pub colour: PathBuf,
    /// Its depth: EXR, PNG, NPY or PFM; a folder, or 'depth/*.png' [default: the depth channel of COLOUR, if that is an EXR]
    #[arg(long, value_name = "DEPTH")]
    #[serde(skip)]
    pub depth: Option<PathBuf>,
    /// File to write: .png, .jpg, .exr or .hdr; a folder, or 'out/*.png'
    #[arg(short, long, value_name = "FILE")]
    #[serde(skip)]
    pub output: PathBuf,
    /// Write transmittance, path radiance and distance as layers too (.exr)
    #[arg(long)]
    pub layers: bool,
    /// Say nothing on standard output
    #[arg(short, long)]
    #[serde(skip)]
    pub quiet: bool,
    #[command(flatten)]
    #[serde(skip)]
    pub batch: BatchArgs,

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
    #[serde(rename = "fov_deg")]
    pub fov: Option<f64>,
    /// Focal length, pixels, instead of --fov
    #[arg(long, value_name = "PX", value_parser = parse::positive, help_heading = "Camera")]
    pub focal_px: Option<f64>,
    /// Where the axis meets the picture, pixels, pixel centres at whole numbers [default: the middle]
    #[arg(long, value_name = "X,Y", value_parser = parse::two_numbers, help_heading = "Camera", requires = "focal_px")]
    pub principal_point: Option<(f64, f64)>,
    /// Elevation of the axis above the horizon, degrees
    #[arg(long, value_name = "DEG", value_parser = parse::elevation_deg, default_value_t = 0.0, help_heading = "Camera")]
    #[serde(rename = "camera_elevation_deg")]
    pub camera_elevation: f64,
    /// Azimuth of the axis, degrees clockwise from north
    #[arg(long, value_name = "DEG", value_parser = parse::number, default_value_t = 0.0, help_heading = "Camera")]
    #[serde(rename = "camera_azimuth_deg")]
    pub camera_azimuth: f64,
    /// Turn about the axis, degrees clockwise
    #[arg(long, value_name = "DEG", value_parser = parse::number, default_value_t = 0.0, help_heading = "Camera")]
    #[serde(rename = "camera_roll_deg")]
    pub camera_roll: f64,
    /// Height of the eye above the ground, m
    #[arg(long, value_name = "M", value_parser = parse::length_m, default_value_t = 1.6, help_heading = "Camera")]
    pub eye_height_m: f64,

    /// Distance at which a contrast of 5 % is left, where the fog is thickest, m
    #[arg(long = "visibility-m", value_name = "M", value_parser = parse::length_m, help_heading = "Fog")]
    #[arg(required_unless_present = "vary")]
    #[serde(skip)]
    pub given_visibility_m: Option<f64>,
    /// The visibility of a picture, m: as given, or as drawn.
    #[arg(skip)]
    pub visibility_m: f64,
    /// Contrast that visibility means: 0.05 (meteorological optical range) or 0.02
    #[arg(long, value_name = "C", default_value = "0.05", value_parser = ["0.05", "0.02"], help_heading = "Fog")]
    pub contrast: String,
    /// How it thins with height
    #[arg(long, value_enum, default_value_t = ModelArg::Uniform, help_heading = "Fog")]
    pub model: ModelArg,
    /// Height over which it thins to 1/e, m (height, clamped, unclamped)
    #[arg(long, value_name = "M", value_parser = parse::length_m, default_value_t = 30.0, help_heading = "Fog")]
    pub scale_height_m: f64,
    /// Height from which on it thins, m (clamped), or where it is as thick as told (unclamped)
    #[arg(long, value_name = "M", value_parser = parse::number, default_value_t = 0.0, help_heading = "Fog")]
    pub base_height_m: f64,
    /// Height of its top, m (slab)
    #[arg(long, value_name = "M", value_parser = parse::length_m, default_value_t = 50.0, help_heading = "Fog")]
    pub top_m: f64,
    /// Drops that it consists of
    #[arg(long, value_enum, default_value_t, help_heading = "Fog")]
    pub droplets: DropletsArg,
    /// Which light it scatters; the same in even fog (uniform), which counts as lit evenly
    #[arg(
        long,
        value_enum,
        value_name = "WHICH",
        default_value_t,
        help_heading = "Fog"
    )]
    pub scattering: FogScatteringArg,

    /// Colour of the light that the fog is in, linear, in the picture's units [default: estimated from the picture]
    #[arg(
        long,
        value_name = "auto|R,G,B",
        default_value = "auto",
        help_heading = "Light"
    )]
    pub ambient: String,
    /// Factor on that light
    #[arg(long, value_name = "FACTOR", value_parser = parse::positive, default_value_t = 1.0, help_heading = "Light")]
    pub ambient_scale: f64,
    /// Elevation of the sun, degrees [default: no sun]
    #[arg(long, value_name = "DEG", value_parser = parse::elevation_deg, help_heading = "Light")]
    #[serde(rename = "sun_elevation_deg")]
    pub sun_elevation: Option<f64>,
    /// Azimuth of the sun, degrees clockwise from north
    #[arg(long, value_name = "DEG", value_parser = parse::number, default_value_t = 180.0, help_heading = "Light", requires = "sun_elevation")]
    #[serde(rename = "sun_azimuth_deg")]
    pub sun_azimuth: f64,
    /// Irradiance facing the sun over that of the ambient light on the level (pi times its radiance)
    #[arg(long, value_name = "RATIO", value_parser = parse::not_negative, default_value_t = 3.0, help_heading = "Light", requires = "sun_elevation")]
    pub sun_strength: f64,
    /// Albedo of the ground under fog that has a top [default: 0.2; that of the atmosphere with --sky-light]
    #[arg(long, value_name = "ALBEDO", value_parser = parse::fraction, help_heading = "Light")]
    pub ground_albedo: Option<f64>,
    #[command(flatten)]
    #[serde(flatten)]
    pub light: super::OverlayLightArgs,
    #[command(flatten)]
    #[serde(skip)]
    pub random: super::OverlayPathsArgs,
}

const EXAMPLES: &str = "\
Examples:
  Fog of 12 m visibility over a photograph with depth in millimetres:
    airlight fog photo.png --depth depth_mm.png --depth-scale 0.001 --fov 41 --visibility-m 12 -o fogged.png
  Ground fog in a rendered valley, with layers for a compositor:
    airlight fog render.exr --visibility-m 400 --model height --scale-height-m 40 --eye-height-m 60 \\
      --camera-elevation -7 --layers -o fogged.exr
  What Foggy Cityscapes would have made of it:
    airlight fog photo.png --depth depth_mm.png --depth-scale 0.001 --visibility-m 12 --model foggy-cityscapes -o fogged.png
  Ishiyama's height fog as printed, whose sun shines through it undimmed:
    airlight fog render.exr --visibility-m 400 --model height --sun-elevation 20 --scattering undimmed -o fogged.exr
  A lamp as the fog note prints it, which takes light away where the lamp is passed:
    airlight fog photo.png --depth depth_mm.png --depth-scale 0.001 --visibility-m 12 --droplets isotropic \\
      --lamp 'pixel=120,80 distance=3 intensity=3,2.5,2' --lamp-form printed -o printed.png
  A street lamp in it, and light from the sky solver on ground fog:
    airlight fog photo.png --depth depth_mm.png --depth-scale 0.001 --visibility-m 12 --lamp 'pixel=120,80 intensity=3,2.5,2' \
      -o fogged.png
    airlight fog render.exr --visibility-m 400 --model height --sky-light --sun-elevation 20 -o fogged.exr
  The same by random paths, with the noise of each pixel in a file of its own (small pictures: it is slow):
    airlight fog small.exr --visibility-m 400 --model height --sky-light --sun-elevation 20 --solver monte-carlo \\
      --paths 512 --noise-map -o fogged.exr
  Every picture of a folder, with the depth of the same name:
    airlight fog rgb/ --depth depth/ --depth-scale 0.001 --visibility-m 80 -o foggy/
  Training data: what * stands for links colour, depth and output; three fogs for each picture, told in foggy/manifest.jsonl:
    airlight fog 'rgb/*_left.png' --depth 'depth/*_depth.png' --depth-scale 0.001 --vary visibility=50..500 \\
      --vary droplets=fine,radiation,advection --variants 3 --seed 1 -o 'foggy/*.png'

--vary takes visibility, scale-height, top, eye-height, ambient-scale (drawn so that their logarithms lie evenly), base-height,
camera-elevation, camera-azimuth, camera-roll, sun-elevation, sun-azimuth, sun-strength, ground-albedo (drawn evenly);
NAME=log:LOW..HIGH and NAME=uniform:LOW..HIGH say otherwise. model and droplets take lists.";
