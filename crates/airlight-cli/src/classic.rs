//! Published models of the sky, made from the options.

use crate::args::{AirArgs, ClassicArgs, SolverArg, VariantArg};
use crate::error::CliError;
use crate::scene::{Scene, Sun};
use airlight::classic::ClassicSky;
use airlight::classic::klassen1987::{Klassen1987, Klassen1987Error, Klassen1987Settings};
use std::sync::Arc;

/// The model asked for, under a sun.
///
/// # Errors
/// [`CliError::Usage`] for what the model refuses.
pub fn model(
    air: &AirArgs,
    args: &ClassicArgs,
    _scene: &Scene,
    sun: &Sun,
) -> Result<Arc<dyn ClassicSky>, CliError> {
    let direction = sun.direction();
    Ok(match air.solver {
        SolverArg::Klassen1987 => {
            let refuse =
                |error: Klassen1987Error| CliError::usage(format!("--solver klassen1987: {error}"));
            let mut settings = Klassen1987Settings::default();
            if args.variant == Some(VariantArg::Printed) {
                settings = settings.printed();
            }
            Arc::new(Klassen1987::new(&settings, direction).map_err(refuse)?)
        }
        SolverArg::Orders | SolverArg::MonteCarlo => {
            return Err(CliError::failure("this solver is no published model"));
        }
    })
}
