//! The threads of a batch: each reads a picture, lays fog over it, writes it, and takes the next.

use super::super::light::{LightSource, SolvedSky};
use super::super::picture::{self, Subject};
use super::record::Which;
use super::{Input, Manifest, PathBuf, Plan, make_folder};
use crate::args::{OverlayArgs, overlay_vary};
use crate::error::CliError;
use crate::interrupt;
use crate::progress::PicturesBar;
use std::num::NonZeroU32;
use std::sync::{
    Mutex, PoisonError,
    atomic::{AtomicUsize, Ordering},
};

/// Pictures to make of one input.
#[derive(Clone, Debug)]
pub struct Task<'a> {
    pub input: &'a Input,
    pub variants: Vec<u32>,
}

/// What became of them.
#[derive(Default)]
pub struct Outcome {
    /// How many were made.
    pub made: usize,
    /// Which failed, and why.
    pub failures: Vec<String>,
    /// Why the rest was not tried.
    pub stopped: Option<CliError>,
}

/// Makes all pictures, as many at a time as there are to be threads. A picture that cannot be read or fogged is a failure of
/// its own; where one cannot be written, or the user stops, all end.
pub fn run(
    args: &OverlayArgs,
    light: &LightSource<'_>,
    plan: &Plan,
    manifest: &Manifest,
    tasks: &[Task<'_>],
) -> Outcome {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let jobs = args
        .batch
        .jobs
        .map_or(cores, |jobs: NonZeroU32| jobs.get() as usize);
    let tasks = pieces(tasks, jobs);
    let count = tasks.iter().map(|task| task.variants.len() as u64).sum();
    let batch = Batch {
        args,
        light,
        plan,
        manifest,
        bar: PicturesBar::new(count),
        outcome: Mutex::new(Outcome::default()),
    };
    let next = AtomicUsize::new(0);
    let workers = jobs.min(tasks.len());
    std::thread::scope(|scope| {
        for worker in 0..workers {
            // Where there are fewer pictures than threads, several work on each.
            let threads = jobs / workers + usize::from(worker < jobs % workers);
            let (batch, tasks, next) = (&batch, &tasks, &next);
            scope.spawn(move || {
                // A pool of its own: in one pool for all, a thread that waits for a part of its picture would take up another
                // picture meanwhile, and more would be in memory than there are threads.
                let pool = rayon::ThreadPoolBuilder::new()
                    .num_threads(threads)
                    .use_current_thread()
                    .build();
                if let Err(error) = pool {
                    batch.stop(CliError::failure(format!("cannot start threads: {error}")));
                }
                while !batch.is_stopped() {
                    let Some(task) = tasks.get(next.fetch_add(1, Ordering::Relaxed)) else {
                        return;
                    };
                    if let Err(error) = batch.make(task) {
                        batch.stop(error);
                    }
                }
            });
        }
    });
    batch
        .outcome
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner)
}

/// Tasks divided so that there is one for each thread, if there are as many pictures.
fn pieces<'a>(tasks: &[Task<'a>], jobs: usize) -> Vec<Task<'a>> {
    let parts = jobs.div_ceil(tasks.len().max(1));
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

struct Batch<'a, 's> {
    args: &'a OverlayArgs,
    light: &'a LightSource<'s>,
    plan: &'a Plan,
    manifest: &'a Manifest,
    bar: PicturesBar,
    outcome: Mutex<Outcome>,
}

impl Batch<'_, '_> {
    fn outcome(&self) -> std::sync::MutexGuard<'_, Outcome> {
        self.outcome.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn is_stopped(&self) -> bool {
        if interrupt::STOP.load(Ordering::Relaxed) {
            self.stop(CliError::Interrupted);
        }
        self.outcome().stopped.is_some()
    }

    /// Ends all; the first reason is kept.
    fn stop(&self, error: CliError) {
        self.outcome().stopped.get_or_insert(error);
    }

    /// Makes the pictures of one input.
    ///
    /// # Errors
    /// [`CliError`] where no other picture is to be tried.
    fn make(&self, task: &Task<'_>) -> Result<(), CliError> {
        let Task { input, variants } = task;
        let output = |variant: &u32| self.plan.output(self.args, input, *variant);
        let Some(first) = variants.first() else {
            return Ok(());
        };
        let format = picture::format_of(self.args, &output(first))?;
        let subject = match Subject::read(self.args, &input.colour, &input.depth, format) {
            Ok(subject) => subject,
            Err(error) => {
                return variants
                    .iter()
                    .try_for_each(|variant| self.failed(input, *variant, output(variant), &error));
            }
        };
        for variant in variants {
            if self.is_stopped() {
                return Ok(());
            }
            let path = output(variant);
            let options = self.plan.options(self.args, input, *variant);
            let made = self.make_one(&subject, input, *variant, &options, &path);
            match made {
                Ok(()) => {
                    self.outcome().made += 1;
                    self.bar.one_more();
                }
                // The options make no fog.
                Err(error @ CliError::Usage(_)) => self.failed(input, *variant, path, &error)?,
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn make_one(
        &self,
        subject: &Subject,
        input: &Input,
        variant: u32,
        options: &OverlayArgs,
        path: &PathBuf,
    ) -> Result<(), CliError> {
        // A sky of its own where what varies changes the sky.
        if overlay_vary::changes_the_sky(&self.args.batch.vary) {
            let solved = SolvedSky::of(options)?;
            let light = LightSource::new(solved.as_ref(), options);
            return self.write_one(&light, subject, input, variant, options, path);
        }
        self.write_one(self.light, subject, input, variant, options, path)
    }

    fn write_one(
        &self,
        light: &LightSource<'_>,
        subject: &Subject,
        input: &Input,
        variant: u32,
        options: &OverlayArgs,
        path: &PathBuf,
    ) -> Result<(), CliError> {
        let fogged = subject.fogged(options, light)?;
        let name = self.manifest.name_of(path);
        let which = Which::new(input, variant, &name);
        make_folder(path.parent())?;
        // Were an old picture there when its new line is, and this run killed, it would be taken for the new one.
        match std::fs::remove_file(path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                return Err(CliError::failure(format!(
                    "cannot write over `{}`: {error}",
                    path.display()
                )));
            }
            _ => {}
        }
        self.manifest
            .add(&name, false, &which.made(options, subject, &fogged))?;
        subject.write(&fogged, options, path, picture::format_of(options, path)?)?;
        Ok(())
    }

    /// Tells of a picture that could not be made.
    ///
    /// # Errors
    /// [`CliError`] where no other is to be tried.
    fn failed(
        &self,
        input: &Input,
        variant: u32,
        path: PathBuf,
        error: &CliError,
    ) -> Result<(), CliError> {
        let why = error.sentence().unwrap_or_default();
        let name = self.manifest.name_of(&path);
        self.manifest
            .add(&name, true, &Which::new(input, variant, &name).failed(why))?;
        self.bar.one_more();
        let mut outcome = self.outcome();
        outcome
            .failures
            .push(format!("`{}`: {why}", path.display()));
        if self.args.batch.fail_fast {
            let stopped = CliError::failure(format!("stopped at the first failure: {why}"));
            outcome.stopped.get_or_insert(stopped);
        }
        Ok(())
    }
}
