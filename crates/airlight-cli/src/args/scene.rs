//! Options that describe a scene: a file and overrides.

use super::fog::{ContrastArgs, FogArgs};
use super::{AirArgs, NightArgs, PlaceArgs, SolverArgs};
use crate::error::CliError;
use crate::parse::put;
use airlight::scene::Scene;
use airlight_render::scene_file;
use clap::Args;
use std::path::{Path, PathBuf};

/// A scene: a file and overrides.
#[derive(Clone, Debug, Default, Args)]
pub struct SceneArgs {
    /// Scene file, which the other options override (`airlight schema` prints its JSON Schema)
    #[arg(long, value_name = "FILE.toml", help_heading = "Scene")]
    pub scene: Option<PathBuf>,
    #[command(flatten)]
    pub place: PlaceArgs,
    #[command(flatten)]
    pub night: NightArgs,
    #[command(flatten)]
    pub air: AirArgs,
    #[command(flatten)]
    pub contrast: ContrastArgs,
    #[command(flatten)]
    pub solver: SolverArgs,
    #[command(flatten)]
    pub fog: FogArgs,
}

impl SceneArgs {
    /// The scene of the file and the options, with the files that it names; `more` applies further options.
    ///
    /// # Errors
    /// [`CliError`] if a file cannot be read or is invalid.
    pub fn read(&self, more: impl FnOnce(&mut Scene)) -> Result<Scene, CliError> {
        let scene = match &self.scene {
            Some(path) => scene_file::load(path)?,
            None => Scene::default(),
        };
        self.over(scene, more)
    }

    /// A scene with the options over it, and the files that it names; `more` applies further options.
    ///
    /// # Errors
    /// [`CliError`] if a file cannot be read or is invalid.
    pub fn over(&self, mut scene: Scene, more: impl FnOnce(&mut Scene)) -> Result<Scene, CliError> {
        self.place.fill(&mut scene);
        self.night.fill(&mut scene);
        self.air.fill(&mut scene.air);
        put(&mut scene.air.contrast, &self.contrast.contrast);
        self.solver.fill(&mut scene.solver);
        self.fog.fill(&mut scene.fog);
        more(&mut scene);
        scene_file::inline_files(&mut scene, Path::new(""))?;
        Ok(scene)
    }
}
