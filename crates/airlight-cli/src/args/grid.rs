//! Options of `airlight grid`.

use clap::Args;
use std::path::PathBuf;

/// Options of `airlight grid`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct GridArgs {
    /// TOML file that describes the contact sheet
    #[arg(value_name = "FILE.toml")]
    pub file: PathBuf,
    /// File to write: .png
    #[arg(short, long, value_name = "FILE.png")]
    pub output: PathBuf,
}

const EXAMPLES: &str = "\
The file has a common scene, as for `airlight sky --scene`, and overrides for each picture:

  title = \"Suns through haze\"
  columns = 3

  [scene]
  air.aod_550 = 0.3
  camera = { projection = \"perspective\", size = [320, 180] }

  [[cell]]
  label = \"10 degrees\"
  sun.elevation_deg = 10

Examples:
  A figure of Klassen 1987:
    airlight grid scenes/klassen1987/figure-12.toml -o figure-12.png";
