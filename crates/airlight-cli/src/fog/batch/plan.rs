//! Which pictures a batch is to make, of what, and with which options.

use super::draw;
use super::inputs::{self, Input, Place, must_have};
use super::pattern::Pattern;
use crate::args::{ModelArg, OverlayArgs, Variation};
use crate::error::CliError;
use crate::fog::{picture, written_over};
use airlight_image::output::PictureFormat;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// What is to be made.
pub struct Plan {
    pub inputs: Vec<Input>,
    /// Pictures of each input, which count from 1.
    pub variants: u32,
    output: Output,
    /// Where the manifest is, if not told: beside the outputs.
    pub folder: PathBuf,
}

enum Output {
    File(PathBuf),
    Folder(PathBuf),
    Pattern(Pattern),
}

/// What stands for the number of the variant in an output.
const VARIANT: &str = "{variant}";

impl Plan {
    /// Finds the inputs and checks that each output has a name of its own.
    ///
    /// # Errors
    /// [`CliError`]: what does not fit together.
    pub fn new(args: &OverlayArgs) -> Result<Self, CliError> {
        check_variation(args)?;
        let is_one = matches!(Place::to_read(&args.colour)?, Place::File(_));
        let inputs = inputs::find(args)?;
        let output = Output::new(args, is_one, inputs[0].parts.len())?;
        let plan = Self {
            folder: output.folder(),
            variants: args.batch.variants.map_or(1, u32::from),
            inputs,
            output,
        };
        plan.check(args)?;
        Ok(plan)
    }

    /// Every picture: its input and variant.
    pub fn pictures(&self) -> impl Iterator<Item = (&Input, u32)> {
        let variants = 1..=self.variants;
        self.inputs
            .iter()
            .flat_map(move |input| variants.clone().map(move |variant| (input, variant)))
    }

    /// Where a picture goes.
    pub fn output(&self, args: &OverlayArgs, input: &Input, variant: u32) -> PathBuf {
        let path = match &self.output {
            Output::File(path) => path.clone(),
            Output::Pattern(pattern) => pattern.path(&input.parts),
            Output::Folder(folder) => {
                let ending = input.colour.extension().unwrap_or_default();
                let ending = ending.to_string_lossy();
                folder.join(format!("{}.{ending}", input.name()))
            }
        };
        let number = format!("{variant:04}");
        let text = path.to_string_lossy();
        if text.contains(VARIANT) {
            return text.replace(VARIANT, &number).into();
        }
        if args.batch.variants.is_none() {
            return path;
        }
        let part = |part: Option<&std::ffi::OsStr>| {
            part.unwrap_or_default().to_string_lossy().into_owned()
        };
        let (stem, ending) = (part(path.file_stem()), part(path.extension()));
        path.with_file_name(format!("{stem}_v{number}.{ending}"))
    }

    /// The options of a picture, what varies drawn for it.
    pub fn options(&self, args: &OverlayArgs, input: &Input, variant: u32) -> OverlayArgs {
        let mut options = args.clone();
        let name = input.name();
        for variation in &args.batch.vary {
            let seed = args.batch.seed.unwrap_or_default();
            variation.set(
                &mut options,
                draw::part(seed, &name, variant, variation.name),
            );
        }
        options
    }

    fn check(&self, args: &OverlayArgs) -> Result<(), CliError> {
        let colours = Place::to_read(&args.colour)?;
        let there = |path: &PathBuf| path.canonicalize().ok();
        let files = self
            .inputs
            .iter()
            .flat_map(|input| [&input.colour, &input.depth]);
        let read: HashSet<PathBuf> = files.filter_map(there).collect();
        let mut taken: HashMap<PathBuf, &Path> = HashMap::new();
        for (input, variant) in self.pictures() {
            let output = self.output(args, input, variant);
            picture::format_of(args, &output)?;
            if there(&output).is_some_and(|path| read.contains(&path)) {
                return Err(written_over(&output));
            }
            if colours.has(&output) {
                return Err(CliError::usage(format!(
                    "`{}` would be taken for a picture without fog the next time: give an --output that `{}` does not name",
                    output.display(),
                    args.colour.display()
                )));
            }
            if let Some(other) = taken.insert(output, &input.colour) {
                let output = self.output(args, input, variant);
                return Err(CliError::usage(format!(
                    "`{}` and `{}` would both become `{}`: give an --output that tells them apart",
                    other.display(),
                    input.colour.display(),
                    output.display()
                )));
            }
        }
        Ok(())
    }
}

