//! Options of `airlight probe`.

use super::SceneArgs;
use crate::error::CliError;
use crate::parse::{self, AzEl, put};
use airlight::scene::Scene;
use airlight::spectrum::RgbSpace;
use clap::Args;
use std::path::PathBuf;

/// Output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FormatArg {
    /// JSON in the format airlight-probe/1.
    Json,
    /// CSV with a line for each direction and wavelength.
    Csv,
    /// Plain text.
    Table,
}

airlight::named! { FormatArg, "an output format", [
    ("json", (Json), "the format airlight-probe/1"),
    ("csv", (Csv), "a line for each direction and wavelength"),
    ("table", (Table), "plain text"),
] }

/// Options of `airlight probe`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES)]
pub struct ProbeArgs {
    /// View direction: azimuth,elevation in degrees; can be repeated
    #[arg(long, value_name = "AZ,EL", value_parser = parse::az_el, allow_hyphen_values = true)]
    #[arg(help_heading = "Directions")]
    pub view: Vec<AzEl>,
    /// CSV file of directions with the columns azimuth_deg, elevation_deg and optionally distance_m; - reads standard input
    #[arg(long, value_name = "FILE.csv", help_heading = "Directions")]
    pub views: Option<PathBuf>,
    /// Length of the rays, m, for the air between the eye and an object at this distance [default: to the ground or to space]
    #[arg(long, value_name = "M", value_parser = parse::length_m, help_heading = "Directions")]
    pub distance_m: Option<f64>,
    /// Also compute the polarisation of the light
    #[arg(long, help_heading = "Directions")]
    pub polarisation: bool,
    /// Output format
    #[arg(long, value_parser = parse::named::<FormatArg>(), default_value_t = FormatArg::Table, help_heading = "Output")]
    pub format: FormatArg,
    /// File to write instead of standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub output: Option<PathBuf>,
    /// Colour space of the RGB values [default: srgb]
    #[arg(long, value_name = "SPACE", value_parser = parse::named::<RgbSpace>(), help_heading = "Output")]
    pub color_space: Option<RgbSpace>,
    #[command(flatten)]
    pub scene: SceneArgs,
}

impl ProbeArgs {
    /// The scene of the options.
    ///
    /// # Errors
    /// [`CliError`] if a file cannot be read or is invalid.
    pub fn read(&self) -> Result<Scene, CliError> {
        self.scene.read(|scene| {
            put(&mut scene.output.color_space, &self.color_space);
            let polarisation = self.polarisation.then_some(true);
            put(&mut scene.output.polarisation, &polarisation);
        })
    }
}

const EXAMPLES: &str = "\
Radiances do not include the sun's disc, whose light is printed separately.

Examples:
  The zenith and a point near the horizon, as plain text:
    airlight probe --sun-elevation 30 --view 0,90 --view 90,2
  The sky over Paris every 5 nm, as JSON:
    airlight probe --at 48.8584,2.2945 --when 2026-06-21T19:15:00Z --view 180,45 --wavelengths fine --format json
  The haze in front of a mountain 20 km away:
    airlight probe --sun-elevation 20 --view 90,1 --distance-m 20e3 --haze-visibility-m 40e3
  The same by Monte Carlo, with standard errors:
    airlight probe --sun-elevation 20 --view 90,1 --distance-m 20e3 --haze-visibility-m 40e3 --solver monte-carlo
  Degree and angle of polarisation at a right angle from the sun:
    airlight probe --sun-elevation 20 --view 0,70 --polarisation
  The same sky by published models (the first has colours only, the second its own wavelengths):
    airlight probe --sun-elevation 20 --view 0,70 --solver single-scattering --variant printed
    airlight probe --sun-elevation 20 --view 0,70 --solver klassen1987
  Illuminance by sun and sky only, for a scene file:
    airlight probe --scene sky.toml --format json";
