//! Job templates as JSON: the work of `airlight.openjd`.

use crate::errors::Failure;
use crate::scene::Scene;
use airlight_render::Renderer;
use airlight_render::openjd::JobTemplate;
use pyo3::prelude::*;

/// The JSON of ``airlight.openjd.job``.
#[pyfunction]
pub fn job_of_command(name: &str, command: Vec<String>, tasks: u32) -> Result<String, Failure> {
    Ok(JobTemplate::of_command(name, &command, tasks)?.to_json())
}

/// The JSON of ``airlight.openjd.sky_job``.
#[pyfunction]
#[pyo3(signature = (scene, tasks=None))]
pub fn job_of_scene(scene: &Scene, tasks: Option<u32>) -> Result<String, Failure> {
    let renderer = Renderer::new(scene.scene())?;
    Ok(JobTemplate::of_scene(&renderer, tasks)?.to_json())
}
