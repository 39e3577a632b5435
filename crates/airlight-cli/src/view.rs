//! `airlight view`: the window.

use crate::args::ViewArgs;
use crate::error::CliError;

/// Opens the window, or draws it into a file.
///
/// # Errors
/// [`CliError`] for an invalid scene, and without a display or a graphics device.
#[cfg(feature = "view")]
pub fn run(args: &ViewArgs) -> Result<(), CliError> {
    use airlight_viewer::state::Terrain;
    use airlight_viewer::{Options, State};
    use std::path::Path;

    let usual = Options::default();
    let state = match &args.file {
        Some(file) => State::load(file)?,
        None => usual.state,
    };
    let scene = args.over(state.scene)?;
    scene.validate()?;
    let size = scene.camera.size.map_or(usual.size, |size| {
        let size = size.map(|v| v as f32);
        match args.screenshot {
            Some(_) => size,
            None => on_screen(size),
        }
    });
    let terrain = args.terrain.as_ref().map(|file| Terrain {
        file: (file != Path::new("mountains")).then(|| file.display().to_string()),
        spacing_m: args.terrain_spacing_m,
        ..Default::default()
    });
    let options = Options {
        state: State {
            terrain: terrain.or(state.terrain),
            compare: state.compare,
            photograph: state.photograph,
            ..State::of_scene(scene)
        },
        size,
        panel: !args.no_panel,
    };
    let shown = match &args.screenshot {
        Some(file) => airlight_viewer::screenshot(options, file),
        None => airlight_viewer::run(options),
    };
    shown.map_err(|error| CliError::failure(error.to_string()))
}

/// The size of a window for a picture of a size: at most [`LARGEST_SIDE`] on a side.
#[cfg(feature = "view")]
fn on_screen(size: [f32; 2]) -> [f32; 2] {
    let factor = (LARGEST_SIDE / size[0].max(size[1])).min(1.0);
    size.map(|side| factor * side)
}

/// Longest side of a window, points.
#[cfg(feature = "view")]
const LARGEST_SIDE: f32 = 1920.0;

/// States how to build the window.
///
/// # Errors
/// Always.
#[cfg(not(feature = "view"))]
pub fn run(args: &ViewArgs) -> Result<(), CliError> {
    let scene = match &args.file {
        Some(file) => airlight_render::scene_file::load(file)?,
        None => airlight::scene::Scene::default(),
    };
    args.over(scene)?;
    Err(CliError::failure(
        "this program was built without the viewer; try \
         cargo install --locked --path crates/airlight-cli --features view",
    ))
}
