//! Options of `airlight join`.

use clap::Args;
use std::path::PathBuf;

/// Options of `airlight join`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct JoinArgs {
    /// EXR files of the bands, in any order
    #[arg(value_name = "BAND.exr", required = true)]
    pub bands: Vec<PathBuf>,
    /// EXR file of the picture
    #[arg(short, long, value_name = "FILE.exr")]
    pub output: PathBuf,
    /// Print nothing on standard output
    #[arg(short, long)]
    pub quiet: bool,
}

const EXAMPLES: &str = "\
Compressed rows are copied, so that the picture has the pixels of one run of airlight sky, to the bit.

Examples:
  Two bands, drawn by two machines with --shard 1/2 and --shard 2/2:
    airlight join sky-1-of-2.exr sky-2-of-2.exr -o sky.exr";
