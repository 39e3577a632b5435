//! Running a batch: each thread reads a picture, adds fog, writes it and takes the next.

use super::record::{Record, Which};
use super::settings::Affects;
use super::{BatchError, BatchPlan, Input, Variant};
use crate::RenderError;
use crate::manifest::{Existing, Manifest, is_whole};
use crate::overlay::{OverlayImage, OverlayScene, PreparedOverlay, SkyLight};
use airlight_image::output::AtomicFile;
use airlight_image::{Control, ImageError, Notes};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A batch that is ready to run, with an open manifest and the list of missing pictures.
#[derive(Debug)]
pub struct BatchRun<'a> {
    plan: &'a BatchPlan,
    manifest: Manifest,
    tasks: Vec<Task<'a>>,
    light: Option<SkyLight>,
    /// Number of unfinished files of earlier runs that were removed.
    removed: u64,
}

/// Result of a batch.
#[derive(Debug, Default)]
pub struct BatchReport {
    /// Number of pictures written.
    pub made: usize,
    /// Pictures that failed, each with the reason.
    pub failures: Vec<String>,
    /// What was converted, repaired or passed over in the files of the pictures written.
    pub notes: Notes,
    /// Why the remaining pictures were not written, if any remain.
    pub stopped: Option<BatchError>,
}

/// Pictures to write for one input.
#[derive(Clone, Debug)]
struct Task<'a> {
    input: &'a Input,
    variants: Vec<Variant>,
}

impl BatchPlan {
    /// Opens the manifest, finds the pictures that do not exist yet, and solves the sky if all pictures share one.
    ///
    /// # Errors
    /// [`BatchError`] if the manifest is not usable, an existing picture has other settings, or the sky cannot be solved; the
    /// manifest is then unchanged.
    pub fn start(&self) -> Result<BatchRun<'_>, BatchError> {
        self.start_with(Control::default())
    }

    /// As [`Self::start`], with cancellation.
    ///
    /// # Errors
    /// As [`Self::start`], and if the caller cancelled.
    pub fn start_with(&self, control: Control<'_>) -> Result<BatchRun<'_>, BatchError> {
        let light = match self.varies(Affects::Sky) {
            true => None,
            false => self.scene().solve_sky_with(control)?,
        };
        let path = self.manifest();
        create_folder(path.parent())?;
        let manifest = Manifest::open(&path)?;
        match missing(self, &manifest) {
            Ok(tasks) => Ok(BatchRun {
                plan: self,
                manifest,
                tasks,
                light,
                removed: remove_leftovers(self, &path),
            }),
            Err(refusal) => {
                manifest.close()?;
                Err(refusal)
            }
        }
    }
}

impl BatchRun<'_> {
    /// Number of pictures to write.
    pub fn missing(&self) -> usize {
        self.tasks.iter().map(|task| task.variants.len()).sum()
    }

    /// Writes the pictures on several threads until all are written or the caller cancels, and finishes the manifest. Progress is
    /// in pictures. A picture whose input cannot be read or whose settings are invalid fails without stopping the others; one
    /// that cannot be written stops the batch.
    ///
    /// # Errors
    /// [`BatchError`] if the manifest cannot be finished. Other errors are in the report.
    pub fn run(self, control: Control<'_>) -> Result<BatchReport, BatchError> {
        let threads = self.plan.settings().threads;
        let threads = threads.map_or_else(
            || std::thread::available_parallelism().map_or(1, usize::from),
            |threads| threads.get() as usize,
        );
        let tasks = split(&self.tasks, threads);
        let worker = Worker {
            plan: self.plan,
            manifest: &self.manifest,
            light: self.light.as_ref(),
            control,
            total: self.missing() as u64,
            report: Mutex::new(BatchReport::default()),
        };
        let next = AtomicUsize::new(0);
        let workers = threads.min(tasks.len());
        std::thread::scope(|scope| {
            for index in 0..workers {
                // With fewer pictures than threads, several threads share a picture.
                let threads = threads / workers + usize::from(index < threads % workers);
                let (worker, tasks, next) = (&worker, &tasks, &next);
                scope.spawn(move || {
                    // In a shared pool, a thread that waits for part of its picture would start another picture, and more pictures
                    // than threads would be in memory.
                    let pool = rayon::ThreadPoolBuilder::new()
                        .num_threads(threads)
                        .use_current_thread()
                        .build();
                    if let Err(error) = pool {
                        worker.stop(BatchError::Threads(error.to_string()));
                    }
                    while !worker.is_stopped() {
                        let Some(task) = tasks.get(next.fetch_add(1, Ordering::Relaxed)) else {
                            return;
                        };
                        if let Err(error) = worker.make(task) {
                            worker.stop(error);
                        }
                    }
                });
            }
        });
        let mut report = worker
            .report
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        self.manifest.finish()?;
        let text = "unfinished files of an earlier run removed";
        report.notes.count(self.removed, text);
        Ok(report)
    }
}

