//! [`BatchPlan`]: inputs, outputs and settings of the pictures of a batch.

use super::inputs::{InputPath, find_inputs};
use super::{BatchError, FoundInputs, Input, Pattern, Variation};
use crate::overlay::OverlayScene;
use airlight::Named;
use airlight_image::output::PictureFormat;
use std::collections::{HashMap, HashSet};
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

/// Settings of a batch, besides the description of its pictures.
#[derive(Clone, Debug, Default)]
pub struct BatchSettings {
    /// Settings drawn for each picture.
    pub vary: Vec<Variation>,
    /// Number of variants of each input, numbered from 1; `None`: one picture without a number in its name.
    pub variants: Option<NonZeroU32>,
    /// Seed of the random draws, which also depend on the picture's name and the number of the variant.
    pub seed: u64,
    /// Path of the manifest; `None`: `manifest.jsonl` in the folder of the outputs.
    pub manifest: Option<PathBuf>,
    /// Whether existing pictures are replaced.
    pub overwrite: bool,
    /// Whether pictures without depth are left out.
    pub skip_unpaired: bool,
    /// Whether to stop at the first picture that fails.
    pub fail_fast: bool,
    /// Number of threads, which also bounds the number of pictures in memory; `None`: one for each processor.
    pub threads: Option<NonZeroU32>,
}

/// The pictures of a batch, each with its input, output and settings.
#[derive(Clone, Debug)]
pub struct BatchPlan {
    /// The description of all pictures; its colour, depth and output are paths, folders or patterns.
    scene: OverlayScene,
    settings: BatchSettings,
    found: FoundInputs,
    output: OutputPath,
}

/// Meaning of the output path.
#[derive(Clone, Debug)]
enum OutputPath {
    File(PathBuf),
    Folder(PathBuf),
    Pattern(Pattern),
}

/// Placeholder for the number of the variant in an output name.
const VARIANT: &str = "{variant}";

/// Whether paths of a description stand for several pictures.
///
/// # Errors
/// [`BatchError`] for an invalid pattern.
pub fn is_batch(colour: &Path, output: &Path) -> Result<bool, BatchError> {
    Ok(InputPath::new(colour)?.is_many() || Pattern::new(output)?.is_some())
}

impl BatchPlan {
    /// Finds the inputs of a description, and checks its settings and that outputs have different names.
    ///
    /// # Errors
    /// [`BatchError`] for invalid settings, missing inputs and conflicting outputs.
    pub fn new(scene: OverlayScene, settings: BatchSettings) -> Result<Self, BatchError> {
        check_variation(&scene, &settings.vary)?;
        let is_one = !InputPath::new(&scene.overlay.colour)?.is_many();
        let found = find_inputs(
            &scene.overlay.colour,
            scene.overlay.depth.as_deref(),
            settings.skip_unpaired,
        )?;
        let output = OutputPath::new(scene.output()?, is_one, found.inputs[0].captures.len())?;
        let plan = Self {
            scene,
            settings,
            found,
            output,
        };
        plan.check()?;
        Ok(plan)
    }

    /// The description of all pictures.
    pub fn scene(&self) -> &OverlayScene {
        &self.scene
    }

    /// Settings of the batch.
    pub fn settings(&self) -> &BatchSettings {
        &self.settings
    }

    /// The inputs, and files that were left out.
    pub fn found(&self) -> &FoundInputs {
        &self.found
    }

    /// Every picture: its input and the number of its variant.
    pub fn pictures(&self) -> impl Iterator<Item = (&Input, u32)> {
        let variants = 1..=self.settings.variants.map_or(1, u32::from);
        self.found
            .inputs
            .iter()
            .flat_map(move |input| variants.clone().map(move |variant| (input, variant)))
    }

    /// Path of the manifest.
    pub fn manifest(&self) -> PathBuf {
        match &self.settings.manifest {
            Some(path) => path.clone(),
            None => self.output.folder().join("manifest.jsonl"),
        }
    }

    /// The output of a picture.
    pub fn output(&self, input: &Input, variant: u32) -> PathBuf {
        let path = match &self.output {
            OutputPath::File(path) => path.clone(),
            OutputPath::Pattern(pattern) => pattern.path(&input.captures),
            OutputPath::Folder(folder) => {
                let ending = input.colour.extension().unwrap_or_default();
                let ending = match self.scene.overlay.layers {
                    true => "exr".into(),
                    false => ending.to_string_lossy(),
                };
                folder.join(format!("{}.{ending}", input.name()))
            }
        };
        let number = format!("{variant:04}");
        let text = path.to_string_lossy();
        if text.contains(VARIANT) {
            return text.replace(VARIANT, &number).into();
        }
        if self.settings.variants.is_none() {
            return path;
        }
        let part = |part: Option<&std::ffi::OsStr>| {
            part.unwrap_or_default().to_string_lossy().into_owned()
        };
        let (stem, ending) = (part(path.file_stem()), part(path.extension()));
        path.with_file_name(format!("{stem}_v{number}.{ending}"))
    }

    /// The description of a picture: its input files, and its varied settings drawn. [`Self::output`] is its output.
    pub fn scene_of(&self, input: &Input, variant: u32) -> OverlayScene {
        let mut scene = self.scene.clone();
        scene.overlay.colour = input.colour.clone();
        scene.overlay.depth = (input.depth != input.colour).then(|| input.depth.clone());
        // The manifest names the output, relative to its folder.
        scene.scene.output.file = None;
        let name = input.name();
        for variation in &self.settings.vary {
            variation.draw(&mut scene, self.settings.seed, &name, variant);
        }
        scene
    }

