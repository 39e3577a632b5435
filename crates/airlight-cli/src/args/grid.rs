//! Options of `airlight grid`.

use clap::Args;
use std::path::PathBuf;

/// Options of `airlight grid`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct GridArgs {
    /// What to draw: a TOML file
    #[arg(value_name = "FILE.toml")]
    pub file: PathBuf,
    /// File to write: .png
    #[arg(short, long, value_name = "FILE.png")]
    pub output: PathBuf,
}

const EXAMPLES: &str = "\
The file has options of `airlight sky` without their dashes, for all pictures under [sky], for each under [[cell]]:

  title = \"Suns through haze\"
  columns = 3

  [sky]
  projection = \"perspective\"
  size = \"320x180\"
  aod-550 = 0.3

  [[cell]]
  label = \"10 degrees\"
  sun-elevation = 10

Examples:
  A figure of Klassen's paper of 1987:
    airlight grid scenes/klassen1987/figure-12.toml -o figure-12.png";
