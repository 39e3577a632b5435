//! Options of `airlight view`.

use super::fog::{ContrastArgs, FogArgs};
use super::{AirArgs, CameraArgs, PlaceArgs, SceneArgs, ToneArgs};
use crate::error::CliError;
use crate::parse;
use airlight::scene::Scene;
use clap::Args;
use std::path::PathBuf;

/// Options of `airlight view`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = NOTES)]
pub struct ViewArgs {
    /// Scene file, which the other options override [default: a hazy evening]
    #[arg(value_name = "FILE.toml")]
    pub file: Option<PathBuf>,
    /// Draw the window into a picture file instead of opening it; --size is then that of the file
    #[arg(long, value_name = "FILE")]
    pub screenshot: Option<PathBuf>,
    /// Show the picture alone, without controls (F2)
    #[arg(long)]
    pub no_panel: bool,
    /// Ground in front of the sky: a file of heights in metres, from north to south (PNG, TIFF, EXR, PFM, NPY), or the word mountains
    #[arg(long, value_name = "FILE|mountains")]
    pub terrain: Option<PathBuf>,
    /// Distance between the pixels of a --terrain file, m [default: 30]
    #[arg(long, value_name = "M", value_parser = parse::positive, requires = "terrain")]
    pub terrain_spacing_m: Option<f64>,
    #[command(flatten)]
    pub place: PlaceArgs,
    #[command(flatten)]
    pub air: AirArgs,
    #[command(flatten)]
    pub contrast: ContrastArgs,
    #[command(flatten)]
    pub fog: FogArgs,
    #[command(flatten)]
    pub camera: CameraArgs,
    #[command(flatten)]
    pub tone: ToneArgs,
}

impl ViewArgs {
    /// A scene, that of the file if there is one, with the options over it.
    ///
    /// # Errors
    /// [`CliError`] if a file cannot be read or is invalid.
    pub fn over(&self, mut scene: Scene) -> Result<Scene, CliError> {
        let place = &self.place;
        if self.file.is_none() && (place.at.is_some() || place.sun_elevation.is_some()) {
            // Towards the sun.
            scene.camera.azimuth_deg = None;
        }
        let options = SceneArgs {
            place: place.clone(),
            air: self.air.clone(),
            contrast: self.contrast.clone(),
            fog: self.fog.clone(),
            ..Default::default()
        };
        options.over(scene, |scene| {
            self.camera.fill(&mut scene.camera);
            self.tone.fill(&mut scene.output);
        })
    }
}

const NOTES: &str = "\
Drag to look around, scroll to zoom, Ctrl and drag to move the sun. With the focus on the picture: arrow keys look around, + and - zoom,
Page Up and Page Down climb, W, A, S and D move over terrain. Ctrl+Z undoes. F2 hides the controls.

Examples:
  airlight view
  airlight view --at 48.8584,2.2945 --when 2026-06-21T21:15:00+02:00
  airlight view --terrain mountains --altitude-m 700 --visibility-m 600 --scale-height-m 40
  airlight view evening.toml --screenshot evening.png --size 1920x1080 --no-panel";
