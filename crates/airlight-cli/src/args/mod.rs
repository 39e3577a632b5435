//! Options of all commands. Options that describe a scene fill in an [`airlight::scene::Scene`].

mod accuracy;
mod air;
mod compare;
mod fog;
mod generate;
mod grid;
mod join;
mod night;
mod overlay;
mod overlay_batch;
mod overlay_light;
mod overlay_solver;
mod picture;
mod place;
mod plot;
mod probe;
mod scene;
mod shaders;
mod sky;
mod solver;
mod view;

pub use accuracy::{AccuracyArgs, ReportArg};
pub use air::{AirArgs, AtmospheresArgs};
pub use compare::{CompareArgs, StatisticsArg};
pub use generate::{CompletionsArgs, ManArgs};
pub use grid::GridArgs;
pub use join::JoinArgs;
pub use night::NightArgs;
pub use overlay::OverlayArgs;
pub use overlay_light::OverlayLightArgs;
pub use overlay_solver::OverlaySolverArgs;
pub use picture::{CameraArgs, DisplayArgs, EncodingArgs, ToneArgs};
pub use place::PlaceArgs;
pub use plot::{
    EfficiencyPlotArgs, FogProfilePlotArgs, Index, PhasePlotArgs, PlotArgs, PlotWhat,
    SpectrumPlotArgs, SplitSumPlotArgs, TransmittancePlotArgs,
};
pub use probe::{FormatArg, ProbeArgs};
pub use scene::SceneArgs;
pub use shaders::ShadersArgs;
pub use sky::{ObjectArgs, SkyArgs};
pub use solver::SolverArgs;
pub use view::ViewArgs;

use clap::{Parser, Subcommand};

/// Compute the colour of the sky: spectral, with multiple scattering, in physical units.
#[derive(Debug, Parser)]
#[command(
    name = "airlight",
    version,
    about,
    subcommand_required = true,
    arg_required_else_help = true
)]
#[command(max_term_width = 110, after_help = NOTES)]
pub struct Cli {
    /// Command to run.
    #[command(subcommand)]
    pub command: Command,
    /// Number of threads [default: one for each processor]
    #[arg(long, global = true, value_name = "N", value_parser = crate::parse::threads)]
    pub threads: Option<u32>,
}

const NOTES: &str = "\
Angles are in degrees: azimuth clockwise from north, elevation up from the horizon.
Exit codes: 0 success, 1 failure, 2 invalid request, 130 interrupted by Ctrl-C.

Examples:
  airlight sky --at 48.8584,2.2945 --when 2026-06-21T21:15:00+02:00 -o sky.exr
  airlight probe --sun-elevation 30 --view 180,45
  airlight topics";

/// Commands of the program.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Draw the sky: whole sphere, cube faces, fisheye or camera; as EXR, HDR, PNG or JPEG.
    Sky(Box<SkyArgs>),
    /// Add fog to existing pictures with depth: one, or whole folders.
    Fog(Box<OverlayArgs>),
    /// Print the spectral radiance of the sky along given directions, and the light of sun and sky.
    Probe(Box<ProbeArgs>),
    /// Draw one sky with two solvers, with maps and statistics of the difference.
    Compare(Box<CompareArgs>),
    /// Draw a contact sheet of skies described by a TOML file.
    Grid(GridArgs),
    /// Join the bands of a picture that several machines drew with --shard.
    Join(JoinArgs),
    /// Report accuracy against measurements and other codes.
    Accuracy(AccuracyArgs),
    /// Open a window in which to look around under any sun, in any air.
    View(Box<ViewArgs>),
    /// Plot curves and maps as SVG or PNG: phase functions, efficiencies, spectra, transmittance, fog.
    Plot(PlotArgs),
    /// Write functions for shaders in WGSL, GLSL, HLSL, Metal or as SPIR-V: fog, phase functions, columns.
    Shaders(ShadersArgs),
    /// List the names of atmospheres and types of haze, or describe one.
    Atmospheres(AtmospheresArgs),
    /// Print worked recipes: panoramas for other programs, photographs, air, fog over pictures, numbers.
    #[command(after_help = crate::topics::TOPICS)]
    Topics,
    /// Print the JSON Schema of scene files, for completion and validation in editors.
    Schema,
    /// Print completions of commands and options for a shell.
    Completions(CompletionsArgs),
    /// Write manual pages of all commands to a folder.
    Man(ManArgs),
}
