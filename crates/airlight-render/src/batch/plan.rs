//! [`BatchPlan`]: inputs, outputs and settings of the pictures of a batch.

use super::inputs::{InputPath, find_inputs};
use super::settings::Affects;
use super::{BatchError, Each, FoundInputs, Input, Pattern, Variation};
use crate::RenderError;
use crate::manifest;
use crate::overlay::OverlayScene;
use crate::shard::Shard;
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
    /// Settings of which every picture gets each value: all combinations of their values.
    pub each: Vec<Each>,
    /// Number of variants of each input, numbered from 1; `None`: one picture without a number in its name.
    pub variants: Option<NonZeroU32>,
    /// The part of the inputs whose pictures are made; `None`: all.
    pub shard: Option<Shard>,
    /// Time between successive inputs, s, for which the wind moves the patches of the fog, as in a film; `None`: they do not move.
    pub patch_interval_s: Option<f64>,
    /// Seed of the random draws, which also depend on the picture's name and the number of the variant.
    pub seed: u64,
    /// Path of the manifest; `None`: `manifest.jsonl` in the folder of the outputs, `manifest-3-of-16.jsonl` for a shard.
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

/// One of the pictures of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Variant {
    /// Number of the draw of the varied settings, from 1.
    pub number: u32,
    /// Index among the combinations of the values of which every picture gets each, from 0; the values of the last setting
    /// change first.
    pub combination: u32,
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

