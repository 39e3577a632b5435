//! Every option of every command.

mod accuracy;
mod air;
mod compare;
mod fog;
mod grid;
mod klassen;
mod models;
mod objects;
mod overlay;
mod overlay_batch;
mod overlay_light;
mod overlay_solver;
mod picture;
mod place;
mod plot;
mod probe;
mod sky_fog;

pub use accuracy::{AccuracyArgs, ReportArg};
pub use air::{AirArgs, EffortArg, ScatteringArg, SolverArg};
pub use compare::{CompareArgs, StatisticsArg};
pub use fog::{DropletsArg, FogScatteringArg, in_words as droplets_in_words};
pub use grid::GridArgs;
pub use klassen::KlassenArgs;
pub use models::{ModelArgs, SunlightArg, VariantArg};
pub use objects::ObjectArgs;
pub use overlay::OverlayArgs;
pub use overlay_light::OverlayLightArgs;
pub use overlay_solver::OverlaySolverArgs;
pub use picture::{
    ColorSpaceArg, CompressionArg, PictureArgs, PrecisionArg, ProjectionArg, SunDiscArg, ToneArg,
};
pub use place::PlaceArgs;
pub use plot::{
    EfficiencyPlotArgs, FogProfilePlotArgs, Index, PhasePlotArgs, PlotArgs, PlotWhat,
    SpectrumPlotArgs, SplitSumPlotArgs, TransmittancePlotArgs,
};
pub use probe::{FormatArg, ProbeArgs};
pub use sky_fog::SkyFogArgs;

use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// The colour of the sky, computed: spectral, multiply scattered, in physical units.
#[derive(Debug, Parser)]
#[command(
    name = "airlight",
    version,
    about,
    subcommand_required = true,
    arg_required_else_help = true
)]
#[command(max_term_width = 110, after_help = EXIT_CODES)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const EXIT_CODES: &str = "\
Angles are in degrees: azimuth clockwise from north, elevation up from the horizon.
Exit codes: 0 done, 1 failed, 2 asked for something that makes no sense, 130 stopped by Ctrl-C.

Examples:
  airlight sky --at 48.8584,2.2945 --when 2026-06-21T21:15:00+02:00 -o sky.exr
  airlight probe --sun-elevation 30 --view 180,45
  airlight atmospheres";

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Draw the sky: whole sphere, cube faces, fisheye or camera; as EXR, HDR, PNG or JPEG.
    Sky(Box<SkyArgs>),
    /// Put fog over existing pictures with depth: one, or whole folders.
    Fog(Box<OverlayArgs>),
    /// Tell the spectral radiance of the sky along given directions, and the light of sun and sky, in numbers.
    Probe(Box<ProbeArgs>),
    /// Draw one sky by two solvers side by side, with maps and statistics of the difference.
    Compare(Box<CompareArgs>),
    /// Draw a contact sheet of skies that a TOML file describes.
    Grid(GridArgs),
    /// Tell how right the solvers are, beside measurement and other people's codes.
    Accuracy(AccuracyArgs),
    /// Plot curves and maps, as SVG or PNG: phase functions, efficiencies, spectra, transmittance, fog.
    Plot(PlotArgs),
    /// List the atmospheres and types of haze that can be asked for by name, or tell what one is made of.
    Atmospheres(AtmospheresArgs),
}

/// Options of `airlight atmospheres`.
#[derive(Debug, Args)]
pub struct AtmospheresArgs {
    /// An atmosphere or a type of haze to describe: its name, or a TOML file
    #[arg(value_name = "NAME|FILE.toml")]
    pub atmosphere: Option<String>,
}

/// Options of `airlight sky`.
#[derive(Clone, Debug, Args)]
#[command(allow_negative_numbers = true, after_help = SKY_EXAMPLES)]
pub struct SkyArgs {
    /// File to write; its ending says the format: .exr, .hdr, .png, .jpg, or .spectral.exr
    #[arg(short, long, value_name = "FILE", help_heading = "Files")]
    pub output: Option<PathBuf>,
    /// Show the picture in the terminal as well (the default where there is no --output)
    #[arg(long, help_heading = "Files")]
    pub preview: bool,
    /// Say nothing on standard output
    #[arg(short, long, help_heading = "Files")]
    pub quiet: bool,
    /// With --solver monte-carlo: write the standard error of each pixel's colour as well, into NAME.noise.exr
    #[arg(long, requires = "output", help_heading = "Files")]
    pub noise_map: bool,
    /// With --solver monte-carlo: follow the polarisation of light, and write its degree and angle into NAME.polarisation.exr
    #[arg(long, requires = "output", help_heading = "Files")]
    pub polarisation: bool,
    #[command(flatten)]
    pub place: PlaceArgs,
    #[command(flatten)]
    pub sequence: SequenceArgs,
    #[command(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    pub air: AirArgs,
    #[command(flatten)]
    pub model: ModelArgs,
    #[command(flatten)]
    pub fog: SkyFogArgs,
    #[command(flatten)]
    pub objects: ObjectArgs,
}

/// Many pictures over a span of time.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Sequences")]
pub struct SequenceArgs {
    /// Draw a sequence from --when until this time, or for a span of time after it: +6h
    #[arg(long, value_name = "TIME|+SPAN", requires = "every")]
    pub until: Option<String>,
    /// Time from frame to frame: 10m, 1h30m, 45s
    #[arg(long, value_name = "SPAN", requires = "until", value_parser = crate::parse::span_s)]
    pub every: Option<i64>,
    /// Draw frames anew whose file is there already; else those are taken as done
    #[arg(long, requires = "until")]
    pub overwrite: bool,
}

const SKY_EXAMPLES: &str = "\
Examples:
  The sky over Paris as a map of the whole sphere, linear light in cd/m^2:
    airlight sky --at 48.8584,2.2945 --when 2026-06-21T21:15:00+02:00 -o sky.exr
  A photograph of a low sun through haze:
    airlight sky --sun-elevation 3 --aod-550 0.3 --projection perspective --size 1920x1080 -o dusk.png
  A dome for rendering, with the sun in a file of its own (dome.sun.exr):
    airlight sky --sun-elevation 40 --sun-disc separate --size 4096x2048 -o dome.exr
  A day, a frame every ten minutes (day.0001.png, ...); started again it goes on where it stopped:
    airlight sky --at 64.1,-21.9 --when 2026-06-21T00:00:00Z --until +24h --every 10m \\
      --projection fisheye -o day.png
  Ground fog at sunrise, seen from a hill 60 m high:
    airlight sky --sun-elevation 2 --fog-visibility-m 150 --fog-top-m 40 --altitude-m 60 --projection perspective -o fog.png
  The same sky by random paths, with the noise of each pixel in a file of its own:
    airlight sky --sun-elevation 3 --solver monte-carlo --paths 1024 --size 512x256 --noise-map -o truth.exr
  With its polarisation: how much, and the angle from the vertical, anticlockwise as the eye sees it:
    airlight sky --sun-elevation 10 --solver monte-carlo --polarisation --projection fisheye --size 256x256 -o blue.exr
  From a height of 400 km, from Mars:
    airlight sky --sun-elevation 20 --altitude-m 400e3 --projection perspective --camera-elevation -15 -o iss.png
    airlight sky --atmosphere mars --sun-elevation 5 --projection perspective -o mars.png";