    /// Whether a varied setting changes the solved sky.
    pub(super) fn varies_sky(&self) -> bool {
        self.settings.vary.iter().any(Variation::changes_sky)
    }

    fn check(&self) -> Result<(), BatchError> {
        let colour = &self.scene.overlay.colour;
        let colours = InputPath::new(colour)?;
        let existing = |path: &PathBuf| path.canonicalize().ok();
        let files = self
            .found
            .inputs
            .iter()
            .flat_map(|input| [&input.colour, &input.depth]);
        let read: HashSet<PathBuf> = files.filter_map(existing).collect();
        let mut taken: HashMap<PathBuf, &Path> = HashMap::new();
        for (input, variant) in self.pictures() {
            let output = self.output(input, variant);
            self.scene.overlay.output_format(&output)?;
            if existing(&output).is_some_and(|path| read.contains(&path)) {
                return Err(BatchError::OutputIsInput(output));
            }
            if colours.includes(&output) {
                return Err(BatchError::OutputMatchesInput {
                    output,
                    colour: colour.clone(),
                });
            }
            if let Some(first) = taken.insert(output, &input.colour) {
                return Err(BatchError::SameOutput {
                    first: first.to_owned(),
                    second: input.colour.clone(),
                    output: self.output(input, variant),
                });
            }
        }
        Ok(())
    }
}

/// Refuses variations that contradict each other or the description or have no effect, and invalid choices.
fn check_variation(scene: &OverlayScene, vary: &[Variation]) -> Result<(), BatchError> {
    let refuse = |name: &str, expected: &str, got: String, advice: &str| {
        Err(BatchError::Variation {
            name: name.to_owned(),
            expected: expected.to_owned(),
            got,
            advice: advice.to_owned(),
        })
    };
    let mut names = HashSet::new();
    for variation in vary {
        let name = variation.name();
        if !names.insert(name) {
            return refuse(
                name,
                "each setting once",
                "it twice".to_owned(),
                "one of them",
            );
        }
    }
    if let (true, Some(given)) = (names.contains("visibility"), scene.fog().visibility_m) {
        return refuse(
            "visibility",
            "a drawn visibility instead of a given one",
            format!("both, as visibility-m is {given}"),
            "leaving one of them out",
        );
    }
    let own = [scene.fog_profile().name()];
    let profiles = vary
        .iter()
        .find(|variation| variation.name() == "fog-profile");
    let profiles = profiles.and_then(Variation::choices).unwrap_or(&own);
    for (name, its) in [
        ("scale-height", &["height", "clamped", "unclamped"][..]),
        ("base-height", &["clamped", "unclamped"]),
        ("top", &["slab"]),
    ] {
        if names.contains(name) && !profiles.iter().any(|profile| its.contains(profile)) {
            return refuse(
                name,
                "a fog profile that has it",
                profiles.join(", "),
                &format!("fog-profile {}", its.join(" or ")),
            );
        }
    }
    if !names.contains("sun-elevation") && scene.scene.sun.elevation_deg.is_none() {
        for name in ["sun-azimuth", "sun-strength"] {
            if names.contains(name) {
                return refuse(
                    name,
                    "a sun",
                    "none".to_owned(),
                    "giving sun-elevation, or varying it",
                );
            }
        }
    }
    // Check each choice with the first values of the other settings.
    let mut base = scene.clone();
    for variation in vary {
        variation.set(&mut base, 0.0);
    }
    for variation in vary {
        for choice in variation.choices().unwrap_or_default() {
            let mut scene = base.clone();
            variation.choose(&mut scene, choice);
            scene.check()?;
        }
    }
    Ok(base.check()?)
}

impl OutputPath {
    fn new(path: &Path, is_one: bool, captures: usize) -> Result<Self, BatchError> {
        if path.to_str().is_none() {
            return Err(BatchError::NotUnicode(path.to_owned()));
        }
        if let Some(pattern) = Pattern::new(path)? {
            pattern.check_wildcards(captures, "output")?;
            PictureFormat::from_path(Path::new(pattern.text()))?;
            return Ok(Self::Pattern(pattern));
        }
        let ends_in_slash = path.to_string_lossy().ends_with(std::path::is_separator);
        if ends_in_slash || path.is_dir() || path.extension().is_none() {
            return Ok(Self::Folder(path.to_owned()));
        }
        if let (false, Err(_)) = (is_one, PictureFormat::from_path(path)) {
            return Err(BatchError::OutputEnding(path.to_owned()));
        }
        PictureFormat::from_path(path)?;
        match is_one {
            true => Ok(Self::File(path.to_owned())),
            false => Err(BatchError::OneOutput(path.to_owned())),
        }
    }

    /// The folder of the outputs of all variants.
    fn folder(&self) -> PathBuf {
        let folder = match self {
            Self::File(path) => path.parent().map(Path::to_owned).unwrap_or_default(),
            Self::Folder(folder) => folder.clone(),
            Self::Pattern(pattern) => pattern.base().to_owned(),
        };
        let is_common =
            |name: &std::path::Component<'_>| !name.as_os_str().to_string_lossy().contains(VARIANT);
        folder.components().take_while(is_common).collect()
    }
}
