//! Options of `airlight fog` that choose the solver.

use airlight::scene::Scene;
use clap::{Args, ValueEnum};

/// How the light that fog scatters is solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FogSolverArg {
    /// Closed forms and the fog's solution for multiple scattering, in a sky solved by orders of scattering: fast, no noise.
    Orders,
    /// Monte Carlo paths through fog and air (with --sky-light): no approximation, slow, with noise of known size. A picture
    /// of 160 x 120 takes a minute on two cores, one of a megapixel an hour.
    MonteCarlo,
}

/// Solver.
#[derive(Clone, Copy, Debug, Default, Args)]
#[command(next_help_heading = "Solver")]
pub struct OverlaySolverArgs {
    /// How the light that fog scatters is solved for [default: orders]
    #[arg(long, value_enum, value_name = "SOLVER")]
    pub solver: Option<FogSolverArg>,
    /// Monte Carlo paths for each pixel [default: 256]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(128..=1_000_000_000))]
    pub paths: Option<u64>,
    /// With --solver monte-carlo: write the standard error of each pixel's path radiance into NAME.noise.exr
    #[arg(long)]
    pub noise_map: bool,
}

impl OverlaySolverArgs {
    /// Sets what was given in a scene.
    pub fn fill(&self, scene: &mut Scene) {
        if let Some(solver) = self.solver {
            let name = match solver {
                FogSolverArg::Orders => "orders",
                FogSolverArg::MonteCarlo => "monte-carlo",
            };
            scene.solver.name = Some(name.to_owned());
        }
        scene.solver.paths = self.paths.or(scene.solver.paths);
        if self.noise_map {
            scene.output.noise_map = Some(true);
        }
    }
}
