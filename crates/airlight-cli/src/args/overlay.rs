//! Options of `airlight fog`.

use super::fog::{ContrastArgs, FogArgs};
use super::overlay_batch::BatchArgs;
use super::{NightArgs, OverlayLightArgs, OverlaySolverArgs, ToneArgs};
use crate::parse;
use airlight_image::input::{DepthPacking, UnknownDepth};
use airlight_render::overlay::{DepthFileKind, NegativeDepth, OverlayScene};
use clap::Args;
use std::path::PathBuf;

/// Options of `airlight fog`.
#[derive(Clone, Debug, Args)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES)]
#[command(mut_args(of_fog))]
pub struct OverlayArgs {
    /// Picture: EXR, HDR or TIFF of floats (linear), PNG, JPEG or TIFF of integers (decoded to light, encoded again); for many, a folder
    /// or 'rgb/*.png'
    #[arg(value_name = "COLOUR", required_unless_present = "scene")]
    pub colour: Option<PathBuf>,
    /// Layer of an EXR picture, such as ViewLayer.Combined, or the name of a part [default: plain R, G, B, else a layer called
    /// Combined, else the only one]
    #[arg(long, value_name = "NAME")]
    pub colour_layer: Option<String>,
    /// Depth map: EXR, PNG, NPY, NPZ, PFM or TIFF; a folder, or 'depth/*.png' [default: the depth channel of COLOUR, if that is an EXR]
    #[arg(long, value_name = "DEPTH")]
    pub depth: Option<PathBuf>,
    /// File to write: .png, .jpg, .exr or .hdr; a folder, or 'out/*.png'
    #[arg(short, long, value_name = "FILE", required_unless_present = "scene")]
    pub output: Option<String>,
    /// Also write transmittance, path radiance and depth as layers (.exr)
    #[arg(long)]
    pub layers: bool,
    /// Quality of .jpg, 1 to 100 [default: 92]
    #[arg(long, value_name = "Q", value_parser = parse::quality)]
    pub quality: Option<u8>,
    /// Scene file, which the other options override
    #[arg(long, value_name = "FILE.toml")]
    pub scene: Option<PathBuf>,
    /// Write the scene of these options to a TOML file
    #[arg(long, value_name = "FILE.toml")]
    pub save_scene: Option<PathBuf>,
    /// Print nothing on standard output
    #[arg(short, long)]
    pub quiet: bool,
    #[command(flatten)]
    pub batch: BatchArgs,

    /// Meaning of the depth values [default: z]
    #[arg(long, value_name = "KIND", value_parser = parse::named::<DepthFileKind>(), help_heading = "Depth")]
    pub depth_kind: Option<DepthFileKind>,
    /// Metres for each unit of depth: 0.001 for millimetres; negative with --depth-offset for inverted depth [default: 1]
    #[arg(long, value_name = "M", value_parser = parse::number, help_heading = "Depth")]
    pub depth_scale: Option<f64>,
    /// Added to scaled depth, m (inverse: 1/m), for normalised depth; 0 is then a depth, otherwise unknown
    #[arg(long, value_name = "M", value_parser = parse::number, help_heading = "Depth")]
    pub depth_offset: Option<f64>,
    /// How a colour PNG holds depth [default: none]
    #[arg(long, value_name = "HOW", value_parser = parse::named::<DepthPacking>(), help_heading = "Depth")]
    pub depth_packing: Option<DepthPacking>,
    /// Treatment of negative depth [default: refuse]
    #[arg(long, value_name = "HOW", value_parser = parse::named::<NegativeDepth>(), help_heading = "Depth")]
    pub negative: Option<NegativeDepth>,
    /// Channel of an EXR, or array of an NPZ depth file
    #[arg(long, value_name = "NAME", help_heading = "Depth")]
    pub depth_channel: Option<String>,
    /// Treatment of pixels of unknown depth [default: fill]
    #[arg(long, value_name = "HOW", value_parser = parse::named::<UnknownDepth>(), help_heading = "Depth")]
    pub holes: Option<UnknownDepth>,
    /// Pixels at this distance or beyond are sky, m
    #[arg(long, value_name = "M", value_parser = parse::length_m, help_heading = "Depth")]
    pub far_m: Option<f64>,
    /// Distance between the cameras of a disparity map, m
    #[arg(long, value_name = "M", value_parser = parse::length_m, help_heading = "Depth")]
    pub baseline_m: Option<f64>,
    /// Near plane of a depth buffer, m
    #[arg(long, value_name = "M", value_parser = parse::length_m, help_heading = "Depth")]
    pub near_plane_m: Option<f64>,
    /// Far plane of a depth buffer, m; what reaches it is sky [default: infinite]
    #[arg(long, value_name = "M", value_parser = parse::length_m, help_heading = "Depth")]
    pub far_plane_m: Option<f64>,
    /// Offset added to disparities, pixels [default: 0]
    #[arg(long, value_name = "PX", value_parser = parse::number, help_heading = "Depth")]
    pub disparity_offset_px: Option<f64>,

