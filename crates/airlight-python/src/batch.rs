//! `fog_batch`: fog over many picture files.

use crate::compute::compute;
use crate::errors::Failure;
use airlight_render::batch::{BatchPlan, BatchSettings};
use airlight_render::openjd::JobTemplate;
use airlight_render::overlay::OverlayScene;
use airlight_render::scene_file;
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

/// Adds fog to many picture files, as ``airlight fog`` does: existing pictures are kept, and all are recorded in a manifest.
///
/// Parameters
/// ----------
/// toml : str
///     A scene file with a table ``[overlay]``, whose ``overlay.colour``, ``overlay.depth`` and ``output.file`` are folders or
///     patterns.
/// vary : list of str
///     Settings drawn for each picture, such as ``visibility=50..500``.
/// each : list of str
///     Settings of which every picture gets each value, such as ``visibility=50,100,200``.
/// variants : int or None
///     Pictures made of each input.
/// seed : int
///     Seed of the draws, which also depend on the name of the picture, and not on the shard.
/// shard : str or None
///     The part of the inputs to make: ``3/16`` is the third of 16.
/// manifest : str, os.PathLike or None
///     The manifest; None: ``manifest.jsonl`` beside the outputs, with the shard in its name.
/// overwrite : bool
///     Whether existing pictures are replaced.
/// threads : int or None
///     Number of threads.
///
/// Returns
/// -------
/// made, existing : int
///     Numbers of pictures.
/// failures : list[str]
///     Pictures that failed, each with the reason.
///
/// Raises
/// ------
/// OSError
///     Where a picture cannot be written, as on a full disk; the others remain, and a later call resumes.
#[pyfunction]
#[pyo3(signature = (
    toml,
    *,
    vary = Vec::new(),
    each = Vec::new(),
    variants = None,
    seed = 0,
    shard = None,
    manifest = None,
    overwrite = false,
    threads = None
), text_signature = "(toml, *, vary=(), each=(), variants=None, seed=0, shard=None, manifest=None, overwrite=False, threads=None)")]
#[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
pub fn fog_batch(
    py: Python<'_>,
    toml: &str,
    vary: Vec<String>,
    each: Vec<String>,
    variants: Option<NonZeroU32>,
    seed: u64,
    shard: Option<&str>,
    manifest: Option<PathBuf>,
    overwrite: bool,
    threads: Option<NonZeroU32>,
) -> PyResult<(usize, usize, Vec<String>)> {
    let settings = BatchSettings {
        shard: shard
            .map(|shard| shard.parse().map_err(Failure::Invalid))
            .transpose()?,
        manifest,
        overwrite,
        threads,
        ..draws(&vary, &each, variants, seed)?
    };
    let (made, existing, failures, stopped) =
        compute(py, threads.map(|n| n.get() as usize), |control| {
            let plan = plan(toml, settings)?;
            let batch = plan.start_with(control)?;
            let existing = plan.pictures().count() - batch.missing();
            let report = batch.run(control)?;
            let stopped = report.stopped.map(|error| error.to_string());
            Ok::<_, Failure>((report.made, existing, report.failures, stopped))
        })?;
    match stopped {
        Some(sentence) => Err(PyOSError::new_err(sentence)),
        None => Ok((made, existing, failures)),
    }
}

/// The settings that differ between pictures.
fn draws(
    vary: &[String],
    each: &[String],
    variants: Option<NonZeroU32>,
    seed: u64,
) -> Result<BatchSettings, Failure> {
    Ok(BatchSettings {
        vary: parsed(vary)?,
        each: parsed(each)?,
        variants,
        seed,
        ..BatchSettings::default()
    })
}

/// The pictures of a scene file with a table ``[overlay]``.
fn plan(toml: &str, settings: BatchSettings) -> Result<BatchPlan, Failure> {
    let mut scene = OverlayScene::from_toml(toml)?;
    scene_file::inline_files(&mut scene.scene, Path::new(""))?;
    Ok(BatchPlan::new(scene, settings)?)
}

/// The JSON of ``airlight.openjd.fog_job``.
#[pyfunction]
#[pyo3(
    signature = (toml, tasks=None, *, vary=Vec::new(), each=Vec::new(), variants=None, seed=0),
    text_signature = "(toml, tasks=None, *, vary=(), each=(), variants=None, seed=0)"
)]
pub fn job_of_batch(
    toml: &str,
    tasks: Option<u32>,
    vary: Vec<String>,
    each: Vec<String>,
    variants: Option<NonZeroU32>,
    seed: u64,
) -> Result<String, Failure> {
    let plan = plan(toml, draws(&vary, &each, variants, seed)?)?;
    Ok(JobTemplate::of_batch(&plan, tasks)?.to_json())
}

/// Settings from their texts.
fn parsed<T: std::str::FromStr<Err = String>>(texts: &[String]) -> Result<Vec<T>, Failure> {
    let read = |text: &String| text.parse().map_err(Failure::Invalid);
    texts.iter().map(read).collect()
}
