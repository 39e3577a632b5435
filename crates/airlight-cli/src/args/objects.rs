//! Options of things before the sky.

use clap::Args;
use std::path::PathBuf;

/// Things before the sky.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Things")]
pub struct ObjectArgs {
    /// Solids that a TOML file describes, lit by sun, sky and fog, and seen through them; they stand about the point under the eye
    #[arg(long, value_name = "FILE.toml")]
    pub objects: Option<PathBuf>,
    /// Write their depth as well, into NAME.depth.exr: metres along the camera's axis (perspective) or along the ray; infinite
    /// for the sky
    #[arg(long, requires = "objects", requires = "output")]
    pub depth_map: bool,
    /// Let things cast no shadows on each other, as in the pictures of 1987
    #[arg(long, requires = "objects")]
    pub no_shadows: bool,
}