/// Removes what killed runs left of the plan's pictures and of its manifest, which this run holds.
fn remove_leftovers(plan: &BatchPlan, manifest: &Path) -> u64 {
    let outputs = plan
        .pictures()
        .map(|(input, variant)| plan.output(input, variant));
    let targets: Vec<PathBuf> = outputs.chain([manifest.to_owned()]).collect();
    AtomicFile::remove_leftovers(targets.iter().map(PathBuf::as_path))
}

/// The pictures that do not exist yet, by input.
///
/// # Errors
/// [`BatchError::Manifest`] for existing pictures with other settings or without a line.
fn missing<'a>(plan: &'a BatchPlan, manifest: &Manifest) -> Result<Vec<Task<'a>>, BatchError> {
    let mut tasks: Vec<Task<'a>> = Vec::new();
    let mut existing = Existing::default();
    for (input, variant) in plan.pictures() {
        let output = plan.output(input, variant);
        if plan.settings().overwrite || !is_whole(&output) {
            match tasks
                .last_mut()
                .filter(|task| std::ptr::eq(task.input, input))
            {
                Some(task) => task.variants.push(variant),
                None => tasks.push(Task {
                    input,
                    variants: vec![variant],
                }),
            }
            continue;
        }
        manifest.compare(&output, &plan.scene_of(input, variant), &mut existing)?;
    }
    existing.check()?;
    Ok(tasks)
}

/// Splits tasks so that there is at least one for each thread, if there are enough pictures.
fn split<'a>(tasks: &[Task<'a>], threads: usize) -> Vec<Task<'a>> {
    let parts = threads.div_ceil(tasks.len().max(1));
    tasks
        .iter()
        .flat_map(|task| {
            let each = task.variants.len().div_ceil(parts);
            task.variants.chunks(each.max(1)).map(|variants| Task {
                input: task.input,
                variants: variants.to_vec(),
            })
        })
        .collect()
}

struct Worker<'a> {
    plan: &'a BatchPlan,
    manifest: &'a Manifest,
    light: Option<&'a SkyLight>,
    control: Control<'a>,
    total: u64,
    report: Mutex<BatchReport>,
}

