//! [`SequenceRun`]: the missing pictures of a sequence, and its manifest.

use super::{Sequence, SequenceStep};
use crate::RenderError;
use crate::frame::{PreparedFrame, WrittenFrame};
use crate::manifest::{self, Existing, MANIFEST_VERSION, Manifest};
use crate::renderer::Renderer;
use crate::shard::Shard;
use airlight::scene::Scene;
use airlight_image::Control;
use airlight_image::output::AtomicFile;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Settings of a run over a sequence.
#[derive(Clone, Debug, Default)]
pub struct SequenceSettings {
    /// The part of the pictures that is drawn; `None`: all.
    pub shard: Option<Shard>,
    /// Whether existing pictures are replaced.
    pub overwrite: bool,
    /// Path of the manifest; `None`: `manifest.jsonl` beside the pictures, `manifest-3-of-16.jsonl` for a shard.
    pub manifest: Option<PathBuf>,
}

/// The missing pictures of a sequence or of a part of it, and the open manifest, which records each picture.
#[derive(Debug)]
pub struct SequenceRun {
    /// `None` once it is finished.
    manifest: Option<Manifest>,
    path: PathBuf,
    missing: Vec<SequenceStep>,
    settings: Vec<StepSettings>,
    total: usize,
    removed: u64,
}

/// What a picture of a sequence depends on.
#[derive(Clone, Debug, Serialize)]
struct StepSettings {
    /// The scene at the time of the picture, without its output file and its sequence.
    #[serde(flatten)]
    scene: Scene,
    /// Times from which the common exposure is metered.
    metered_at: Option<Vec<String>>,
}

/// The line of a picture.
#[derive(Serialize)]
struct Record<'a> {
    /// Output relative to the manifest's folder. This is the first key, by which a manifest is recognised.
    output: &'a str,
    manifest_version: u32,
    number: u64,
    /// What the picture depends on.
    scene: &'a StepSettings,
    sun_elevation_deg: f64,
    sun_azimuth_deg: f64,
    airlight: &'static str,
}

impl Renderer {
    /// Opens the manifest of a sequence, finds the pictures that do not exist yet, and removes what killed runs left of them.
    ///
    /// # Errors
    /// [`RenderError`] if the folder is missing, the manifest is not usable, or an existing picture was drawn from another scene or is
    /// not in the manifest; the manifest is then unchanged.
    pub fn start_sequence(
        &self,
        sequence: &Sequence,
        settings: &SequenceSettings,
    ) -> Result<SequenceRun, RenderError> {
        let metered_at = self.meters_together().then(|| {
            let steps = sequence.first_middle_last().into_iter();
            steps.map(|step| step.time.to_string()).collect()
        });
        let of_step = |step: &SequenceStep| {
            let mut scene = self.scene().clone();
            (scene.output.file, scene.sequence) = (None, None);
            scene.sun.time = Some(step.time.to_string());
            if let (Some(fog), Some(patches)) = (&mut scene.fog, self.patches_at(Some(step.time))) {
                fog.patches = Some(patches);
            }
            StepSettings {
                scene,
                metered_at: metered_at.clone(),
            }
        };
        let is_ours = |step: &&SequenceStep| {
            let index = step.number as usize - 1;
            settings.shard.is_none_or(|shard| shard.has(index))
        };
        let ours: Vec<&SequenceStep> = sequence.steps().iter().filter(is_ours).collect();
        let path = match &settings.manifest {
            Some(path) => path.clone(),
            None => self
                .output_path()?
                .with_file_name(manifest::name(settings.shard.as_ref())),
        };
        // Refuses a folder that does not exist.
        AtomicFile::create(&path)?;
        let manifest = Manifest::open(&path)?;
        let mut existing = Existing::default();
        let (mut missing, mut missing_settings) = (Vec::new(), Vec::new());
        let mut compared = Ok(());
        for step in &ours {
            let of_step = of_step(step);
            if settings.overwrite || !step.is_whole() {
                missing.push((*step).clone());
                missing_settings.push(of_step);
            } else if compared.is_ok() {
                compared = manifest.compare(&step.path, &of_step, &mut existing);
            }
        }
        if let Err(refusal) = compared.and_then(|()| existing.check()) {
            manifest.close()?;
            return Err(refusal.into());
        }
        let files = ours.iter().flat_map(|step| &step.files);
        let targets = files
            .map(|file| file.path.as_path())
            .chain([path.as_path()]);
        Ok(SequenceRun {
            removed: AtomicFile::remove_leftovers(targets),
            manifest: Some(manifest),
            path,
            missing,
            settings: missing_settings,
            total: ours.len(),
        })
    }
}

impl SequenceRun {
    /// Pictures to draw, in order.
    pub fn missing(&self) -> &[SequenceStep] {
        &self.missing
    }

    /// Number of pictures, existing ones included.
    pub fn total(&self) -> usize {
        self.total
    }

    /// Number of unfinished files of earlier runs that were removed.
    pub fn removed(&self) -> u64 {
        self.removed
    }

    /// Path of the manifest.
    pub fn manifest(&self) -> &Path {
        &self.path
    }

    /// Writes the picture at an index of [`SequenceRun::missing`], and its line of the manifest.
    ///
    /// # Errors
    /// [`RenderError`] if there is no such picture, and as [`PreparedFrame::write`].
    pub fn write(
        &self,
        index: usize,
        frame: &PreparedFrame,
        control: Control<'_>,
    ) -> Result<WrittenFrame, RenderError> {
        let (Some(step), Some(settings), Some(manifest)) = (
            self.missing.get(index),
            self.settings.get(index),
            &self.manifest,
        ) else {
            return Err(RenderError::setting(format!(
                "expected one of {} missing pictures, got index {index}",
                self.missing.len()
            )));
        };
        let name = manifest.name_of(&step.path);
        let sun = frame.sun();
        let record = Record {
            output: &name,
            manifest_version: MANIFEST_VERSION,
            number: step.number,
            scene: settings,
            sun_elevation_deg: sun.elevation_deg,
            sun_azimuth_deg: sun.azimuth_deg,
            airlight: env!("CARGO_PKG_VERSION"),
        };
        let files = step.files.iter().map(|file| file.path.as_path());
        manifest.begin(files, &name, &record)?;
        frame.write(&step.path, control)
    }

    /// Sorts the manifest and closes it.
    ///
    /// # Errors
    /// [`RenderError`] if it cannot be written.
    pub fn finish(mut self) -> Result<(), RenderError> {
        match self.manifest.take() {
            Some(manifest) => Ok(manifest.finish()?),
            None => Ok(()),
        }
    }
}

impl Drop for SequenceRun {
    /// Sorts the manifest of a run that stopped; its lines are valid without that.
    fn drop(&mut self) {
        if let Some(manifest) = self.manifest.take() {
            let _ = manifest.finish();
        }
    }
}
