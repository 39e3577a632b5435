//! Options of published models of the sky.

use super::{KlassenArgs, SolverArg};
use crate::error::CliError;
use clap::{Args, ValueEnum};

/// Which form of a published model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum VariantArg {
    /// As it was published, with its mistakes.
    Printed,
    /// With its mistakes mended.
    Corrected,
}

/// Options of published models of the sky.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Published models")]
pub struct ClassicArgs {
    /// Which form of a published model [default: corrected]
    #[arg(long, value_enum)]
    pub variant: Option<VariantArg>,
    #[command(flatten)]
    pub klassen: KlassenArgs,
}

impl ClassicArgs {
    /// Refuses options that the solver asked for does not know.
    ///
    /// # Errors
    /// [`CliError::Usage`]: which.
    pub fn check(&self, solver: SolverArg) -> Result<(), CliError> {
        if self.klassen.given() && solver != SolverArg::Klassen1987 {
            return Err(CliError::usage(
                "--haze-extinction-per-m, --haze-thickness-m, --wet-haze, --air-density, --air-thickness-m and --base-blue are \
                 for one published model: give --solver klassen1987 as well",
            ));
        }
        match (solver.is_classic(), self.variant) {
            (false, Some(_)) => Err(CliError::usage(
                "--variant is for published models: give --solver with the name of one",
            )),
            _ => Ok(()),
        }
    }
}
