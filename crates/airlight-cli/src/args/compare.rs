//! Options of `airlight compare`.

use super::{AirArgs, EffortArg, ModelArgs, PictureArgs, PlaceArgs, ScatteringArg, SkyFogArgs};
use super::{KlassenArgs, ObjectArgs, SkyArgs, SolverArg, VariantArg};
use crate::parse;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// How statistics are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StatisticsArg {
    /// A text to read.
    Table,
    /// One JSON object.
    Json,
}

/// Options of `airlight compare`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES)]
pub struct CompareArgs {
    /// The solver to measure against: a name that --solver takes, or NAME:FORM, where the form is one of --variant for
    /// published models, and single or fine for orders
    #[arg(value_name = "SOLVER", value_parser = SolverSpec::parse)]
    pub first: SolverSpec,
    /// The solver that is measured
    #[arg(value_name = "SOLVER", value_parser = SolverSpec::parse)]
    pub second: SolverSpec,
    /// File to write: .png with both pictures and the maps of their difference
    #[arg(short, long, value_name = "FILE.png", help_heading = "Files")]
    pub output: Option<PathBuf>,
    /// How the statistics are written to standard output
    #[arg(long, value_enum, default_value_t = StatisticsArg::Table, help_heading = "Files")]
    pub format: StatisticsArg,
    /// Scale the second sky so that both shed the same light on the horizontal: for models whose brightness means nothing
    #[arg(long, help_heading = "Difference")]
    pub same_light: bool,
    /// Percent at the ends of the map's colours [default: as the differences are]
    #[arg(long, value_name = "PERCENT", value_parser = parse::positive, help_heading = "Difference")]
    pub map_percent: Option<f64>,
    #[command(flatten)]
    pub place: PlaceArgs,
    #[command(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    pub air: AirArgs,
    #[command(flatten)]
    pub model: ModelArgs,
    #[command(flatten)]
    pub fog: SkyFogArgs,
    /// Solids that a TOML file describes, lit and seen by both
    #[arg(long, value_name = "FILE.toml", help_heading = "Things")]
    pub objects: Option<PathBuf>,
}

/// A solver and its form.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverSpec {
    /// As it was written.
    pub name: String,
    solver: SolverArg,
    form: Form,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Default,
    Single,
    Fine,
    Variant(VariantArg),
}

impl SolverSpec {
    fn parse(text: &str) -> Result<Self, String> {
        let (name, form) = text.split_once(':').unwrap_or((text, ""));
        let solver = SolverArg::from_str(name, true).map_err(|_| {
            let names: Vec<String> = SolverArg::value_variants()
                .iter()
                .filter_map(|solver| solver.to_possible_value())
                .map(|value| value.get_name().to_owned())
                .collect();
            format!("knows no solver {name}: there are {}", names.join(", "))
        })?;
        let form = match (solver.is_published_model(), form) {
            (_, "") => Form::Default,
            (true, form) => Form::Variant(
                VariantArg::from_str(form, true)
                    .map_err(|_| format!("{name} has no form {form}: see --variant"))?,
            ),
            (false, "single") => Form::Single,
            (false, "fine") if solver == SolverArg::Orders => Form::Fine,
            (false, form) => {
                return Err(format!(
                    "{name} has no form {form}: there are single{}",
                    if solver == SolverArg::Orders {
                        " and fine"
                    } else {
                        ""
                    }
                ));
            }
        };
        Ok(Self {
            name: text.to_owned(),
            solver,
            form,
        })
    }
}

impl CompareArgs {
    /// The options of `airlight sky` that draw the scene by a solver, without the sun's disc.
    pub fn sky(&self, by: &SolverSpec) -> SkyArgs {
        let mut sky = SkyArgs {
            output: None,
            preview: false,
            quiet: true,
            noise_map: false,
            polarisation: false,
            place: self.place.clone(),
            sequence: super::SequenceArgs {
                until: None,
                every: None,
                overwrite: false,
            },
            picture: PictureArgs {
                sun_disc: super::SunDiscArg::Out,
                ..self.picture.clone()
            },
            air: self.air.clone(),
            model: self.model.clone(),
            fog: self.fog.clone(),
            objects: ObjectArgs {
                objects: self.objects.clone(),
                ..ObjectArgs::default()
            },
        };
        sky.air.solver = by.solver;
        if by.solver != SolverArg::MonteCarlo {
            (sky.air.paths, sky.air.seed) = (None, None);
        }
        if by.solver != SolverArg::Klassen1987 {
            sky.model.klassen = KlassenArgs::default();
        }
        match by.form {
            Form::Default => {}
            Form::Single => sky.air.scattering = ScatteringArg::Single,
            Form::Fine => sky.air.effort = EffortArg::Fine,
            Form::Variant(variant) => sky.model.variant = Some(variant),
        }
        sky
    }

    /// Whether one of the solvers follows random paths.
    pub fn has_paths(&self) -> bool {
        [&self.first, &self.second]
            .iter()
            .any(|spec| spec.solver == SolverArg::MonteCarlo)
    }
}

const EXAMPLES: &str = "\
The difference is that of the second from the first, over the sky above the horizon, the sun's disc left out.

Examples:
  What is lost where light is scattered once only:
    airlight compare orders orders:single --sun-elevation 10 --size 512x256 -o single.png
  The model of 1987 as printed beside its corrected form:
    airlight compare klassen1987 klassen1987:printed --sun-elevation 10 --size 512x256 -o klassen.png
  The fast solver beside random paths, statistics alone:
    airlight compare monte-carlo orders --sun-elevation 3 --size 64x32 --paths 2048 --format json";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solvers_have_forms_of_their_own() {
        for text in [
            "orders",
            "orders:single",
            "orders:fine",
            "monte-carlo:single",
        ] {
            assert!(SolverSpec::parse(text).is_ok(), "{text}");
        }
        assert!(SolverSpec::parse("klassen1987:printed").is_ok());
        for (text, said) in [
            ("sunny", "there are orders, monte-carlo"),
            ("orders:printed", "there are single and fine"),
            ("monte-carlo:fine", "there are single"),
            ("klassen1987:fine", "see --variant"),
        ] {
            let error = SolverSpec::parse(text).unwrap_err();
            assert!(error.contains(said), "{text}: {error}");
        }
    }
}