    /// Horizontal field of view, degrees [default: 60]
    #[arg(long, value_name = "DEG", value_parser = parse::positive, help_heading = "Camera", conflicts_with = "focal_px")]
    pub fov: Option<f64>,
    /// Focal length, pixels, instead of --fov
    #[arg(long, value_name = "PX", value_parser = parse::positive, help_heading = "Camera")]
    pub focal_px: Option<f64>,
    /// Principal point, pixels, with pixel centres at whole numbers [default: the centre]
    #[arg(long, value_name = "X,Y", value_parser = parse::two_numbers, help_heading = "Camera")]
    pub principal_point: Option<(f64, f64)>,
    /// Elevation of the camera's axis above the horizon, degrees [default: 0]
    #[arg(long, value_name = "DEG", value_parser = parse::elevation_deg, help_heading = "Camera")]
    pub camera_elevation: Option<f64>,
    /// Azimuth of the axis, degrees clockwise from north [default: 0]
    #[arg(long, value_name = "DEG", value_parser = parse::number, help_heading = "Camera")]
    pub camera_azimuth: Option<f64>,
    /// Rotation about the axis, degrees clockwise [default: 0]
    #[arg(long, value_name = "DEG", value_parser = parse::number, help_heading = "Camera")]
    pub camera_roll: Option<f64>,
    /// Height of the eye above the ground, m [default: 1.6]
    #[arg(long, value_name = "M", value_parser = parse::length_m, help_heading = "Camera")]
    pub eye_height_m: Option<f64>,

    #[command(flatten)]
    pub fog: FogArgs,
    #[command(flatten)]
    pub contrast: ContrastArgs,
    #[command(flatten)]
    pub light: OverlayLightArgs,
    #[command(flatten)]
    pub night: NightArgs,
    #[command(flatten)]
    pub solver: OverlaySolverArgs,
    #[command(flatten)]
    pub tone: ToneArgs,
}

/// The options of [`ToneArgs`] and [`NightArgs`], under headings that say when they act; without `--stars`, which fog cannot show.
fn of_fog(arg: clap::Arg) -> clap::Arg {
    let hidden = arg.get_id() == "stars";
    match arg.get_help_heading() {
        Some("Picture") => arg.help_heading("Display (linear light in, PNG or JPEG out)"),
        Some("Night") => arg.help_heading("Night (with --sky-light)").hide(hidden),
        _ => arg,
    }
}

impl OverlayArgs {
    /// Overrides values of a description.
    pub fn fill(&self, to: &mut OverlayScene) {
        let put = |value: &mut Option<f64>, given: Option<f64>| *value = given.or(*value);
        let overlay = &mut to.overlay;
        if let Some(colour) = &self.colour {
            // The description's depth map belongs to another picture.
            (overlay.colour, overlay.depth) = (colour.clone(), None);
            overlay.colour_layer = None;
        }
        overlay.colour_layer = self.colour_layer.clone().or(overlay.colour_layer.take());
        overlay.depth = self.depth.clone().or(overlay.depth.take());
        overlay.depth_kind = self.depth_kind.unwrap_or(overlay.depth_kind);
        overlay.depth_scale = self.depth_scale.unwrap_or(overlay.depth_scale);
        overlay.depth_channel = self.depth_channel.clone().or(overlay.depth_channel.take());
        put(&mut overlay.depth_offset, self.depth_offset);
        overlay.depth_packing = self.depth_packing.or(overlay.depth_packing);
        overlay.negative = self.negative.or(overlay.negative);
        overlay.holes = self.holes.unwrap_or(overlay.holes);
        put(&mut overlay.far_m, self.far_m);
        put(&mut overlay.baseline_m, self.baseline_m);
        put(&mut overlay.near_plane_m, self.near_plane_m);
        put(&mut overlay.far_plane_m, self.far_plane_m);
        let offset_px = self.disparity_offset_px;
        overlay.disparity_offset_px = offset_px.unwrap_or(overlay.disparity_offset_px);
        if self.fov.is_some() {
            (overlay.focal_px, overlay.principal_point_px) = (None, None);
        }
        put(&mut overlay.focal_px, self.focal_px);
        let principal = self.principal_point.map(|(x, y)| [x, y]);
        overlay.principal_point_px = principal.or(overlay.principal_point_px);
        overlay.layers |= self.layers;

        let scene = &mut to.scene;
        scene.output.file = self.output.clone().or(scene.output.file.take());
        scene.output.quality = self.quality.or(scene.output.quality);
        self.tone.fill(&mut scene.output);
        if self.focal_px.is_some() {
            scene.camera.fov_deg = None;
        }
        put(&mut scene.camera.fov_deg, self.fov);
        put(&mut scene.camera.azimuth_deg, self.camera_azimuth);
        put(&mut scene.camera.elevation_deg, self.camera_elevation);
        put(&mut scene.camera.roll_deg, self.camera_roll);
        put(&mut scene.observer.eye_height_m, self.eye_height_m);
        put(&mut scene.air.contrast, self.contrast.contrast);
        self.fog.fill(&mut scene.fog);
        self.solver.fill(scene);
        self.night.fill(&mut to.scene);
        self.light.fill(to);
    }
}