/// Refuses variation that contradicts itself or has no effect.
fn check_variation(args: &OverlayArgs) -> Result<(), CliError> {
    let mut names = HashSet::new();
    for variation in &args.batch.vary {
        if !names.insert(variation.name) {
            return Err(CliError::usage(format!(
                "--vary {} is given twice: once is enough",
                variation.name
            )));
        }
    }
    match (names.contains("visibility"), args.given_visibility_m) {
        (true, Some(_)) => {
            return Err(CliError::usage(
                "--vary visibility takes the place of --visibility-m: leave one out",
            ));
        }
        (false, None) => {
            return Err(CliError::usage(
                "how far can one see? Give --visibility-m, or --vary visibility=50..500",
            ));
        }
        _ => {}
    }
    let own = [args.model];
    let models = args.batch.vary.iter().find_map(Variation::models);
    let models = models.unwrap_or(&own);
    let of_models = [
        (
            "scale-height",
            &[ModelArg::Height, ModelArg::Clamped, ModelArg::Unclamped][..],
        ),
        ("base-height", &[ModelArg::Clamped, ModelArg::Unclamped]),
        ("top", &[ModelArg::Slab]),
    ];
    for (name, its) in of_models {
        if names.contains(name) && !models.iter().any(|model| its.contains(model)) {
            let its: Vec<String> = its
                .iter()
                .map(|model| format!("{model:?}").to_lowercase())
                .collect();
            return Err(CliError::usage(format!(
                "--vary {name} would change nothing: it belongs to --model {}",
                its.join(" or ")
            )));
        }
    }
    let sun = args.sun_elevation.is_some() || names.contains("sun-elevation");
    let of_sun = ["sun-azimuth", "sun-strength"];
    match of_sun.into_iter().find(|name| names.contains(name)) {
        Some(name) if !sun => Err(CliError::usage(format!(
            "--vary {name} needs a sun: give --sun-elevation, or vary it"
        ))),
        _ => Ok(()),
    }
}

impl Output {
    fn new(args: &OverlayArgs, is_one: bool, parts: usize) -> Result<Self, CliError> {
        let path = &args.output;
        if path.to_str().is_none() {
            return Err(CliError::usage(format!(
                "--output `{}` is not Unicode, as names in a manifest must be",
                path.display()
            )));
        }
        if let Some(pattern) = Pattern::new(path)? {
            must_have(&pattern, parts, "--output")?;
            PictureFormat::from_path(Path::new(pattern.text()))?;
            return Ok(Self::Pattern(pattern));
        }
        let ends_in_slash = path.to_string_lossy().ends_with(std::path::is_separator);
        if ends_in_slash || path.is_dir() || path.extension().is_none() {
            return Ok(Self::Folder(path.clone()));
        }
        PictureFormat::from_path(path)?;
        match is_one {
            true => Ok(Self::File(path.clone())),
            false => Err(CliError::usage(format!(
                "many pictures cannot all be `{}`: give --output a folder, or a pattern such as 'out/*.png'",
                path.display()
            ))),
        }
    }

    fn folder(&self) -> PathBuf {
        match self {
            Self::File(path) => path.parent().map(Path::to_owned).unwrap_or_default(),
            Self::Folder(folder) => folder.clone(),
            Self::Pattern(pattern) => pattern.base().to_owned(),
        }
    }
}
