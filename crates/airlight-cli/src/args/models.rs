//! Options of published models of the sky.

use super::{KlassenArgs, SolverArg};
use crate::error::CliError;
use crate::parse::{self, name};
use clap::{Args, ValueEnum};

/// Which form of a published model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum VariantArg {
    /// As it was published, with its mistakes.
    Printed,
    /// With its mistakes mended.
    Corrected,
    /// single-scattering: as published, in f64 where the shader has f32.
    #[value(name = "printed-f64")]
    PrintedF64,
    /// single-scattering: the ways to the sun from a table.
    Table,
    /// single-scattering: with light scattered more than once.
    Multiple,
}

impl VariantArg {
    /// The forms that a solver has.
    fn of(solver: SolverArg) -> &'static [Self] {
        match solver {
            SolverArg::Klassen1987 => &[Self::Printed, Self::Corrected],
            SolverArg::SingleScattering => &[
                Self::Printed,
                Self::PrintedF64,
                Self::Corrected,
                Self::Table,
                Self::Multiple,
            ],
            _ => &[],
        }
    }
}

/// The colour of the sun of the sky article.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SunlightArg {
    /// White on the ground when it stands in the zenith, as printed.
    White,
    /// As bright and as coloured as measured outside the air.
    Measured,
}

/// Options of published models of the sky.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Published models")]
pub struct ModelArgs {
    /// Which form of a published model [default: corrected]
    #[arg(long, value_enum)]
    pub variant: Option<VariantArg>,
    /// single-scattering: the colour of the sun [default: white]
    #[arg(long, value_enum)]
    pub sunlight: Option<SunlightArg>,
    /// single-scattering: illuminance by a white sun in the zenith, lx; 6.2832 for colours about 1 [default: 120000]
    #[arg(long, value_name = "LX", value_parser = parse::positive)]
    pub zenith_lux: Option<f64>,
    #[command(flatten)]
    pub klassen: KlassenArgs,
}

impl ModelArgs {
    /// The form of a solver that has several.
    pub fn variant_of(&self, solver: SolverArg) -> Option<VariantArg> {
        let known = VariantArg::of(solver);
        (!known.is_empty()).then(|| self.variant.unwrap_or(VariantArg::Corrected))
    }

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
        if let Some(variant) = self.variant {
            let known = VariantArg::of(solver);
            if !solver.is_published_model() {
                return Err(CliError::usage(
                    "--variant is for published models: give --solver with the name of one",
                ));
            }
            if !known.contains(&variant) {
                return Err(CliError::usage(format!(
                    "--variant: --solver {} has {}",
                    name(&solver),
                    match known {
                        [] => "one form only: leave --variant out".to_owned(),
                        known => known.iter().map(name).collect::<Vec<_>>().join(", "),
                    }
                )));
            }
        }
        if solver != SolverArg::SingleScattering
            && (self.sunlight.is_some() || self.zenith_lux.is_some())
        {
            return Err(CliError::usage(
                "--sunlight and --zenith-lux are for --solver single-scattering",
            ));
        }
        if self.sunlight == Some(SunlightArg::Measured) && self.zenith_lux.is_some() {
            return Err(CliError::usage(
                "--zenith-lux is for a white sun: leave it out, or give --sunlight white",
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_for_solvers_that_know_them() {
        let args = |variant, sunlight, zenith_lux| ModelArgs {
            variant,
            sunlight,
            zenith_lux,
            klassen: KlassenArgs::default(),
        };
        let refused = |args: ModelArgs, solver| {
            let error = args.check(solver).unwrap_err();
            error.sentence().unwrap_or_default().to_owned()
        };
        let table = args(Some(VariantArg::Table), None, None);
        assert_eq!(table.check(SolverArg::SingleScattering), Ok(()));
        assert!(refused(table.clone(), SolverArg::Klassen1987).contains("printed, corrected"));
        assert!(refused(table.clone(), SolverArg::Preetham).contains("one form only"));
        assert!(refused(table, SolverArg::Orders).contains("--solver"));
        let white = args(None, Some(SunlightArg::White), Some(3.0));
        assert_eq!(white.check(SolverArg::SingleScattering), Ok(()));
        assert!(refused(white, SolverArg::Hillaire2020).contains("single-scattering"));
        let both = args(None, Some(SunlightArg::Measured), Some(1e5));
        assert!(refused(both, SolverArg::SingleScattering).contains("white sun"));
    }
}
