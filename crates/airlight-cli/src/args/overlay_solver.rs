//! Options of `airlight fog` for the solver.

use crate::parse;
use airlight::scene::Scene;
use airlight_render::overlay::OverlaySolver;
use clap::Args;

/// Options for the solver.
#[derive(Clone, Copy, Debug, Default, Args)]
#[command(next_help_heading = "Solver")]
pub struct OverlaySolverArgs {
    /// Solver of the light scattered by fog [default: orders]
    #[arg(long, value_name = "SOLVER", value_parser = parse::named::<OverlaySolver>())]
    pub solver: Option<OverlaySolver>,
    /// Monte Carlo paths for each pixel [default: 256]
    #[arg(long, value_name = "N", value_parser = parse::paths)]
    pub paths: Option<u64>,
    /// With --solver monte-carlo: write the standard error of each pixel's path radiance to NAME.noise.exr
    #[arg(long)]
    pub noise_map: bool,
}

impl OverlaySolverArgs {
    /// Overrides values of a scene.
    pub fn fill(&self, scene: &mut Scene) {
        if let Some(solver) = self.solver {
            scene.solver.name = Some(solver.to_string());
        }
        scene.solver.paths = self.paths.or(scene.solver.paths);
        if self.noise_map {
            scene.output.noise_map = Some(true);
        }
    }
}