/// Greatest number of pictures of an input.
const MOST_VARIANTS: u64 = 1_000_000;

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
        let each = settings.each.iter().map(|each| each.count() as u64);
        let combinations = each.fold(1u64, u64::saturating_mul);
        let variants = settings.variants.map_or(1, |n| u64::from(n.get()));
        if combinations.saturating_mul(variants) > MOST_VARIANTS {
            return Err(BatchError::TooManyVariants {
                combinations,
                variants,
                most: MOST_VARIANTS,
            });
        }
        let drawn = settings.vary.iter().map(|drawn| ("vary", drawn));
        let listed = settings.each.iter().map(|each| ("each", each.variation()));
        if let Some(interval_s) = settings.patch_interval_s {
            check_patch_interval(&scene, interval_s)?;
        }
        check_variation(&scene, &drawn.chain(listed).collect::<Vec<_>>())?;
        let is_one = !InputPath::new(&scene.overlay.colour)?.is_many();
        let found = find_inputs(
            &scene.overlay.colour,
            scene.overlay.depth.as_deref(),
            settings.skip_unpaired,
        )?;
        let output = OutputPath::new(scene.output()?, is_one, found.inputs[0].captures.len())?;
        let mut plan = Self {
            scene,
            settings,
            found,
            output,
        };
        // All shards check all pictures, so that none begins what another refuses.
        plan.check()?;
        if let Some(shard) = plan.settings.shard {
            let mut index = 0..;
            plan.found
                .inputs
                .retain(|_| index.next().is_some_and(|index| shard.has(index)));
        }
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

    /// The pictures of each input.
    fn variants(&self) -> Vec<Variant> {
        let combinations = self
            .settings
            .each
            .iter()
            .map(Each::count)
            .product::<usize>() as u32;
        let numbers = 1..=self.settings.variants.map_or(1, u32::from);
        let of = |combination| {
            let with = move |number| Variant {
                number,
                combination,
            };
            numbers.clone().map(with)
        };
        (0..combinations).flat_map(of).collect()
    }

    /// Every picture of the batch or the shard: its input and its variant.
    pub fn pictures(&self) -> impl Iterator<Item = (&Input, Variant)> {
        let variants = self.variants();
        self.found.inputs.iter().flat_map(move |input| {
            let variants = variants.clone().into_iter();
            variants.map(move |variant| (input, variant))
        })
    }

    /// The settings of which every picture gets each value, with the index of the value in a variant.
    pub(super) fn chosen(&self, variant: Variant) -> Vec<(&Each, usize)> {
        let mut left = variant.combination as usize;
        let mut chosen: Vec<(&Each, usize)> = Vec::new();
        for each in self.settings.each.iter().rev() {
            chosen.push((each, left % each.count()));
            left /= each.count();
        }
        chosen.reverse();
        chosen
    }

    /// Path of the manifest.
    pub fn manifest(&self) -> PathBuf {
        match &self.settings.manifest {
            Some(path) => path.clone(),
            None => {
                let name = manifest::name(self.settings.shard.as_ref());
                self.output.folder(&self.settings.each).join(name)
            }
        }
    }

    /// The output of a picture.
    pub fn output(&self, input: &Input, variant: Variant) -> PathBuf {
        let path = match &self.output {
            OutputPath::File(path) => path.clone(),
            OutputPath::Pattern(pattern) => pattern.path(&input.captures),
            OutputPath::Folder(folder) => {
                let ending = self.scene.overlay.ending_in_folder(&input.colour);
                folder.join(format!("{}.{ending}", input.name()))
            }
        };
        let mut text = path.to_string_lossy().into_owned();
        let mut suffix = String::new();
        for (each, at) in self.chosen(variant) {
            let (placeholder, value) = (placeholder(each), each.value(at).to_string());
            match text.contains(&placeholder) {
                true => text = text.replace(&placeholder, &value),
                false => suffix.push_str(&format!("_{}-{value}", each.name())),
            }
        }
        let number = format!("{:04}", variant.number);
        if text.contains(VARIANT) {
            text = text.replace(VARIANT, &number);
        } else if self.settings.variants.is_some() {
            suffix.push_str(&format!("_v{number}"));
        }
        let path = PathBuf::from(text);
        if suffix.is_empty() {
            return path;
        }
        let part = |part: Option<&std::ffi::OsStr>| {
            part.unwrap_or_default().to_string_lossy().into_owned()
        };
        let (stem, ending) = (part(path.file_stem()), part(path.extension()));
        path.with_file_name(format!("{stem}{suffix}.{ending}"))
    }

    /// The description of a picture: its input files, its varied settings drawn, and its values of the others. [`Self::output`] is
    /// its output.
    pub fn scene_of(&self, input: &Input, variant: Variant) -> OverlayScene {
        let mut scene = self.scene.clone();
        scene.overlay.colour = input.colour.clone();
        scene.overlay.depth = (input.depth != input.colour).then(|| input.depth.clone());
        // The manifest names the output, relative to its folder.
        scene.scene.output.file = None;
        let name = input.name();
        for variation in &self.settings.vary {
            variation.draw(&mut scene, self.settings.seed, &name, variant.number);
        }
        for (each, at) in self.chosen(variant) {
            each.set(&mut scene, at);
        }
        if let Some(interval_s) = self.settings.patch_interval_s
            && let Some(patches) = &mut scene.fog_mut().patches
        {
            *patches = patches.after(interval_s * input.index as f64);
        }
        scene
    }

    /// Whether a setting that differs between pictures changes more than the fog.
    pub(super) fn varies(&self, what: Affects) -> bool {
        let listed = self.settings.each.iter().map(Each::variation);
        let mut all = self.settings.vary.iter().chain(listed);
        all.any(|variation| variation.affects() == what)
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
            self.scene.output_format(&output)?;
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

/// Refuses an interval without a wind.
fn check_patch_interval(scene: &OverlayScene, interval_s: f64) -> Result<(), RenderError> {
    let patches = scene.fog().patches.as_ref();
    match patches.and_then(|patches| patches.wind_m_s) {
        Some(_) => Ok(()),
        None => Err(RenderError::value(
            "patch_interval_s",
            "patches of fog that a wind moves",
            format!("{interval_s} s without a wind"),
            "patch-wind 2,0",
        )),
    }
}

/// Refuses variations that contradict each other or the description or have no effect, and invalid choices.
fn check_variation(
    scene: &OverlayScene,
    given: &[(&'static str, &Variation)],
) -> Result<(), BatchError> {
    let vary = || given.iter().map(|(_, variation)| *variation);
    let refuse = |name: &str, expected: &str, got: String, advice: &str| {
        let option = given.iter().rev().find(|(_, its)| its.name() == name);
        Err(BatchError::Variation {
            option: option.map_or("vary", |(option, _)| option),
            name: name.to_owned(),
            expected: expected.to_owned(),
            got,
            advice: advice.to_owned(),
        })
    };
    let mut names = HashSet::new();
    for variation in vary() {
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
    let profiles = vary().find(|variation| variation.name() == "fog-profile");
    let profiles = profiles
        .and_then(|variation| variation.choices())
        .unwrap_or(&own);
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
    // Check each value of a list and both ends of a range with the first values of the other settings.
    let mut base = scene.clone();
    for variation in vary() {
        variation.set(&mut base, 0.0);
    }
    for variation in vary() {
        for scene in variation.extremes(&base) {
            scene.check()?;
        }
    }
    Ok(base.check()?)
}

/// Placeholder for the value of a setting in an output name.
fn placeholder(each: &Each) -> String {
    format!("{{{}}}", each.name())
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
    fn folder(&self, each: &[Each]) -> PathBuf {
        let folder = match self {
            Self::File(path) => path.parent().map(Path::to_owned).unwrap_or_default(),
            Self::Folder(folder) => folder.clone(),
            Self::Pattern(pattern) => pattern.base().to_owned(),
        };
        let placeholders = || each.iter().map(placeholder);
        let is_common = |name: &std::path::Component<'_>| {
            let name = name.as_os_str().to_string_lossy();
            !name.contains(VARIANT) && !placeholders().any(|one| name.contains(&one))
        };
        folder.components().take_while(is_common).collect()
    }
}
