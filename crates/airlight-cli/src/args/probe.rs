//! Options of `airlight probe`.

use super::SceneArgs;
use crate::error::CliError;
use crate::parse::{self, AzEl, put};
use airlight::scene::Scene;
use airlight::spectrum::RgbSpace;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FormatArg {
    /// One JSON object, format airlight-probe/1.
    Json,
    /// A line for each direction and wavelength, with a header.
    Csv,
    /// A text to read.
    Table,
}

/// Options of `airlight probe`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES)]
pub struct ProbeArgs {
    /// A direction to look in: azimuth,elevation in degrees; may be given many times
    #[arg(long, value_name = "AZ,EL", value_parser = parse::az_el, allow_hyphen_values = true)]
    #[arg(help_heading = "Directions")]
    pub view: Vec<AzEl>,
    /// CSV file of directions: a header with azimuth_deg, elevation_deg and, if wanted, distance_m; - reads standard
    /// input
    #[arg(long, value_name = "FILE.csv", help_heading = "Directions")]
    pub views: Option<PathBuf>,
    /// Look no farther than this, m: the air between the eye and an object at that distance [default: to the ground or
    /// to space]
    #[arg(long, value_name = "M", value_parser = parse::length_m, help_heading = "Directions")]
    pub distance_m: Option<f64>,
    /// With --solver monte-carlo: the polarisation of the light as well
    #[arg(long, help_heading = "Directions")]
    pub polarisation: bool,
    /// How the numbers are written
    #[arg(long, value_enum, default_value_t = FormatArg::Table, help_heading = "Output")]
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
    /// [`CliError`] where a file cannot be read or is wrong.
    pub fn read(&self) -> Result<Scene, CliError> {
        self.scene.read(|scene| {
            put(&mut scene.output.color_space, &self.color_space);
            let polarisation = self.polarisation.then_some(true);
            put(&mut scene.output.polarisation, &polarisation);
        })
    }
}

const EXAMPLES: &str = "\
Radiances leave out the sun's own disc; its light is given apart from the sky's.

Examples:
  The zenith and a point near the horizon, to read:
    airlight probe --sun-elevation 30 --view 0,90 --view 90,2
  Every 5 nm over Paris, for a program:
    airlight probe --at 48.8584,2.2945 --when 2026-06-21T19:15:00Z --view 180,45 --wavelengths fine --format json
  The haze before a mountain 20 km away:
    airlight probe --sun-elevation 20 --view 90,1 --distance-m 20e3 --haze-visibility-m 40e3
  The same by Monte Carlo, each value with its standard error:
    airlight probe --sun-elevation 20 --view 90,1 --distance-m 20e3 --haze-visibility-m 40e3 --solver monte-carlo
  How much of the sky's light is polarised a right angle from the sun, and in which plane:
    airlight probe --sun-elevation 20 --view 0,70 --solver monte-carlo --polarisation
  That sky by a shader and by a model of 1987 (the first in colours only, the second at wavelengths of its own):
    airlight probe --sun-elevation 20 --view 0,70 --solver single-scattering --variant printed
    airlight probe --sun-elevation 20 --view 0,70 --solver klassen1987
  Illuminance of sun and sky alone, of a scene file:
    airlight probe --scene sky.toml --format json";