const EXAMPLES: &str = "\
Examples:
  Fog of 12 m visibility over a photograph with depth in millimetres:
    airlight fog photo.png --depth depth_mm.png --depth-scale 0.001 --fov 41 --visibility-m 12 -o fogged.png
  Ground fog in a rendered valley, with layers for a compositor:
    airlight fog render.exr --visibility-m 400 --scale-height-m 40 --eye-height-m 60 \\
      --camera-elevation -7 --layers -o fogged.exr
  The same fog as in Foggy Cityscapes:
    airlight fog photo.png --depth depth_mm.png --depth-scale 0.001 --visibility-m 12 --fog-profile foggy-cityscapes \\
      -o fogged.png
  Ishiyama's height fog as printed, with unattenuated sunlight:
    airlight fog render.exr --visibility-m 400 --fog-profile height --sun-elevation 20 --fog-scattering undimmed \\
      -o fogged.exr
  A light in the form printed in the fog note, negative for rays that pass the light:
    airlight fog photo.png --depth depth_mm.png --depth-scale 0.001 --visibility-m 12 --droplets isotropic \\
      --light 'pixel=120,80 distance=3 intensity=3,2.5,2' --light-form printed -o printed.png
  A street light; ground fog lit by the solved sky:
    airlight fog photo.png --depth depth_mm.png --depth-scale 0.001 --visibility-m 12 \\
      --light 'pixel=120,80 intensity=3,2.5,2' -o fogged.png
    airlight fog render.exr --visibility-m 400 --fog-profile height --sky-light --sun-elevation 20 -o fogged.exr
  Ground fog on a night of full moon:
    airlight fog render.exr --visibility-m 400 --fog-profile height --sky-light --sun-elevation -30 --moon-elevation 40 \\
      --moon-phase 0 -o fogged.exr
  Ground fog by Monte Carlo, with a noise map in a second file (slow; for small pictures):
    airlight fog small.exr --visibility-m 400 --fog-profile height --sky-light --sun-elevation 20 --solver monte-carlo \\
      --paths 512 --noise-map -o fogged.exr
  Every picture of a folder, with the depth map of the same name:
    airlight fog rgb/ --depth depth/ --depth-scale 0.001 --visibility-m 80 -o foggy/
  A rendered picture as a photograph of a dull day, exposed by its brightest part:
    airlight fog render.exr --visibility-m 300 --exposure highlight-weighted --saturation 0.9 -o fogged.png
  Training data: * matches colour, depth and output; three variants of each picture, recorded in foggy/manifest.jsonl:
    airlight fog 'rgb/*_left.png' --depth 'depth/*_depth.png' --depth-scale 0.001 --vary visibility=50..500 \\
      --vary droplets=fine,radiation,advection --variants 3 --seed 1 -o 'foggy/*.png'

  Three visibilities of each picture in patchy fog, half of the pictures on each of two machines:
    airlight fog 'rgb/*.png' --depth 'depth/*.png' --depth-scale 0.001 --each visibility=50,100,200 --patch-strength 0.7 \\
      --vary patch-seed=0..999999 --seed 1 --shard 1/2 -o 'foggy/{visibility}/*.png'

--vary and --each take the numeric options of one number, without their units: visibility, scale-height, base-height, top,
contrast, patch-strength, patch-size, patch-height, patch-seed, patch-time, eye-height, camera-elevation, camera-azimuth,
camera-roll, fov, focal, depth-scale, depth-offset, far, baseline, near-plane, far-plane, disparity-offset, ambient-scale,
sun-elevation, sun-azimuth, sun-strength, moon-elevation, moon-azimuth, moon-phase, solar-flux, sky-quality, star-latitude,
ground-albedo, ground-altitude, aod-550, haze-visibility, radiance-scale, quality, exposure, brighten, tone-contrast, saturation
and white-balance; of options of several numbers each by itself: ambient-red, ambient-green, ambient-blue, patch-wind-east,
patch-wind-north, principal-point-x and principal-point-y; and lists of fog-profile, droplets and fog-scattering. --vary draws
lengths, ambient-scale, radiance-scale, focal, haze-visibility and white-balance uniformly in the logarithm, and others uniformly;
NAME=log:LOW..HIGH and NAME=uniform:LOW..HIGH override this.";
