//! Options of `airlight fog` for random paths.

use crate::error::CliError;
use airlight::monte_carlo::{MonteCarloSettings, SunShape};
use clap::{Args, ValueEnum};

/// Paths for each pixel where nothing is said.
const PATHS: u64 = 256;

/// How the light that fog scatters is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum FogSolverArg {
    /// Closed forms, and the fog's own solution of light scattered many times: fast, without noise.
    #[default]
    Fast,
    /// Random paths through fog and air (with --sky-light): no approximation in what they scatter, slow, with noise whose
    /// size is told. A picture of 160 x 120 takes a minute on two cores, one of a megapixel an hour.
    MonteCarlo,
}

/// Random paths.
#[derive(Clone, Copy, Debug, Default, Args)]
#[command(next_help_heading = "Solver")]
pub struct OverlayPathsArgs {
    /// How the light that fog scatters is found
    #[arg(long, value_enum, default_value_t = FogSolverArg::Fast)]
    pub solver: FogSolverArg,
    /// Random paths for each pixel [default: 256]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(128..=1_000_000_000))]
    pub paths: Option<u64>,
    /// With --solver monte-carlo: write the standard error of each pixel's path radiance as well, into NAME.noise.exr
    #[arg(long)]
    pub noise_map: bool,
}

impl OverlayPathsArgs {
    /// Settings of the Monte Carlo with `seed`, where that is asked for.
    ///
    /// # Errors
    /// [`CliError::Usage`] for its options without it.
    pub fn settings(&self, seed: Option<u64>) -> Result<Option<MonteCarloSettings>, CliError> {
        let given = [
            (self.paths.is_some(), "--paths"),
            (self.noise_map, "--noise-map"),
        ];
        match (self.solver, given.iter().find(|(given, _)| *given)) {
            (FogSolverArg::MonteCarlo, _) => Ok(Some(MonteCarloSettings {
                paths: self.paths.unwrap_or(PATHS),
                seed: seed.unwrap_or(1),
                sun: SunShape::Disc,
            })),
            (FogSolverArg::Fast, None) => Ok(None),
            (FogSolverArg::Fast, Some((_, option))) => Err(CliError::usage(format!(
                "{option} is for random paths: give --solver monte-carlo as well"
            ))),
        }
    }
}
