//! Options of `airlight compare`.

use super::{CameraArgs, DisplayArgs, SceneArgs};
use crate::error::CliError;
use crate::parse;
use airlight::models::registry;
use airlight::scene::{Effort, Input, RadianceModel, Scene, SunDiscPlacement};
use airlight::sky::Scattering;
use clap::Args;
use std::path::PathBuf;

/// Format of the statistics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StatisticsArg {
    /// Plain text.
    Table,
    /// JSON.
    Json,
}

airlight::named! { StatisticsArg, "a format of statistics", [
    ("table", (Table), "plain text"),
    ("json", (Json), "JSON"),
] }

/// Options of `airlight compare`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES)]
pub struct CompareArgs {
    /// Reference: a name for --solver, or NAME:FORM, where the form is a --variant of a published model, or single or fine for
    /// solvers
    #[arg(value_name = "SOLVER", value_parser = SolverChoice::parse)]
    pub first: SolverChoice,
    /// Solver that is compared with the reference
    #[arg(value_name = "SOLVER", value_parser = SolverChoice::parse)]
    pub second: SolverChoice,
    /// File to write: .png with both pictures and maps of their difference
    #[arg(short, long, value_name = "FILE.png", help_heading = "Files")]
    pub output: Option<PathBuf>,
    /// Format of the statistics on standard output
    #[arg(long, value_parser = parse::named::<StatisticsArg>(), default_value_t = StatisticsArg::Table, help_heading = "Files")]
    pub format: StatisticsArg,
    /// Scale the second sky to the same horizontal illuminance, for models without absolute brightness
    #[arg(long, help_heading = "Difference")]
    pub same_light: bool,
    /// Percentage at the ends of the map's colour scale [default: from the differences]
    #[arg(long, value_name = "PERCENT", value_parser = parse::positive, help_heading = "Difference")]
    pub map_percent: Option<f64>,
    #[command(flatten)]
    pub scene: SceneArgs,
    #[command(flatten)]
    pub camera: CameraArgs,
    #[command(flatten)]
    pub display: DisplayArgs,
    /// TOML file of objects in both pictures
    #[arg(long, value_name = "FILE.toml", help_heading = "Objects")]
    pub objects: Option<String>,
}

/// A solver with its form.
#[derive(Clone, Debug)]
pub struct SolverChoice {
    /// Text of the argument.
    pub text: String,
    model: &'static dyn RadianceModel,
    form: Form,
}

#[derive(Clone, Debug, PartialEq)]
enum Form {
    Default,
    Single,
    Fine,
    Variant(String),
}

impl SolverChoice {
    fn parse(text: &str) -> Result<Self, String> {
        let (name, form) = text.split_once(':').unwrap_or((text, ""));
        let model = registry::find(name).map_err(|error| {
            let sentence = error.to_string();
            let expected = sentence.strip_prefix("solver.name: ");
            expected.unwrap_or(&sentence).to_owned()
        })?;
        let capabilities = model.capabilities();
        let mut forms: Vec<&str> = capabilities.variants.to_vec();
        for (input, name) in [(Input::Scattering, "single"), (Input::Effort, "fine")] {
            if capabilities.honours(input) {
                forms.push(name);
            }
        }
        if !form.is_empty() && !forms.contains(&form) {
            let there = match forms.is_empty() {
                true => format!("{name} without a form, as it has no variants"),
                false => forms.join(", "),
            };
            return Err(format!(
                "expected a form of {name}, got \"{form}\"; try {there}"
            ));
        }
        Ok(Self {
            text: text.to_owned(),
            model,
            form: match form {
                "" => Form::Default,
                "single" => Form::Single,
                "fine" => Form::Fine,
                variant => Form::Variant(variant.to_owned()),
            },
        })
    }

    /// The scene with this solver, without inputs that only `other` honours.
    fn choose(&self, mut scene: Scene, other: &Self) -> Scene {
        let (own, others) = (self.model.capabilities(), other.model.capabilities());
        for input in scene.set_inputs() {
            if !own.honours(input) && others.honours(input) {
                scene = scene.without(input);
            }
        }
        let solver = &mut scene.solver;
        solver.name = Some(self.model.name().to_owned());
        match &self.form {
            Form::Default => {}
            Form::Single => solver.scattering = Some(Scattering::Single),
            Form::Fine => solver.effort = Some(Effort::Fine),
            Form::Variant(variant) => solver.variant = Some(variant.clone()),
        }
        scene
    }
}

impl CompareArgs {
    /// The scene with each solver, without the sun's disc.
    ///
    /// # Errors
    /// [`CliError`] if a file cannot be read or is invalid, or --solver is given.
    pub fn read(&self) -> Result<[Scene; 2], CliError> {
        if self.scene.solver.solver.is_some() {
            return Err(CliError::usage(
                "--solver: expected two solvers as arguments, got this option too; try leaving it out",
            ));
        }
        let scene = self.scene.read(|scene| {
            self.camera.fill(&mut scene.camera);
            scene.output = Default::default();
            scene.output.sun_disc = Some(SunDiscPlacement::Out);
            self.display.fill(&mut scene.output);
            super::ObjectArgs {
                objects: self.objects.clone(),
                ..Default::default()
            }
            .fill(&mut scene.objects);
            scene.sequence = None;
        })?;
        Ok([
            self.first.choose(scene.clone(), &self.second),
            self.second.choose(scene, &self.first),
        ])
    }
}

const EXAMPLES: &str = "\
The difference is that of the second from the first, over the sky above the horizon, without the sun's disc. Options that only
one of the two solvers honours apply to that one.

Examples:
  Effect of multiple scattering:
    airlight compare orders orders:single --sun-elevation 10 --size 512x256 -o single.png
  Klassen 1987 as printed and as corrected:
    airlight compare klassen1987 klassen1987:printed --sun-elevation 10 --size 512x256 -o klassen.png
  The fast solver and Monte Carlo, statistics only:
    airlight compare monte-carlo orders --sun-elevation 3 --size 64x32 --paths 2048 --format json";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms_depend_on_the_solver() {
        for text in [
            "orders",
            "orders:single",
            "orders:fine",
            "monte-carlo:single",
            "klassen1987:printed",
        ] {
            assert!(SolverChoice::parse(text).is_ok(), "{text}");
        }
        for (text, part) in [
            ("sunny", "orders"),
            ("orders:printed", "single, fine"),
            ("monte-carlo:fine", "single"),
            ("klassen1987:fine", "printed"),
            ("preetham:printed", "no variants"),
        ] {
            let error = SolverChoice::parse(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
    }

    #[test]
    fn options_apply_to_solvers_that_honour_them() {
        let parse = |text| SolverChoice::parse(text).unwrap();
        let (paths, orders) = (parse("monte-carlo"), parse("orders:single"));
        let mut scene = Scene::default();
        scene.solver.paths = Some(512);
        let [a, b] = [
            paths.choose(scene.clone(), &orders),
            orders.choose(scene.clone(), &paths),
        ];
        assert_eq!((a.solver.paths, b.solver.paths), (Some(512), None));
        assert_eq!(b.solver.scattering, Some(Scattering::Single));
        // An input that both ignore is kept, so that the renderer refuses it.
        assert_eq!(orders.choose(scene, &orders).solver.paths, Some(512));
    }
}
