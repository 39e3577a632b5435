//! Options of `airlight fog` for the solver.

use airlight::scene::Scene;
use clap::{Args, ValueEnum};

/// Solver of the light scattered by fog.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FogSolverArg {
    /// Closed forms and discrete ordinates for the fog, in a sky solved by orders of scattering: fast, without noise.
    Orders,
    /// Monte Carlo path tracing in fog and air (with --sky-light): no approximation, slow, with noise of known size. A picture
    /// of 160 x 120 pixels takes a minute on two cores, one of a megapixel an hour.
    MonteCarlo,
}

/// Options for the solver.
#[derive(Clone, Copy, Debug, Default, Args)]
#[command(next_help_heading = "Solver")]
pub struct OverlaySolverArgs {
    /// Solver of the light scattered by fog [default: orders]
    #[arg(long, value_enum, value_name = "SOLVER")]
    pub solver: Option<FogSolverArg>,
    /// Monte Carlo paths for each pixel [default: 256]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(128..=1_000_000_000))]
    pub paths: Option<u64>,
    /// With --solver monte-carlo: write the standard error of each pixel's path radiance to NAME.noise.exr
    #[arg(long)]
    pub noise_map: bool,
}

impl OverlaySolverArgs {
    /// Overrides values of a scene.
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