impl Worker<'_> {
    fn report(&self) -> MutexGuard<'_, BatchReport> {
        self.report.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn is_stopped(&self) -> bool {
        if let Err(cancelled) = self.control.check() {
            self.stop(ImageError::from(cancelled).into());
        }
        self.report().stopped.is_some()
    }

    /// Stops the batch; only the first reason is stored.
    fn stop(&self, error: BatchError) {
        self.report().stopped.get_or_insert(error);
    }

    /// Writes the pictures of one input.
    ///
    /// # Errors
    /// [`BatchError`] if the batch must stop.
    fn make(&self, task: &Task<'_>) -> Result<(), BatchError> {
        let Task { input, variants } = task;
        let Some(first) = variants.first() else {
            return Ok(());
        };
        let format = self
            .plan
            .scene()
            .output_format(&self.plan.output(input, *first))?;
        // Settings that change how files are read need a picture of their own.
        let at_once = match self.plan.varies(Affects::Files) {
            true => 1,
            false => variants.len(),
        };
        for variants in variants.chunks(at_once) {
            let scene = self.plan.scene_of(input, variants[0]);
            match OverlayImage::read_with(&scene, format, self.control) {
                Ok(image) => self.make_all(input, &image, variants)?,
                Err(error) => variants
                    .iter()
                    .try_for_each(|variant| self.failed(input, *variant, &error))?,
            }
        }
        Ok(())
    }

    /// Writes pictures of an image.
    ///
    /// # Errors
    /// [`BatchError`] if the batch must stop.
    fn make_all(
        &self,
        input: &Input,
        image: &OverlayImage,
        variants: &[Variant],
    ) -> Result<(), BatchError> {
        self.report().notes.merge(&image.notes());
        for variant in variants {
            if self.is_stopped() {
                return Ok(());
            }
            let scene = self.plan.scene_of(input, *variant);
            match self.make_one(&scene, image, input, *variant) {
                Ok(()) => {
                    let mut report = self.report();
                    report.made += 1;
                    self.done(&report);
                }
                // The settings of this picture are invalid.
                Err(BatchError::Render(error)) if error.is_refusal() => {
                    self.failed(input, *variant, &error)?;
                }
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn make_one(
        &self,
        scene: &OverlayScene,
        image: &OverlayImage,
        input: &Input,
        variant: Variant,
    ) -> Result<(), BatchError> {
        let control = self.control.without_progress();
        let own = match self.plan.varies(Affects::Sky) {
            true => scene.solve_sky_with(control)?,
            false => None,
        };
        let light = own.as_ref().or(self.light);
        let prepared = PreparedOverlay::new_with(scene, image, light, control)?;
        let output = &self.plan.output(input, variant);
        let rows = prepared.output(scene, image, scene.output_format(output)?)?;
        let name = self.manifest.name_of(output);
        create_folder(output.parent())?;
        let settings = self.plan.settings();
        let seed = (!settings.vary.is_empty()).then_some(settings.seed);
        let record = Record::made(
            &name,
            input,
            self.which(variant),
            scene,
            seed,
            image,
            (&prepared, rows.exposure()),
        );
        self.manifest.begin([output.as_path()], &name, &record)?;
        let written = rows.write(output, control)?;
        let mut notes = rows.overlay().notes();
        notes.count(
            written.clamped_samples,
            format!("samples {}", rows.format().clamping()),
        );
        self.report().notes.merge(&notes);
        Ok(())
    }

    /// Records a picture that failed.
    ///
    /// # Errors
    /// [`BatchError`] if the batch must stop.
    fn failed(
        &self,
        input: &Input,
        variant: Variant,
        error: &RenderError,
    ) -> Result<(), BatchError> {
        if error.is_cancelled() {
            return Err(ImageError::Cancelled.into());
        }
        let why = error.to_string();
        let scene = self.plan.scene_of(input, variant);
        let output = &self.plan.output(input, variant);
        let name = self.manifest.name_of(output);
        let record = Record::failed(&name, input, self.which(variant), &scene, &why);
        self.manifest.add(&name, true, &record)?;
        let mut report = self.report();
        report
            .failures
            .push(format!("`{}`: {why}", output.display()));
        if self.plan.settings().fail_fast {
            report.stopped.get_or_insert(BatchError::FirstFailure(why));
        }
        self.done(&report);
        Ok(())
    }

    /// What distinguishes a picture from the others of its input, for the manifest.
    fn which(&self, variant: Variant) -> Which {
        let chosen = self.plan.chosen(variant).into_iter();
        Which {
            variant: variant.number,
            each: chosen
                .map(|(each, at)| (each.name(), each.value(at)))
                .collect(),
        }
    }

    fn done(&self, report: &BatchReport) {
        let done = report.made + report.failures.len();
        self.control.report(done as u64, self.total);
    }
}

/// Creates a folder if it does not exist.
fn create_folder(folder: Option<&Path>) -> Result<(), BatchError> {
    let Some(folder) = folder.filter(|folder| !folder.as_os_str().is_empty()) else {
        return Ok(());
    };
    std::fs::create_dir_all(folder).map_err(|source| BatchError::File {
        action: "create the folder",
        path: folder.to_owned(),
        source,
    })
}
